//! One run from a problem to a report: statics, dual solve, bracket, displacement models, verdict.

mod accepted;
mod adaptive;
mod admission;
mod answers;
mod baseline;
mod certified;
mod claim;
mod curves;
mod date;
mod dossier;
mod field;
mod forecast;
mod indicators;
mod maps;
mod outlook;
mod patch;
mod primal;
mod provenance;
mod rounds;
mod sharpen;
mod stage;
mod trend;
#[cfg(test)]
mod trend_tests;
mod verdict;
mod warm_start;

pub use accepted::{Accepted, Signature, checks as baseline_checks};
pub use adaptive::{Adapt, Adapted, Goal, Wanted, adapt, tolerance_check};
pub use admission::Admission;
pub use answers::{
    Answer, GivenValue, Meant, answers, quantity_checks, refuse_quantities, summaries, value_checks, wanted_checks,
};
pub use baseline::{Baseline, BaselineError};
pub use certified::{Certified, StudyError, certify};
pub use claim::{Claim, claim, diagnoses, error_check, weak_contact};
pub use curves::remarks as curve_remarks;
pub use date::today;
pub use dossier::{Findings, assemble, infeasible};
pub use field::{FieldArrays, FieldError, ForeignField};
pub use indicators::Indicators;
pub use maps::Fields;
pub use outlook::outlook;
pub use primal::{candidates, pins};
pub use provenance::provenance;
pub(crate) use provenance::{hash, hex, identifier, locked_version};
pub use sharpen::{Sharpened, sharpen};
pub use stage::certify_divided;
pub use warm_start::{closed_coefficients, guess_refined};
