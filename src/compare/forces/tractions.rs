//! Tractions at the nodes of a displacement model.

use super::NodalForces;
use super::springs::Functions;
use crate::element::polynomial::side;
use crate::mesh::Triangulation;
use crate::problem::Problem;

impl NodalForces {
    /// Adds to the loads the forces of all tractions on the functions of degree `degree`.
    pub(in crate::compare) fn add_tractions(&mut self, problem: &Problem, degree: usize, functions: Functions) {
        for (e, traction) in problem.pressed_edges() {
            add(problem, (e, &problem.times_weight(e, &traction)), degree, functions, &mut self.load);
        }
    }
}

/// Adds ∫ T·φ along an edge, T by its Bernstein coefficients, the weight of the section in it.
pub fn add(
    problem: &Problem,
    (e, traction): (usize, &[[f64; 2]]),
    degree: usize,
    functions: Functions,
    load: &mut [[f64; 2]],
) {
    let length = problem.scene.thickness * problem.mesh.edge_frame(e).0;
    for c in 0..2 {
        let along: Vec<f64> = traction.iter().map(|t| t[c]).collect();
        let forces = functions.moments(side::moments(&along, degree));
        nodes(&problem.mesh, e, degree).zip(forces).for_each(|(node, f)| load[node][c] += length * f);
    }
}

/// The nodes of a field of degree `degree` on edge `e`, from its first vertex to its second.
pub fn nodes(mesh: &Triangulation, e: usize, degree: usize) -> impl Iterator<Item = usize> {
    let [a, b] = mesh.edges[e].vertices;
    let inside = mesh.points.len() + e * (degree - 1);
    std::iter::once(a).chain(inside..inside + degree - 1).chain([b])
}
