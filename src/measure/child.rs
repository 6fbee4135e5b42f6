//! Starts this program once more for one run, and waits no longer than allowed.

use std::ffi::OsString;
use std::io::Read;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};

use super::clock::Clock;
use super::record::Measured;
use crate::process::Tail;

/// Limits of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits<'a> {
    /// The process is ended after this time.
    pub budget: Duration,
    /// A folder for compiled forms; an empty one makes FEniCSx compile.
    pub cache: Option<&'a Path>,
}

/// How a process ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Ended {
    /// It printed its results.
    Told(Vec<Measured>),
    /// It ended without results; the text is the end of what it printed.
    Crashed(String),
    /// It was ended.
    OverBudget,
}

const POLL: Duration = Duration::from_millis(2);
/// Pipes that grandchildren keep open are not waited for longer than this.
const DRAINED: Duration = Duration::from_secs(3);
/// Bytes beyond which what it prints is no list of results.
const RESULTS: usize = 16 << 20;

/// Runs `program measure ARGUMENTS`, which prints a list of [`Measured`].
///
/// # Errors
/// The process could not be started or watched.
pub fn run(program: &Path, arguments: &[OsString], limits: Limits<'_>) -> std::io::Result<Ended> {
    let mut command = Command::new(program);
    command.arg("measure").args(arguments).arg("--spawned").arg(Clock::stamp().to_string());
    if let Some(cache) = limits.cache {
        command.env("XDG_CACHE_HOME", cache);
    }
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let started = Instant::now();
    let mut child = command.spawn()?;
    let streams = drain(child.stdout.take()).and_then(|out| Ok((out, drain(child.stderr.take())?)));
    let (out, err) = match streams {
        Ok(streams) => streams,
        // The system has no thread left to read with.
        Err(error) => {
            child.kill()?;
            child.wait()?;
            return Err(error);
        }
    };
    let status = loop {
        if let Some(status) = child.try_wait()? {
            break status;
        }
        if started.elapsed() >= limits.budget {
            // A displacement model below it ends by itself when this process is gone.
            child.kill()?;
            child.wait()?;
            return Ok(Ended::OverBudget);
        }
        thread::sleep(POLL);
    };
    let text = received(&out).beginning;
    if status.success()
        && let Ok(results) = serde_json::from_slice::<Vec<Measured>>(&text)
    {
        return Ok(Ended::Told(results));
    }
    if status.success() {
        return Ok(Ended::Crashed("it printed results that are not numbers".to_string()));
    }
    let complaint = received(&err).end.lines().join("\n");
    Ok(Ended::Crashed(match complaint.is_empty() {
        true => status.to_string(),
        false => format!("{status}: {complaint}"),
    }))
}

/// The kept parts of a stream: results are at its beginning, complaints at its end.
#[derive(Default)]
struct Printed {
    beginning: Vec<u8>,
    end: Tail,
}

type Drained = std::sync::mpsc::Receiver<Printed>;

fn drain(stream: Option<impl Read + Send + 'static>) -> std::io::Result<Drained> {
    let (send, receive) = std::sync::mpsc::channel();
    let read = move || {
        let mut printed = Printed::default();
        let mut buffer = vec![0; 1 << 16];
        let mut stream = stream;
        // What cannot be read is missing from the text, and the run then counts as crashed.
        while let Some(read) = stream.as_mut().and_then(|s| s.read(&mut buffer).ok()).filter(|read| *read > 0) {
            let room = RESULTS - printed.beginning.len();
            printed.beginning.extend_from_slice(&buffer[..read.min(room)]);
            printed.end.push(&buffer[..read]);
        }
        let _ = send.send(printed);
    };
    thread::Builder::new().spawn(read).map(|_| receive)
}

fn received(from: &Drained) -> Printed {
    from.recv_timeout(DRAINED).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use std::os::unix::fs::PermissionsExt;

    use super::*;

    /// Runs a program with the shell commands `body`.
    fn run_script(body: &str) -> Ended {
        let folder = tempfile::tempdir().expect("a folder");
        let program = folder.path().join("program");
        std::fs::write(&program, format!("#!/bin/sh\n{body}\n")).expect("writable");
        std::fs::set_permissions(&program, std::fs::Permissions::from_mode(0o755)).expect("ours");
        run(&program, &[], Limits { budget: Duration::from_secs(120), cache: None }).expect("a shell")
    }

    #[test]
    fn a_gigabyte_of_complaints_or_results_costs_no_memory() {
        let Ended::Crashed(text) = run_script("yes no | head -c 1000000000 >&2; echo last >&2; exit 7") else {
            panic!("it has no results")
        };
        assert!(text.contains('7') && text.ends_with("last") && text.len() < 100_000, "{} bytes", text.len());
        let wordy = run_script("yes '[]' | head -c 1000000000");
        assert_eq!(wordy, Ended::Crashed("it printed results that are not numbers".to_string()));
        assert_eq!(run_script("echo '[]'"), Ended::Told(Vec::new()));
    }
}
