//! `hypercircle schema`: the file formats for editors and other programs.

use std::io::{ErrorKind, Write};

use clap::ValueEnum;

use crate::cli::{CliError, Exit};
use crate::job;
use crate::report;
use crate::scene;
use crate::workbench;

/// Options of `schema`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Which file
    #[arg(value_enum)]
    pub file: File,
}

/// A file format of the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum File {
    /// scene.toml
    Scene,
    /// report.json
    Report,
    /// job.json
    Job,
    /// report.json of `element`
    Element,
}

/// Prints the JSON Schema on stdout.
///
/// # Errors
/// stdout cannot be written.
pub fn run(args: &Args) -> Result<Exit, CliError> {
    let schema = match args.file {
        File::Scene => scene::schema(),
        File::Report => report::schema(),
        File::Job => job::schema(),
        File::Element => workbench::schema(),
    };
    match writeln!(std::io::stdout(), "{schema:#}") {
        // A reader such as `head` may have had enough.
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(CliError::stopped(Exit::Failed, format!("the schema cannot be written ({error})"), ""))
        }
        _ => Ok(Exit::Agree),
    }
}
