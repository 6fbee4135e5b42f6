//! One run from a problem to a report: statics, dual solve, bracket, displacement models, verdict.

mod baseline;
mod certified;
mod dossier;
mod primal;
mod provenance;

pub use baseline::{Baseline, BaselineError};
pub use certified::{Certified, StudyError, certify};
pub use dossier::{Fields, Findings, assemble, infeasible};
pub use primal::{candidates, pins};
pub use provenance::provenance;
