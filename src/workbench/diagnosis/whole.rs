//! Mistakes made on the whole matrix: half of it, axes not rotated back.

use nalgebra::DMatrix;

use super::{Reference, Trial};

/// Half a matrix, a diagonal that counts twice, local axes.
pub(super) fn trials(r: &Reference) -> Vec<Trial> {
    let mut all = Vec::new();
    let mut push = |rank, cause, sentence: String, matrix| all.push(Trial { rank, cause, sentence, matrix });
    let size = r.matrix.nrows();
    let upper = DMatrix::from_fn(size, size, |i, j| if i <= j { r.matrix[(i, j)] } else { 0.0 });
    push(1, "triangle-only", "K holds its upper triangle only".into(), upper.clone());
    push(1, "triangle-only", "K holds its lower triangle only".into(), upper.transpose());
    let text = "the diagonal counts twice: K is the sum of a triangle and its transpose, both with the diagonal";
    push(1, "diagonal-twice", text.into(), &upper + upper.transpose());
    let corners = r.family.corners();
    for i in 0..corners {
        let (a, b) = (r.nodes[i], r.nodes[(i + 1) % corners]);
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        let (c, s) = ((b[0] - a[0]) / length, (b[1] - a[1]) / length);
        if s.abs() < 1e-4 {
            continue;
        }
        let q = DMatrix::from_fn(size, size, |i, j| match (i / 2 == j / 2, i % 2, j % 2) {
            (false, ..) => 0.0,
            (_, 0, 1) => s,
            (_, 1, 0) => -s,
            _ => c,
        });
        let [from, to] = [r.order[i], r.order[(i + 1) % corners]];
        let text = format!("K is in local axes along the side from node {from} to {to} and was not rotated back");
        push(2, "local-axes", text, &q * &r.matrix * q.transpose());
        let text =
            format!("K is rotated from the axes along the side from node {from} to {to} on one of its sides only");
        push(2, "local-axes", text.clone(), &q * &r.matrix);
        push(2, "local-axes", text, &r.matrix * q.transpose());
    }
    all
}
