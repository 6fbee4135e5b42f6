//! Motions that only contacts with a gap would hinder.
//!
//! Gaps do not enter the question whether an equilibrium exists: a body falls through any of them until it is held. Where the loads
//! are balanced without the contacts that have a gap all along, the motions that these alone would hinder are free as well, as far
//! as the gaps go.

use super::StaticsError;
use super::balance::{RANK, Verdict};
use super::cone::span::Span;
use super::loads::LoadResultants;
use super::openings::Points;
use super::restraint::{Group, Run};
use crate::problem::{ContactPair, Problem};
use nalgebra::DVector;

/// Groups of more pieces than this are not asked: nobody reads what would be told.
const MANY: usize = 24;

/// Part of the largest displacement below which a piece is at rest.
const AT_REST: f64 = 1e-9;

/// True if the contact of `run` has a gap along its whole length.
fn is_apart(problem: &Problem, run: &Run) -> bool {
    // Friction acts across a gap, too.
    let apart = |pair: &ContactPair| pair.friction.is_none() && pair.gap.iter().all(|g| *g > 0.0);
    problem.interfaces[run.interface].pairs.iter().all(apart)
}

/// `group` without the contacts that have a gap all along.
pub(super) fn without_gaps<'a>(problem: &Problem, group: &Group<'a>) -> Group<'a> {
    let runs = group.runs.iter().copied().filter(|run| !is_apart(problem, run)).collect();
    Group { components: group.components, members: group.members.clone(), runs }
}

/// The names of the contacts that have to stay open for a motion, and the motion.
pub(super) type WhileOpen = (Vec<String>, DVector<f64>);

/// Motions beside those that `found` has for `group`, each with the names of the contacts that have to stay open for it.
///
/// # Errors
/// As that of the group itself.
pub(super) fn free_while_open(
    problem: &Problem,
    group: &Group,
    loads: &LoadResultants,
    found: &Verdict,
) -> Result<Vec<WhileOpen>, StaticsError> {
    let with_gap = || group.runs.iter().filter(|run| is_apart(problem, run));
    if found.driven.is_some() || group.members.len() > MANY || with_gap().next().is_none() {
        return Ok(Vec::new());
    }
    let alone = Verdict::of(problem, &without_gaps(problem, group), loads, &[])?;
    if alone.driven.is_some() {
        return Ok(Vec::new());
    }
    let mut known = Span::empty(group.dimension());
    known.extend(&found.held, RANK);
    let mut more = Vec::new();
    for motion in alone.held {
        let size = motion.norm();
        let before = known.basis.len();
        known.extend(std::slice::from_ref(&motion), RANK * size);
        if known.basis.len() == before {
            continue;
        }
        let motion = with_most_at_rest(motion, &found.held);
        let hindering = with_gap().filter(|run| {
            let jumps = group.jumps(run, Points::Ends);
            jumps.iter().any(|row| group.dense(row).dot(&motion).abs() > AT_REST * motion.amax())
        });
        let mut names: Vec<String> = hindering.map(|run| problem.interfaces[run.interface].name.clone()).collect();
        names.dedup();
        more.push((names, motion));
    }
    Ok(more)
}

/// `motion` with one of `others` taken away where more pieces are at rest without it.
fn with_most_at_rest(motion: DVector<f64>, others: &[DVector<f64>]) -> DVector<f64> {
    let moving = |v: &DVector<f64>| {
        let still = AT_REST * v.amax();
        v.as_slice().chunks(3).filter(|piece| piece.iter().any(|x| x.abs() > still)).count()
    };
    let mut best = motion.clone();
    for other in others {
        for i in (0..other.len()).filter(|i| other[*i].abs() > AT_REST * other.amax()) {
            let mut tried = &motion - other * (motion[i] / other[i]);
            let largest = motion.amax();
            tried.iter_mut().filter(|x| x.abs() < AT_REST * largest).for_each(|x| *x = 0.0);
            if tried.amax() > 0.0 && moving(&tried) < moving(&best) {
                best = tried;
            }
        }
    }
    best
}
