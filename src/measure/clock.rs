//! Time since the process was started, by the one who started it.

use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

/// A clock that began when the process was asked for, before the first instruction of the program.
#[derive(Debug, Clone, Copy)]
pub struct Clock {
    entered: Instant,
    startup: Duration,
}

impl Clock {
    /// A clock for a process that another one asked for at `spawned` nanoseconds after 1970, if it said so.
    pub fn since(spawned: Option<u128>) -> Self {
        let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        let startup = spawned.map_or(0, |then| now.as_nanos().saturating_sub(then));
        Clock { entered: Instant::now(), startup: Duration::from_nanos(u64::try_from(startup).unwrap_or(0)) }
    }

    /// Nanoseconds since 1970, as [`Clock::since`] takes them.
    pub fn stamp() -> u128 {
        SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_nanos()
    }

    /// Seconds until the program was entered.
    pub fn startup(&self) -> f64 {
        self.startup.as_secs_f64()
    }

    /// Seconds since the process was asked for.
    pub fn elapsed(&self) -> f64 {
        self.startup() + self.entered.elapsed().as_secs_f64()
    }
}
