//! Files that meshio reads, by a script in a Python process of its own.

use std::path::Path;
use std::time::Duration;

use crate::process::{Outcome, Scratch, python, supervise};

/// Exit code of a script whose interpreter has no meshio.
const NO_MESHIO: i32 = 44;

/// Exit code where meshio itself lacks a package for this format; the last line names it.
const NO_PACKAGE: i32 = 45;

/// Exit code where a reader of this program finds that the file does not follow its format; the last line says how.
const NOT_ITS_FORMAT: i32 = 46;

/// How long meshio may read one file where nobody says otherwise.
pub const PATIENCE: Duration = Duration::from_secs(120);

/// Runs the script that its first argument names: it is longer than one argument may be.
const RUN: &str = r#"
import sys

with open(sys.argv.pop(1), encoding="utf-8") as script:
    exec(compile(script.read(), "reader", "exec"))
"#;

/// Why a file could not be read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Failure {
    /// The finding.
    pub what: String,
    /// Advice for the user.
    pub remedy: String,
}

/// Runs `script` on `file` with the first interpreter that has meshio (`HYPERCIRCLE_PYTHON`, `python3`,
/// `/usr/bin/python3`), and gives what it wrote: its arguments are `file` and the file to write. A script ends with
/// code 44 where meshio is missing, with 45 and its name where a package that meshio needs is, and with a message where it fails. `instead` is a remedy that needs no meshio.
///
/// # Errors
/// [`Failure`] when there is no such interpreter, or when the script fails or takes longer than `limit`.
pub fn run(script: &str, file: &Path, instead: &str, limit: Duration) -> Result<Vec<u8>, Failure> {
    let failure = |what: String, remedy: String| Failure { what, remedy };
    let no_folder = |e| failure(format!("no temporary folder: {e}"), "set TMPDIR to a folder with space".into());
    let folder = Scratch::new().map_err(no_folder)?;
    let place = folder.folder("run").map_err(no_folder)?;
    let target = folder.path().join("result.json");
    let reader = folder.path().join("reader.py");
    std::fs::write(&reader, script).map_err(no_folder)?;
    let file = std::path::absolute(file).map_err(no_folder)?;
    let chosen = std::env::var_os("HYPERCIRCLE_PYTHON");
    if let Some(name) = chosen.as_deref().filter(|name| python::find(Path::new(name)).is_none()) {
        let what = format!("HYPERCIRCLE_PYTHON is {}, and there is no such interpreter", Path::new(name).display());
        return Err(failure(what, "set it to an interpreter that has meshio, or unset it".into()));
    }
    let names = chosen.iter().map(Path::new).chain(["python3", "/usr/bin/python3"].map(Path::new));
    for interpreter in names.filter_map(python::find) {
        let mut command = python::command(&interpreter, RUN, &place, &[], None).map_err(no_folder)?;
        // meshio wraps its messages at the width of the terminal.
        command.arg(&reader).arg(&file).arg(&target).env("COLUMNS", "1000");
        let Ok(ended) = supervise(&mut command, limit) else { continue };
        match ended.outcome {
            Outcome::Exit(status) if status.success() => {
                return std::fs::read(&target)
                    .map_err(|e| failure(format!("meshio's result cannot be read: {e}"), instead.to_string()));
            }
            Outcome::Exit(status) if status.code() == Some(NO_MESHIO) => {}
            Outcome::Exit(status) if status.code() == Some(NO_PACKAGE) => {
                let name = ended.log.iter().map(|line| line.trim()).rfind(|l| !l.is_empty()).unwrap_or("it needs");
                let what = format!(
                    "this format is read with the Python package {name}, and {} lacks it",
                    interpreter.display()
                );
                let remedy =
                    format!("install it (pip install {name}, or apt-get install python3-{name}), or {instead}");
                return Err(failure(what, remedy));
            }
            Outcome::Exit(status) if status.code() == Some(NOT_ITS_FORMAT) => {
                return Err(failure(
                    reason(ended.log.iter().map(String::as_str)),
                    format!("check the file, or {instead}"),
                ));
            }
            Outcome::Exit(_) | Outcome::Lost(_) => {
                let end = reason(ended.log.iter().map(String::as_str));
                return Err(failure(format!("meshio cannot read it: {end}"), format!("check the file, or {instead}")));
            }
            Outcome::TimedOut => {
                let what = format!("meshio did not finish in {} s", limit.as_secs_f64());
                return Err(failure(what, format!("allow more with --reading-seconds, or {instead}")));
            }
        }
    }
    Err(failure(
        "this format is read through meshio, and no Python interpreter here has it".into(),
        format!(
            "install it (pip install meshio, or apt-get install python3-meshio), set HYPERCIRCLE_PYTHON to an \
             interpreter that has it, or {instead}"
        ),
    ))
}

/// Reason of a script that failed: its last line, and before it the one that meshio printed as an error or just before one,
/// which has the reason where the other only says that reading failed.
fn reason<'a>(log: impl Iterator<Item = &'a str>) -> String {
    let lines: Vec<&str> = log.map(str::trim).filter(|line| !line.is_empty()).collect();
    let Some((last, before)) = lines.split_last() else { return "no message".to_string() };
    let printed = match last.strip_prefix("Error:") {
        Some(_) => before.last().copied(),
        None => before.iter().rev().find_map(|line| line.strip_prefix("Error:")),
    };
    match printed.map(|text| text.trim().trim_end_matches('.')) {
        Some(text) if !last.contains(text) => format!("{text} ({last})"),
        _ => (*last).to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reason_that_was_printed_before_the_last_line_is_kept() {
        let log = ["Error: Element type not available: CPE3", "", "Couldn't read file x.inp as abaqus"];
        assert_eq!(reason(log.into_iter()), "Element type not available: CPE3 (Couldn't read file x.inp as abaqus)");
        assert_eq!(reason(["Error: no cells", "no cells"].into_iter()), "no cells");
        assert_eq!(reason([].into_iter()), "no message");
    }
}
