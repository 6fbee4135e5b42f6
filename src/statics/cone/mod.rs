//! Projection of the loads onto the cone of allowed motions.
//!
//! Let C = {y : g_i · y ≤ 0} be the allowed motions and C° = {Σ μ_i g_i : μ ≥ 0} its polar, the loads the contact
//! forces μ can balance. Every load splits as L = Σ μ_i g_i + r with r ∈ C orthogonal to the first part (Moreau), and
//! L(r) = |r|². So r = 0 exactly when equilibrium is possible (Farkas), and otherwise r is the allowed motion of unit
//! length on which the loads do most work. The non-negative least-squares problem behind it is solved by the active-set
//! method of Lawson and Hanson, which ends at an exact vertex: no interior-point tolerance blurs the borderline.
pub(super) mod few;
pub(super) mod interior;
pub(super) mod many;
pub(super) mod span;
pub(super) mod sparse;

use nalgebra::{DMatrix, DVector};

/// The rounds were used up: the working set did not settle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Unsettled;

/// Cosine from which a row counts as leaning towards the unbalanced load. A row let in by round-off alone is turned away
/// again, because it must balance more than was balanced before.
const ANGLE: f64 = 1e-12;

/// A working set: rows that carry force, the forces, and the load they leave unbalanced.
#[derive(Clone)]
struct Working {
    rows: Vec<usize>,
    forces: Vec<f64>,
    rest: DVector<f64>,
}

/// r above, for unit `rows` g_i. Zero to round-off of |`load`| when the rows can balance the load.
pub(crate) fn unbalanced(load: &DVector<f64>, rows: &[DVector<f64>]) -> Result<DVector<f64>, Unsettled> {
    Ok(balanced(load, rows)?.0)
}

/// The unbalanced part of a load, and the forces that balance the other part: (row, force).
pub(crate) type Balanced = (DVector<f64>, Vec<(usize, f64)>);

/// As [`unbalanced`], with the forces that balance the other part.
pub(crate) fn balanced(load: &DVector<f64>, rows: &[DVector<f64>]) -> Result<Balanced, Unsettled> {
    let size = load.norm();
    let mut now = Working { rows: Vec::new(), forces: Vec::new(), rest: load.clone() };
    let mut refused = vec![false; rows.len()];
    let mut settled = false;
    for _ in 0..100 + 20 * rows.len() {
        let rest = now.rest.norm();
        if rest <= 4.0 * f64::EPSILON * size {
            settled = true;
            break;
        }
        let entering = (0..rows.len())
            .filter(|i| !refused[*i] && !now.rows.contains(i))
            .map(|i| (i, rows[i].dot(&now.rest)))
            .filter(|(_, pull)| *pull > ANGLE * rest)
            .max_by(|a, b| a.1.total_cmp(&b.1));
        let Some((entering, _)) = entering else {
            settled = true;
            break;
        };
        match with_row(&now, entering, load, rows) {
            Some(next) if next.rest.norm() < rest => {
                now = next;
                refused.fill(false);
            }
            _ => refused[entering] = true,
        }
    }
    let Working { rows, forces, rest } = now;
    if settled { Ok((rest, rows.into_iter().zip(forces).collect())) } else { Err(Unsettled) }
}

/// The working set after `entering` has joined and every force that would turn negative has left; `None` where
/// round-off makes the new row useless.
fn with_row(from: &Working, entering: usize, load: &DVector<f64>, rows: &[DVector<f64>]) -> Option<Working> {
    let mut now = from.clone();
    now.rows.push(entering);
    now.forces.push(0.0);
    loop {
        let (forces, rest) = least_squares(&now.rows, load, rows)?;
        if forces.iter().all(|force| *force > 0.0) {
            return Some(Working { forces, rest, ..now });
        }
        let newest = now.rows.last() == Some(&entering);
        if newest && now.forces.last() == Some(&0.0) && forces.last().is_some_and(|force| *force <= 0.0) {
            return None;
        }
        let step = |(old, new): (&f64, &f64)| if *new > 0.0 { f64::INFINITY } else { old / (old - new) };
        let (blocking, length) =
            now.forces.iter().zip(&forces).map(step).enumerate().min_by(|a, b| a.1.total_cmp(&b.1))?;
        for (old, new) in now.forces.iter_mut().zip(&forces) {
            *old += length * (new - *old);
        }
        now.forces[blocking] = 0.0;
        let keep: Vec<bool> = now.forces.iter().map(|force| *force > 0.0).collect();
        let mut kept = keep.iter();
        now.rows.retain(|_| *kept.next().unwrap_or(&false));
        now.forces.retain(|force| *force > 0.0);
        if now.rows.is_empty() {
            return None;
        }
    }
}

/// Forces on `active` that balance `load` best, and what they leave.
fn least_squares(active: &[usize], load: &DVector<f64>, rows: &[DVector<f64>]) -> Option<(Vec<f64>, DVector<f64>)> {
    if active.len() > load.len() {
        return None;
    }
    let columns: Vec<_> = active.iter().map(|i| rows[*i].clone()).collect();
    let qr = DMatrix::from_columns(&columns).qr();
    let q = qr.q();
    let along = q.tr_mul(load);
    let mut rest = load - &q * &along;
    rest -= &q * q.tr_mul(&rest);
    let forces = qr.r().solve_upper_triangular(&along)?;
    forces.iter().all(|force| force.is_finite()).then(|| (forces.as_slice().to_vec(), rest))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn unit(values: [f64; 4]) -> DVector<f64> {
        DVector::from_row_slice(&values).normalize()
    }

    proptest! {
        /// The three conditions that characterise the projection, whichever way it was found.
        #[test]
        fn rest_is_allowed_and_orthogonal_to_the_balanced_part(
            load in proptest::array::uniform4(-1.0..1.0f64),
            raw in proptest::collection::vec(proptest::array::uniform4(-1.0..1.0f64), 0..12),
        ) {
            let load = DVector::from_row_slice(&load);
            let rows: Vec<_> = raw.into_iter().map(unit).collect();
            let rest = unbalanced(&load, &rows).unwrap();
            prop_assert!(rows.iter().all(|row| row.dot(&rest) < 1e-11));
            prop_assert!((load.dot(&rest) - rest.norm_squared()).abs() < 1e-13);
            // The balanced part lies in the polar cone: balancing it again leaves nothing.
            let balanced = &load - &rest;
            prop_assert!(unbalanced(&balanced, &rows).unwrap().norm() < 1e-11);
        }
    }

    #[test]
    fn narrow_cones_are_resolved() {
        // Two rows 2e-7 apart span a wedge; a load leaning 1e-6 of that width out of it is told from one inside.
        let (left, right) = (unit([1.0, -1e-7, 0.0, 0.0]), unit([1.0, 1e-7, 0.0, 0.0]));
        let rows = [left, right];
        let inside = unit([1.0, 1e-7 * (1.0 - 1e-6), 0.0, 0.0]);
        let outside = unit([1.0, 1e-7 * (1.0 + 1e-6), 0.0, 0.0]);
        assert!(unbalanced(&inside, &rows).unwrap().norm() < 1e-15);
        let rest = unbalanced(&outside, &rows).unwrap().norm();
        assert!((rest / 1e-13 - 1.0).abs() < 0.01, "{rest}");
    }
}
