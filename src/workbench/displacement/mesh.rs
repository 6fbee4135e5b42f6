//! A square of elements: assembled, loaded, solved.

use nalgebra::{DMatrix, DVector};

use super::{DisplacementElement, nodes_on, skyline};
use crate::workbench::finding::Fault;
use crate::workbench::material::Material;
use crate::workbench::outline::side_weights;

/// Nodes nearer to each other than this part of the square are one.
const SAME: f64 = 1e-7;

/// The unit square, cut into cells of one quadrilateral or two triangles.
pub struct Patch {
    /// Nodes of the whole square.
    pub nodes: Vec<[f64; 2]>,
    /// Nodes of each element.
    elements: Vec<Vec<usize>>,
    /// Cells along a side.
    cells: usize,
}

impl Patch {
    /// n × n cells whose inner corners are moved by about `distortion` times the size of a cell.
    ///
    /// # Errors
    /// The element is neither a triangle nor a quadrilateral.
    pub fn new(e: &DisplacementElement, n: usize, distortion: f64) -> Result<Self, Fault> {
        let layout = e.layout()?;
        let corner = |i: usize, j: usize| {
            let moved = |k: f64| {
                let inner = i > 0 && j > 0 && i < n && j < n;
                if inner { distortion * (12.9 * i as f64 + 78.2 * j as f64 + k).sin() } else { 0.0 }
            };
            [(i as f64 + moved(0.3)) / n as f64, (j as f64 + moved(1.9)) / n as f64]
        };
        let mut patch = Patch { nodes: Vec::new(), elements: Vec::new(), cells: n };
        for (i, j) in (0..n).flat_map(|j| (0..n).map(move |i| (i, j))) {
            let q = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
            match layout.ncols() {
                4 => patch.add(&layout, &q),
                // All diagonals one way, which triangles that lock like least.
                _ => [[q[0], q[1], q[2]], [q[0], q[2], q[3]]].iter().for_each(|t| patch.add(&layout, t)),
            }
        }
        Ok(patch)
    }

    fn add(&mut self, layout: &DMatrix<f64>, corners: &[[f64; 2]]) {
        let own = nodes_on(layout, corners).into_iter().map(|x| {
            let same = |y: &[f64; 2]| (x[0] - y[0]).abs() < SAME && (x[1] - y[1]).abs() < SAME;
            self.nodes.iter().position(same).unwrap_or_else(|| {
                self.nodes.push(x);
                self.nodes.len() - 1
            })
        });
        let own = own.collect();
        self.elements.push(own);
    }

    /// Cells along a side.
    pub fn cells(&self) -> usize {
        self.cells
    }

    /// The nodes off the boundary.
    pub fn inside(&self) -> Vec<usize> {
        let is_inside = |x: &[f64; 2]| x.iter().all(|x| *x > SAME && *x < 1.0 - SAME);
        (0..self.nodes.len()).filter(|&n| is_inside(&self.nodes[n])).collect()
    }

    /// The stiffness matrix of all elements.
    ///
    /// # Errors
    /// The formula fails.
    pub fn assembled(&self, e: &DisplacementElement, material: &Material) -> Result<DMatrix<f64>, Fault> {
        let mut whole = DMatrix::zeros(2 * self.nodes.len(), 2 * self.nodes.len());
        for element in &self.elements {
            let nodes: Vec<[f64; 2]> = element.iter().map(|&n| self.nodes[n]).collect();
            let k = e.stiffness(&nodes, material)?;
            for (i, j) in (0..k.nrows()).flat_map(|i| (0..k.ncols()).map(move |j| (i, j))) {
                whole[(2 * element[i / 2] + i % 2, 2 * element[j / 2] + j % 2)] += k[(i, j)];
            }
        }
        Ok(whole)
    }

    /// 𝓛(u_h) under the traction `load(y)` along x on the side x = 1, on rollers at x = 0 and y = 0, with the number of unknowns.
    ///
    /// # Errors
    /// The formula fails, or the matrix of the square is singular or not definite.
    pub fn energy(
        &self,
        e: &DisplacementElement,
        material: &Material,
        load: impl Fn(f64) -> f64,
    ) -> Result<(f64, usize), Fault> {
        let k = self.assembled(e, material)?;
        let mut forces = DVector::zeros(k.nrows());
        let outline = &e.outline;
        for element in &self.elements {
            for side in &outline.sides {
                let side: Vec<usize> = side.iter().map(|&n| element[n]).collect();
                let (a, b) = (self.nodes[side[0]], self.nodes[side[side.len() - 1]]);
                if [a, b].iter().all(|x| x[0] > 1.0 - SAME) {
                    let length = (b[1] - a[1]).abs();
                    let weights = side_weights(&self.nodes, &side, |s| load(a[1] + s * (b[1] - a[1])));
                    for (&n, w) in side.iter().zip(weights) {
                        forces[2 * n] += material.thickness * length * w;
                    }
                }
            }
        }
        let is_free = |i: &usize| self.nodes[i / 2][i % 2] > SAME;
        let free: Vec<usize> = (0..k.nrows()).filter(is_free).collect();
        let (k, f) = (k.select_rows(&free).select_columns(&free), forces.select_rows(&free));
        let u = skyline::solve(&k, &f).filter(|u| u.iter().all(|u| u.is_finite()));
        let text = "the matrix of a supported square of elements is not definite: there is no solution";
        let u = u.ok_or_else(|| Fault::Failed(text.into()))?;
        Ok((-0.5 * f.dot(&u), free.len()))
    }
}
