//! Balance of the loads on one group of pieces.

use super::StaticsError;
use super::cone;
use super::loads::LoadResultants;
use super::restraint::{Group, Run};
use super::span::Span;
use super::words;
use crate::problem::Problem;
use nalgebra::{DMatrix, DVector};

/// Unit rows closer than this to the span of the others depend on them.
pub(super) const RANK: f64 = 1e-9;

/// Unbalanced loads below this fraction of the sum of all loads are round-off.
const BALANCED: f64 = 1e-10;

/// What was found for one group, as vectors in the unknowns of the group.
pub(super) struct Verdict {
    /// The motions allowed both ways.
    pub held: Span,
    /// A motion r in which the loads do work |r|² and that nothing stops; none where the loads are balanced.
    pub driven: Option<Driven>,
    /// The borderline motion, see [`super::Equilibrium::Possible`].
    pub one_way: Option<DVector<f64>>,
    /// The motion that the pressures of the mesh cannot stop, see [`super::Equilibrium::Possible`].
    pub beyond_mesh: Option<DVector<f64>>,
}

impl Verdict {
    pub fn of(problem: &Problem, group: &Group, loads: &LoadResultants) -> Result<Self, StaticsError> {
        let undecided = |_: cone::Unsettled| StaticsError::Undecided { bodies: words::all_names(group) };
        let mut load = DVector::zeros(group.dimension());
        for (i, c) in group.members.iter().enumerate() {
            load[3 * i] = loads.force[*c][0];
            load[3 * i + 1] = loads.force[*c][1];
            load[3 * i + 2] = loads.moment[*c] / group.components.size[*c];
        }
        let total: f64 = group.members.iter().map(|c| loads.magnitude[*c]).sum();
        let tolerance = total * round_off(group);

        let rollers = group.rollers(problem);
        let allowed = Allowed::new(group, &rollers, |run| run.ends);
        let parts = allowed.unbalanced(&load).map_err(undecided)?;
        let [both, one] = &parts;
        let size = both.norm().hypot(one.norm());
        if size > tolerance {
            // A pure translation says more than a mixed motion on which the loads do hardly more work.
            let mut no_rotation = rollers;
            let units =
                (0..group.members.len()).map(|m| DVector::from_fn(group.dimension(), |i, _| f64::from(i == 3 * m + 2)));
            no_rotation.extend(units);
            let translations =
                Allowed::new(group, &no_rotation, |run| run.ends).unbalanced(&load).map_err(undecided)?;
            let work_free = both.norm() <= tolerance;
            let driven = translations.into_iter().chain(parts).find(|part| part.norm() >= 0.7 * size).map(|part| {
                let work = part.norm_squared();
                let motion = if work_free { allowed.without_sliding(group, part, |run| run.ends) } else { part };
                Driven { motion, work }
            });
            return Ok(Verdict { held: allowed.held, driven, one_way: None, beyond_mesh: None });
        }

        let thirds = Allowed::new(group, &rollers, |run| run.thirds);
        let [_, beyond] = thirds.unbalanced(&load).map_err(undecided)?;
        let one_way = allowed.borderline(&load, total).map_err(undecided)?;
        Ok(Verdict {
            driven: None,
            one_way: one_way.map(|motion| allowed.without_sliding(group, motion, |run| run.ends)),
            beyond_mesh: (beyond.norm() > tolerance).then(|| allowed.without_sliding(group, beyond, |run| run.thirds)),
            held: allowed.held,
        })
    }
}

/// A motion and the work of the loads in it.
pub(super) struct Driven {
    pub motion: DVector<f64>,
    pub work: f64,
}

/// The cone of allowed motions of a group.
struct Allowed {
    supports: Span,
    /// The motions allowed both ways.
    held: Span,
    /// Unit rows g with g · y ≤ 0, orthogonal to the supports and to `held`.
    rows: Vec<DVector<f64>>,
}

impl Allowed {
    /// From rows that must vanish and the two points of each contact run where the jump must not be positive.
    fn new(group: &Group, vanishing: &[DVector<f64>], points: impl Fn(&Run) -> [[f64; 2]; 2]) -> Self {
        let mut supports = Span::empty(group.dimension());
        supports.extend(vanishing, RANK);
        let mut fixed = supports.clone();
        let ties: Vec<_> =
            group.runs.iter().flat_map(|run| group.ties(run)).map(|row| supports.residual(&row)).collect();
        fixed.extend(&ties, RANK);
        let held = fixed.complement();
        let jumps = group.runs.iter().flat_map(|run| points(run).map(|point| group.jump(run, point)));
        let rows = jumps
            .map(|row| held.residual(&supports.residual(&row)))
            .filter(|row| row.norm() > RANK)
            .map(|row| row.normalize())
            .collect();
        Allowed { supports, held, rows }
    }

    /// What neither supports nor contacts can balance: the part along motions allowed both ways, and the rest.
    fn unbalanced(&self, load: &DVector<f64>) -> Result<[DVector<f64>; 2], cone::Unsettled> {
        let load = self.supports.residual(load);
        let both = self.held.project(&load);
        let one = cone::unbalanced(&(load - &both), &self.rows)?;
        Ok([both, one])
    }

    /// A motion of the cone, not allowed both ways, that sees no work of a balanced `load`. There is one exactly when the
    /// load is balanced on the edge of what the contacts can balance: when it cannot be prolonged a little from an inner
    /// point, the sum of all contact forces.
    fn borderline(&self, load: &DVector<f64>, total: f64) -> Result<Option<DVector<f64>>, cone::Unsettled> {
        if self.rows.is_empty() {
            return Ok(None);
        }
        let step = if total > 0.0 { 1e-7 * total } else { 1.0 };
        let mut prolonged = load.clone();
        for row in &self.rows {
            prolonged.axpy(-step / self.rows.len() as f64, row, 1.0);
        }
        let [_, one] = self.unbalanced(&prolonged)?;
        Ok((one.norm() > 1e-4 * step).then_some(one))
    }

    /// `motion` with free motions added so that, as far as they can, pieces do not slide where they stay in touch: what
    /// turns then turns about its points of contact and not about a point that round-off or the method would choose.
    /// Translations stay as they are. Touch is judged at the two `points` of each run. The loads must do no work on free motions.
    fn without_sliding(
        &self,
        group: &Group,
        motion: DVector<f64>,
        points: impl Fn(&Run) -> [[f64; 2]; 2],
    ) -> DVector<f64> {
        let size = motion.amax();
        let turns = (0..motion.len()).any(|i| i % 3 == 2 && motion[i].abs() > 1e-5 * size);
        if !turns || self.held.basis.is_empty() {
            return motion;
        }
        let ends = group.runs.iter().flat_map(|run| points(run).map(|end| (*run, end)));
        let touching = ends.filter(|(run, end)| group.jump(run, *end).dot(&motion).abs() <= 1e-5 * size);
        let rows: Vec<_> = touching.map(|(run, end)| group.slip(run, end)).collect();
        if rows.is_empty() {
            return motion;
        }
        let on_free = DMatrix::from_fn(rows.len(), self.held.basis.len(), |i, j| rows[i].dot(&self.held.basis[j]));
        let slips = DVector::from_fn(rows.len(), |i, _| -rows[i].dot(&motion));
        let amounts = on_free.svd(true, true).solve(&slips, RANK);
        let mut still = motion;
        for (q, amount) in self.held.basis.iter().zip(amounts.iter().flat_map(|all| all.iter())) {
            still.axpy(*amount, q, 1.0);
        }
        still
    }
}

/// What counts as zero relative to the loads: [`BALANCED`], or more where coordinates far from the origin or short
/// contacts leave fewer digits in the directions of contact.
fn round_off(group: &Group) -> f64 {
    let components = group.components;
    let far = |c: &usize| components.centre[*c][0].hypot(components.centre[*c][1]) + components.size[*c];
    let farthest = group.members.iter().map(far).fold(0.0, f64::max);
    let lengths = group.runs.iter().map(|run| {
        let [p, q] = run.ends;
        (q[0] - p[0]).hypot(q[1] - p[1])
    });
    let smallest = group.members.iter().map(|c| components.size[*c]).chain(lengths).fold(f64::INFINITY, f64::min);
    (BALANCED + 16.0 * f64::EPSILON * farthest / smallest).min(1e-7)
}
