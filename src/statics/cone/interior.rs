//! The projection of the loads for many pieces, as a quadratic program for the forces.
//!
//! With unit rows g the forces μ ≥ 0 minimise ½|L − Σ μ g|², and what they leave of the load L is the projection: a quadratic form
//! whose matrix has an entry for two rows that share a piece, with a bound for each unknown. Many rows depend on each other; an
//! interior point does not mind, and comes to forces in the middle of those that are possible. What has been found is held against the
//! conditions of the projection themselves, so that a search that stopped short costs time and no verdict.

use faer::Side;
use faer::sparse::linalg::solvers::Llt;
use faer::sparse::{SparseColMat, Triplet};

use super::sparse::{Row, dot};
use crate::optimise::{Law, Program, SparseForm, State, active_sets, interior_point};
use crate::vector::long::largest;

/// Mean product of force and slack that the interior point aims at, for a load of size one: that of rounding in both.
const ENOUGH: f64 = 1e-22;
/// Sets of rows that are tried from its point.
const SETS: usize = 8;
/// Rest of the load, relative to it, that is known to be one …
const CERTAIN: f64 = 1e-6;
/// … where the bound of its error is this part of it.
const DOUBT: f64 = 0.01;
/// Eigenvalues of Σ g gᵀ, for rows of length one, above which no motion is overlooked by all rows: rounding in its factor is
/// a hundred times smaller, and [`crate::statics::balance::RANK`] squared smaller still.
const DEFINITE: f64 = 1e-11;

/// True if rows of length one resist every motion, by far more than the tolerance of a rank; where not, elimination has to decide.
pub(in crate::statics) fn see_every_motion(rows: &[Row], columns: usize) -> bool {
    let unit = rows.iter().map(|row| (row, 1.0));
    columns == 0 || normal(unit, columns, -DEFINITE).is_some()
}

/// The part of `load` that no forces on `rows` can balance; `None` if it was not found to `round_off`, relative to the load.
pub(in crate::statics) fn projection(rows: &[Row], columns: usize, load: &[f64], round_off: f64) -> Option<Vec<f64>> {
    let size = load.iter().fold(0.0_f64, |m, v| m.hypot(*v));
    let unit: Vec<f64> = load.iter().map(|v| v / size).collect();
    let form = SparseForm::of_products(rows, columns)?;
    // The unknowns are −μ.
    let pulls: Vec<f64> = rows.iter().map(|row| -dot(row, &unit)).collect();
    let laws = vec![Law::AtMost { bound: 0.0 }; rows.len()];
    let program = Program { form: &form, load: &pulls, laws: &laws };
    let inner = interior_point(&program, ENOUGH)?;
    let found = |x: &[f64], states: &[State]| {
        let carrying = x.iter().zip(states).map(|(x, state)| if *state == State::Held { 0.0 } else { (-x).max(0.0) });
        let forces: Vec<f64> = carrying.collect();
        let rest = left_of(&unit, rows, &forces);
        is_projection(rows, &forces, &rest, round_off).then_some(rest)
    };
    let (mut x, mut states) = (inner.x.clone(), inner.states);
    let mut rest = found(&x, &states);
    for _ in 0..SETS {
        if rest.is_some() {
            break;
        }
        let next = active_sets(&program, states.clone(), Some(x), 1);
        rest = found(&next.x, &states);
        (x, states) = (next.x, next.states);
    }
    let rest = rest.or_else(|| certain(rows, &unit, &inner.x, round_off))?;
    Some(rest.into_iter().map(|v| size * v).collect())
}

/// True if `forces` and their `rest` satisfy the conditions of the projection: no row is violated, and every row with a force is tight.
pub(in crate::statics) fn is_projection(rows: &[Row], forces: &[f64], rest: &[f64], round_off: f64) -> bool {
    rows.iter().zip(forces).all(|(row, force)| {
        let pull = dot(row, rest);
        pull <= round_off && (*force == 0.0 || pull >= -round_off)
    })
}

/// The rest of a load of size one beside the forces −`x`, if it is many times the largest error that it can have: the rest
/// r of any forces μ that violates no row is within √(2 Σ μ |g · r|) of the projection.
fn certain(rows: &[Row], load: &[f64], x: &[f64], round_off: f64) -> Option<Vec<f64>> {
    let forces: Vec<f64> = x.iter().map(|x| (-x).max(0.0)).collect();
    let rest = left_of(load, rows, &forces);
    let length = rest.iter().fold(0.0_f64, |m, v| m.hypot(*v));
    let (mut work, mut broken) = (0.0, 0.0_f64);
    for (row, force) in rows.iter().zip(&forces) {
        let pull = dot(row, &rest);
        broken = broken.max(pull);
        work += force * pull.abs();
    }
    let sound = broken <= round_off && length >= CERTAIN && (2.0 * work).sqrt() <= DOUBT * length;
    sound.then_some(rest)
}

/// The rest of `load` that the `forces` do not balance.
pub(in crate::statics) fn left_of(load: &[f64], rows: &[Row], forces: &[f64]) -> Vec<f64> {
    let mut rest = load.to_vec();
    for (row, force) in rows.iter().zip(forces).filter(|(_, force)| **force != 0.0) {
        row.iter().for_each(|(k, v)| rest[*k] -= v * force);
    }
    rest
}

/// The factor of Σ w g gᵀ with `shift` added to its diagonal, relative to the largest entry there.
fn normal<'a>(weighted: impl Iterator<Item = (&'a Row, f64)>, columns: usize, shift: f64) -> Option<Llt<usize, f64>> {
    let mut entries = Vec::new();
    let mut diagonal = vec![0.0; columns];
    for (row, weight) in weighted {
        for (a, (i, v)) in row.iter().enumerate() {
            diagonal[*i] += weight * v * v;
            entries.extend(row[..=a].iter().map(|(k, w)| Triplet::new(*i, *k, weight * v * w)));
        }
    }
    let shift = shift * largest(&diagonal);
    entries.extend((0..columns).map(|k| Triplet::new(k, k, shift)));
    SparseColMat::try_new_from_triplets(columns, columns, &entries).ok()?.sp_cholesky(Side::Lower).ok()
}
