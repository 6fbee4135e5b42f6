//! Forces of springs and elastic layers at the nodes of a displacement model.

use super::NodalForces;
use super::functions::{Functions, nodes_along};
use crate::element::polynomial::{positive, side};
use crate::problem::{Bed, Problem};
use crate::vector::dot;

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
        let along = |e: usize| nodes_along(mesh, e, degree).collect::<Vec<_>>();
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
                        for forces in [&mut self.left, &mut self.sprung] {
                            (0..2).for_each(|c| forces[node][c] += sign * force * axis[c]);
                        }
                        for sizes in [&mut self.size, &mut self.sprung_size] {
                            sizes[node] += spread;
                        }
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
    let along = |e: usize| nodes_along(mesh, e, degree).collect::<Vec<_>>();
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
