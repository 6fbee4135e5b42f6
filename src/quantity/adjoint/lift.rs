//! Displacements that lift the weight of a contact force.

use crate::bounds::{holds_at, jumps};
use crate::element::Displacement;
use crate::element::polynomial::side;
use crate::problem::Problem;

/// The displacement, linear on triangles, that has jumps −φ from the motion of first sides alone and meets the supports;
/// `None` where no such one does.
pub(in crate::quantity) fn lift(problem: &Problem, weights: &[Vec<f64>]) -> Option<Displacement> {
    let mesh = &problem.mesh;
    let mut vertex = vec![[0.0; 2]; mesh.points.len()];
    let pairs = || problem.pairs().zip(weights);
    for (pair, weights) in pairs().filter(|(_, weights)| !weights.is_empty()) {
        for (end, weight) in [(0, weights[0]), (1, weights[weights.len() - 1])] {
            let n = pair.direction.ends[end];
            let by = -weight / (n[0] * n[0] + n[1] * n[1]);
            vertex[pair.first[end]] = n.map(|n| by * n);
        }
    }
    let holds = holds_at(problem, |_, _| [0.0; 2]).ok()?;
    let size = vertex.iter().flatten().fold(0.0_f64, |m, v| m.max(v.abs()));
    let met = vertex.iter().zip(&holds.vertices).all(|(u, hold)| {
        let held = hold.impose(*u);
        (held[0] - u[0]).hypot(held[1] - u[1]) <= 1e-12 * size
    });
    let lift = Displacement::from_p1(mesh, &vertex);
    // Linear weights along a direction that is constant are met exactly; others are not.
    let exact = pairs().all(|(pair, weights)| {
        let jumps = jumps(problem, &lift, pair);
        let weights = if weights.is_empty() { vec![0.0; 2] } else { weights.clone() };
        let degree = jumps.len().max(weights.len()) - 1;
        let [jumps, weights] = [jumps, weights].map(|c| side::elevate(&c, degree));
        jumps.iter().zip(&weights).all(|(j, w)| (j + w).abs() <= 1e-9 * size)
    });
    (met && exact).then_some(lift)
}
