//! One run from a problem to a report: statics, dual solve, bracket, displacement models, verdict.

mod accepted;
mod adaptive;
mod adjoint;
mod answers;
mod certified;
mod claim;
mod curves;
mod dossier;
mod field;
mod primal;
mod quantity_checks;
mod ranges;
mod slopes;

pub use accepted::baseline::{Baseline, BaselineError};
pub use accepted::date::today;
pub use accepted::{Accepted, Signature, checks as baseline_checks};
pub use adaptive::admission::Admission;
pub use adaptive::indicators::Indicators;
pub use adaptive::outlook::outlook;
pub use adaptive::sharpen::{Sharpened, sharpen};
pub use adaptive::stage::certify_divided;
pub use adaptive::warm_start::{closed_coefficients, guess_refined};
pub use adaptive::{Adapt, Adapted, Goal, Wanted, adapt, tolerance_check};
pub use adjoint::{Adjoint, adjoint};
pub use answers::{Answer, answers, refuse_quantities, sharper};
pub use certified::{Certified, StudyError, certify};
pub use claim::{Claim, claim, claim_before_contact, diagnoses, error_check, weak_contact};
pub use curves::remarks as curve_remarks;
pub use dossier::maps::Fields;
pub use dossier::provenance::provenance;
pub(crate) use dossier::provenance::{hash, hex, identifier, locked_version};
pub use dossier::{Findings, assemble, infeasible};
pub use field::{FieldArrays, FieldError, ForeignField};
pub use primal::{candidates, pins};
pub use quantity_checks::{GivenValue, Meant, quantity_checks, summaries, value_checks, wanted_checks};
pub use ranges::OtherEnd;
