//! `hypercircle part`: the part of a bracket that one of several ranks makes. Not for people.

use std::path::PathBuf;

use crate::bounds::make_part;
use crate::cli::{CliError, Exit};
use crate::process::end_with_parent;

/// Options of `part`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The file of the part
    pub part: PathBuf,
    /// The file for the result
    pub found: PathBuf,
}

/// Makes the part on one thread: there are as many ranks as are to work.
///
/// # Errors
/// The files cannot be used.
pub fn run(args: &Args) -> Result<Exit, CliError> {
    end_with_parent();
    let make = || make_part(&args.part, &args.found);
    let made = match rayon::ThreadPoolBuilder::new().num_threads(1).build() {
        Ok(pool) => pool.install(make),
        Err(_) => make(),
    };
    made.map(|()| Exit::Agree).map_err(|error| {
        let what = format!("{}: {error}", args.part.display());
        CliError::stopped(Exit::Failed, what, "start the run again")
    })
}
