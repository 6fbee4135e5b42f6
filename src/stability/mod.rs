//! Where methods can be trusted: regimes known to break contact solvers, each swept until methods break.
//!
//! A [`Regime`] is a family of problems with one parameter and what is known about their answers without solving them:
//! an exact solution, statics, a scaling relation, or else a bracket on a finer mesh. [`sweep`] runs every method on every
//! value in a process of its own, [`judge`] holds what came back against what is known. [`Matrix::defects`] and
//! [`Matrix::shortfalls`] are what must be empty.

mod curve;
mod data;
mod journal;
mod judge;
mod known;
mod markdown;
mod matrix;
mod page;
mod regimes;
mod scenes;
mod store;
mod strips;
mod truth;

pub use curve::curve;
pub use data::{Cell, Matrix, Outcome, PROMISING, Row, Step};
pub use journal::Journal;
pub use judge::{Claim, judge};
pub use known::Known;
pub use markdown::markdown;
pub use matrix::{Sweep, SweepError, sweep};
pub use page::page;
pub use regimes::{REGIMES, Regime, regime};
pub use store::write;
pub use truth::Truth;
