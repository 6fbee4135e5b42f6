//! One run from a problem to a report: statics, dual solve, bracket, displacement models, verdict.

mod adaptive;
mod baseline;
mod certified;
mod dossier;
mod field;
mod indicators;
mod primal;
mod provenance;
mod warm_start;

pub use adaptive::{Adapted, Goal, adapt, tolerance_check};
pub use baseline::{Baseline, BaselineError};
pub use certified::{Certified, StudyError, certify};
pub use dossier::{Fields, Findings, assemble, infeasible};
pub use field::{FieldError, ForeignField};
pub use indicators::Indicators;
pub use primal::{candidates, pins};
pub use provenance::provenance;
pub(crate) use provenance::{hash, hex};
pub use warm_start::closed_ends;
