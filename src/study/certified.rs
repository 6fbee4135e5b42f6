//! The dual side of a run: from a problem to a bracket.

use std::time::Instant;

use super::admission::Admission;
use crate::bounds::{Bracket, NoUpperBound, NodalValues, supports_agree, without_stress};
use crate::dual::{self, DualError, DualMethod, DualSolution, Motion, Options, Size};
use crate::element::Elements;
use crate::problem::{Problem, ProblemError};
use crate::statics::{self, Solvability, Statics, StaticsError};

/// A problem with its dual solution and bracket.
#[derive(Debug, Clone)]
pub struct Certified {
    /// Scene and mesh.
    pub problem: Problem,
    /// What rigid motions are held.
    pub statics: Statics,
    /// λ_h.
    pub dual: DualSolution,
    /// The two bounds that follow from it.
    pub bracket: Bracket,
}

/// Why there is no bracket.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// Whether there is an equilibrium could not be decided.
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
        /// What would have to be expressed.
        sentence: String,
        /// The part of an edge that pressure of the degrees in use can be confined to.
        part: String,
    },
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

/// Checks the statics of `problem`, solves the dual problem, and brackets the energy.
///
/// # Errors
/// [`StudyError`].
pub fn certify(problem: Problem, method: &dyn DualMethod, options: &Options) -> Result<Certified, StudyError> {
    let size = Size::of_degrees(&problem, &options.elements);
    if let Err(excess) = Admission::new(method, options.budget).admit(size, None) {
        let reason = format!("a solve on {} triangles does not fit: about {excess}", problem.mesh.triangles.len());
        return Err(DualError::TooLarge { reason }.into());
    }
    let statics = balance(&problem, &options.elements)?;
    solve_balanced(problem, statics, method, options, None)
}

/// The statics of a problem that has an equilibrium, on this mesh with these elements or on a finer one.
///
/// # Errors
/// [`StudyError::Contradiction`], [`StudyError::NoEquilibrium`], or the question could not be decided.
pub(super) fn balance(problem: &Problem, elements: &Elements) -> Result<Statics, StudyError> {
    supports_agree(problem)?;
    let statics = statics::check_with_degrees(problem, &|t| elements.degree(t))?;
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

/// Solves a problem with an equilibrium and brackets its energy; the upper bound may begin from `start`.
///
/// # Errors
/// [`StudyError::BeyondMesh`], [`StudyError::Dual`].
pub(super) fn solve_balanced(
    problem: Problem,
    statics: Statics,
    method: &dyn DualMethod,
    options: &Options,
    start: Option<NodalValues>,
) -> Result<Certified, StudyError> {
    let began = Instant::now();
    if let Solvability::Possible { beyond_mesh: Some(_), .. } = &statics.equilibrium {
        let part = match options.elements.largest_degree() {
            1 => "third".to_string(),
            2 => "quarter".to_string(),
            p => format!("1/{}", p + 2),
        };
        return Err(StudyError::BeyondMesh { sentence: statics.notes.join(" "), part });
    }
    let motions = statics.held_at_vertices(&problem);
    let (mut dual, bracket) = options.on_threads(|| {
        let dual = without_stress(&problem, dual::solve(method, &problem, &motions, options)?);
        let bracket = Bracket::from_start(&problem, &dual, start, options.keep_factor);
        Ok::<_, DualError>((dual, bracket))
    })?;
    dual.seconds.total = began.elapsed().as_secs_f64();
    Ok(Certified { problem, statics, dual, bracket })
}
