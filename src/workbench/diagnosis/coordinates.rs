//! Nodes that K was made of, where they are others than those given.
//!
//! K R = 0 for the rigid motions of the nodes that K was made of, and for nothing else: beside the shifts, what K annihilates is the
//! rotation (−y, x) of these nodes about their centre. So they can be read off, up to place and size, which K does not depend on.

use nalgebra::{DMatrix, Matrix2};

use super::numbering::renumbered;
use super::{Reference, Trial};
use crate::report::text::number::significant;
use crate::workbench::displacement::{DisplacementElement, hooke_seen, silent_motions};
use crate::workbench::formulas::Variant;
use crate::workbench::outline::Outline;

/// Relative to the largest singular value, what is zero.
const SILENT: f64 = 1e-7;
/// Relative to the size of the element, what is the same place.
const SAME: f64 = 1e-5;

/// Points about their centre, and their size.
fn centred(nodes: &[[f64; 2]]) -> (Vec<[f64; 2]>, f64) {
    let count = nodes.len() as f64;
    let centre = [0, 1].map(|c| nodes.iter().map(|x| x[c]).sum::<f64>() / count);
    let about: Vec<[f64; 2]> = nodes.iter().map(|x| [x[0] - centre[0], x[1] - centre[1]]).collect();
    let size = about.iter().flatten().map(|x| x * x).sum::<f64>().sqrt();
    (about, size)
}

/// The nodes that K was made of, numbered as the element's, about their centre and of size one; `None` where K annihilates more or less than
/// three motions, or not the shifts.
fn seen(k: &DMatrix<f64>, precision: f64) -> Option<Vec<[f64; 2]>> {
    let silent = silent_motions(k, SILENT.max(3.0 * precision));
    if silent.ncols() != 3 {
        return None;
    }
    let n = k.nrows() / 2;
    // What is left of the three without the shifts has rank one.
    let mut rest = silent;
    for mut column in rest.column_iter_mut() {
        for c in 0..2 {
            let mean = (0..n).map(|i| column[2 * i + c]).sum::<f64>() / n as f64;
            (0..n).for_each(|i| column[2 * i + c] -= mean);
        }
    }
    let longest = rest.column_iter().max_by(|a, b| a.norm().total_cmp(&b.norm()))?.normalize();
    let others = &rest - &longest * longest.tr_mul(&rest);
    if others.amax() > SILENT.max(30.0 * precision) * 1e2 {
        return None;
    }
    let v = longest;
    Some((0..n).map(|i| [v[2 * i + 1], -v[2 * i]]).collect())
}

/// K of the nodes that K itself shows, or of the right nodes in the order that it shows.
pub(super) fn trials(e: &DisplacementElement, r: &Reference) -> Vec<Trial> {
    let mut all = others(r);
    let Some(seen) = seen(&e.matrix, e.precision) else { return all };
    let same = SAME.max(30.0 * e.precision);
    let (given, size) = centred(&e.nodes);
    let given: Vec<[f64; 2]> = given.iter().map(|x| x.map(|x| x / size)).collect();
    // Which of both signs: the one nearer to the nodes given, for a half turn changes nothing.
    let dot: f64 = given.iter().zip(&seen).map(|(a, b)| a[0] * b[0] + a[1] * b[1]).sum();
    let sign = if dot < 0.0 { -1.0 } else { 1.0 };
    let seen: Vec<[f64; 2]> = seen.iter().map(|x| x.map(|x| sign * x)).collect();
    if apart(&seen, &given) < same {
        return all;
    }
    let hooke = match (e.material, Outline::of(&seen)) {
        (Some(_), _) => r.hooke,
        (None, Some(outline)) => hooke_seen(&e.matrix, &seen, &outline),
        (None, None) => return all,
    };
    let (cause, sentence) = words(&given, &seen, same);
    let nodes = r.in_order(&seen);
    if let Ok(matrix) = r.on(&nodes, &hooke, Variant::Right) {
        all.push(Trial { rank: 2, cause, sentence: sentence.clone(), matrix });
    }
    if r.is_isoparametric() {
        // Crossed sides give det J both signs.
        if let Ok(points) = r.family.points(&nodes, r.rule) {
            let k: DMatrix<f64> = points.iter().map(|p| p.stiffness(&hooke) * p.sign()).sum();
            all.push(Trial { rank: 2, cause, sentence, matrix: r.placed(&k) });
        }
    }
    all.extend(order_of(&given, &seen, same).map(|order| renumbered(&r.matrix, &order)));
    all
}

/// The reference element, and nodes with x and y exchanged.
fn others(r: &Reference) -> Vec<Trial> {
    let swapped: Vec<[f64; 2]> = r.nodes.iter().map(|[x, y]| [*y, *x]).collect();
    let list = [(r.family.nodes(), "the reference element"), (swapped, "nodes with x and y exchanged")];
    let of = |(nodes, whose): (Vec<[f64; 2]>, &str)| {
        let matrix = r.on(&nodes, &r.hooke, Variant::Right).ok()?;
        let sentence = format!("K is that of other coordinates: {whose}");
        Some(Trial { rank: 2, cause: "other-coordinates", sentence, matrix })
    };
    list.into_iter().filter_map(of).collect()
}

/// The largest distance of points of the same number.
fn apart(a: &[[f64; 2]], b: &[[f64; 2]]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1])).fold(0.0, f64::max)
}

/// For each node seen the number of the given one in the same place, where all are there.
fn order_of(given: &[[f64; 2]], seen: &[[f64; 2]], same: f64) -> Option<Vec<usize>> {
    for sign in [1.0, -1.0] {
        let at = |x: &[f64; 2]| given.iter().position(|y| (sign * x[0] - y[0]).hypot(sign * x[1] - y[1]) < same);
        if let Some(order) = seen.iter().map(at).collect::<Option<Vec<usize>>>() {
            return Some(order);
        }
    }
    None
}

/// How the nodes seen come from those given.
fn words(given: &[[f64; 2]], seen: &[[f64; 2]], same: f64) -> (&'static str, String) {
    // The linear map A with seen = A given, by least squares: only a turn, or a mirror, keeps all lengths.
    let mut gram = Matrix2::<f64>::zeros();
    let mut cross = Matrix2::<f64>::zeros();
    for (x, y) in given.iter().zip(seen) {
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            gram[(i, j)] += x[i] * x[j];
            cross[(i, j)] += y[i] * x[j];
        }
    }
    if let Some(inverse) = gram.try_inverse() {
        let a = cross * inverse;
        let carried: Vec<[f64; 2]> =
            given.iter().map(|x| [0, 1].map(|i| a[(i, 0)] * x[0] + a[(i, 1)] * x[1])).collect();
        let near = |x: f64, y: f64| (x - y).abs() < same;
        if apart(&carried, seen) < same && near(a[(0, 0)], a[(1, 1)]) && near(a[(0, 1)], -a[(1, 0)]) {
            let angle = a[(1, 0)].atan2(a[(0, 0)]).to_degrees();
            let text = format!("K is in axes turned by {}° and was not rotated back", significant(-angle, 4));
            return ("local-axes", text);
        }
        if apart(&carried, seen) < same && near(a[(0, 1)], 0.0) && near(a[(1, 0)], 0.0) && near(a[(0, 0)], -a[(1, 1)]) {
            return (
                "other-coordinates",
                "K is that of other coordinates: nodes mirrored, x or y of the wrong sign".into(),
            );
        }
    }
    if let Some(order) = order_of(given, seen, same) {
        let names: Vec<String> = order.iter().map(usize::to_string).collect();
        let text = format!("K is made of the coordinates of nodes {} in place of nodes 0, 1, …", names.join(", "));
        return ("node-order", text);
    }
    // From the first node, with the first side of length one, so that size and place play no part.
    let [from, to] = [seen[0], seen[1]];
    let length = (to[0] - from[0]).hypot(to[1] - from[1]);
    let round = |x: f64| significant((x / length * 1e6).round() / 1e6 + 0.0, 4);
    let list: Vec<String> =
        seen.iter().map(|x| format!("({}, {})", round(x[0] - from[0]), round(x[1] - from[1]))).collect();
    let text = format!("K is that of other coordinates, up to place and size: nodes at {}", list.join(", "));
    ("other-coordinates", text)
}
