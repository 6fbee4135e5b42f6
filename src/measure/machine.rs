//! Where the seconds were measured.

use serde::{Deserialize, Serialize};

/// The machine and the build.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Machine {
    /// Version of the program.
    pub version: String,
    /// True if the compiler optimised for speed; seconds of other builds say little.
    pub optimised: bool,
    /// Name of the processor, where the system tells.
    pub processor: Option<String>,
    /// Processors that may be used.
    pub processors: usize,
}

impl Machine {
    /// This one.
    pub fn here() -> Self {
        let processor = std::fs::read_to_string("/proc/cpuinfo").ok().and_then(|text| {
            let line = text.lines().find(|line| line.starts_with("model name"))?;
            Some(line.split_once(':')?.1.trim().to_string())
        });
        Machine {
            version: env!("CARGO_PKG_VERSION").to_string(),
            optimised: !cfg!(debug_assertions),
            processor,
            processors: std::thread::available_parallelism().map_or(1, usize::from),
        }
    }
}
