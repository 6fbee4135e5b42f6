//! Friction in the balance of rigid pieces: forces along contacts, none of them larger than its bound.
//!
//! Along a straight run a rigid motion slides everywhere alike, and a given bound of the traction resists it with one force f of at most
//! F = ∫ τ̄ ds. The forces that contacts can balance are then Σ μ g + Σ f h with μ ≥ 0 and |f| ≤ F: what is left of the load beside those
//! nearest to it is a motion r on which the loads do more work than friction takes up, L(r) − Σ F |h · r| = |r|², and none is left
//! exactly where L(y) ≤ Σ F |h · y| for all motions y that contact allows. The nearest forces are the minimum of a quadratic program;
//! they are then part of the load, and the rest is balanced as without friction.

use faer::Mat;
use nalgebra::DVector;

use super::balance::RANK;
use super::openings::Points;
use super::restraint::{Group, Part};
use crate::optimise::{Law, Program, solve};

/// Forces of this many times the loads are as good as any: levers make no more of them.
const MOST: f64 = 1e6;

/// The forces of friction that leave least of a `load`, as a load, where `vanishing` rows do not move and contacts push at these `points`.
pub(super) fn relieved(
    group: &Group,
    vanishing: &[Part],
    points: Points,
    load: &DVector<f64>,
    total: f64,
) -> DVector<f64> {
    let supports = group.span(vanishing);
    let left = |row: &DVector<f64>| supports.residual(row);
    let rubbing = group.runs.iter().filter(|run| run.friction > 0.0);
    let slips: Vec<(DVector<f64>, f64)> = rubbing
        .map(|run| (group.dense(&group.slip(run, run.ends[0])), run.friction.min(MOST * total)))
        .filter(|(row, most)| left(row).norm() > RANK && *most > 0.0)
        .collect();
    let jumps = group.runs.iter().flat_map(|run| group.jumps(run, points)).map(|row| group.dense(&row));
    let jumps: Vec<DVector<f64>> = jumps.map(|row| left(&row)).filter(|row| row.norm() > RANK).collect();
    let none = DVector::zeros(group.dimension());
    if slips.is_empty() || load.amax() == 0.0 {
        return none;
    }
    let all: Vec<DVector<f64>> = jumps.iter().cloned().chain(slips.iter().map(|(row, _)| left(row))).collect();
    let laws = jumps.iter().map(|_| PUSHES);
    let laws: Vec<Law> = laws.chain(slips.iter().map(|(_, most)| held_to(*most))).collect();
    let Some(found) = nearest(&all, &laws, &left(load)) else { return none };
    let forces = found[jumps.len()..].iter().zip(&slips);
    forces.fold(none, |sum, (f, (row, most))| sum + row * f.clamp(-most, *most))
}

/// The law of minus a force that pushes.
pub(super) const PUSHES: Law = Law::AtMost { bound: 0.0 };

/// The law of a force of friction.
pub(super) fn held_to(most: f64) -> Law {
    Law::Between { lower: -most, upper: most }
}

/// The forces along `rows`, under [`PUSHES`] or [`held_to`] a bound, that leave least of a `load`; none where they were not found.
pub(super) fn nearest(rows: &[DVector<f64>], laws: &[Law], load: &DVector<f64>) -> Option<Vec<f64>> {
    let sign = |i: usize| if laws[i] == PUSHES { -1.0 } else { 1.0 };
    let form = Mat::from_fn(rows.len(), rows.len(), |i, k| sign(i) * sign(k) * rows[i].dot(&rows[k]));
    let pulls: Vec<f64> = rows.iter().enumerate().map(|(i, row)| sign(i) * row.dot(load)).collect();
    let found = solve(&Program { form: &form, load: &pulls, laws }, None)?;
    Some(found.x.iter().enumerate().map(|(i, x)| sign(i) * x).collect())
}

/// Work absorbed by friction in a `motion` of the group.
pub(super) fn resistance(group: &Group, motion: &DVector<f64>) -> f64 {
    let of = |run: &&super::restraint::Run| {
        let slip = group.dense(&group.slip(run, run.ends[0])).dot(motion);
        run.friction * slip.abs()
    };
    group.runs.iter().filter(|run| run.friction > 0.0).map(of).sum()
}
