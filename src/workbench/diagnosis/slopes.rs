//! Mistakes in derivatives of one shape function: lost, of the wrong sign, or taken at a mirrored place.

use nalgebra::DMatrix;

use super::{Reference, Trial};
use crate::workbench::formulas::{Family, Point, Variant};

/// A mistake in one derivative along a local direction.
#[derive(Clone, Copy, PartialEq)]
enum Wrong {
    Lost,
    Sign,
    /// Taken with this local coordinate of the wrong sign, (1 + η) for (1 − η).
    Mirrored(usize),
}

/// Derivatives along x, y or both with the Jacobian right, and along the local directions with and without the Jacobian.
pub(super) fn trials(r: &Reference) -> Vec<Trial> {
    if !r.is_isoparametric() {
        return Vec::new();
    }
    [global(r), local(r)].concat()
}

fn sum(r: &Reference, points: &[Point]) -> DMatrix<f64> {
    let n = 2 * r.order.len();
    points.iter().fold(DMatrix::zeros(n, n), |k, p| k + p.stiffness(&r.hooke))
}

fn global(r: &Reference) -> Vec<Trial> {
    let mut all = Vec::new();
    let points = r.points();
    for node in 0..r.order.len() {
        for (which, name) in [(&[0][..], "∂N/∂x"), (&[1], "∂N/∂y"), (&[0, 1], "∇N")] {
            for (factor, done) in [(0.0, "is lost"), (-1.0, "has the wrong sign")] {
                let mut points = points.clone();
                points.iter_mut().for_each(|p| which.iter().for_each(|&c| p.gradients[node][c] *= factor));
                let sentence = format!("{name} of node {} {done}", r.order[node]);
                let matrix = r.placed(&sum(r, &points));
                all.push(Trial { rank: 3, cause: "shape-derivative", sentence, matrix });
            }
        }
    }
    all
}

/// The local directions of a triangle begin at any of its corners; those of a quadrilateral are parallel whichever it is.
fn local(r: &Reference) -> Vec<Trial> {
    let mut all = Vec::new();
    let corners = r.family.corners();
    for base in 0..if corners == 3 { 3 } else { 1 } {
        let turn = |i: usize| if i < corners { (i + base) % corners } else { corners + (i + base) % corners };
        let nodes: Vec<usize> = (0..r.order.len()).map(turn).collect();
        let turned = Reference {
            family: r.family,
            rule: r.rule,
            matrix: r.matrix.clone(),
            order: nodes.iter().map(|&i| r.order[i]).collect(),
            nodes: nodes.iter().map(|&i| r.nodes[i]).collect(),
            hooke: r.hooke,
        };
        all.extend(local_from(&turned));
    }
    all
}

fn local_from(r: &Reference) -> Vec<Trial> {
    let (n, corners) = (r.order.len(), r.family.corners());
    // A triangle has no place to mirror about.
    let kinds = [Wrong::Lost, Wrong::Sign, Wrong::Mirrored(0), Wrong::Mirrored(1)];
    let kinds = &kinds[..if corners == 4 { 4 } else { 2 }];
    let mut all = Vec::new();
    for (node, along, &wrong) in
        (0..n).flat_map(|i| [0, 1].map(move |a| (i, a))).flat_map(|(i, a)| kinds.iter().map(move |k| (i, a, k)))
    {
        let right = |at| r.family.slopes(at);
        let changed = |at: [f64; 2]| {
            let mut slopes = right(at);
            slopes[node][along] = match wrong {
                Wrong::Lost => 0.0,
                Wrong::Sign => -slopes[node][along],
                Wrong::Mirrored(c) => {
                    right(std::array::from_fn(|i| if i == c { 1.0 - at[i] } else { at[i] }))[node][along]
                }
            };
            slopes
        };
        let local = ["ξ", "η"];
        let done = match wrong {
            Wrong::Lost => "is lost".to_string(),
            Wrong::Sign => "has the wrong sign".to_string(),
            Wrong::Mirrored(c) => format!("is taken with {} of the wrong sign", local[c]),
        };
        let end = if along == 0 { 1 } else { corners - 1 };
        let side = format!("{} from node {} to node {}", local[along], r.order[0], r.order[end]);
        // With a wrong J it matters which points a quadratic triangle has.
        for (in_jacobian, rule) in [(false, r.rule), (true, r.rule), (true, Variant::Inner)] {
            if rule == Variant::Inner && r.family != Family::P2 {
                continue;
            }
            let points = match in_jacobian {
                true => r.family.points_by(&r.nodes, rule, &changed, &changed),
                false => r.family.points_by(&r.nodes, rule, &right, &changed),
            };
            let Ok(points) = points else { continue };
            let also = if in_jacobian { ", in J too" } else { "" };
            let sentence = format!("∂N/∂{} of node {} {done}{also} ({side})", local[along], r.order[node]);
            all.push(Trial { rank: 3, cause: "shape-derivative", sentence, matrix: r.placed(&sum(r, &points)) });
        }
    }
    all
}
