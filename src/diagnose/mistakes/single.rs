//! A solver in single precision: its residual is that of rounding to seven digits, node by node.

use crate::compare::Solution;
use crate::diagnose::Finding;
use crate::diagnose::words::number;

/// Roundings to single precision that may meet in the force of a node: those of the entries of its row, of the values, and of an
/// elimination that passes them on.
const MEETING: f64 = 64.0;
const SINGLE: f64 = f32::EPSILON as f64;

/// The finding of single precision, where the displacements are kept in it and no node misses more than it explains. Rounding counts for
/// displacements as large as those of a solution at most: beyond, it would hide any mistake.
pub fn finding(solution: &Solution<'_>) -> Option<Finding> {
    if solution.candidate.precision != SINGLE {
        return None;
    }
    let part = if solution.largest > 0.0 { solution.reference / solution.largest } else { 1.0 };
    let most = solution.rest.iter().zip(&solution.forces.size).map(|(rest, size)| {
        let left = rest[0].hypot(rest[1]);
        if left > 0.0 { left / (SINGLE * part * size) } else { 0.0 }
    });
    let most = most.fold(0.0, f64::max);
    let sentence = format!(
        "the equations were solved in single precision: no node misses more than {} times what rounding to seven digits leaves there",
        number(most)
    );
    (most <= MEETING).then(|| Finding::new("precision/single", Some(most), None, sentence))
}
