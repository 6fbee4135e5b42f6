//! Settings of a run.

use crate::budget::Budget;
use crate::primal::SolverCommand;
use crate::study::{Adapt, Goal, Wanted};

/// Choices of a run that are not the problem's.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Threads.
    pub threads: usize,
    /// Largest guaranteed relative error of an adaptive run.
    pub tolerance: Option<f64>,
    /// Triangles beyond which an adaptive run stops.
    pub max_triangles: Option<usize>,
    /// Seconds that a process started from here may take.
    pub seconds: f64,
    /// Memory that the process may hold.
    pub budget: Budget,
    /// Names of the quantities of the scene that are asked for; an adaptive run has its tolerance for these then.
    pub quantities: Vec<String>,
    /// Step length of the paper's plain iteration, relative to the largest that converges.
    pub step_length: Option<f64>,
    /// A displacement solver to run in the place of FEniCSx.
    pub program: Option<SolverCommand>,
}

impl Settings {
    /// Goal of an adaptive run that refines as `adapt` says.
    pub(super) fn goal(&self, adapt: Adapt) -> Goal {
        let tolerance = self.tolerance.unwrap_or(f64::MIN_POSITIVE);
        let wanted = self.quantities.iter().map(|name| Wanted { name: name.clone(), tolerance });
        let of_energy = if self.quantities.is_empty() { tolerance } else { f64::INFINITY };
        Goal { max_triangles: self.max_triangles, wanted: wanted.collect(), adapt, ..Goal::new(of_energy) }
    }
}
