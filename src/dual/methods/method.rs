//! The seam between the dual problem and the methods that solve it.

use std::io;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use faer::Par;

use crate::budget::Budget;
use crate::dual::{Divided, Factorised, Motion, Phases, Size};
use crate::element::{Block, Elements, SideValues, StressField};
use crate::problem::{ContactPair, Problem};

/// A way to find λ_h. All of them solve the same strictly convex problem and must agree.
///
/// ```
/// # use hypercircle_core as hypercircle;
/// use std::path::Path;
///
/// use hypercircle::bounds::complementary;
/// use hypercircle::dual::{ActiveSet, Condensed, DualMethod, Options, solve};
/// use hypercircle::problem::Problem;
/// use hypercircle::scene::Scene;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # std::env::set_current_dir("..")?;
/// let problem = Problem::load(Scene::read(Path::new("cases/two_blocks.toml"))?)?;
/// let methods: [&dyn DualMethod; 2] = [&Condensed::default(), &ActiveSet::default()];
/// let [a, b] = methods.map(|method| solve(method, &problem, &[], &Options::default()));
/// let [a, b] = [a?, b?].map(|found| complementary(&problem, &found.stress).lower());
/// assert!((a - b).abs() < 1e-12);
/// # Ok(())
/// # }
/// ```
pub trait DualMethod: Sync {
    /// Name on the command line and in reports.
    fn name(&self) -> &'static str;

    /// The equilibrium residual that the method promises, relative to the load.
    fn accuracy(&self) -> f64 {
        1e-9
    }

    /// True if each contact state on the way costs a linear solve, so that a first guess from a coarser mesh pays.
    fn wants_guess(&self) -> bool {
        false
    }

    /// True if the processes that find the solution can make the upper bound, too.
    fn divides(&self) -> bool {
        false
    }

    /// Bytes that this process holds at the peak of a run on a mesh of that size, its bracket included.
    fn memory(&self, size: Size) -> f64;

    /// Solves `problem`; `motions` are the rigid motions that neither supports nor closed contacts resist, on which the
    /// loads are known to do no work.
    ///
    /// # Errors
    /// [`DualError`] where the method did not arrive; a stop on the way is never a solution.
    fn solve(&self, problem: &Problem, motions: &[Motion], options: &Options) -> Result<Found, DualError>;
}

/// Refuses springs, elastic layers and friction to a method that has no words for them.
///
/// # Errors
/// [`DualError::NotExpressible`].
pub(in crate::dual) fn contact_alone(problem: &Problem, method: &'static str) -> Result<(), DualError> {
    let with = |has: fn(&ContactPair) -> bool| problem.interfaces.iter().find(|contact| contact.pairs.iter().any(has));
    let (elastic, rubbing) = (with(|pair| pair.stiffness.is_some()), with(|pair| pair.friction.is_some()));
    let what = match (problem.beds.first(), elastic, rubbing) {
        (Some(bed), ..) if bed.is_layer() => format!("the elastic layer {}", bed.name),
        (Some(bed), ..) => format!("the springs on {}", bed.name),
        (None, Some(contact), _) => format!("the stiffness of contact {}", contact.name),
        (None, None, Some(contact)) => format!("the friction of contact {}", contact.name),
        (None, None, None) => return Ok(()),
    };
    let remedy = "use --method condensed or active-set, without --engine";
    Err(DualError::NotExpressible { method, what, remedy })
}

/// The result of a method before it is measured.
#[derive(Debug, Clone)]
pub struct Found {
    /// λ_h.
    pub stress: StressField,
    /// Edge moments, as in [`crate::dual::DualSolution::moments`].
    pub moments: SideValues<[f64; 2]>,
    /// Closed coefficients of contact, as in [`crate::dual::DualSolution::closed`].
    pub closed: SideValues<bool>,
    /// Number of unknowns.
    pub unknowns: usize,
    /// Steps of the contact iteration; of a linear solver that iterates, its iterations.
    pub iterations: usize,
    /// Seconds by phase; `read` and `total` are the caller's.
    pub seconds: Phases,
    /// Notes for the reader of a report.
    pub notes: Vec<String>,
    /// K and its factor for further loads, where [`Options::keep_factor`] asks for it and the method has one.
    pub factorised: Option<Arc<Factorised>>,
    /// Who found which part, where the method [`DualMethod::divides`].
    pub divided: Option<Arc<Divided>>,
}

/// Choices of a dual solve.
#[derive(Clone)]
pub struct Options {
    /// The element of each triangle.
    pub elements: Elements,
    /// Threads. Results are bit-identical with any number of them up to factors of a hundred million numbers, and beyond with one.
    pub threads: usize,
    /// First guess of the closed coefficients, from a similar problem.
    pub closed: Option<SideValues<bool>>,
    /// True if the factor is to be kept with the solution.
    pub keep_factor: bool,
    /// Memory that the process may hold.
    pub budget: Budget,
    /// When what takes many factorisations gives up.
    pub deadline: Option<Instant>,
    /// Told now and then how many iterations an iterative method has made and what residual it has reached.
    pub progress: Option<Progress>,
}

/// Receives iterations made and relative residual reached.
pub type Progress = Arc<dyn Fn(usize, f64) + Send + Sync>;

/// Refuses bodies of revolution, of which a method knows nothing.
///
/// # Errors
/// [`DualError::NotExpressible`].
pub(in crate::dual) fn plane_only(problem: &Problem, method: &'static str) -> Result<(), DualError> {
    if !problem.section().is_revolved() {
        return Ok(());
    }
    let remedy = "leave --method and --engine out, or use --method active-set";
    Err(DualError::NotExpressible { method, what: "bodies of revolution".to_string(), remedy })
}

impl Default for Options {
    fn default() -> Self {
        Options {
            elements: Elements::Uniform(&Block),
            threads: 1,
            closed: None,
            keep_factor: false,
            budget: Budget::UNLIMITED,
            deadline: None,
            progress: None,
        }
    }
}

/// Numbers in a factor from which sharing its kernels among threads gains more than it costs.
const SHARED_FROM: usize = 100_000_000;

impl Options {
    /// Parallelism of the kernels that work on a factor of so many numbers.
    pub fn par(&self, numbers: usize) -> Par {
        if self.threads > 1 && numbers >= SHARED_FROM { Par::rayon(self.threads) } else { Par::Seq }
    }

    /// Does `work` on as many threads as these options have: those that are there where they are as many, else its own.
    pub fn on_threads<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        let threads = self.threads.max(1);
        if rayon::current_num_threads() == threads {
            return work();
        }
        match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
            Ok(pool) => pool.install(work),
            // Where no thread can be started the work is the same on those that are there.
            Err(_) => work(),
        }
    }
}

/// Why there is no dual solution.
#[derive(Debug, thiserror::Error)]
pub enum DualError {
    /// The sparse factorisation broke down.
    #[error(
        "the stiffness matrix could not be factorised ({reason}): the supports may not hold the bodies, or triangles are \
         degenerate"
    )]
    Factorisation {
        /// The report of the factorisation.
        reason: String,
    },
    /// The memory is not there, or may not be taken.
    #[error("{reason}")]
    TooLarge {
        /// The part that does not fit, with both figures.
        reason: String,
    },
    /// The method has no words for something in the problem.
    #[error("{method} cannot express {what}; {remedy}")]
    NotExpressible {
        /// Name of the method.
        method: &'static str,
        /// The part of the problem that the method cannot state, and where it is.
        what: String,
        /// Advice for the user.
        remedy: &'static str,
    },
    /// The contact state is not determined by the energy.
    #[error("the contact state could not be determined: the open part of the contact leaves a body without hold")]
    ContactUndetermined,
    /// An iteration did not arrive.
    #[error(
        "{method} stopped after {iterations} iterations with a residual of {residual:.2e} where {wanted:.2e} was asked: \
         {advice}"
    )]
    NotConverged {
        /// Name of the method.
        method: &'static str,
        /// Iterations made.
        iterations: usize,
        /// Residual reached.
        residual: f64,
        /// Residual asked.
        wanted: f64,
        /// Advice for the user.
        advice: String,
    },
    /// Programs that the method starts are missing.
    #[error(
        "the parallel solver is not installed: {0}; install openmpi-bin, python3-petsc4py and python3-scipy, or name an \
         interpreter that has petsc4py in HYPERCIRCLE_PYTHON"
    )]
    NotInstalled(String),
    /// Programs that the method started did not bring a solution.
    #[error("the parallel solver failed ({reason}); the end of its log:\n{log}")]
    Process {
        /// How it ended.
        reason: String,
        /// The last lines it printed.
        log: String,
    },
    /// Files that are exchanged with such programs cannot be written or read.
    #[error("cannot use {path}: {source}; check that the folder exists, is writable and has room")]
    Exchange {
        /// The file or folder.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// No stress balances the loads with contact tractions that only press.
    #[error(
        "no stress balances the loads: a motion that supports and contacts allow gains the work {work:.6e} for a largest \
         edge displacement of one; add a support or change the loads"
    )]
    Infeasible {
        /// The motion, as moments ∫ u B_k ds of every edge, scaled so that the largest mean displacement of an edge is one.
        certificate: SideValues<[f64; 2]>,
        /// Work of the loads on it, positive.
        work: f64,
    },
}

impl DualError {
    /// [`DualError::Infeasible`] from moments of any size and the work of the loads on them.
    pub(in crate::dual) fn infeasible(problem: &Problem, mut certificate: SideValues<[f64; 2]>, work: f64) -> Self {
        let mut largest = 0.0_f64;
        for (e, moments) in certificate.iter().enumerate() {
            let [x, y] = moments.iter().fold([0.0; 2], |sum, m| [sum[0] + m[0], sum[1] + m[1]]);
            largest = largest.max(x.hypot(y) / problem.mesh.edge_frame(e).0);
        }
        if largest > 0.0 {
            certificate.values_mut().as_flattened_mut().iter_mut().for_each(|m| *m /= largest);
            return DualError::Infeasible { certificate, work: work / largest };
        }
        DualError::Infeasible { certificate, work }
    }
}
