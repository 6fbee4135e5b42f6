//! Tractions at the nodes of a displacement model.

use super::NodalForces;
use super::functions::{Functions, nodes_along};
use crate::element::polynomial::side;
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
    let moments = [0, 1].map(|c| side::moments(&side::component(traction, c), degree));
    spread(problem, (e, moments), functions, load);
}

/// Adds forces along an edge, by their components ∫ T_c B_k on an edge of length one.
pub fn spread(problem: &Problem, (e, moments): (usize, [Vec<f64>; 2]), functions: Functions, load: &mut [[f64; 2]]) {
    let length = problem.scene.thickness * problem.mesh.edge_frame(e).0;
    let nodes = nodes_along(&problem.mesh, e, moments[0].len() - 1);
    for (c, moments) in moments.into_iter().enumerate() {
        nodes.clone().zip(functions.moments(moments)).for_each(|(node, f)| load[node][c] += length * f);
    }
}
