//! The methods by their names.

use crate::dual::{ActiveSet, Clarabel, Condensed, DualMethod, Uzawa};

/// How the dual problem is solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, clap::ValueEnum)]
pub enum Solver {
    /// One sparse factorisation, contact solved on its Schur complement
    Condensed,
    /// Interior point
    Clarabel,
    /// Uzawa's iteration on the multipliers
    Uzawa,
    /// Primal–dual active set, refactorising at each step
    ActiveSet,
}

impl std::fmt::Display for Solver {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Solver::Condensed => "condensed",
            Solver::Clarabel => "clarabel",
            Solver::Uzawa => "uzawa",
            Solver::ActiveSet => "active-set",
        })
    }
}

impl Solver {
    /// The method, as it is where nothing more is said.
    pub fn method(self) -> Box<dyn DualMethod> {
        match self {
            Solver::Condensed => Box::new(Condensed::default()),
            Solver::ActiveSet => Box::new(ActiveSet::default()),
            Solver::Clarabel => Box::new(Clarabel::default()),
            Solver::Uzawa => Box::new(Uzawa::default()),
        }
    }
}
