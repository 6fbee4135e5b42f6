//! Relaxation of the free upper bound: one patch of triangles after the other gives up energy.
//!
//! The local fit leaves an error that oscillates from triangle to triangle, and it knows nothing of where supports and
//! gaps let the displacement go. Minimising the energy over the values at a group of vertices and on the edges that meet
//! there, with everything else fixed and no jump on Γ_K above its gap, removes most of both; the patches are large enough
//! to hold fields without change of volume, so that this works as ν → ½ as well. Every step stays admissible and lowers
//! the energy.

pub(super) mod fronts;
pub(super) mod groups;
pub(super) mod momentum;
pub(super) mod patch;
pub(super) mod patches;
pub(super) mod share;

use super::NoUpperBound;
use super::admissible::contact::ROUNDING;
use super::admissible::ends::largest;
use super::admissible::nodes::NodalValues;
use super::energy::model::Model;
use crate::problem::Problem;
use momentum::Momentum;
use patches::Patches;
use share::Share;

/// Rounding of a step of all patches at once, in that of one: jumps that stay closed grow by it, and would cut the step short. What
/// penetrates by it is drawn back with the rest at the end.
const AT_ONCE: f64 = 1e3;
/// Sweeps over all patches. The first takes most of what there is to gain, at ν = 0.3 all of it; the third is worth
/// less than its time even at ν = 0.4999.
const SWEEPS: usize = 2;

/// More sweeps follow, up to this many, while one gains more than this part of the gap: slivers couple their vertices so
/// strongly that the local fit leaves errors far above the energy itself.
const MOST_SWEEPS: usize = 500;
const WORTH_A_SWEEP: f64 = 3e-3;

/// Replaces [`WORTH_A_SWEEP`] where the direction of contact varies: it differs with every polygon along a curve, one body slides around
/// the other as a whole, and the displacement of the previous mesh is off by a little everywhere, which sweeps remove slowly.
const WORTH_WHERE_BENT: f64 = 1e-3;

/// Of the smallest gain that is worth a sweep this part, divided among all patches: a patch that gained less, and lies beside none
/// that gained more, rests …
const QUIET: f64 = 0.05;
/// (the same near a lower bound, where a sweep of few patches is worth less in proportion)
const QUIET_NEAR: f64 = 0.3;
/// … where no more than this part of all have to move.
const FEW: f64 = 0.5;

/// Part of the energy below which a gain is rounding, however little is wanted.
const NO_GAIN: f64 = 1e-13;

/// A gap above this part of the energy makes a poor bound, and smaller gains are worth a sweep in proportion: sweeps that
/// gain little lead to others that gain much.
const GOOD: f64 = 1e-3;

/// A field with more energy than this, relative to what bodies at rest have or to the lower bound, says nothing about the
/// displacement. On slivers a good one may have very much.
const WILD: f64 = 1e30;

/// When relaxing ends, after the sweeps that are always made; energies are per unit thickness.
#[derive(Debug, Clone, Copy)]
pub enum Until {
    /// A sweep gains a small part of what lies between the energy and this lower bound of it.
    Near(f64),
    /// A sweep gains no more than `least`. A field that was `relaxed` under a pull that differs little but at the contact moves there
    /// first, and where patches still gained.
    Gains { least: f64, relaxed: bool },
}

impl Until {
    /// Sweeps that are made in any case. Where it is known what a gain is worth the first may be enough: it often begins with a
    /// field that was relaxed under a similar pull.
    fn least_sweeps(self) -> usize {
        match self {
            Until::Near(_) => SWEEPS,
            Until::Gains { .. } => 1,
        }
    }

    /// The size of the energy, as far as it is known.
    fn size(self) -> f64 {
        match self {
            Until::Near(size) | Until::Gains { least: size, .. } => size.abs(),
        }
    }

    /// Least gain that makes a sweep of all patches, which leads to this energy, worth its time: the part `part` of the gap.
    fn worth(self, part: f64, energy: f64, rounding: f64) -> f64 {
        match self {
            Until::Gains { least, .. } => least.max(NO_GAIN * energy.abs()),
            Until::Near(floor) => {
                let gap = (energy - floor).max(0.0);
                // Where bodies that nothing holds have turned far, little energy is lost in the rounding of much motion, and
                // what a sweep gains is known to more digits.
                let nothing = (part * rounding).max(NO_GAIN * floor.abs());
                if gap == 0.0 { nothing } else { part * (GOOD * floor.abs() / gap).min(1.0) * gap }
            }
        }
    }

    /// Least gain for which a patch is moved again with few of all `count` patches; `None` where all go on moving. Near a lower bound this
    /// requires that contact does not bend and the bound is good already, so that the remaining gap lies at corners and ends of contact:
    /// the error of a poor bound may be everywhere, and move slowly. The energy, `begun` at first, has to be known to enough digits.
    fn quiet(self, bends: bool, energy: f64, begun: f64, count: f64) -> Option<f64> {
        match self {
            Until::Gains { least, .. } => Some(QUIET * least / count),
            Until::Near(floor) => {
                let (gap, worth) = (energy - floor, self.worth(WORTH_A_SWEEP, energy, 0.0));
                let good = gap > 0.0 && gap <= GOOD * floor.abs() && NO_GAIN * begun.abs() <= worth;
                (good && !bends).then_some(QUIET_NEAR * worth / count)
            }
        }
    }
}

/// Lowers the energy, that of `model`, of the best of several admissible fields, or of the one `at_rest` where these are
/// wild. Where that ends far above the lower bound, the best field on the way to the one at rest is relaxed again.
///
/// # Errors
/// That of `at_rest`.
pub fn relax(
    problem: &Problem,
    model: &Model,
    patches: &mut Patches,
    until: Until,
    candidates: Vec<NodalValues>,
    at_rest: impl Fn() -> Result<NodalValues, NoUpperBound>,
    share: &dyn Share,
) -> Result<NodalValues, NoUpperBound> {
    let begun = begin(model, until, candidates, &at_rest, share)?;
    let (energy, field) = relaxed(problem, model, patches, until, begun, share);
    if let Until::Near(floor) = until
        && energy - floor > floor.abs()
        && let Ok(rest) = at_rest()
    {
        // A body that is held by little may have gone far, and sweeps bring it back slowly.
        let nearer = best_between(model, rest, (energy, field), share);
        return Ok(relaxed(problem, model, patches, until, nearer, share).1);
    }
    Ok(field)
}

/// The energy that sweeps lead to from `begun`, and the field that has it.
fn relaxed(
    problem: &Problem,
    model: &Model,
    patches: &mut Patches,
    until: Until,
    begun: (f64, NodalValues),
    share: &dyn Share,
) -> (f64, NodalValues) {
    let (begun, NodalValues { nodes, mut values }) = begun;
    let mut energy = begun;
    let slack = ROUNDING * largest(&values, share);
    let bends = problem.contact_bends();
    let part = if bends { WORTH_WHERE_BENT } else { WORTH_A_SWEEP };
    let count = share.total(patches.count() as f64);
    let mut momentum = Momentum::default();
    // Those to move, and how many all processes have of them, where these are few.
    let few = |moved: Vec<usize>| {
        let all = share.total(moved.len() as f64);
        (all < FEW * count).then_some((moved, all))
    };
    let mut next = match (until, until.quiet(bends, energy, begun, count)) {
        (Until::Gains { relaxed: true, .. }, Some(quiet)) => {
            few(patches.to_move_or_bounded(problem, model, quiet, share))
        }
        _ => None,
    };
    for sweep in 0..MOST_SWEEPS {
        // Back and forth: what one direction pushes ahead of it the other brings back.
        let back = sweep % 2 == 1;
        let before = (sweep >= SWEEPS && next.is_none()).then(|| values.clone());
        let which = next.as_ref().map(|(which, _)| &which[..]);
        let mut gained = patches.sweep(model, which, back, slack, &mut values, share);
        if let Some(before) = before {
            gained += momentum.push(model, &before, AT_ONCE * slack, &mut values, share);
        }
        energy -= gained;
        let is_near = matches!(until, Until::Near(_));
        let mut rounding = 0.0;
        if is_near && next.is_none() && sweep + 1 >= SWEEPS {
            // What is left of a wild field is lost in the sum of what it gained.
            let found = model.energy(&values, share);
            rounding = (found - energy).abs();
            energy = found;
        }
        // Moving a few patches takes less time than moving all.
        let part_moved = next.as_ref().filter(|_| is_near).map_or(1.0, |(_, all)| all / count);
        if sweep + 1 >= until.least_sweeps() && gained <= part_moved * until.worth(part, energy, rounding) {
            break;
        }
        let quiet = until.quiet(bends, energy, begun, count);
        next = quiet.and_then(|quiet| few(patches.to_move(problem, model, quiet, share)));
    }
    (energy, NodalValues { nodes, values })
}

/// The least energy of a field to begin with, and the field.
fn begin(
    model: &Model,
    until: Until,
    candidates: Vec<NodalValues>,
    at_rest: impl Fn() -> Result<NodalValues, NoUpperBound>,
    share: &dyn Share,
) -> Result<(f64, NodalValues), NoUpperBound> {
    // A displacement that is not a number has no energy to compare.
    let known = |energy: f64| if energy.is_nan() { f64::INFINITY } else { energy };
    let fields = candidates.into_iter().map(|field| (known(model.energy(&field.values, share)), field));
    let least = fields.min_by(|(a, _), (b, _)| a.total_cmp(b));
    match least {
        Some(least) if least.0 <= WILD * until.size() => Ok(least),
        other => {
            let rest = at_rest()?;
            let own = model.energy(&rest.values, share);
            Ok(other.filter(|(energy, _)| *energy <= WILD * own.abs()).unwrap_or((own, rest)))
        }
    }
}

/// The field of least energy on the way from `rest` to `field`, and its energy: what is admissible is convex.
fn best_between(model: &Model, rest: NodalValues, field: (f64, NodalValues), share: &dyn Share) -> (f64, NodalValues) {
    let at = |part: f64| {
        let pairs = rest.values.iter().zip(&field.1.values);
        let values: Vec<[f64; 2]> = pairs.map(|(r, v)| [0, 1].map(|c| r[c] + part * (v[c] - r[c]))).collect();
        (model.energy(&values, share), NodalValues { nodes: rest.nodes.clone(), values })
    };
    let (first, half, last) = (model.energy(&rest.values, share), at(0.5).0, field.0);
    let bend = 2.0 * (first + last) - 4.0 * half;
    let part = (first + bend - last) / (2.0 * bend);
    let between = part.is_finite().then(|| at(part.clamp(0.0, 1.0)));
    let all = between.into_iter().chain([(first, rest), field]);
    all.min_by(|(a, _), (b, _)| a.total_cmp(b)).expect("two fields or three")
}
