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

/// What a run is allowed.
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
    let out = drain(child.stdout.take());
    let err = drain(child.stderr.take());
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
    let text = received(&out);
    if status.success()
        && let Ok(results) = serde_json::from_slice::<Vec<Measured>>(&text)
    {
        return Ok(Ended::Told(results));
    }
    if status.success() {
        return Ok(Ended::Crashed("it printed results that are not numbers".to_string()));
    }
    let complaint = String::from_utf8_lossy(&received(&err)).trim().to_string();
    Ok(Ended::Crashed(match complaint.is_empty() {
        true => status.to_string(),
        false => format!("{status}: {complaint}"),
    }))
}

type Drained = std::sync::mpsc::Receiver<Vec<u8>>;

fn drain(stream: Option<impl Read + Send + 'static>) -> Drained {
    let (send, receive) = std::sync::mpsc::channel();
    thread::spawn(move || {
        let mut bytes = Vec::new();
        if let Some(mut stream) = stream {
            // What cannot be read is missing from the text, and the run then counts as crashed.
            let _ = stream.read_to_end(&mut bytes);
        }
        let _ = send.send(bytes);
    });
    receive
}

fn received(from: &Drained) -> Vec<u8> {
    from.recv_timeout(DRAINED).unwrap_or_default()
}
