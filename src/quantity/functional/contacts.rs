//! Forces and moments of contacts: weights on their normal tractions.

use super::{Functional, Kind};
use crate::problem::{ContactPair, Problem};
use crate::quantity::adjoint::lift::lift;

/// Weights on the pairs of one contact, by the coefficients that `weight` gives.
pub fn on_contact(
    problem: &Problem,
    contact: usize,
    kind: Kind,
    weight: impl Fn(&Problem, &ContactPair) -> Vec<f64>,
) -> Functional {
    let mut functional = Functional::empty(problem, kind);
    let mut next = 0;
    for (i, interface) in problem.interfaces.iter().enumerate() {
        for pair in &interface.pairs {
            if i == contact {
                functional.load.weights[next] = weight(problem, pair);
                let young = pair.edges[0].and_then(|e| problem.mesh.edges[e].triangles[0]);
                let young = young.map_or(0.0, |t| problem.material(problem.mesh.body[t]).young()[1]);
                functional.natural += young * functional.load.weights[next].iter().map(|w| w * w).sum::<f64>();
            }
            next += 1;
        }
    }
    functional.lift = lift(problem, &functional.load.weights);
    functional
}

/// r × n̂ about a point, as coefficients along the pair.
pub fn moment_of(problem: &Problem, pair: &ContactPair, about: [f64; 2]) -> Vec<f64> {
    let [a, b] = pair.first.map(|v| [0, 1].map(|c| problem.mesh.points[v][c] - about[c]));
    let [m, n] = pair.direction.ends;
    let cross = |r: [f64; 2], n: [f64; 2]| r[0] * n[1] - r[1] * n[0];
    // The product of two linear functions.
    vec![cross(a, m), 0.5 * (cross(a, n) + cross(b, m)), cross(b, n)]
}

/// A weight: 0 at the first and last arc length, 1 between the inner two.
pub fn trapezoid([a, b, c, d]: [f64; 4], s: f64) -> f64 {
    let rise = if b > a {
        (s - a) / (b - a)
    } else if s < a {
        0.0
    } else {
        1.0
    };
    let fall = if d > c {
        (d - s) / (d - c)
    } else if s > d {
        0.0
    } else {
        1.0
    };
    rise.min(fall).clamp(0.0, 1.0)
}
