//! Runs the Python package in a process under supervision.

use std::env;
use std::ffi::OsString;
use std::fs;
use std::io;
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus};

use super::exchange::PROBLEM_FILE;
use super::{Options, PrimalError, Sabotage};
use crate::process::{Ended, Outcome, Scratch, python, supervise};

/// The Python package, carried along so that program and reference always belong together.
const PACKAGE: [(&str, &str); 10] = [
    ("__init__.py", include_str!("../../reference/hypercircle_reference/__init__.py")),
    ("__main__.py", include_str!("../../reference/hypercircle_reference/__main__.py")),
    ("compat.py", include_str!("../../reference/hypercircle_reference/compat.py")),
    ("constraints.py", include_str!("../../reference/hypercircle_reference/constraints.py")),
    ("descent.py", include_str!("../../reference/hypercircle_reference/descent.py")),
    ("exchange.py", include_str!("../../reference/hypercircle_reference/exchange.py")),
    ("group.py", include_str!("../../reference/hypercircle_reference/group.py")),
    ("model.py", include_str!("../../reference/hypercircle_reference/model.py")),
    ("run.py", include_str!("../../reference/hypercircle_reference/run.py")),
    ("solve.py", include_str!("../../reference/hypercircle_reference/solve.py")),
];

/// Runs the package as `python3 -m` does.
const START: &str = "import runpy\nrunpy.run_module('hypercircle_reference', run_name='__main__', alter_sys=True)\n";

const NOT_INSTALLED_CODE: i32 = 4;
const NOT_INSTALLED_TEXT: &str = "hypercircle-reference: not installed:";

/// Solve the problem in `folder`, which then holds one result file per degree.
///
/// `HYPERCIRCLE_REFERENCE` may name a folder with another copy of the package `hypercircle_reference`.
pub fn run(folder: &Path, options: &Options) -> Result<(), PrimalError> {
    let in_folder = |source| PrimalError::Io { path: folder.to_owned(), source };
    let folder = std::path::absolute(folder).map_err(in_folder)?;
    let scratch = Scratch::new().map_err(|source| PrimalError::Io { path: env::temp_dir(), source })?;
    let in_scratch = |source| PrimalError::Io { path: scratch.path().to_owned(), source };
    let package = match env::var_os("HYPERCIRCLE_REFERENCE") {
        Some(given) => {
            let given = PathBuf::from(given);
            std::path::absolute(&given).map_err(|source| PrimalError::Io { path: given, source })?
        }
        None => unpack(&scratch).map_err(in_scratch)?,
    };
    if !package.join("hypercircle_reference/__main__.py").is_file() {
        let reason = format!("{} (from HYPERCIRCLE_REFERENCE) holds no hypercircle_reference", package.display());
        return Err(PrimalError::NotInstalled(reason));
    }
    let place = scratch.folder("run").map_err(in_scratch)?;
    let mut command = command(&folder, &package, &place, options)?;
    let program = command.get_program().to_owned();
    let ended = supervise(&mut command, options.timeout).map_err(|error| match error.kind() {
        io::ErrorKind::NotFound => PrimalError::NotInstalled(format!("{} does not exist", program.display())),
        _ => PrimalError::Failed { status: format!("{} did not start", program.display()), log: error.to_string() },
    })?;
    judge(ended, options)
}

/// Puts the package into a folder of `scratch`, which is the result.
fn unpack(scratch: &Scratch) -> io::Result<PathBuf> {
    let root = scratch.folder("package")?;
    let package = root.join("hypercircle_reference");
    fs::create_dir(&package)?;
    for (name, text) in PACKAGE {
        fs::write(package.join(name), text)?;
    }
    Ok(root)
}

fn interpreter(options: &Options) -> Result<PathBuf, PrimalError> {
    let found = options
        .interpreter
        .clone()
        .or_else(|| env::var_os("HYPERCIRCLE_PYTHON").map(PathBuf::from))
        .unwrap_or_else(|| PathBuf::from("/usr/bin/python3"));
    python::find(&found).ok_or_else(|| PrimalError::NotInstalled(format!("{} does not exist", found.display())))
}

fn command(folder: &Path, package: &Path, place: &Path, options: &Options) -> Result<Command, PrimalError> {
    let launcher: Vec<OsString> = match options.ranks {
        None => Vec::new(),
        Some(ranks) => {
            let missing = || PrimalError::NotInstalled("mpirun does not exist".to_owned());
            let mpirun = python::find(Path::new("mpirun")).ok_or_else(missing)?;
            let count = ranks.to_string();
            let arguments = ["--allow-run-as-root", "--oversubscribe", "-n", &count].map(OsString::from);
            std::iter::once(mpirun.into_os_string()).chain(arguments).collect()
        }
    };
    let mut command = python::command(&interpreter(options)?, START, place, &launcher, Some(package))
        .map_err(|source| PrimalError::Io { path: place.to_owned(), source })?;
    command.arg(folder.join(PROBLEM_FILE)).arg("--out").arg(folder).env("OMP_NUM_THREADS", "1");
    for degree in &options.degrees {
        command.args(["--degree", &degree.to_string()]);
    }
    match options.sabotage {
        Some(Sabotage::FlipSign) => command.args(["--sabotage", "flip-sign"]),
        Some(Sabotage::DropRow) => command.args(["--sabotage", "drop-row"]),
        None => &mut command,
    };
    if options.nodal_contact {
        command.arg("--nodal-contact");
    }
    Ok(command)
}

/// What the end of the process means.
fn judge(ended: Ended, options: &Options) -> Result<(), PrimalError> {
    let text = if ended.log.is_empty() { "(nothing was printed)".to_owned() } else { ended.log.join("\n") };
    match ended.outcome {
        Outcome::TimedOut => Err(PrimalError::TimedOut { limit: options.timeout, log: text }),
        Outcome::Lost(error) => Err(PrimalError::Failed { status: format!("lost: {error}"), log: text }),
        Outcome::Exit(status) if status.success() => Ok(()),
        Outcome::Exit(status) if status.code() == Some(NOT_INSTALLED_CODE) => {
            let reason = ended.log.iter().find_map(|line| line.strip_prefix(NOT_INSTALLED_TEXT)).map(str::trim);
            Err(PrimalError::NotInstalled(reason.map_or(text, str::to_owned)))
        }
        Outcome::Exit(status) => Err(PrimalError::Failed { status: words(status), log: text }),
    }
}

fn words(status: ExitStatus) -> String {
    match (status.code(), status.signal()) {
        (Some(code), _) => format!("exit code {code}"),
        (None, Some(signal)) => format!("ended by signal {signal}"),
        (None, None) => "ended abnormally".to_owned(),
    }
}

#[cfg(test)]
#[path = "process_tests.rs"]
mod tests;
