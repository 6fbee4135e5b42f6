//! The projection of the loads for many pieces: an interior point tells which rows carry force, and weighted least squares
//! make the forces exact.
//!
//! With unit rows g the projection r of a load L minimises ½|r|² − L·r under g · r ≤ 0, and the multipliers are forces. An
//! interior point (Clarabel) comes near them in some twenty sparse factorisations, whatever the number of rows that depend on
//! each other. From there forces μ > 0 change by μ (g · z) with (Σ μ g gᵀ) z = what is left of the load along these rows:
//! each in proportion to itself, so that none changes its sign. What has been found is then held against the conditions of the
//! projection themselves, by the caller: an interior point that stopped short costs time and no verdict.

use clarabel::algebra::CscMatrix;
use clarabel::solver::SupportedConeT::NonnegativeConeT;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver};
use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::Llt;
use faer::sparse::{SparseColMat, Triplet};
use faer::{Col, Side};

use super::sparse::{Row, dot};
use crate::vector::long::largest;

/// Duality gap and infeasibility that the interior point aims at, for a load of size one.
const TOLERANCE: f64 = 1e-13;
const ITERATIONS: u32 = 60;
/// Sets of rows that are made exact before the search goes another way.
const SETS: usize = 6;
/// Corrections of the forces on one set.
const CORRECTIONS: usize = 8;
/// What is added to the diagonal of Σ μ g gᵀ, relative to its largest entry, where rows depend on each other.
const SHIFTS: [f64; 3] = [1e-14, 1e-12, 1e-10];
/// Eigenvalues of Σ g gᵀ, for rows of length one, above which no motion is overlooked by all rows: rounding in its factor is
/// a hundred times smaller, and [`super::balance::RANK`] squared smaller still.
const DEFINITE: f64 = 1e-11;

/// Whether rows of length one see every motion, by far more than the tolerance of a rank; where not, elimination has to tell.
pub(super) fn see_every_motion(rows: &[Row], columns: usize) -> bool {
    let unit = rows.iter().map(|row| (row, 1.0));
    columns == 0 || normal(unit, columns, -DEFINITE).is_some()
}

/// Forces on `rows`, none of them negative, that leave of `load` what no forces can balance, to `round_off`; nothing where
/// that was not reached.
pub(super) fn forces(rows: &[Row], columns: usize, load: &[f64], round_off: f64) -> Option<Vec<f64>> {
    let size = load.iter().fold(0.0_f64, |m, v| m.hypot(*v));
    let mut forces = near(rows, columns, load, size)?;
    for _ in 0..SETS {
        let rest = exact(rows, columns, load, &mut forces, round_off)?;
        let missed: Vec<usize> =
            (0..rows.len()).filter(|i| forces[*i] == 0.0 && dot(&rows[*i], &rest) > round_off).collect();
        if missed.is_empty() {
            return Some(forces);
        }
        let share = forces.iter().sum::<f64>().max(size) / rows.len() as f64;
        missed.into_iter().for_each(|i| forces[i] = 1e-3 * share);
    }
    None
}

/// What the `forces` leave of `load`.
pub(super) fn left_of(load: &[f64], rows: &[Row], forces: &[f64]) -> Vec<f64> {
    let mut rest = load.to_vec();
    for (row, force) in rows.iter().zip(forces).filter(|(_, force)| **force != 0.0) {
        row.iter().for_each(|(k, v)| rest[*k] -= v * force);
    }
    rest
}

/// Forces where the interior point ends; none on rows from which the motion moves away.
fn near(rows: &[Row], columns: usize, load: &[f64], size: f64) -> Option<Vec<f64>> {
    let at = |i: usize| rows[i].iter().map(move |(k, v)| (i, *k, *v));
    let mut entries: Vec<(usize, usize, f64)> = (0..rows.len()).flat_map(at).collect();
    entries.sort_unstable_by_key(|(i, k, _)| (*k, *i));
    let mut starts = vec![0; columns + 1];
    entries.iter().for_each(|(_, k, _)| starts[k + 1] += 1);
    (0..columns).for_each(|k| starts[k + 1] += starts[k]);
    let (indices, values) = entries.iter().map(|(i, _, v)| (*i, *v)).unzip();
    let matrix = CscMatrix::new(rows.len(), columns, starts, indices, values);
    let q: Vec<f64> = load.iter().map(|v| -v / size).collect();
    let settings = DefaultSettings {
        max_iter: ITERATIONS,
        verbose: false,
        tol_gap_abs: TOLERANCE,
        tol_gap_rel: TOLERANCE,
        tol_feas: TOLERANCE,
        max_threads: 1,
        equilibrate_enable: false,
        ..DefaultSettings::default()
    };
    let (zero, cones) = (vec![0.0; rows.len()], [NonnegativeConeT(rows.len())]);
    let mut solver = DefaultSolver::new(&CscMatrix::identity(columns), &q, &matrix, &zero, &cones, settings).ok()?;
    solver.solve();
    // However it ended, what it came to is a first guess.
    let found = solver.solution.z.iter().zip(&solver.solution.s);
    let forces: Vec<f64> = found.map(|(force, away)| if force > away { size * force } else { 0.0 }).collect();
    forces.iter().all(|force| force.is_finite()).then_some(forces)
}

/// Makes the positive `forces` those that balance the most of `load`, dropping those that would turn negative; what they leave.
fn exact(rows: &[Row], columns: usize, load: &[f64], forces: &mut [f64], round_off: f64) -> Option<Vec<f64>> {
    let mut rest = left_of(load, rows, forces);
    let pull = |forces: &[f64], rest: &[f64]| {
        let carrying = rows.iter().zip(forces).filter(|(_, force)| **force > 0.0);
        carrying.fold(0.0_f64, |m, (row, _)| m.max(dot(row, rest).abs()))
    };
    let mut most = pull(forces, &rest);
    while most > round_off {
        let before = most;
        let factor = SHIFTS.into_iter().find_map(|shift| {
            let weighted =
                rows.iter().zip(&*forces).filter(|(_, force)| **force > 0.0).map(|(row, force)| (row, *force));
            normal(weighted, columns, shift)
        })?;
        for _ in 0..CORRECTIONS {
            let z = factor.solve(Col::from_fn(columns, |k| rest[k]));
            let z: Vec<f64> = z.iter().copied().collect();
            for (force, row) in forces.iter_mut().zip(rows).filter(|(force, _)| **force > 0.0) {
                *force = (*force * (1.0 + dot(row, &z))).max(0.0);
            }
            rest = left_of(load, rows, forces);
            most = pull(forces, &rest);
            if most <= round_off {
                break;
            }
        }
        // Digits that are not won by a new factor are lost.
        if most > 0.1 * before && most > round_off {
            return None;
        }
    }
    Some(rest)
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
