//! Mistakes in derivatives of one shape function: lost, or with the wrong sign.

use super::{Reference, Trial};

/// One derivative, or both, of one shape function, with the Jacobian right.
pub(super) fn trials(r: &Reference) -> Vec<Trial> {
    let Some(points) = r.points() else { return Vec::new() };
    let mut all = Vec::new();
    for node in 0..r.order.len() {
        for (which, name) in [(vec![0], "∂N/∂x"), (vec![1], "∂N/∂y"), (vec![0, 1], "∇N")] {
            for (factor, done) in [(0.0, "is lost"), (-1.0, "has the wrong sign")] {
                let mut k = nalgebra::DMatrix::zeros(2 * r.order.len(), 2 * r.order.len());
                for p in &points {
                    let mut p = p.clone();
                    which.iter().for_each(|&c: &usize| p.gradients[node][c] *= factor);
                    k += p.stiffness(&r.hooke);
                }
                let sentence = format!("{name} of node {} {done}", r.order[node]);
                all.push(Trial { rank: 3, cause: "shape-derivative", sentence, matrix: r.placed(&k) });
            }
        }
    }
    all
}
