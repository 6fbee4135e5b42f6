//! Processes: how this program starts others, how they end, and what goes with it when it ends itself.
//!
//! A process started here has a group of its own, a limit of time, pipes that are drained into the end of a log, and does
//! not outlive this one. Python is started so that no file in the current folder is taken for a module ([`python`]), and
//! with packages that this program carries ([`package`]).
//! Temporary folders ([`Scratch`]) go with the process: on its way out, on a signal ([`signals`]), and after a signal that
//! leaves no time by the next run ([`clear`]).

pub mod child;
mod interrupt;
pub mod package;
pub mod python;
mod scratch;
pub mod signals;
mod tail;
pub mod words;

use std::time::Duration;

pub use child::{Ended, Outcome, supervise, supervise_unless};
pub use interrupt::{Interrupted, interruptible, stop_if_unwanted};
pub use scratch::{Scratch, clear};
pub use tail::Tail;

/// A time in seconds as a limit; one that no clock reaches is as good as none.
pub fn limit(seconds: f64) -> Duration {
    Duration::try_from_secs_f64(seconds.max(0.0)).unwrap_or(Duration::MAX)
}

/// Asks the system to end this process when the one that started it is gone, where the system can.
pub fn end_with_parent() {
    let _ = rustix::process::set_parent_process_death_signal(Some(rustix::process::Signal::KILL));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_number_is_a_limit() {
        assert_eq!(limit(1.5), Duration::from_millis(1500));
        assert_eq!(limit(1e300), Duration::MAX);
        assert_eq!((limit(-1.0), limit(f64::NAN)), (Duration::ZERO, Duration::ZERO));
    }
}
