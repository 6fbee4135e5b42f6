//! The dual side of a run: from a problem to a bracket.

use std::time::Instant;

use super::adaptive::admission::Admission;
use crate::bounds::on_ranks;
use crate::bounds::{Bracket, Groundwork, NoUpperBound, NodalValues, supports_agree, without_stress};
use crate::dual::{self, DualError, DualMethod, DualSolution, Motion, Options, Size};
use crate::element::Elements;
use crate::problem::{Note, Problem, ProblemError};
use crate::statics::{self, Solvability, Statics, StaticsError};

/// A problem with its dual solution and bracket.
#[derive(Debug, Clone)]
pub struct Certified {
    /// Scene and mesh.
    pub problem: Problem,
    /// The rigid motions that are held.
    pub statics: Statics,
    /// λ_h.
    pub dual: DualSolution,
    /// The two bounds that follow from it.
    pub bracket: Bracket,
}

/// Why there is no bracket.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// It could not be decided whether there is an equilibrium.
    #[error(transparent)]
    Statics(#[from] StaticsError),
    /// There is none.
    #[error("{sentence}")]
    NoEquilibrium {
        /// Which bodies move, and how.
        sentence: String,
        /// The motion, as a displacement of every vertex.
        motion: Motion,
        /// The work of the loads on it.
        work: f64,
        /// The problem it belongs to.
        problem: Box<Problem>,
    },
    /// There is one, but no stress field of this mesh can express it.
    #[error(
        "no equilibrated stress exists on this mesh: {sentence} The loads press on less than the last {part} of an edge; \
         refine the mesh at the end of the contact"
    )]
    BeyondMesh {
        /// The pressures that would have to be expressed, in words.
        sentence: String,
        /// The part of an edge that pressure of the degrees in use can be confined to.
        part: String,
    },
    /// No bound of friction was found that goes with the pressure that it leads to.
    #[error("{0}")]
    Coulomb(String),
    /// Supports and contacts contradict each other.
    #[error("{0}; prescribe displacements that fit together there, or leave out one of the conditions")]
    Contradiction(#[from] NoUpperBound),
    /// The dual solver failed.
    #[error(transparent)]
    Dual(#[from] DualError),
    /// A refined mesh does not fit the scene.
    #[error(transparent)]
    Mesh(#[from] ProblemError),
}

/// Checks the statics of `problem`, solves the dual problem, and brackets the energy. Contacts with Coulomb friction have the bounds that
/// the problem holds, none at first; [`super::solve_coulomb`] finds those that go with their pressures.
///
/// # Errors
/// [`StudyError`].
pub fn certify(problem: Problem, method: &dyn DualMethod, options: &Options) -> Result<Certified, StudyError> {
    let (problem, options) = carrying_loads(problem, options)?;
    admit(&problem, method, &options)?;
    let statics = Balanced::new(&problem, &options.elements, None)?;
    solve_balanced(problem, statics, method, &options, None)
}

/// The options with the degrees that the loads of `problem` ask for, and the problem with a note where these are not the given ones.
///
/// # Errors
/// [`DualError::NotExpressible`].
pub(super) fn carrying_loads(mut problem: Problem, options: &Options) -> Result<(Problem, Options), DualError> {
    let elements = dual::carrying(&problem, &options.elements)?;
    let mesh = &problem.mesh;
    let short = |b: usize| {
        let mut own = (0..mesh.triangles.len()).filter(|&t| mesh.body[t] == b);
        own.any(|t| options.elements.degree(t) < problem.least_degree(t))
    };
    let bodies = (0..problem.scene.bodies.len()).filter(|&b| short(b));
    let names: Vec<&str> = bodies.map(|b| problem.scene.bodies[b].name.as_str()).collect();
    if !names.is_empty() {
        let why = match problem.section().is_revolved() {
            true => {
                "Times the distance from the axis the loads on {} are no linear functions, or its contact turns on the axis"
            }
            false => "The body force of {} is not the same everywhere",
        };
        let text = format!(
            "{}: stresses that balance it exactly have degree 2 at least, and have it there.",
            why.replace("{}", &names.join(", "))
        );
        problem.notes.push(Note { weakens_guarantee: false, text });
    }
    Ok((problem, Options { elements, ..options.clone() }))
}

/// Refuses a solve for which there is no memory.
pub(super) fn admit(problem: &Problem, method: &dyn DualMethod, options: &Options) -> Result<(), StudyError> {
    let size = Size::of_degrees(problem, &options.elements);
    let admitted = Admission::new(method, options.budget).admit(size, None);
    admitted.map_err(|excess| {
        let reason = format!("a solve on {} triangles does not fit: about {excess}", problem.mesh.triangles.len());
        DualError::TooLarge { reason }.into()
    })
}

/// The statics of a problem that has an equilibrium, and the seconds that they took.
pub(super) struct Balanced {
    pub statics: Statics,
    pub seconds: f64,
}

impl Balanced {
    /// The statics of `problem`; `coarser` are those on a coarser mesh.
    ///
    /// # Errors
    /// As [`balance`].
    pub fn new(problem: &Problem, elements: &Elements, coarser: Option<&Statics>) -> Result<Self, StudyError> {
        let began = Instant::now();
        let statics = balance(problem, elements, coarser)?;
        Ok(Balanced { statics, seconds: began.elapsed().as_secs_f64() })
    }
}

/// The statics of a problem that has an equilibrium, on this mesh with these elements or on a finer one; `coarser` are those
/// of a coarser mesh.
///
/// # Errors
/// [`StudyError::Contradiction`], [`StudyError::NoEquilibrium`], or the question could not be decided.
pub(super) fn balance(
    problem: &Problem,
    elements: &Elements,
    coarser: Option<&Statics>,
) -> Result<Statics, StudyError> {
    supports_agree(problem)?;
    let statics = statics::check_after(problem, &|t| elements.degree(t), coarser)?;
    match &statics.equilibrium {
        Solvability::Impossible { motion, work, sentence, .. } => Err(StudyError::NoEquilibrium {
            sentence: sentence.clone(),
            motion: motion.at_vertices(problem, &statics.components),
            work: *work,
            problem: Box::new(problem.clone()),
        }),
        Solvability::Possible { .. } => Ok(statics),
    }
}

/// Room for several times what a solve is estimated to take: nothing that it is refused for may depend on the threads.
const AMPLE: f64 = 3.0;

/// True if another thread can prepare the mesh data of the upper bound beside the solve, and there is memory for both.
fn may_prepare_beside(problem: &Problem, method: &dyn DualMethod, options: &Options) -> bool {
    let size = Size::of_degrees(problem, &options.elements);
    let both = AMPLE * method.memory(size) + size.bracket();
    rayon::current_num_threads() > 1 && options.budget.admit_more(both).is_ok()
}

/// Refuses a mesh that cannot express the pressures that balance the loads.
fn expressible(statics: &Statics, options: &Options) -> Result<(), StudyError> {
    if !statics.is_beyond_mesh() {
        return Ok(());
    }
    let part = match options.elements.largest_degree() {
        1 => "third".to_string(),
        2 => "quarter".to_string(),
        p => format!("1/{}", p + 2),
    };
    Err(StudyError::BeyondMesh { sentence: statics.notes.join(" "), part })
}

/// The stresses of `problem` alone, without a bracket.
///
/// # Errors
/// [`StudyError`].
pub(super) fn stresses(
    problem: &Problem,
    method: &dyn DualMethod,
    options: &Options,
) -> Result<DualSolution, StudyError> {
    let Balanced { statics, .. } = Balanced::new(problem, &options.elements, None)?;
    expressible(&statics, options)?;
    let motions = statics.null_motions(problem);
    let dual = options.on_threads(|| dual::solve(method, problem, &motions, options))?;
    Ok(without_stress(problem, dual))
}

/// Solves a problem with an equilibrium and brackets its energy; the upper bound may begin from `start`.
///
/// # Errors
/// [`StudyError::BeyondMesh`], [`StudyError::Dual`].
pub(super) fn solve_balanced(
    problem: Problem,
    Balanced { statics, seconds }: Balanced,
    method: &dyn DualMethod,
    options: &Options,
    start: Option<NodalValues>,
) -> Result<Certified, StudyError> {
    let began = Instant::now();
    expressible(&statics, options)?;
    let motions = statics.null_motions(&problem);
    // Ranks keep nothing for quantities, and begin with nothing.
    let divides = method.divides() && !options.keep_factor && start.is_none();
    let (mut dual, bracket) = options.on_threads(|| {
        let solve = || dual::solve(method, &problem, &motions, options);
        let (dual, ground) = if !divides && may_prepare_beside(&problem, method, options) {
            let degrees = dual::edge_degrees(&problem, &options.elements).into_iter().map(usize::from);
            let (dual, ground) = rayon::join(solve, || Groundwork::factorised(&problem, degrees));
            (dual?, Some(ground))
        } else {
            (solve()?, None)
        };
        let mut dual = without_stress(&problem, dual);
        let bracketing = Instant::now();
        let divided = dual.divided.take().filter(|_| divides);
        let bracket = match (divided, ground) {
            (Some(divided), _) => {
                let ranks = divided.petsc.ranks;
                dual.notes.push(format!("The displacement of the upper bound was made on {ranks} ranks."));
                on_ranks(&problem, &dual, &divided)?
            }
            (None, Some(ground)) => Bracket::on(ground, &problem, &dual, start, options.keep_factor),
            (None, None) => Bracket::from_start(&problem, &dual, start, options.keep_factor),
        };
        dual.seconds.bounds = bracketing.elapsed().as_secs_f64();
        Ok::<_, DualError>((dual, bracket))
    })?;
    dual.seconds.statics = seconds;
    dual.seconds.total = seconds + began.elapsed().as_secs_f64();
    Ok(Certified { problem, statics, dual, bracket })
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::budget::Budget;
    use crate::dual::Condensed;
    use crate::scene::Scene;

    /// Reasons to refuse a run must not depend on its threads, so nothing is made beside the solve where memory is short.
    #[test]
    fn nothing_is_made_beside_a_solve_without_another_thread_and_ample_memory() {
        let scene = Scene::read(Path::new("cases/two_blocks.toml")).expect("a scene");
        let problem = Problem::load(scene).expect("a problem");
        let beside = |threads, budget| {
            let options = Options { threads, budget, ..Options::default() };
            options.on_threads(|| may_prepare_beside(&problem, &Condensed::default(), &options))
        };
        assert!(beside(2, Budget::UNLIMITED));
        assert!(!beside(1, Budget::UNLIMITED));
        let size = Size::of_degrees(&problem, &Elements::Uniform(&crate::element::Block));
        let enough = Condensed::default().memory(size);
        assert!(!beside(2, Budget::of(enough as u64)));
    }
}
