//! Displacements on edges and the opening of contact pairs, by Bernstein coefficients.

use crate::element::Displacement;
use crate::element::polynomial::side;
use crate::problem::{ContactPair, Direction, Problem};

/// The coefficients of `v` along edge `e`, from its first vertex to its second, in the degree of its first triangle.
pub fn side_coefficients(problem: &Problem, v: &Displacement, e: usize) -> Vec<[f64; 2]> {
    let mesh = &problem.mesh;
    // From triangles[0] the edge runs from corner i + 1 to corner i + 2.
    let t = mesh.edges[e].triangles[0].unwrap_or(0);
    let i = mesh.triangle_edges[t].iter().position(|&x| x == e).unwrap_or(0);
    v.side(t, i).collect()
}

/// The coefficients of the opening g − (v' − v'')·n̂ along `pair`.
pub fn openings(problem: &Problem, v: &Displacement, pair: &ContactPair) -> Vec<f64> {
    let jumps = jumps(problem, v, pair);
    let degree = jumps.len().max(pair.gap_polynomial().len()) - 1;
    less(&pair.gap_below(degree), &side::elevate(&jumps, degree))
}

/// Coefficients of degree `degree`, of which no polynomial with smaller ones opens wider than `v` does along `pair`.
pub fn openings_within(problem: &Problem, v: &Displacement, pair: &ContactPair, degree: usize) -> Option<Vec<f64>> {
    let jumps = jumps(problem, v, pair);
    (jumps.len() <= degree + 1).then(|| less(&pair.gap_below(degree), &side::elevate(&jumps, degree)))
}

fn less(gap: &[f64], jumps: &[f64]) -> Vec<f64> {
    gap.iter().zip(jumps).map(|(gap, jump)| gap - jump).collect()
}

/// The coefficients of (v' − v'')·n̂ along `pair`.
pub fn jumps(problem: &Problem, v: &Displacement, pair: &ContactPair) -> Vec<f64> {
    jumps_along(problem, v, pair, &pair.direction).0
}

/// The coefficients of v' − v'' along `direction` on `pair`, and the size of the displacements that they are the difference of.
pub fn jumps_along(problem: &Problem, v: &Displacement, pair: &ContactPair, direction: &Direction) -> (Vec<f64>, f64) {
    let mut size = 0.0_f64;
    let mut along = |e: usize, start: usize| {
        let mut u = side_coefficients(problem, v, e);
        if problem.mesh.edges[e].vertices[0] != start {
            u.reverse();
        }
        size = u.iter().flatten().fold(size, |m, u| m.max(u.abs()));
        projected(&u, direction)
    };
    let own = pair.edges[0].map_or_else(|| vec![0.0; 2], |e| along(e, pair.first[0]));
    let other = pair.edges[1].zip(pair.second).map_or_else(|| vec![0.0; 2], |(e, second)| along(e, second[0]));
    let degree = own.len().max(other.len()) - 1;
    let [own, other] = [own, other].map(|u| side::elevate(&u, degree));
    (own.iter().zip(&other).map(|(own, other)| own - other).collect(), size)
}

/// The coefficients of u along a direction: of the degree of u, or of one more where it turns.
fn projected(u: &[[f64; 2]], direction: &Direction) -> Vec<f64> {
    let [first, last] = direction.ends;
    let dot = |u: &[f64; 2], n: [f64; 2]| u[0] * n[0] + u[1] * n[1];
    if direction.is_constant() {
        return u.iter().map(|u| dot(u, first)).collect();
    }
    let k = u.len();
    let term = |j: usize| {
        let before = if j > 0 { j as f64 * dot(&u[j - 1], last) } else { 0.0 };
        let after = if j < k { (k - j) as f64 * dot(&u[j], first) } else { 0.0 };
        (before + after) / k as f64
    };
    (0..=k).map(term).collect()
}
