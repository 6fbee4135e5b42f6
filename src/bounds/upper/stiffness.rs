//! The energy of a triangle as a function of the nodes on its boundary, the inside minimised away.

use rayon::prelude::*;

use super::cholesky;
use super::nodes::Nodes;
use super::split::{Split, load, pull};
use crate::dual::modes::materials;
use crate::element::side::{elevation, product};
use crate::element::{Compliance, StressField};
use crate::problem::{Condition, Problem};

/// ½ uᵀKu − fᵀu of one triangle, u being x and y of the nodes on its boundary ([`Nodes::of_triangle`]).
#[derive(Debug, Clone)]
pub struct Condensed {
    size: usize,
    /// K row by row, then f: body force and traction.
    data: Box<[f64]>,
    /// What another load needs, where it was kept.
    inside: Option<Box<Inside>>,
}

/// How the inside was eliminated.
#[derive(Debug, Clone)]
struct Inside {
    /// Degree, and degrees of the sides.
    k: usize,
    degrees: [usize; 3],
    /// L of K_ii = L Lᵀ, packed.
    factor: Box<[f64]>,
    /// L⁻¹ K_ib, row by row.
    across: Box<[f64]>,
    /// L⁻¹ f_i.
    load: Box<[f64]>,
}

impl Condensed {
    /// A row of K.
    pub fn row(&self, i: usize) -> &[f64] {
        &self.data[i * self.size..(i + 1) * self.size]
    }

    /// f.
    pub fn load(&self) -> &[f64] {
        &self.data[self.size * self.size..]
    }

    /// Adds Ku, times `factor`, to `out`.
    pub fn add_times(&self, factor: f64, u: &[f64], out: &mut [f64]) {
        // K is symmetric: its rows are its columns.
        for (row, u) in self.data.chunks_exact(self.size).zip(u) {
            let by = factor * u;
            out.iter_mut().zip(row).for_each(|(o, k)| *o += by * k);
        }
    }

    /// Puts the load of other forces, on all coefficients of the triangle, in the place of f; `false` where nothing was kept
    /// for that.
    fn reload(&mut self, forces: &[f64]) -> bool {
        let Some(inside) = &mut self.inside else { return false };
        let (boundary, within) = forces.split_at(6 * inside.k);
        inside.load.copy_from_slice(within);
        cholesky::forward(&inside.factor, &mut inside.load, within.len());
        let mut load = boundary.to_vec();
        for (by, row) in inside.load.iter().zip(inside.across.chunks_exact(boundary.len())) {
            load.iter_mut().zip(row).for_each(|(f, v)| *f -= by * v);
        }
        let size = self.size;
        let own = &mut self.data[size * size..];
        if inside.degrees == [inside.k; 3] {
            own.copy_from_slice(&load);
            return true;
        }
        own.fill(0.0);
        for (i, a, p) in raising(inside.k, inside.degrees) {
            (0..2).for_each(|c| own[2 * a + c] += p * load[2 * i + c]);
        }
        true
    }

    /// The coefficients inside, x and y of each, that minimise the energy where those on the boundary are `boundary`, all in the
    /// degree of the triangle; `None` where nothing was kept for that.
    pub fn inside(&self, boundary: &[f64]) -> Option<Vec<f64>> {
        let Inside { factor, across, load, .. } = self.inside.as_deref()?;
        let rows = across.chunks_exact(boundary.len());
        let mut x: Vec<f64> = load
            .iter()
            .zip(rows)
            .map(|(f, row)| f - row.iter().zip(boundary).map(|(k, u)| k * u).sum::<f64>())
            .collect();
        cholesky::backward(factor, &mut x);
        Some(x)
    }

    /// uᵀKv.
    pub fn form(&self, u: &[f64], v: &[f64]) -> f64 {
        let row = |(row, u): (&[f64], &f64)| u * row.iter().zip(v).map(|(k, v)| k * v).sum::<f64>();
        self.data.chunks_exact(self.size).zip(u).map(row).sum()
    }

    /// f − Ku.
    pub fn residual(&self, u: &[f64], out: &mut Vec<f64>) {
        out.clear();
        out.extend_from_slice(self.load());
        self.add_times(-1.0, u, out);
    }
}

/// What pulls at a displacement: the energy is ½‖σ(v)‖²_a less the work of these.
#[derive(Debug, Clone, Copy)]
pub struct Pull<'a> {
    /// Body forces and tractions of the scene, times this.
    pub scene: f64,
    /// Forces ∫ σ : e(v) of a stress on every triangle.
    pub stress: Option<&'a StressField>,
}

impl Pull<'_> {
    /// The scene alone: the energy is 𝓛.
    pub const SCENE: Pull<'static> = Pull { scene: 1.0, stress: None };

    /// The energy of triangle `t` for displacements of degree `k`, but for tractions.
    pub fn split(&self, problem: &Problem, t: usize, k: usize, material: &Compliance) -> Split {
        let mut split = Split::new(k, problem.mesh.corners(t), material);
        split.load = self.forces(problem, t, k);
        split
    }

    /// The forces on all coefficients of triangle `t` in degree `k`, but for tractions.
    fn forces(&self, problem: &Problem, t: usize, k: usize) -> Vec<f64> {
        let corners = problem.mesh.corners(t);
        let force = problem.scene.bodies[problem.mesh.body[t]].body_force;
        let mut forces = load(k, corners, force.map(|f| self.scene * f));
        if let Some(stress) = self.stress {
            pull(k, corners, stress, t, &mut forces);
        }
        forces
    }

    /// The traction of the scene at the ends of edge `e`, where it pulls.
    fn traction(&self, problem: &Problem, e: usize) -> Option<[[f64; 2]; 2]> {
        match problem.conditions[e] {
            Condition::Traction(ends) if self.scene != 0.0 => Some(ends.map(|p| p.map(|p| self.scene * p))),
            _ => None,
        }
    }
}

/// Of every triangle, per unit thickness, with what other loads need where they are to come. `None` where the inside has no
/// unique minimum in numbers.
pub fn condensed(problem: &Problem, nodes: &Nodes, pull: Pull<'_>, keep: bool) -> Vec<Option<Condensed>> {
    let materials = materials(problem);
    let mesh = &problem.mesh;
    (0..mesh.triangles.len())
        .into_par_iter()
        .with_min_len(16)
        .map(|t| {
            let degrees = mesh.triangle_edges[t].map(|e| nodes.degree(e));
            let k = nodes.triangle_degree(mesh, t);
            let split = pull.split(problem, t, k, &materials[mesh.body[t]]);
            let mut element = lowered(eliminated(&split, degrees, keep)?, k, degrees);
            add_tractions(problem, pull, t, degrees, &mut element);
            Some(element)
        })
        .collect()
}

/// Puts the load of `pull` in the place of that of `elements`, which were made to be used again.
pub fn reload(problem: &Problem, nodes: &Nodes, pull: Pull<'_>, elements: &mut [Option<Condensed>]) {
    let mesh = &problem.mesh;
    elements.par_iter_mut().enumerate().with_min_len(16).for_each(|(t, element)| {
        if let Some(element) = element {
            let forces = pull.forces(problem, t, nodes.triangle_degree(mesh, t));
            let reloaded = element.reload(&forces);
            debug_assert!(reloaded, "made to be used once");
            add_tractions(problem, pull, t, mesh.triangle_edges[t].map(|e| nodes.degree(e)), element);
        }
    });
}

/// Adds the tractions on the boundary edges of triangle `t` to its load.
fn add_tractions(problem: &Problem, pull: Pull<'_>, t: usize, degrees: [usize; 3], element: &mut Condensed) {
    let mesh = &problem.mesh;
    for (i, &e) in mesh.triangle_edges[t].iter().enumerate() {
        let Some(ends) = pull.traction(problem, e) else { continue };
        // A boundary edge runs from corner i + 1 to corner i + 2 of its triangle.
        let (length, _) = mesh.edge_frame(e);
        let first = 3 + degrees[..i].iter().map(|k| k - 1).sum::<usize>();
        let k = degrees[i];
        let size = element.size;
        let load = &mut element.data[size * size..];
        for j in 0..=k {
            let node = match j {
                0 => (i + 1) % 3,
                j if j == k => (i + 2) % 3,
                j => first + j - 1,
            };
            let weights = [0, 1].map(|end| length * product(1, end, k, j));
            for c in 0..2 {
                load[2 * node + c] += weights[0] * ends[0][c] + weights[1] * ends[1][c];
            }
        }
    }
}

/// Eliminates the inside: with K_ii = L Lᵀ and Y = L⁻¹ K_ib, what is left is K_bb − YᵀY.
fn eliminated(split: &Split, degrees: [usize; 3], keep: bool) -> Option<Condensed> {
    let (size, inside) = (split.boundary, split.inside);
    let mut factor = split.inside();
    if !cholesky::factorise(&mut factor, inside, 0.0) {
        return None;
    }
    // The load is one more column.
    let mut y = Vec::with_capacity(inside * (size + 1));
    for i in size..size + inside {
        y.extend_from_slice(&split.row(i)[..size]);
        y.push(split.load[i]);
    }
    cholesky::forward(&factor, &mut y, inside);
    let mut data = Vec::with_capacity(size * (size + 1));
    (0..size).for_each(|i| data.extend_from_slice(&split.row(i)[..size]));
    data.extend_from_slice(&split.load[..size]);
    let (matrix, load) = data.split_at_mut(size * size);
    for y in y.chunks_exact(size + 1) {
        for (i, row) in matrix.chunks_exact_mut(size).enumerate() {
            let by = y[i];
            row.iter_mut().zip(y).for_each(|(k, v)| *k -= by * v);
            load[i] -= by * y[size];
        }
    }
    let rows = || y.chunks_exact(size + 1);
    let kept = || Inside {
        k: size / 6,
        degrees,
        factor: factor.as_slice().into(),
        across: rows().flat_map(|row| &row[..size]).copied().collect(),
        load: rows().map(|row| row[size]).collect(),
    };
    Some(Condensed { size, data: data.into(), inside: keep.then(|| Box::new(kept())) })
}

/// The same energy for sides of the given degrees, from that for sides of degree `k`.
fn lowered(element: Condensed, k: usize, degrees: [usize; 3]) -> Condensed {
    if degrees == [k; 3] {
        return element;
    }
    let raising = raising(k, degrees);
    let count = 3 + degrees.iter().map(|k| k - 1).sum::<usize>();
    let size = 2 * count;
    let mut data = vec![0.0; size * (size + 1)];
    let (matrix, load) = data.split_at_mut(size * size);
    for (i, a, p) in &raising {
        for c in 0..2 {
            load[2 * a + c] += p * element.load()[2 * i + c];
            let row = element.row(2 * i + c);
            for (j, b, q) in &raising {
                for d in 0..2 {
                    matrix[(2 * a + c) * size + 2 * b + d] += p * q * row[2 * j + d];
                }
            }
        }
    }
    Condensed { size, data: data.into(), inside: element.inside }
}

/// What coefficient i of the boundary in degree `k` has of node a where the sides have the given degrees: i, a and the factor.
fn raising(k: usize, degrees: [usize; 3]) -> Vec<(usize, usize, f64)> {
    let mut entries: Vec<(usize, usize, f64)> = (0..3).map(|corner| (corner, corner, 1.0)).collect();
    let mut first = 3;
    for (i, own) in degrees.into_iter().enumerate() {
        let node = |j: usize| match j {
            0 => (i + 1) % 3,
            j if j == own => (i + 2) % 3,
            j => first + j - 1,
        };
        for j in 1..k {
            for m in 0..=own {
                let factor = elevation(own, k, j, m);
                if factor != 0.0 {
                    entries.push((3 + i * (k - 1) + j - 1, node(m), factor));
                }
            }
        }
        first += own - 1;
    }
    entries
}
