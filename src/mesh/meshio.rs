//! Files that meshio reads, by a script in a Python process of its own.

use std::io::Read;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Exit code of a script whose interpreter has no meshio.
const NO_MESHIO: i32 = 44;
const PATIENCE: Duration = Duration::from_secs(120);

/// Why a file could not be read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Failure {
    /// What was found.
    pub what: String,
    /// What to do.
    pub remedy: String,
}

/// Runs `script` on `file` with the first interpreter that has meshio (`HYPERCIRCLE_PYTHON`, `python3`,
/// `/usr/bin/python3`), and gives what it wrote: its arguments are `file` and the file to write. A script ends with
/// code 44 where meshio is missing, and with a message where it fails. `instead` is a remedy that needs no meshio.
///
/// # Errors
/// [`Failure`] when there is no such interpreter, or when the script fails or takes too long.
pub(crate) fn run(script: &str, file: &Path, instead: &str) -> Result<Vec<u8>, Failure> {
    let failure = |what: String, remedy: String| Failure { what, remedy };
    let no_folder = |e| failure(format!("no temporary folder: {e}"), "set TMPDIR to a folder with space".into());
    let folder = tempfile::tempdir().map_err(no_folder)?;
    let target = folder.path().join("result.json");
    let chosen = std::env::var("HYPERCIRCLE_PYTHON").ok();
    for python in chosen.iter().map(String::as_str).chain(["python3", "/usr/bin/python3"]) {
        let mut command = Command::new(python);
        // meshio wraps its messages at the width of the terminal.
        command.args(["-c", script]).arg(file).arg(&target).env("COLUMNS", "1000");
        let Ok(child) = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped()).spawn() else {
            continue;
        };
        match finish(child, PATIENCE) {
            Finished::Code(Some(0), _) => {
                return std::fs::read(&target)
                    .map_err(|e| failure(format!("meshio's result cannot be read: {e}"), instead.to_string()));
            }
            Finished::Code(Some(NO_MESHIO), _) => {}
            Finished::Code(_, log) => {
                let end = log.lines().map(str::trim).rfind(|line| !line.is_empty()).unwrap_or("no message");
                return Err(failure(format!("meshio cannot read it: {end}"), format!("check the file, or {instead}")));
            }
            Finished::TimeOut => {
                let what = format!("meshio did not finish in {} s", PATIENCE.as_secs());
                return Err(failure(what, instead.to_string()));
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

enum Finished {
    Code(Option<i32>, String),
    TimeOut,
}

/// Waits for the process, at most for `patience`; what it writes to its error stream is read meanwhile.
fn finish(mut child: Child, patience: Duration) -> Finished {
    let stream = child.stderr.take();
    let reader = std::thread::spawn(move || {
        let mut log = Vec::new();
        // What cannot be read is missing from a message, no more.
        let _ = stream.map(|mut s| s.read_to_end(&mut log));
        String::from_utf8_lossy(&log).into_owned()
    });
    let start = Instant::now();
    loop {
        match child.try_wait() {
            Ok(Some(status)) => return Finished::Code(status.code(), reader.join().unwrap_or_default()),
            Ok(None) if start.elapsed() < patience => std::thread::sleep(Duration::from_millis(10)),
            _ => {
                let _ = child.kill();
                let _ = child.wait();
                return Finished::TimeOut;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_process_that_hangs_is_ended() {
        let child = Command::new("sleep").arg("60").stderr(Stdio::piped()).spawn().expect("sleep exists");
        let start = Instant::now();
        assert!(matches!(finish(child, Duration::from_millis(50)), Finished::TimeOut));
        assert!(start.elapsed() < Duration::from_secs(10));
    }
}
