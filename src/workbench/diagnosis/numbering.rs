//! Another order of nodes, unknowns or components, and entries that are wrong one by one.

use nalgebra::DMatrix;

use super::Trial;
use crate::report::text::number::significant;
use crate::workbench::displacement::{DisplacementElement, Order};

/// Of all entries, how many may be wrong for them to be listed.
const FEW: usize = 4;

/// The right matrix with its rows and columns in another order.
pub(super) fn trials(e: &DisplacementElement, right: &DMatrix<f64>) -> Vec<Trial> {
    let n = e.nodes.len();
    let permuted = |place: &dyn Fn(usize) -> usize| DMatrix::from_fn(2 * n, 2 * n, |i, j| right[(place(i), place(j))]);
    let mut trials = Vec::new();
    let blocked = |i: usize| if i < n { 2 * i } else { 2 * (i - n) + 1 };
    let text = "all unknowns along x come before those along y; say so with the order blocked";
    trials.push(Trial { rank: 1, cause: "component-order", sentence: text.into(), matrix: permuted(&blocked) });
    let interleaved = |i: usize| Order::Blocked.place(n, i / 2, i % 2);
    let text = "the unknowns were taken for blocked and are interleaved: x and y of one node after the other";
    trials.push(Trial { rank: 1, cause: "component-order", sentence: text.into(), matrix: permuted(&interleaved) });
    let text = "x and y are exchanged in every node";
    trials.push(Trial { rank: 2, cause: "components-exchanged", sentence: text.into(), matrix: permuted(&|i| i ^ 1) });
    trials.extend(orders(n).iter().map(|order| renumbered(right, order)));
    trials
}

/// The right matrix with its nodes in this order.
pub(super) fn renumbered(right: &DMatrix<f64>, order: &[usize]) -> Trial {
    let names: Vec<String> = order.iter().map(usize::to_string).collect();
    let last = order.len().saturating_sub(1);
    let sentence =
        format!("the nodes are in another order: nodes 0 to {last} of K are nodes {} of the list", names.join(", "));
    let place = |i: usize| 2 * order[i / 2] + i % 2;
    let matrix = DMatrix::from_fn(right.nrows(), right.ncols(), |i, j| right[(place(i), place(j))]);
    Trial { rank: 3, cause: "node-order", sentence, matrix }
}

/// All orders of up to six nodes but the one they have; of more, those that begin elsewhere, forwards and backwards.
fn orders(n: usize) -> Vec<Vec<usize>> {
    let mut all: Vec<Vec<usize>> = vec![Vec::new()];
    if n <= 6 {
        for k in 0..n {
            all = all
                .into_iter()
                .flat_map(|order| (0..=k).map(move |at| [&order[..at], &[k], &order[at..]].concat()))
                .collect();
        }
    } else {
        all = (0..n)
            .flat_map(|k| [(0..n).map(|i| (i + k) % n).collect(), (0..n).map(|i| (n + k - i) % n).collect()])
            .collect();
    }
    all.retain(|order| order.iter().enumerate().any(|(i, &n)| i != n));
    all
}

/// Differences up to this part of the largest entry are digits.
const DIGITS: f64 = 1e-6;

/// A few wrong entries, all others being right.
pub(super) fn entries(e: &DisplacementElement, right: &DMatrix<f64>) -> Option<Trial> {
    let (k, rows) = (&e.matrix, e.matrix.nrows());
    let wrong: Vec<usize> = (0..k.len()).filter(|&at| (k[at] - right[at]).abs() > e.precision * right.amax()).collect();
    // Digits that were lost are in all of them.
    let most = wrong.iter().map(|&at| (k[at] - right[at]).abs()).fold(0.0, f64::max);
    if wrong.is_empty() || wrong.len() * FEW > k.len() || most < DIGITS * right.amax() {
        return None;
    }
    let name = |at: &usize| {
        format!("({}, {}) = {} for {}", at % rows, at / rows, significant(k[*at], 4), significant(right[*at], 4))
    };
    let mut listed: Vec<String> = wrong.iter().take(6).map(name).collect();
    if wrong.len() > listed.len() {
        listed.push(format!("and {} more", wrong.len() - listed.len()));
    }
    let is_mutual = wrong.iter().all(|at| (k[*at] - k[(at / rows, at % rows)]).abs() <= e.precision * right.amax());
    let cause = if is_mutual { "entries" } else { "unsymmetric" };
    let sentence = format!("{} of {} entries are wrong, the others right: {}", wrong.len(), k.len(), listed.join(", "));
    Some(Trial { rank: 7, cause, sentence, matrix: k.clone() })
}
