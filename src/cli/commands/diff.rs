//! `hypercircle diff`: two reports beside each other.

use std::io::Write;
use std::path::{Path, PathBuf};

use crate::cli::words::say;
use crate::cli::{CliError, Exit};
use crate::diff::{compare, page, text};
use crate::report::Stored;
use crate::report::folder::replace_file;

/// Options of `diff`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The first report: its folder, or report.json
    #[arg(value_name = "A")]
    pub first: PathBuf,
    /// The second report
    #[arg(value_name = "B")]
    pub second: PathBuf,
    /// Write a page with the two beside each other to FILE
    #[arg(long, value_name = "FILE")]
    pub html: Option<PathBuf>,
}

/// True if nothing is lost with a file: it is not there, empty, or a page.
fn is_replaceable(path: &Path) -> bool {
    std::fs::read(path).map_or(true, |bytes| bytes.is_empty() || bytes.starts_with(b"<!DOCTYPE html"))
}

/// Compares, and ends with code 1 if the outcome of a check differs or the reports contradict each other.
///
/// # Errors
/// There is no report, its files are of several runs, or the page cannot be written.
pub fn run(args: &Args) -> Result<Exit, CliError> {
    if let Some(file) = args.html.as_ref().filter(|file| !is_replaceable(file)) {
        let message = format!("{}: the file is there and is no page, and --html would replace it", file.display());
        return Err(CliError::stopped(Exit::BadInput, message, "give the path of another file"));
    }
    let read = |path: &Path| {
        Stored::read(path).map_err(|e| {
            CliError::stopped(Exit::BadInput, e.to_string(), "give the folder of a report, or its report.json")
        })
    };
    let found = compare(read(&args.first)?, read(&args.second)?);
    let names = [&args.first, &args.second].map(|path| path.display().to_string());
    let names = [names[0].as_str(), names[1].as_str()];
    if let Some(file) = &args.html {
        replace_file(file, page(&found, names).into_bytes()).map_err(|e| CliError::unwritable(file, &e))?;
    }
    // A reader such as `head` may have had enough.
    let _ = text(&found, names).lines().try_for_each(|line| writeln!(std::io::stdout(), "{}", say::shown(line)));
    Ok(if found.is_decisive() { Exit::Disagree } else { Exit::Agree })
}
