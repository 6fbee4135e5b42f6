//! Balance of the loads on one group of pieces.

use super::StaticsError;
use super::cone;
use super::cone::few::DenseCone;
use super::cone::many::SparseCone;
use super::friction;
use super::lasting::{Lasting, Question};
use super::loads::LoadResultants;
use super::openings::{Points, Ties};
use super::restraint::{Group, Part};
use super::words;
use crate::problem::Problem;
use nalgebra::{DVector, Vector3};

/// Unit rows closer than this to the span of the others depend on them.
pub(super) const RANK: f64 = 1e-9;

/// Unbalanced loads below this fraction of the sum of all loads are round-off.
const BALANCED: f64 = 1e-10;

/// Groups of more pieces than this are judged with sparse rows.
const MANY: usize = 24;

/// The findings for one group, as vectors in the unknowns of the group.
pub(super) struct Verdict {
    /// A basis of the motions allowed both ways.
    pub held: Vec<DVector<f64>>,
    /// A motion r in which the loads do work |r|² and that nothing stops; none where the loads are balanced.
    pub driven: Option<Driven>,
    /// The borderline motion, see [`super::Solvability::Possible`].
    pub one_way: Option<DVector<f64>>,
    /// The motion that the pressures of the mesh cannot stop, see [`super::Solvability::Possible`].
    pub beyond_mesh: Option<DVector<f64>>,
    /// The part of the verdict that a finer mesh does not change.
    pub lasting: Option<Lasting>,
}

impl Verdict {
    /// The verdict on `group`; what is known of it from `before`, a coarser mesh, is taken from there.
    pub fn of(
        problem: &Problem,
        group: &Group,
        loads: &LoadResultants,
        before: &[Lasting],
    ) -> Result<Self, StaticsError> {
        Self::from_cones(problem, group, loads, before, |vanishing, points| {
            cone(group, vanishing, points, Ties::Vertices)
        })
    }

    /// A basis of those motions of `held` that keep contact closed between vertices too.
    pub fn held_along_edges(&self, problem: &Problem, group: &Group) -> Vec<DVector<f64>> {
        if self.held.is_empty() || group.runs.iter().all(|run| run.turning.is_none()) {
            return self.held.clone();
        }
        cone(group, &group.rollers(problem), Points::Ends, Ties::Edges).held()
    }

    /// As [`Self::of`], with the cones that `cone` makes of vanishing rows and of the points of runs that must not penetrate.
    pub fn from_cones<'a>(
        problem: &Problem,
        group: &Group,
        loads: &LoadResultants,
        before: &[Lasting],
        cone: impl Fn(&[Part], Points) -> Box<dyn Cone + 'a>,
    ) -> Result<Self, StaticsError> {
        let undecided = |_: cone::Unsettled| StaticsError::Undecided { bodies: words::all_names(group) };
        let given = group.load(loads);
        let total = group.magnitude(loads);
        let tolerance = total * round_off(group);

        let rollers = group.rollers(problem);
        let rubs = group.runs.iter().any(|run| run.friction > 0.0);
        // What friction leaves of a load; its forces are found anew for each, and for where contacts push.
        let left = |load: &DVector<f64>, points: Points| match rubs {
            true => load - friction::relieved(group, &rollers, points, load, total),
            false => load.clone(),
        };
        let load = left(&given, Points::Ends);
        let question = Question::new(group, &rollers, &load, total);
        if let Some(known) = before.iter().find(|known| !rubs && known.answers(&question)) {
            let beyond_mesh = beyond_mesh(&*cone(&rollers, Points::Reach), &load, tolerance).map_err(undecided)?;
            let Lasting { held, one_way, .. } = known.clone();
            let lasting = Some(known.clone());
            return Ok(Verdict { held, driven: None, one_way, beyond_mesh, lasting });
        }
        let allowed = cone(&rollers, Points::Ends);
        let parts = allowed.unbalanced(&load).map_err(undecided)?;
        let [both, one] = &parts;
        let size = both.norm().hypot(one.norm());
        if size > tolerance {
            // A pure translation says more than a mixed motion on which the loads do hardly more work.
            let mut no_rotation = rollers.clone();
            no_rotation.extend((0..group.members.len()).map(|m| (m, Vector3::z())));
            let translations = cone(&no_rotation, Points::Ends).unbalanced(&load).map_err(undecided)?;
            let work_free = both.norm() <= tolerance;
            // What friction takes up depends on the motion: that of all is the one it was found for.
            let translations = if rubs { [&given * 0.0, &given * 0.0] } else { translations };
            let driven = translations.into_iter().chain(parts).find(|part| part.norm() >= 0.7 * size).map(|part| {
                let work = part.norm_squared();
                let motion = if work_free && !rubs { allowed.without_sliding(part) } else { part };
                let resisted = friction::resistance(group, &motion);
                Driven { work: work + resisted, motion, resisted }
            });
            // Forces that balance the load less well than others prove nothing.
            if let Some(driven) = &driven
                && rubs
                && given.dot(&driven.motion) <= driven.resisted + 0.5 * (driven.work - driven.resisted)
            {
                return Err(undecided(cone::Unsettled));
            }
            return Ok(Verdict { held: allowed.held(), driven, one_way: None, beyond_mesh: None, lasting: None });
        }

        let reached = left(&given, Points::Reach);
        let beyond_mesh = beyond_mesh(&*cone(&rollers, Points::Reach), &reached, tolerance).map_err(undecided)?;
        let one_way = borderline(&*allowed, |load| left(load, Points::Ends), &given, total).map_err(undecided)?;
        let one_way = one_way.map(|motion| allowed.without_sliding(motion));
        let held = allowed.held();
        // On another mesh friction has another sum, and so has what it leaves of the loads.
        let lasting = (!rubs).then(|| Lasting { question, held: held.clone(), one_way: one_way.clone() });
        Ok(Verdict { held, driven: None, one_way, beyond_mesh, lasting })
    }
}

/// The cone of allowed motions of `group`.
fn cone<'a>(group: &'a Group<'a>, vanishing: &[Part], points: Points, ties: Ties) -> Box<dyn Cone + 'a> {
    if group.members.len() > MANY {
        Box::new(SparseCone::new(group, vanishing, points, ties))
    } else {
        Box::new(DenseCone::new(group, vanishing, points, ties))
    }
}

/// The motion that the pressures of the mesh, which `carried` knows the reach of, cannot stop.
fn beyond_mesh(
    carried: &dyn Cone,
    load: &DVector<f64>,
    tolerance: f64,
) -> Result<Option<DVector<f64>>, cone::Unsettled> {
    let [_, beyond] = carried.unbalanced(load)?;
    Ok((beyond.norm() > tolerance).then(|| carried.without_sliding(beyond)))
}

/// A motion and the work of the loads in it.
pub(super) struct Driven {
    pub motion: DVector<f64>,
    pub work: f64,
    /// Work absorbed by friction in it.
    pub resisted: f64,
}

/// The cone of allowed motions of a group.
pub(super) trait Cone {
    /// The part of `load` that neither supports nor contacts can balance: the component along motions allowed both ways, and the rest.
    fn unbalanced(&self, load: &DVector<f64>) -> Result<[DVector<f64>; 2], cone::Unsettled>;

    /// How many rows g, of length one and orthogonal to motions allowed both ways, have g · y ≤ 0, and their sum.
    fn rows(&self) -> (usize, DVector<f64>);

    /// A basis of the motions allowed both ways, readable: most of them translations of few pieces.
    fn held(&self) -> Vec<DVector<f64>>;

    /// `motion` with free motions added so that, as far as they can, pieces do not slide where they stay in touch: a piece that
    /// turns then turns about its points of contact and not about a point that round-off or the method would choose.
    /// Translations stay as they are. The loads must do no work on free motions.
    fn without_sliding(&self, motion: DVector<f64>) -> DVector<f64>;
}

/// A motion of the cone, not allowed both ways, that sees no work of a balanced `load`. There is one exactly when the
/// load is balanced on the edge of what the contacts can balance: when it cannot be prolonged a little from an inner
/// point, the sum of all contact forces. Friction takes its part of the prolonged load, and `left` is the rest.
fn borderline(
    cone: &dyn Cone,
    left: impl Fn(&DVector<f64>) -> DVector<f64>,
    load: &DVector<f64>,
    total: f64,
) -> Result<Option<DVector<f64>>, cone::Unsettled> {
    let (count, sum) = cone.rows();
    if count == 0 {
        return Ok(None);
    }
    let step = if total > 0.0 { 1e-7 * total } else { 1.0 };
    let [_, one] = cone.unbalanced(&left(&(load - sum * (step / count as f64))))?;
    Ok((one.norm() > 1e-4 * step).then_some(one))
}

/// Threshold of zero relative to the loads: [`BALANCED`], or more where coordinates far from the origin or short
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
