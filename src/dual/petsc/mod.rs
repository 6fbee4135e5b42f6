//! The hybrid form on PETSc, over MPI ranks.
//!
//! This program computes the matrices of the elements and writes them down ([`blocks`], [`exchange`]). The Python package
//! `hypercircle_dual`, started by `mpirun`, distributes the triangles, assembles K as one matrix over all ranks, finds the
//! contact state and refines on the stresses, rank by rank. What it hands back are mode parameters: the stresses are made
//! of them here, and held against equilibrium here, by code that knows nothing of PETSc. So no guarantee rests on it.

mod blocks;
mod exchange;
mod nodal;

use std::env;
use std::ffi::OsString;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::equilibrium::Equilibrium;
use super::methods::method::{contact_alone, plane_only};
use super::modes::ModeTable;
use super::system::unknowns::Unknowns;
use super::{DualError, DualMethod, Found, Motion, Options, Phases, Size};
use crate::element::SideValues;
use crate::problem::Problem;
use crate::process::Scratch;
use crate::process::package::{Call, Failure, Package};

/// The Python package.
const PACKAGE: Package = Package {
    name: "hypercircle_dual",
    files: &[
        ("__init__.py", include_str!("../../../reference/hypercircle_dual/__init__.py")),
        ("__main__.py", include_str!("../../../reference/hypercircle_dual/__main__.py")),
        ("bracket.py", include_str!("../../../reference/hypercircle_dual/bracket.py")),
        ("compat.py", include_str!("../../../reference/hypercircle_dual/compat.py")),
        ("contact.py", include_str!("../../../reference/hypercircle_dual/contact.py")),
        ("distribution.py", include_str!("../../../reference/hypercircle_dual/distribution.py")),
        ("exchange.py", include_str!("../../../reference/hypercircle_dual/exchange.py")),
        ("model.py", include_str!("../../../reference/hypercircle_dual/model.py")),
        ("refinement.py", include_str!("../../../reference/hypercircle_dual/refinement.py")),
        ("run.py", include_str!("../../../reference/hypercircle_dual/run.py")),
        ("solvers.py", include_str!("../../../reference/hypercircle_dual/solvers.py")),
    ],
};

/// Bytes that this process holds for each triangle: element matrices and stresses, then the bracket.
const EACH: f64 = 9500.0;
/// Likewise where ranks make the upper bound.
const EACH_DIVIDED: f64 = 5000.0;

/// How PETSc solves with K.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, clap::ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum LinearSolver {
    /// Sparse Cholesky factorisation over all ranks
    #[default]
    Mumps,
    /// Conjugate gradients with algebraic multigrid
    Gamg,
    /// Conjugate gradients with domain decomposition, a subdomain for each rank: also where materials are nearly incompressible
    Bddc,
}

impl LinearSolver {
    /// True if it is an iteration, and not a factorisation.
    fn iterates(self) -> bool {
        self != LinearSolver::Mumps
    }
}

/// The hybrid form on PETSc.
#[derive(Debug, Clone, PartialEq)]
pub struct Petsc {
    /// MPI ranks.
    pub ranks: usize,
    /// How K is solved with.
    pub linear_solver: LinearSolver,
    /// The ranks are ended when they take longer.
    pub limit: Duration,
    /// The Python interpreter; `None` asks `HYPERCIRCLE_PYTHON`, then takes `/usr/bin/python3`.
    pub interpreter: Option<PathBuf>,
    /// The executable of this program, which more than one rank start for their parts of the upper bound; `None` has it computed in
    /// this process.
    pub program: Option<PathBuf>,
}

/// Who found which part of a solution.
#[derive(Debug, Clone, PartialEq)]
pub struct Divided {
    /// The rank of each triangle.
    pub owner: Vec<usize>,
    /// How the ranks are started.
    pub petsc: Petsc,
}

impl DualMethod for Petsc {
    fn name(&self) -> &'static str {
        match self.linear_solver {
            LinearSolver::Mumps => "petsc",
            LinearSolver::Gamg => "petsc-gamg",
            LinearSolver::Bddc => "petsc-bddc",
        }
    }

    fn wants_guess(&self) -> bool {
        self.linear_solver.iterates()
    }

    fn divides(&self) -> bool {
        self.ranks > 1 && self.program.is_some()
    }

    fn memory(&self, size: Size) -> f64 {
        size.linear(if self.divides() { EACH_DIVIDED } else { EACH })
    }

    fn solve(&self, problem: &Problem, motions: &[Motion], options: &Options) -> Result<Found, DualError> {
        plane_only(problem, self.name())?;
        let start = Instant::now();
        contact_alone(problem, self.name())?;
        let modes = ModeTable::new(problem, options.elements.clone());
        let unknowns = Unknowns::new(problem, modes.elements());
        let scratch = Scratch::new().map_err(|source| DualError::Exchange { path: env::temp_dir(), source })?;
        let failed = |source: io::Error| DualError::Exchange { path: scratch.path().to_owned(), source };
        let folder = scratch.folder("dual").map_err(failed)?;
        let guess = options.closed.as_ref().map(SideValues::values);
        exchange::write(&folder, problem, &unknowns, &modes, motions, guess, (self.ranks, self.linear_solver))
            .map_err(failed)?;
        let written = start.elapsed().as_secs_f64();

        self.run(vec![folder.join(exchange::PROBLEM_FILE).into()])?;

        let start = Instant::now();
        let jumps = unknowns.count - unknowns.first_jump;
        let mut found = exchange::read(&folder, unknowns.count, jumps, modes.parameters()).map_err(failed)?;
        if self.divides() {
            found.owner =
                Some(exchange::read_owner(&folder, problem.mesh.triangles.len(), self.ranks).map_err(failed)?);
        }
        let stress = modes.stresses(problem, &found.parameters);
        let moments = unknowns.moments(&found.unknowns);
        let residual = Equilibrium::measure(problem, &stress, &moments).residual();
        let answer = &found.answer;
        if !residual.is_finite() || residual > self.accuracy() {
            return Err(DualError::NotConverged {
                method: self.name(),
                iterations: answer.steps + answer.iterations,
                residual,
                wanted: self.accuracy(),
                advice: if self.linear_solver.iterates() {
                    "use --linear-solver mumps, or leave --engine out".to_string()
                } else {
                    "leave --engine out".to_string()
                },
            });
        }
        let seconds = Phases {
            assemble: written + answer.seconds.assemble,
            factor: answer.seconds.factor,
            contact: answer.seconds.contact,
            recover: answer.seconds.refine + start.elapsed().as_secs_f64(),
            ..Phases::default()
        };
        Ok(Found {
            stress,
            moments,
            closed: unknowns.by_pair(found.closed),
            unknowns: unknowns.count,
            iterations: if self.linear_solver.iterates() { answer.iterations } else { answer.steps },
            seconds,
            notes: vec![self.note(answer)],
            factorised: None,
            divided: found.owner.take().map(|owner| Arc::new(Divided { owner, petsc: self.clone() })),
        })
    }
}

impl Petsc {
    fn run(&self, arguments: Vec<OsString>) -> Result<(), DualError> {
        let call =
            Call { interpreter: self.interpreter.as_deref(), ranks: Some(self.ranks), arguments, limit: self.limit };
        PACKAGE.run(&call).map_err(|failure| self.explain(failure))
    }

    /// Has each rank make its part of an upper bound, from a file `part-…` of `folder` to a file `found-…`.
    ///
    /// # Errors
    /// [`DualError`].
    pub fn run_brackets(&self, folder: &Path) -> Result<(), DualError> {
        let program = self.program.iter().flat_map(|program| ["--bracket".into(), program.clone().into()]);
        self.run(std::iter::once(folder.into()).chain(program).collect())
    }

    /// How the stresses were found.
    fn note(&self, answer: &exchange::Answer) -> String {
        let megabytes = answer.memory.iter().copied().max().unwrap_or(0) / 1_000_000;
        let (ranks, release, steps) = (answer.ranks, &answer.petsc, answer.steps);
        let ranks = if ranks == 1 { "1 rank".to_string() } else { format!("{ranks} ranks") };
        let iterated = |with: &str| {
            let (first, all) = (answer.first_iterations, answer.iterations);
            format!("solved by conjugate gradients with {with}, {first} iterations in the first solve, {all} in all")
        };
        let how = match self.linear_solver {
            LinearSolver::Mumps => "factorised by MUMPS".to_string(),
            LinearSolver::Gamg => iterated("GAMG"),
            LinearSolver::Bddc => iterated("BDDC"),
        };
        format!(
            "The stresses were found by PETSc {release} on {ranks}, {how}; contact states tried: {steps}; largest memory of \
             a rank {megabytes} MB."
        )
    }

    fn explain(&self, failure: Failure) -> DualError {
        match failure {
            Failure::NotInstalled(reason) => DualError::NotInstalled(reason),
            Failure::Failed { status, log } => DualError::Process { reason: status, log },
            Failure::TimedOut { log } => {
                DualError::Process { reason: format!("stopped after {} s", self.limit.as_secs_f64()), log }
            }
            Failure::Io { path, source } => DualError::Exchange { path, source },
        }
    }
}
