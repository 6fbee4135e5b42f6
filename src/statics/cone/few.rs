//! The cone of allowed motions of a group of few pieces, by orthonormal bases with the rank decided by pivoting.

use super::span::Span;
use crate::statics::balance::{Cone, RANK};
use crate::statics::cone;
use crate::statics::openings::{Points, Ties};
use crate::statics::restraint::{Group, Part};
use nalgebra::{DMatrix, DVector};

/// The allowed motions of a group.
pub(in crate::statics) struct DenseCone<'a> {
    group: &'a Group<'a>,
    points: Points,
    supports: Span,
    /// The motions allowed both ways.
    held: Span,
    /// Unit rows g with g · y ≤ 0, orthogonal to the supports and to `held`.
    rows: Vec<DVector<f64>>,
}

impl<'a> DenseCone<'a> {
    /// From rows that must vanish, the two points of each contact run where the jump must not be positive, and where contact keeps closed in
    /// motions allowed both ways.
    pub fn new(group: &'a Group<'a>, vanishing: &[Part], points: Points, ties: Ties) -> Self {
        let supports = group.span(vanishing);
        let mut fixed = supports.clone();
        let ties: Vec<_> = group
            .runs
            .iter()
            .flat_map(|run| group.ties(run, ties))
            .map(|row| supports.residual(&group.dense(&row)))
            .collect();
        fixed.extend(&ties, RANK);
        let held = fixed.complement();
        let jumps = group.runs.iter().flat_map(|run| group.jumps(run, points));
        let rows = jumps
            .map(|row| held.residual(&supports.residual(&group.dense(&row))))
            .filter(|row| row.norm() > RANK)
            .map(|row| row.normalize())
            .collect();
        DenseCone { group, points, supports, held, rows }
    }
}

impl Cone for DenseCone<'_> {
    fn unbalanced(&self, load: &DVector<f64>) -> Result<[DVector<f64>; 2], cone::Unsettled> {
        let load = self.supports.residual(load);
        let both = self.held.project(&load);
        let one = cone::unbalanced(&(load - &both), &self.rows)?;
        Ok([both, one])
    }

    fn rows(&self) -> (usize, DVector<f64>) {
        let sum = self.rows.iter().fold(DVector::zeros(self.group.dimension()), |sum, row| sum + row);
        (self.rows.len(), sum)
    }

    /// In reduced echelon form, rotations eliminated first.
    fn held(&self) -> Vec<DVector<f64>> {
        let mut rows = self.held.basis.clone();
        let mut done = 0;
        for class in [|i: usize| i % 3 == 2, |i: usize| i % 3 != 2] {
            while done < rows.len() {
                let columns = (0..self.group.dimension()).filter(|i| class(*i));
                let entries = columns.flat_map(|i| (done..rows.len()).map(move |r| (r, i)));
                let largest = entries.max_by(|a, b| rows[a.0][a.1].abs().total_cmp(&rows[b.0][b.1].abs()));
                let Some((r, i)) = largest.filter(|(r, i)| rows[*r][*i].abs() > RANK) else { break };
                rows.swap(done, r);
                let pivot = rows[done].clone() / rows[done][i];
                for (other, row) in rows.iter_mut().enumerate() {
                    let factor = row[i];
                    if other != done {
                        row.axpy(-factor, &pivot, 1.0);
                    }
                }
                rows[done] = pivot;
                done += 1;
            }
        }
        for row in &mut rows {
            let size = row.amax();
            row.iter_mut().filter(|x| x.abs() < 1e-12 * size).for_each(|x| *x = 0.0);
        }
        rows
    }

    fn without_sliding(&self, motion: DVector<f64>) -> DVector<f64> {
        let Some(touching) = self.group.touching(&motion, self.points).filter(|_| !self.held.basis.is_empty()) else {
            return motion;
        };
        let slips: Vec<_> = touching.iter().map(|(run, end)| self.group.dense(&self.group.slip(run, *end))).collect();
        let basis = &self.held.basis;
        let on_free = DMatrix::from_fn(slips.len(), basis.len(), |i, j| slips[i].dot(&basis[j]));
        let wanted = DVector::from_fn(slips.len(), |i, _| -slips[i].dot(&motion));
        let amounts = on_free.svd(true, true).solve(&wanted, RANK);
        let mut still = motion;
        for (q, amount) in basis.iter().zip(amounts.iter().flat_map(|all| all.iter())) {
            still.axpy(*amount, q, 1.0);
        }
        still
    }
}
