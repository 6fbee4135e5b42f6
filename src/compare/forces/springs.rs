//! Forces of springs and elastic layers at the nodes of a displacement model.

use super::NodalForces;
use crate::element::polynomial::{positive, side};
use crate::problem::{Bed, EdgeWeight, Problem};
use crate::vector::dot;

/// The functions that belong to the nodes of a field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Functions {
    /// Values at vertices, and for degree 2 at the middles of edges.
    Values,
    /// Bernstein coefficients.
    Coefficients,
}

impl Functions {
    /// ∫ φ_i φ_j on an edge of length one.
    fn product(self, degree: usize, i: usize, j: usize) -> f64 {
        const QUADRATIC: [[f64; 3]; 3] = [[4.0, 2.0, -1.0], [2.0, 16.0, 2.0], [-1.0, 2.0, 4.0]];
        match (self, degree) {
            (Functions::Values, 2) => QUADRATIC[i][j] / 30.0,
            _ => side::product(degree, i, degree, j),
        }
    }

    /// As [`Self::product`], with the weight of the points of the edge.
    fn weighted(self, weight: EdgeWeight, degree: usize, i: usize, j: usize) -> f64 {
        if weight.radii().is_none() {
            return self.product(degree, i, j);
        }
        // The functions of values by their Bernstein coefficients.
        const VALUES: [[f64; 3]; 3] = [[1.0, -0.5, 0.0], [0.0, 2.0, 0.0], [0.0, -0.5, 1.0]];
        match (self, degree) {
            (Functions::Values, 2) => (0..3)
                .flat_map(|p| (0..3).map(move |q| (p, q)))
                .map(|(p, q)| VALUES[i][p] * VALUES[j][q] * weight.product(2, p, q))
                .sum(),
            _ => weight.product(degree, i, j),
        }
    }

    /// ∫ f φ_i of the functions of a degree, from those of the Bernstein polynomials of that degree.
    pub fn moments(self, moments: Vec<f64>) -> Vec<f64> {
        match (self, &moments[..]) {
            (Functions::Values, [a, middle, b]) => vec![a - 0.5 * middle, 2.0 * middle, b - 0.5 * middle],
            _ => moments,
        }
    }

    /// Bernstein coefficients of the jump with these values less the gap with those coefficients.
    fn beyond(self, jump: &[f64], gap: &[f64]) -> Vec<f64> {
        let own = match (self, jump) {
            (Functions::Values, [a, middle, b]) => vec![*a, 2.0 * middle - 0.5 * (a + b), *b],
            _ => jump.to_vec(),
        };
        let degree = own.len().max(gap.len()) - 1;
        let [own, gap] = [&own, gap].map(|f| side::elevate(f, degree));
        own.iter().zip(&gap).map(|(j, g)| j - g).collect()
    }

    /// ∫ d₊ φ_i on an edge of length one whose points have the weight `weight`, for all functions of degree `degree`.
    fn forces(self, weight: EdgeWeight, beyond: &[f64], degree: usize) -> Vec<f64> {
        self.moments(positive::moments(beyond, degree, weight.ends()))
    }
}

impl NodalForces {
    /// Adds the forces of springs for the values `value` of nodes: vertices, then those inside each edge. Returns the energy of the
    /// springs, thickness included.
    pub(in crate::compare) fn add_springs(
        &mut self,
        problem: &Problem,
        degree: usize,
        functions: Functions,
        value: impl Fn(usize) -> [f64; 2],
    ) -> f64 {
        let mesh = &problem.mesh;
        let along = |e: usize| -> Vec<usize> {
            let [a, b] = mesh.edges[e].vertices;
            let inside = mesh.points.len() + e * (degree - 1);
            std::iter::once(a).chain(inside..inside + degree - 1).chain([b]).collect()
        };
        let mut energy = 0.0;
        for (pair, stiffness) in problem.bed_pairs() {
            let first = along(pair.edge);
            let second: Vec<usize> = pair.opposite.map_or_else(Vec::new, |e| along(e).into_iter().rev().collect());
            for (axis, k) in pair.axes.iter().zip(stiffness).filter(|(_, k)| *k > 0.0) {
                let own = |node: &usize| dot(value(*node), *axis);
                let other = |i: usize| second.get(i).map_or(0.0, own);
                let jump: Vec<f64> = first.iter().enumerate().map(|(i, node)| own(node) - other(i)).collect();
                let size: Vec<f64> = first.iter().enumerate().map(|(i, n)| own(n).abs() + other(i).abs()).collect();
                let whole = problem.scene.thickness * k * pair.length;
                // Elastic contact resists what the jump exceeds the gap by.
                let beyond = pair.contact.map(|contact| functions.beyond(&jump, &contact.gap()));
                let forces = beyond.as_ref().map(|d| functions.forces(pair.weight, d, degree));
                if let Some((beyond, contact)) = beyond.zip(pair.contact) {
                    energy += 0.5 * whole * positive::square(&beyond, pair.weight.ends());
                    let gap = contact.gap();
                    let on_gap = |at: f64, d: f64, weight: f64| {
                        self.on_gaps += whole * weight * pair.weight.at(at) * d * side::value(&gap, at);
                    };
                    positive::points(&beyond, beyond.len() + gap.len() - 1, on_gap);
                }
                for i in 0..=degree {
                    let weight = |j: usize| whole * functions.weighted(pair.weight, degree, i, j);
                    let force: f64 = match &forces {
                        Some(forces) => whole * forces[i],
                        None => (0..=degree).map(|j| weight(j) * jump[j]).sum(),
                    };
                    let spread: f64 = (0..=degree).map(|j| weight(j).abs() * size[j]).sum();
                    energy += if forces.is_none() { 0.5 * force * jump[i] } else { 0.0 };
                    for (node, sign) in [(first.get(i), 1.0), (second.get(i), -1.0)] {
                        let Some(&node) = node else { continue };
                        (0..2).for_each(|c| self.left[node][c] += sign * force * axis[c]);
                        self.size[node] += spread;
                        self.stiffness[node] += weight(i);
                    }
                }
            }
        }
        energy
    }
}

/// A part of the law of springs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Part {
    /// The actual forces: for elastic contact those where the jump exceeds the gap.
    Own,
    /// The additional forces of elastic contact if it pulled where it is open.
    Pulling,
    /// The forces of elastic contact whose gap is multiplied by this factor.
    WithGap(f64),
}

/// The forces of one bed along one of its two directions for the nodal values `value` of a field of degree 1 or 2, per unit of
/// stiffness, thickness included.
pub fn spring_forces(
    problem: &Problem,
    bed: &Bed,
    direction: usize,
    part: Part,
    (degree, nodes): (usize, usize),
    value: impl Fn(usize) -> [f64; 2],
) -> Vec<[f64; 2]> {
    let (mesh, functions) = (&problem.mesh, Functions::Values);
    let along = |e: usize| -> Vec<usize> {
        let ([a, b], inside) = (mesh.edges[e].vertices, mesh.points.len() + e);
        if degree == 1 { vec![a, b] } else { vec![a, inside, b] }
    };
    let mut forces = vec![[0.0; 2]; nodes];
    for pair in &bed.pairs {
        let axis = pair.axes[direction];
        let first = along(pair.edge);
        let second: Vec<usize> = pair.opposite.map_or_else(Vec::new, |e| along(e).into_iter().rev().collect());
        let own = |node: &usize| dot(value(*node), axis);
        let jump: Vec<f64> = first.iter().enumerate().map(|(i, n)| own(n) - second.get(i).map_or(0.0, own)).collect();
        let of_nodes = match (&pair.contact, part) {
            (Some(contact), Part::Own) => {
                functions.forces(pair.weight, &functions.beyond(&jump, &contact.gap()), degree)
            }
            (Some(contact), Part::WithGap(factor)) => {
                let gap: Vec<f64> = contact.gap().iter().map(|g| factor * g).collect();
                functions.forces(pair.weight, &functions.beyond(&jump, &gap), degree)
            }
            (Some(contact), Part::Pulling) => {
                let open: Vec<f64> = functions.beyond(&jump, &contact.gap()).iter().map(|d| -d).collect();
                functions.forces(pair.weight, &open, degree).iter().map(|f| -f).collect()
            }
            (None, _) => (0..=degree)
                .map(|i| (0..=degree).map(|j| functions.weighted(pair.weight, degree, i, j) * jump[j]).sum())
                .collect::<Vec<f64>>(),
        };
        for (i, force) in of_nodes.into_iter().enumerate() {
            let force = problem.scene.thickness * pair.length * force;
            for (node, sign) in [(first.get(i), 1.0), (second.get(i), -1.0)] {
                let Some(&node) = node else { continue };
                (0..2).for_each(|c| forces[node][c] += sign * force * axis[c]);
            }
        }
    }
    forces
}
