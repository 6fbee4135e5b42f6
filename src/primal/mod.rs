//! The displacement model: FEniCSx or a solver of the user's, run as a process on the same triangles.
//!
//! It minimises 𝓛(v) = ½∫ c e(v):e(v) − ∫F·v − ∫P·v over continuous displacements of degree k. Contact is imposed on the
//! Bernstein coefficients of the normal jump, so that v_n' + v_n'' ≤ g holds between the nodes too and 𝓛(u_h) bounds
//! 𝓛(u) from above.
//!
//! [`run`] writes the exchange file ([`exchange`]), starts the interpreter that has FEniCSx ([`process`]) with the
//! Python package this program carries inside it, or the command that was given ([`SolverCommand`]), and reads the results. The
//! files are described in `docs/exchange.md`.

mod cells;
mod command;
pub mod exchange;
#[cfg(test)]
pub(crate) mod fixture;
pub mod process;

use std::io;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};

pub use self::cells::{Cells, Space, WantedCells, remark, spaces};
pub use self::command::SolverCommand;
use crate::problem::{Pin, Problem};

/// The highest degree of a displacement solution.
pub const HIGHEST_DEGREE: u8 = crate::element::displacement::MOST as u8;

/// The displacement models to solve, and the settings of the run.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Polynomial degrees, each from 1 to [`HIGHEST_DEGREE`], each solved once. A program that is not told them solves its own.
    pub degrees: Vec<u8>,
    /// Cells they are solved on; a program chooses for itself.
    pub cells: WantedCells,
    /// A solver to run in the place of FEniCSx; ranks, planted bugs, nodal contact and the interpreter are not for it.
    pub program: Option<SolverCommand>,
    /// The process is ended when it takes longer.
    pub timeout: Duration,
    /// A bug to plant on purpose.
    pub sabotage: Option<Sabotage>,
    /// Number of MPI ranks; `None` runs without `mpirun`.
    pub ranks: Option<usize>,
    /// Impose contact at the nodes only. The result is then no upper bound, and says so.
    pub nodal_contact: bool,
    /// Folder for the exchange files, kept afterwards; `None` uses a temporary one.
    pub scratch: Option<PathBuf>,
    /// The Python interpreter; `None` asks `HYPERCIRCLE_PYTHON`, then takes `/usr/bin/python3`.
    pub interpreter: Option<PathBuf>,
}

impl Default for Options {
    fn default() -> Self {
        Options {
            degrees: vec![1, 2],
            cells: WantedCells::Triangles,
            program: None,
            timeout: Duration::from_secs(1800),
            sabotage: None,
            ranks: None,
            nodal_contact: false,
            scratch: None,
            interpreter: None,
        }
    }
}

/// A bug in the displacement model, planted to see whether the comparison notices.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sabotage {
    /// 1 + 2ν in place of 1 − 2ν in Lamé's λ (1 + ν² in place of 1 − ν² in plane stress). Without effect for ν = 0.
    FlipSign,
    /// The closed contact row with the largest reaction is left unbounded.
    DropRow,
}

/// Why there is no displacement solution.
#[derive(Debug, thiserror::Error)]
pub enum PrimalError {
    /// The interpreter, `mpirun` or a Python package is missing.
    #[error(
        "the FEniCSx reference is not installed: {0}; install python3-dolfinx, or name an interpreter that has it in HYPERCIRCLE_PYTHON"
    )]
    NotInstalled(String),
    /// The solver of the user's is not there.
    #[error(
        "the displacement solver {0} is not found; give the path of the program, or the name of one in a folder of PATH"
    )]
    NotFound(String),
    /// The process ended without result files.
    #[error("{of} failed ({status}); the end of its log:\n{log}")]
    Failed {
        /// Whose process.
        of: String,
        /// How the process ended.
        status: String,
        /// The last lines it printed.
        log: String,
    },
    /// The solver of the user's says, by exit code 3, that it has no answer.
    #[error("{of} failed (exit code 3); the end of its log:\n{log}")]
    NoAnswer {
        /// Whose process.
        of: String,
        /// The last lines it printed.
        log: String,
    },
    /// The process did not end in time and was stopped.
    #[error("{of} was stopped after {} s; the end of its log:\n{log}", limit.as_secs_f64())]
    TimedOut {
        /// Whose process.
        of: String,
        /// The time allowed.
        limit: Duration,
        /// The last lines it printed.
        log: String,
    },
    /// The solver of the user's ended well, and left no result.
    #[error(
        "{of} wrote no primal-P1.json, primal-P2.json, … into the folder that stands for {{out}}; docs/exchange.md says what they \
         hold; the end of its log:\n{log}"
    )]
    NoResult {
        /// Whose process.
        of: String,
        /// The last lines it printed.
        log: String,
    },
    /// A result file that contradicts its format or the problem.
    #[error("{file} of the displacement solver is not usable: {reason}; docs/exchange.md says what it has to hold")]
    BadResult {
        /// Name of the file.
        file: String,
        /// Its defect.
        reason: String,
    },
    /// Options that cannot be run.
    #[error(
        "the FEniCSx reference solves degrees from 1 to {HIGHEST_DEGREE}, on one rank or more; found degrees {degrees:?}, ranks {ranks:?}"
    )]
    BadOptions {
        /// Degrees asked for.
        degrees: Vec<u8>,
        /// Ranks asked for.
        ranks: Option<usize>,
    },
    /// The exchange folder cannot be used.
    #[error("cannot use {path}: {source}; check that the folder exists and is writable")]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
}

/// The displacement solution of one degree. Energies and forces include the thickness.
///
/// Fields that a solver may omit from its file are then empty, zero or `None`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PrimalSolution {
    /// `FEniCSx`, or what the solver calls itself.
    #[serde(default)]
    pub solver: String,
    /// Release of DOLFINx, or of the solver.
    #[serde(default)]
    pub solver_version: String,
    /// Release of PETSc's Python interface.
    #[serde(default)]
    pub petsc_version: String,
    /// Polynomial degree k.
    pub degree: u8,
    /// The cells that it is a displacement on.
    #[serde(default)]
    pub cells: Cells,
    /// Points of the Gauss rule in each direction of a quadrilateral; `None` on triangles.
    #[serde(default)]
    pub gauss_points: Option<usize>,
    /// Number of MPI ranks.
    #[serde(default)]
    pub ranks: usize,
    /// 𝓛(u_h).
    #[serde(default)]
    pub energy: Option<f64>,
    /// ½∫ c e(u_h):e(u_h).
    #[serde(default)]
    pub strain_energy: Option<f64>,
    /// Σ ∫ τ̄ B_i · |d_i| of the coefficients of tangential jumps, a part of `energy`; `None` where nothing rubs or the solver does not
    /// tell.
    #[serde(default)]
    pub friction_work: Option<f64>,
    /// Estimated error of `energy` from rounding and the residual; `None` where the solver does not tell.
    #[serde(default)]
    pub energy_rounding: Option<f64>,
    /// Sets of closed contacts that were tried; 1 for a problem without contact, `None` where the solver does not tell.
    #[serde(default)]
    pub iterations: Option<usize>,
    /// The solver's reason for stopping; positive.
    #[serde(default)]
    pub converged_reason: i32,
    /// Unknowns left after supports are eliminated; `None` where the solver does not tell.
    #[serde(default)]
    pub unknowns: Option<usize>,
    /// True if the model imposes v_n' + v_n'' ≤ g everywhere and not at the nodes only.
    #[serde(default)]
    pub admissible: Option<bool>,
    /// Wall-clock time by phase.
    #[serde(default)]
    pub seconds: PrimalSeconds,
    /// u_h at each vertex of the mesh.
    pub vertex_displacement: Vec<[f64; 2]>,
    /// u_h at the k − 1 points inside each edge of the mesh, at equal steps from its first vertex to its second; `None` for
    /// degree 1. On quadrilaterals that of a diagonal is the one in the middle of its cell.
    #[serde(default)]
    pub edge_displacement: Option<Vec<[f64; 2]>>,
    /// u_h at the (k − 1)(k − 2)/2 points inside each triangle, as [`crate::element::PlainDisplacement`] has them; `None` below
    /// degree 3.
    #[serde(default)]
    pub triangle_displacement: Option<Vec<[f64; 2]>>,
    /// Reactions, contact by contact in scene order.
    #[serde(default)]
    pub contacts: Option<Vec<PrimalContact>>,
    /// Coulomb friction by the model itself; `None` without, or where the solver does not have it.
    #[serde(default)]
    pub coulomb: Option<PrimalCoulomb>,
}

/// Coulomb friction of a displacement model, with limits from its own reactions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PrimalCoulomb {
    /// Solutions on the way.
    pub iterations: usize,
    /// True if the limits agree with the reactions.
    pub converged: bool,
    /// By what part of their sum the limits still changed; `None` where nothing was solved.
    pub change: Option<f64>,
    /// 𝓛 with these limits; `None` where it is not known.
    pub energy: Option<f64>,
    /// Contact forces, in scene order.
    pub contacts: Vec<PrimalCoulombContact>,
}

/// Forces of a contact with Coulomb friction in the model itself.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PrimalCoulombContact {
    /// Name of the interface.
    pub name: String,
    /// The sum of its reactions.
    pub pressure: f64,
    /// The sum of its forces of friction, positive along the arc length of the first side.
    pub friction: f64,
}

/// Seconds spent in each phase. Imports and the compilation of forms stand apart from the work itself.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct PrimalSeconds {
    /// Loading Python packages.
    pub import: f64,
    /// Reading and distributing the mesh.
    pub mesh: f64,
    /// Assembly, and the change of variables for the contact.
    pub assemble: f64,
    /// Compiling the forms, or finding them compiled.
    pub compile: f64,
    /// Solving.
    pub solve: f64,
    /// All of it.
    pub total: f64,
}

/// Reactions of one contact, consistent with the discrete equilibrium.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PrimalContact {
    /// Name of the interface.
    pub name: String,
    /// Vertices of the first side along the contact.
    pub vertices: Vec<usize>,
    /// R ≥ 0 at each of `vertices`, conjugate to the jump there. Zero where supports alone decide the jump.
    pub vertex_reaction: Vec<f64>,
    /// R ≥ 0 of each pair, conjugate to the inner Bernstein coefficients of its jump (to the values at the nodes with
    /// [`Options::nodal_contact`]): k − 1, or k where the direction of contact turns; `None` for degree 1.
    pub edge_reaction: Option<Vec<Vec<f64>>>,
    /// Force of friction on the first side along t̂ at each of `vertices`, conjugate to the tangential jump there; `None` without friction.
    #[serde(default)]
    pub vertex_friction: Option<Vec<f64>>,
    /// Force of friction of each pair, conjugate to the k − 1 inner Bernstein coefficients of its tangential jump; `None` for degree 1.
    #[serde(default)]
    pub edge_friction: Option<Vec<Vec<f64>>>,
    /// Force on the first side.
    pub resultant: [f64; 2],
}

/// Solve `problem` in displacements, once for each of [`Options::degrees`], in their order; a program that is not told the
/// degrees gives those it has, the lowest first.
///
/// # Errors
/// Everything that keeps the results from being complete is a [`PrimalError`]; the call ends at the latest a few
/// seconds after [`Options::timeout`].
pub fn run(problem: &Problem, pins: &[Pin], options: &Options) -> Result<Vec<PrimalSolution>, PrimalError> {
    let problem = &*problem.softened();
    let degrees_fit = options.degrees.iter().all(|d| (1..=HIGHEST_DEGREE).contains(d)) && !options.degrees.is_empty();
    if !degrees_fit || options.ranks == Some(0) {
        return Err(PrimalError::BadOptions { degrees: options.degrees.clone(), ranks: options.ranks });
    }
    let temporary;
    let folder = match &options.scratch {
        Some(folder) => folder.as_path(),
        None => {
            let place = std::env::temp_dir();
            temporary = crate::process::Scratch::new().map_err(|source| PrimalError::Io { path: place, source })?;
            temporary.path()
        }
    };
    exchange::write_problem(problem, pins, folder)?;
    let Some(program) = &options.program else {
        let spaces = spaces(&problem.mesh, options.cells, &options.degrees);
        process::run(folder, options, &spaces)?;
        return spaces.iter().map(|&space| exchange::read_solution(folder, space, problem)).collect();
    };
    let started = Instant::now();
    let spaces = program.run(folder, &options.degrees, options.timeout)?;
    let share = started.elapsed().as_secs_f64() / spaces.len() as f64;
    let named = |space: &Space| {
        let mut solution = exchange::read_solution(folder, *space, problem)?;
        if solution.solver.is_empty() {
            solution.solver = program.name();
        }
        if solution.seconds.total == 0.0 {
            (solution.seconds.solve, solution.seconds.total) = (share, share);
        }
        Ok(solution)
    };
    spaces.iter().map(named).collect()
}
