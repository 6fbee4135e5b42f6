//! How close to an end of contact a pressure can act, by its degree.

use crate::problem::{ContactPair, Problem};

/// The degree of the stresses on each triangle.
pub(super) type Degree<'a> = &'a dyn Fn(usize) -> usize;

/// The degree of t on a pair: what the stresses on both sides can carry, one less where the direction turns.
pub(super) fn pressure_degree(problem: &Problem, pair: &ContactPair, degree: Degree<'_>) -> usize {
    let triangles = pair.edges.iter().flatten().filter_map(|&e| problem.mesh.edges[e].triangles[0]);
    let carried = triangles.map(degree).min().unwrap_or(1);
    pair.direction.columns(carried) - 1
}

/// The point nearest to `end` of an edge from there to `other` through which a pressure of degree k can act when none of its
/// Bernstein coefficients pulls. That of coefficient j alone has its centroid at (j + 1)/(k + 2), so it is 1/(k + 2) of the
/// edge from the end: a third for a linear pressure, the middle for a constant one.
pub(super) fn reach(end: [f64; 2], other: [f64; 2], k: usize) -> [f64; 2] {
    [0, 1].map(|c| end[c] + (other[c] - end[c]) / (k + 2) as f64)
}
