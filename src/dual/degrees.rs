//! The degrees that loads ask for.

use std::collections::HashMap;

use super::DualError;
use crate::element::{Elements, MAX_DEGREE};
use crate::mesh::Triangulation;
use crate::problem::Problem;

/// The elements of `problem` with the degree raised where a load asks for more than they have: a stress of degree p balances body
/// forces of degree p − 1.
///
/// # Errors
/// [`DualError::NotExpressible`] where an element is no block, and so none of a higher degree stands for it.
pub fn carrying(problem: &Problem, elements: &Elements) -> Result<Elements, DualError> {
    let mesh = &problem.mesh;
    let count = mesh.triangles.len();
    let short: Vec<usize> = (0..count).filter(|&t| elements.degree(t) < problem.least_degree(t)).collect();
    let Some(&first) = short.first() else { return Ok(elements.clone()) };
    let mut degree: Vec<u8> = (0..count).map(|t| elements.degree(t) as u8).collect();
    short.iter().for_each(|&t| degree[t] = problem.least_degree(t) as u8);
    spread(mesh, &problem.facing_edges(), &mut degree, short);
    elements.at_least(count, |t| degree[t].into()).ok_or_else(|| DualError::NotExpressible {
        method: elements.of(first).name(),
        what: format!(
            "the load on body {}, which asks for stresses of degree {}",
            problem.scene.bodies[mesh.body[first]].name,
            problem.least_degree(first)
        ),
        remedy: "take an element of that degree, or one of the library with --degree",
    })
}

/// Raises degrees around the triangles that are `waiting`, so far that neighbours differ by one at most, and the two at edges that are
/// `facing` each other across a contact not at all: on the side of a lower degree no stress would feel the sliding and the jumps
/// beyond that degree.
pub fn spread(mesh: &Triangulation, facing: &[[usize; 2]], degree: &mut [u8], mut waiting: Vec<usize>) {
    let opposite: HashMap<usize, usize> = facing.iter().flat_map(|&[a, b]| [(a, b), (b, a)]).collect();
    while let Some(t) = waiting.pop() {
        for e in mesh.triangle_edges[t] {
            let across = opposite.get(&e).and_then(|&o| mesh.edges[o].triangles[0]).map(|other| (other, degree[t]));
            let beside = mesh.edges[e].triangles.iter().flatten().map(|&other| (other, degree[t] - 1));
            for (other, least) in beside.chain(across).collect::<Vec<_>>() {
                if degree[other] < least {
                    degree[other] = least.min(MAX_DEGREE as u8);
                    waiting.push(other);
                }
            }
        }
    }
}
