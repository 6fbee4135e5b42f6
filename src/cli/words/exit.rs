//! Meaning of the process's exit code.

use std::process::ExitCode;

/// How a command ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum Exit {
    /// Every check passed, or there was nothing to check.
    Agree = 0,
    /// A check failed or could not be made.
    Disagree = 1,
    /// The command line, a scene, a mesh or a field is at fault.
    BadInput = 2,
    /// A solver or the reference failed.
    Failed = 3,
    /// The reference is not installed.
    NotInstalled = 4,
    /// The scene has no equilibrium.
    NoEquilibrium = 5,
}

impl Exit {
    /// The one with that code; a code that is none means a failure.
    pub fn of(code: u8) -> Self {
        match code {
            0 => Exit::Agree,
            1 => Exit::Disagree,
            2 => Exit::BadInput,
            4 => Exit::NotInstalled,
            5 => Exit::NoEquilibrium,
            _ => Exit::Failed,
        }
    }
}

/// The table for the help text.
pub const TABLE: &str = "Exit codes: 0 agree, 1 disagree, 2 bad input, 3 a solver or the reference failed, \
                         4 the reference is not installed, 5 no equilibrium exists";

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        ExitCode::from(exit as u8)
    }
}
