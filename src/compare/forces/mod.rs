//! Forces at the nodes of a displacement model: those of its stresses, less those of the loads.

pub mod cells;
pub(super) mod coefficients;
pub mod functions;
pub(super) mod quadrilaterals;
pub mod springs;
pub mod tractions;
pub mod turned;

use crate::bounds::{Hold, Holds, Nodes};
use crate::element::Material;
use crate::element::geometry::{gradients, shape_gradients};
use crate::problem::Problem;
use functions::Functions;

/// Barycentric coordinates of the midpoints of the edges opposite the corners, as [`shape_gradients`] counts them.
const MIDPOINTS: usize = 3;

/// Per node (vertices, then for degree 2 the midpoint of every edge; of higher degrees per coefficient), thickness included.
#[derive(Debug, Clone)]
pub struct NodalForces {
    /// ∫ c (e(u) − ε0):e(φ) − ∫ F·φ − ∫ P·φ for the two displacements of each node: the force that supports and contact exert.
    pub left: Vec<[f64; 2]>,
    /// ∫ F·φ + ∫ P·φ + ∫ cε0:e(φ).
    pub load: Vec<[f64; 2]>,
    /// ∫ cε0:e(φ) alone.
    pub initial: Vec<[f64; 2]>,
    /// Σ_j |K_ij| |u_j| + |load|: the scale of the errors by rounding of the values at the nodes.
    pub size: Vec<f64>,
    /// An upper estimate of the diagonal entry K_ii.
    pub stiffness: Vec<f64>,
    /// The triangle that contributes most to the stiffness, to name the body of a node.
    pub triangle: Vec<usize>,
    /// ∫ k (j − g)₊ g of elastic contact: the work of its pressures on its gaps.
    pub on_gaps: f64,
    /// The forces of springs, elastic layers and elastic contact.
    pub sprung: Vec<[f64; 2]>,
    /// Their part of [`Self::size`].
    pub sprung_size: Vec<f64>,
}

impl NodalForces {
    /// Forces of a continuous displacement of degree 1 or 2 with the given values at vertices and edge midpoints.
    pub fn new(problem: &Problem, degree: usize, vertex: &[[f64; 2]], middle: &[[f64; 2]]) -> Self {
        let mut forces = Self::on(problem, degree, vertex, middle, |_| true);
        let value = |node: usize| *vertex.get(node).unwrap_or_else(|| &middle[node - vertex.len()]);
        forces.add_springs(problem, degree, Functions::Values, value);
        forces.add_tractions(problem, degree, Functions::Values);
        forces.take_loads();
        forces
    }

    /// Zero forces at `count` nodes.
    pub(in crate::compare) fn zeros(count: usize) -> Self {
        NodalForces {
            left: vec![[0.0; 2]; count],
            load: vec![[0.0; 2]; count],
            initial: vec![[0.0; 2]; count],
            size: vec![0.0; count],
            stiffness: vec![0.0; count],
            triangle: vec![0; count],
            on_gaps: 0.0,
            sprung: vec![[0.0; 2]; count],
            sprung_size: vec![0.0; count],
        }
    }

    /// Adds the nodal forces of the stress at one point of a cell, of weight `weight`, where the functions of its nodes have `gradients`
    /// and the nodes the values `u`; returns strain and stress.
    pub(in crate::compare) fn add_stress(
        &mut self,
        (material, weight): (&Material, f64),
        nodes: &[usize],
        gradients: &[[f64; 2]],
        u: &[[f64; 2]],
    ) -> [[f64; 3]; 2] {
        let (mut e, mut spread) = ([0.0; 3], 0.0);
        for (d, value) in gradients.iter().zip(u) {
            // Differences from one node: a rigid translation leaves no trace.
            let (x, y) = (value[0] - u[0][0], value[1] - u[0][1]);
            e[0] += d[0] * x;
            e[1] += d[1] * y;
            e[2] += 0.5 * (d[1] * x + d[0] * y);
            spread += d[0].hypot(d[1]) * value[0].hypot(value[1]);
        }
        let (s, modulus) = (material.stress(e), material.stiffest());
        for (&node, d) in nodes.iter().zip(gradients) {
            self.left[node][0] += weight * (d[0] * s[0] + d[1] * s[2]);
            self.left[node][1] += weight * (d[0] * s[2] + d[1] * s[1]);
            self.size[node] += weight * modulus * d[0].hypot(d[1]) * spread;
        }
        [e, s]
    }

    /// Adds to the loads the forces of cε0 at one point, of weight `weight`, on nodes whose functions have `gradients` there.
    pub(in crate::compare) fn add_initial(
        &mut self,
        weight: f64,
        s: [f64; 3],
        nodes: &[usize],
        gradients: &[[f64; 2]],
    ) {
        for (&node, d) in nodes.iter().zip(gradients) {
            for forces in [&mut self.load, &mut self.initial] {
                forces[node][0] += weight * (d[0] * s[0] + d[1] * s[2]);
                forces[node][1] += weight * (d[0] * s[2] + d[1] * s[1]);
            }
            self.size[node] += weight.abs() * d[0].hypot(d[1]) * (s[0].abs() + s[1].abs() + s[2].abs());
        }
    }

    /// The forces of stresses and body forces on the triangles that are `counted`.
    pub(in crate::compare) fn on(
        problem: &Problem,
        degree: usize,
        vertex: &[[f64; 2]],
        middle: &[[f64; 2]],
        counted: impl Fn(usize) -> bool,
    ) -> Self {
        let mesh = &problem.mesh;
        let vertices = mesh.points.len();
        let of_initial = |material: &Material, k: usize, at: usize| {
            let [_, b, c] = [at, at + 1, at + 2].map(|i| mesh.corners(k)[i % 3]);
            material.held_back([0.5 * (b[0] + c[0]), 0.5 * (b[1] + c[1])])
        };
        let count = vertices + if degree == 2 { mesh.edges.len() } else { 0 };
        let mut forces = NodalForces::zeros(count);
        let mut stiffest = vec![0.0; count];
        let materials = problem.materials();
        let t = problem.scene.thickness;
        for (k, corners) in mesh.triangles.iter().enumerate().filter(|(k, _)| counted(*k)) {
            let material = &materials[mesh.body[k]];
            let modulus = material.stiffest();
            let area = t * mesh.area(k);
            let g = gradients(mesh.corners(k));
            let quadratic = [0, 1, 2].map(|i| vertices + mesh.triangle_edges[k][i]);
            let nodes: Vec<usize> = match degree {
                2 => corners.iter().copied().chain(quadratic).collect(),
                _ => corners.to_vec(),
            };
            let value = |node: usize| if node < vertices { vertex[node] } else { middle[node - vertices] };
            let u: Vec<[f64; 2]> = nodes.iter().map(|&node| value(node)).collect();
            for at in 0..MIDPOINTS {
                let shape = if degree == 2 { shape_gradients(&g, at).to_vec() } else { g.to_vec() };
                let weight = area / MIDPOINTS as f64;
                forces.add_stress((material, weight), &nodes, &shape, &u);
                if !material.initial().is_none() {
                    forces.add_initial(weight, of_initial(material, k, at), &nodes, &shape);
                }
                for (&node, d) in nodes.iter().zip(&shape) {
                    let long = d[0].hypot(d[1]);
                    let part = weight * modulus * long * long;
                    forces.stiffness[node] += part;
                    if part > stiffest[node] {
                        (stiffest[node], forces.triangle[node]) = (part, k);
                    }
                }
            }
            for (&node, f) in nodes.iter().zip(problem.force_on(k).of_area(area).at_nodes(degree == 2)) {
                forces.load[node][0] += f[0];
                forces.load[node][1] += f[1];
            }
        }
        forces
    }

    /// Subtracts the loads from the forces of the stresses: the remainder is missing in equilibrium.
    pub(in crate::compare) fn take_loads(&mut self) {
        for (node, load) in self.load.iter().enumerate() {
            self.left[node][0] -= load[0];
            self.left[node][1] -= load[1];
            self.size[node] += load[0].hypot(load[1]);
        }
    }

    /// √Σ |f_i|²/K_ii: the size of nodal forces as the root of an energy.
    pub fn energy_size(&self, size: impl Fn(usize) -> f64) -> f64 {
        let term = |(i, k): (usize, &f64)| if *k > 0.0 { size(i).powi(2) / k } else { 0.0 };
        self.stiffness.iter().enumerate().map(term).sum::<f64>().sqrt()
    }

    /// The loads, without what initial strains ask for.
    pub fn applied(&self) -> Vec<[f64; 2]> {
        self.load.iter().zip(&self.initial).map(|(f, h)| [f[0] - h[0], f[1] - h[1]]).collect()
    }

    /// The sizes of the loads and of the forces of initial strains, each as the root of an energy.
    pub fn energy_sizes(&self) -> [f64; 2] {
        let applied = self.applied();
        let loads = self.energy_size(|i| applied[i][0].hypot(applied[i][1]));
        [loads, self.energy_size(|i| self.initial[i][0].hypot(self.initial[i][1]))]
    }

    /// The part of `left` that supports cannot take; `nodes` numbers its nodes on vertices and edges.
    pub fn unsupported(&self, holds: &Holds, nodes: &Nodes) -> Vec<[f64; 2]> {
        let all = holds.of_nodes(nodes).chain(std::iter::repeat(Hold::Free));
        self.left.iter().zip(all).map(|(f, hold)| hold.project(*f)).collect()
    }
}
