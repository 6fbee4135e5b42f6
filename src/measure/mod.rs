//! One method on one problem, in a process of its own: what it answered, how long it took, how much memory it had.
//!
//! [`measure`] is what happens inside that process, [`run`] starts it and reads what it prints. A crash, a hang or a
//! memory peak then belongs to exactly one run.

mod child;
mod clock;
mod machine;
mod memory;
mod method;
mod primal;
mod record;
mod settings;
mod solve;

pub use child::{Ended, Limits, run};
pub use clock::Clock;
pub use machine::Machine;
pub use method::Method;
pub use record::{Answer, Asked, End, Measured, Seconds, finite_or_null};
pub use settings::Settings;
pub use solve::measure;

/// Progress of the measurements, for whoever waits.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Step {
    /// Its name.
    pub what: String,
    /// Runs that have ended, those kept from before left out.
    pub done: usize,
    /// Runs that are still to be made.
    pub left: usize,
}
