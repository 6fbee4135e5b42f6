//! The next mesh and its degrees: rounds of Dörfler marking with predicted terms of the gap, until the work has grown enough
//! or the predicted bound meets the tolerance.

use super::admission::Admission;
use super::forecast::Forecast;
use super::indicators::Indicators;
use super::stage::{Solved, Stage};
use super::stop::Stop;
use super::trend::{EXPECTED, inherited, raised};
use super::{Adapt, Goal};
use crate::dual::{Size, carrying};
use crate::element::{Elements, block};
use crate::problem::Problem;
use crate::report::text::number::vector;
use crate::study::certified::StudyError;

/// Unknowns of the next mesh per unknown of this one: the solves on meshes that grow by g cost g/(g − 1) times the last one,
/// if a solve costs in proportion to its unknowns, and less where it costs more.
const GROWTH: f64 = 2.4;

/// Widths and errors fall at least like this power of the unknowns, turned round, and a mesh may have so much more than that
/// takes: predictions that fail near the tolerance would make it far too large.
const SLOWEST: f64 = 0.75;
const MORE: f64 = 1.15;

/// The bound aimed at, relative to the tolerance: a mesh that misses it narrowly costs one more solve.
const AIM: f64 = 0.9;

/// How far growth and prediction may be off before a round is made smaller.
const SLACK: f64 = 0.1;

/// Degrees are chosen from this one on: linear stresses tell little of where to raise it.
const FIRST_DEGREE: usize = 3;

/// Where no more than this factor is left of the gap, some more linear triangles cost less than higher degrees.
const NEAR: f64 = 4.0;

/// Least growth: a mesh with hardly more triangles than the last one costs as much and tells little more.
const WORTH_A_SOLVE: f64 = 1.1;

/// Part of the area of a triangle of the last mesh that its pieces have on the next one, at least: predictions hold no
/// farther.
const DEEPEST: f64 = 1e-6;

/// The time that a mesh takes grows like this power of its unknowns.
pub const TIME: f64 = 1.4;

/// A run ends where more than this part of the error cannot be refined away, and with more than the other part where the last
/// mesh was hardly worth its unknowns: the fields differ around such a place, too.
const MOST_OF_IT: f64 = 0.5;
const SOME_OF_IT: f64 = 0.02;

/// Coordinates that are zero when they are told, relative to the smallest area.
const NOWHERE: f64 = 1e4;

/// From a mesh that was solved to the next one.
pub struct Rounds<'a> {
    goal: &'a Goal,
    admission: &'a Admission<'a>,
    forecast: &'a Forecast,
    /// On the mesh that was solved.
    problem: &'a Problem,
    /// Size of the solution that is kept while the next mesh is solved.
    kept: Size,
    /// No triangle of less area is refined.
    smallest: f64,
    /// Seconds that are left, and those that the last mesh took.
    seconds: Option<[f64; 2]>,
}

/// How far a mesh is to go.
#[derive(Clone, Copy)]
struct Aim {
    /// Sum of the terms that is small enough.
    enough: f64,
    /// Unknowns of the mesh that was solved.
    solved: f64,
    /// Unknowns of the next one.
    most: f64,
}

/// The step after a mesh.
pub enum Next {
    /// Another mesh.
    Mesh(Box<Stage>),
    /// None, and why.
    Nothing(Stop),
}

/// Outcome of a round.
enum Round {
    /// A finer mesh, and the terms of the gap to expect on it.
    Finer(Box<Stage>, Indicators),
    /// No finer mesh: why, and the factor by which triangles must have grown for the rounds so far to be of use.
    Last(Stop, f64),
}

impl<'a> Rounds<'a> {
    /// From the mesh of `problem` with its `elements`; triangles `shortest` across, relative to the farthest corner, are not
    /// refined. Of `seconds`, where they are limited, the first are left and the second are what the last mesh took.
    pub fn new(
        goal: &'a Goal,
        admission: &'a Admission<'a>,
        forecast: &'a Forecast,
        (problem, elements): (&'a Problem, &Elements),
        shortest: f64,
        seconds: Option<[f64; 2]>,
    ) -> Self {
        let kept = Size::of_degrees(problem, elements);
        Rounds { goal, admission, forecast, problem, kept, smallest: smallest_area(problem, shortest), seconds }
    }

    /// The next mesh, or the reason why there is none. The sum of `terms` belongs to an error or a width that is `left` times as large
    /// as allowed; `stalls` says that the last mesh hardly reduced it.
    ///
    /// # Errors
    /// [`StudyError::Mesh`].
    pub fn next(&self, solved: &Solved, terms: &Indicators, left: f64, stalls: bool) -> Result<Next, StudyError> {
        let mut stage = Stage::new(self.problem.clone(), solved.refinement.clone(), solved.elements.clone());
        stage.ways.clone_from(&solved.ways);
        if let Some(reason) = self.beyond_numbers(&stage, terms, left, stalls) {
            return Ok(Next::Nothing(Stop::Scales(reason)));
        }
        let solved = unknowns(&stage);
        let in_time = self.seconds.map_or(GROWTH, |[left, last]| (left / last).powf(1.0 / TIME));
        if in_time < WORTH_A_SOLVE {
            return Ok(Next::Nothing(Stop::SecondsLeft));
        }
        if left > NEAR
            && let Some(raised) = self.with_first_degree(&stage)
            && unknowns(&raised) <= in_time * solved
        {
            return Ok(Next::Mesh(Box::new(raised)));
        }
        let growth = GROWTH.min(in_time).min(MORE * (left / (AIM * AIM)).powf(SLOWEST));
        let aim = Aim { enough: terms.total() * AIM * AIM / left, solved, most: growth * solved };
        let mut terms = terms.clone();
        loop {
            match self.round(&stage, &terms, aim)? {
                Round::Finer(next, predicted) => (stage, terms) = (*next, predicted),
                Round::Last(reason, worth) => {
                    let useful = unknowns(&stage) >= worth * solved && unknowns(&stage) > solved;
                    return Ok(if useful { Next::Mesh(Box::new(stage)) } else { Next::Nothing(reason) });
                }
            }
            let count = unknowns(&stage);
            if count >= (1.0 - SLACK) * aim.most || (count >= WORTH_A_SOLVE * solved && terms.total() <= aim.enough) {
                return Ok(Next::Mesh(Box::new(stage)));
            }
        }
    }

    /// Degrees are chosen, and these stresses are linear blocks: the same mesh with those that choosing begins with, where they may be
    /// solved.
    fn with_first_degree(&self, stage: &Stage) -> Option<Stage> {
        // But for what the loads ask for.
        let least = carrying(&stage.problem, &Elements::Uniform(block(1))).ok()?;
        let linear = (0..stage.problem.mesh.triangles.len()).all(|t| stage.elements.of(t).name() == least.of(t).name());
        if self.goal.adapt != Adapt::Hp || !linear {
            return None;
        }
        let mut raised = Stage::new(stage.problem.clone(), stage.refinement.clone(), stage.elements.clone());
        raised.elements = Elements::Uniform(block(FIRST_DEGREE));
        self.beyond(&raised).is_none().then_some(raised)
    }

    /// Why no refinement reaches what is wanted: most of the error, and more than may stay, lies in triangles that are as small
    /// as numbers can resolve, as where supports turn by a little in a corner.
    fn beyond_numbers(&self, stage: &Stage, terms: &Indicators, left: f64, stalls: bool) -> Option<String> {
        let mesh = &self.problem.mesh;
        let stays = |t: &usize| mesh.area(*t) <= self.smallest && !stage.rises(*t);
        let staying: Vec<usize> = (0..mesh.triangles.len()).filter(stays).collect();
        let share = staying.iter().map(|&t| terms.of(t)).sum::<f64>() / terms.total();
        let worst = staying.into_iter().max_by(|&a, &b| terms.of(a).total_cmp(&terms.of(b)))?;
        let corner = mesh.corners(worst)[0].map(|x| if x.abs() * x.abs() <= NOWHERE * self.smallest { 0.0 } else { x });
        let place = vector(self.problem.scene.as_written(corner), 6);
        let most = share > MOST_OF_IT && share * left > 1.0;
        let where_it_is = if most {
            "most of what is left of the error lies"
        } else {
            "the error no longer becomes smaller, and a part of it lies"
        };
        (most || stalls && share > SOME_OF_IT)
            .then(|| format!("{where_it_is} at {place}, where the triangles are as small as numbers can resolve"))
    }

    /// One round of marking. The last one is tried with smaller parts of the gap, down to a sixteenth, while it would
    /// overshoot.
    fn round(&self, stage: &Stage, terms: &Indicators, aim: Aim) -> Result<Round, StudyError> {
        let area = |t: usize| stage.problem.mesh.area(t);
        let may = |t: usize| area(t) > DEEPEST * self.problem.mesh.area(stage.parent[t]) && area(t) > self.smallest;
        let mut bulk = self.goal.bulk;
        loop {
            let marked = terms.marked(bulk, |t| stage.rises(t) || may(t));
            let (next, predicted) = self.stepped(stage, terms, &marked)?;
            let count = unknowns(&next);
            let beyond = self.beyond(&next);
            let enough_already =
                predicted.total() < (1.0 - SLACK) * aim.enough && count > (1.0 + SLACK) * WORTH_A_SOLVE * aim.solved;
            let too_far = count > (1.0 + SLACK) * aim.most || enough_already;
            bulk *= 0.5;
            if (beyond.is_some() || too_far) && bulk > self.goal.bulk / 20.0 {
                continue;
            }
            return Ok(match beyond {
                Some(reason) => Round::Last(reason, WORTH_A_SOLVE),
                None if count > unknowns(stage) => Round::Finer(Box::new(next), predicted),
                None => Round::Last(Stop::Scales("the triangles are as small as numbers can resolve".to_string()), 1.0),
            });
        }
    }

    /// With the marked triangles bisected or of higher degree, each its way, and the terms to expect.
    fn stepped(&self, stage: &Stage, terms: &Indicators, marked: &[usize]) -> Result<(Stage, Indicators), StudyError> {
        let (rising, falling): (Vec<usize>, Vec<usize>) = marked.iter().partition(|&&t| stage.rises(t));
        let (mut next, within) = stage.bisect(&falling)?;
        let (mesh, before) = (&next.problem.mesh, &stage.problem.mesh);
        let mut predicted = self.forecast.foresee(terms, (before, &stage.elements), mesh, &within);
        if !rising.is_empty() {
            let mut rises = vec![false; before.triangles.len()];
            rising.iter().for_each(|&t| rises[t] = true);
            let rising: Vec<usize> = (0..within.len()).filter(|&t| rises[within[t]]).collect();
            let raised = raised(mesh, &next.problem.facing_edges(), &next.elements, &rising);
            let left = |t: usize| EXPECTED.powi((raised.degree(t) - next.elements.degree(t)) as i32);
            predicted = (0..within.len()).map(|t| predicted.of(t) * left(t)).collect();
            next.elements = raised;
        }
        if self.goal.adapt == Adapt::Hp {
            next.ways = inherited(self.forecast, &stage.ways, before, &next.problem.mesh, &within);
        }
        Ok((next, predicted))
    }

    /// Why `next` is more than may be solved.
    fn beyond(&self, next: &Stage) -> Option<Stop> {
        let count = next.problem.mesh.triangles.len();
        match self.goal.max_triangles {
            Some(most) if count > most => Some(Stop::Triangles(most)),
            _ => self.admission.admit(next.size(), Some(self.kept)).err().map(|excess| Stop::Memory(count, excess)),
        }
    }
}

/// As many as three edges for each triangle, shared by two, have of its degree.
pub fn unknowns_of(degrees: impl Iterator<Item = usize>) -> f64 {
    degrees.map(|degree| 3 * (degree + 1)).sum::<usize>() as f64
}

fn unknowns(stage: &Stage) -> f64 {
    unknowns_of((0..stage.problem.mesh.triangles.len()).map(|t| stage.elements.degree(t)))
}

/// The area of triangles that are `shortest` across, relative to the farthest corner.
fn smallest_area(problem: &Problem, shortest: f64) -> f64 {
    (shortest * farthest(problem)).powi(2)
}

/// How far the smallest triangle is across, relative to the farthest corner.
pub fn across(problem: &Problem) -> f64 {
    let areas = (0..problem.mesh.triangles.len()).map(|t| problem.mesh.area(t));
    areas.fold(f64::INFINITY, f64::min).sqrt() / farthest(problem)
}

fn farthest(problem: &Problem) -> f64 {
    problem.mesh.points.iter().flatten().fold(0.0, |m, x| m.max(x.abs()))
}
