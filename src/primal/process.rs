//! Runs the Python package as a process that can neither hang nor be left behind.

use std::env;
use std::ffi::OsString;
use std::fs;
use std::io::{self, BufRead, BufReader, Read};
use std::os::unix::process::{CommandExt, ExitStatusExt};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{self, Receiver, Sender};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use super::exchange::PROBLEM_FILE;
use super::{Options, PrimalError, Sabotage, Tail};

/// The Python package, carried along so that program and reference always belong together.
const PACKAGE: [(&str, &str); 9] = [
    ("__init__.py", include_str!("../../reference/hypercircle_reference/__init__.py")),
    ("__main__.py", include_str!("../../reference/hypercircle_reference/__main__.py")),
    ("compat.py", include_str!("../../reference/hypercircle_reference/compat.py")),
    ("constraints.py", include_str!("../../reference/hypercircle_reference/constraints.py")),
    ("exchange.py", include_str!("../../reference/hypercircle_reference/exchange.py")),
    ("group.py", include_str!("../../reference/hypercircle_reference/group.py")),
    ("model.py", include_str!("../../reference/hypercircle_reference/model.py")),
    ("run.py", include_str!("../../reference/hypercircle_reference/run.py")),
    ("solve.py", include_str!("../../reference/hypercircle_reference/solve.py")),
];

const NOT_INSTALLED_CODE: i32 = 4;
const NOT_INSTALLED_TEXT: &str = "hypercircle-reference: not installed:";
/// How long a process may take to end after it was asked to, and its pipes to close after it ended.
const GRACE: Duration = Duration::from_secs(2);
const POLL: Duration = Duration::from_millis(10);

/// Solve the problem in `folder`, which then holds one result file per degree.
///
/// `HYPERCIRCLE_REFERENCE` may name a folder with another copy of the package `hypercircle_reference`.
pub fn run(folder: &Path, options: &Options) -> Result<(), PrimalError> {
    let in_folder = |source| PrimalError::Io { path: folder.to_owned(), source };
    let folder = std::path::absolute(folder).map_err(in_folder)?;
    let unpacked;
    let package = match env::var_os("HYPERCIRCLE_REFERENCE") {
        Some(given) => {
            let given = PathBuf::from(given);
            std::path::absolute(&given).map_err(|source| PrimalError::Io { path: given, source })?
        }
        None => {
            unpacked = unpack().map_err(|source| PrimalError::Io { path: env::temp_dir(), source })?;
            unpacked.path().to_owned()
        }
    };
    if !package.join("hypercircle_reference/__main__.py").is_file() {
        let reason = format!("{} (from HYPERCIRCLE_REFERENCE) holds no hypercircle_reference", package.display());
        return Err(PrimalError::NotInstalled(reason));
    }
    let mut command = command(&folder, &package, options)?;
    let program = command.get_program().to_owned();
    let child = command.spawn().map_err(|error| match error.kind() {
        io::ErrorKind::NotFound => PrimalError::NotInstalled(format!("{} does not exist", program.display())),
        _ => PrimalError::Failed { status: format!("{} did not start", program.display()), log: error.to_string() },
    })?;
    supervise(child, options.timeout)
}

fn unpack() -> io::Result<tempfile::TempDir> {
    let root = tempfile::tempdir()?;
    let package = root.path().join("hypercircle_reference");
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
    // A bare name is looked up in PATH; anything else must survive the change of folder below.
    if found.components().count() < 2 {
        return Ok(found);
    }
    if !found.is_file() {
        return Err(PrimalError::NotInstalled(format!("{} does not exist", found.display())));
    }
    std::path::absolute(&found).map_err(|source| PrimalError::Io { path: found, source })
}

fn command(folder: &Path, package: &Path, options: &Options) -> Result<Command, PrimalError> {
    let python = interpreter(options)?;
    let mut command = match options.ranks {
        None => Command::new(python),
        Some(ranks) => {
            let mut launcher = Command::new("mpirun");
            launcher.args(["--allow-run-as-root", "--oversubscribe", "-n", &ranks.to_string()]).arg(python);
            launcher
        }
    };
    command.args(["-m", "hypercircle_reference"]).arg(folder.join(PROBLEM_FILE)).arg("--out").arg(folder);
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
    let mut path = OsString::from(package);
    if let Some(inherited) = env::var_os("PYTHONPATH").filter(|value| !value.is_empty()) {
        path.push(":");
        path.push(inherited);
    }
    command
        // The pipe is never written to: its end tells the process that this one is gone.
        .arg("--stop-with-stdin")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        // Python looks for modules in the current folder first; the exchange folder holds none.
        .current_dir(folder)
        .env("PYTHONPATH", path)
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .env("OMP_NUM_THREADS", "1")
        .process_group(0);
    Ok(command)
}

/// Wait for the end of `child`, for at most `limit`, and judge it.
fn supervise(mut child: Child, limit: Duration) -> Result<(), PrimalError> {
    let started = Instant::now();
    let tail = Arc::new(Mutex::new(Tail::default()));
    let (open, closed) = mpsc::channel();
    let streams: [Option<Box<dyn Read + Send>>; 2] =
        [child.stdout.take().map(|s| Box::new(s) as _), child.stderr.take().map(|s| Box::new(s) as _)];
    for stream in streams.into_iter().flatten() {
        drain(stream, Arc::clone(&tail), open.clone());
    }
    drop(open);
    let log = |tail: &Mutex<Tail>| tail.lock().unwrap_or_else(PoisonError::into_inner).text();
    loop {
        match child.try_wait() {
            Ok(Some(status)) => {
                // Descendants may keep the pipes open for as long as they live; nothing they print matters any more.
                wait_closed(&closed);
                return judge(status, log(&tail));
            }
            Ok(None) if started.elapsed() >= limit => {
                stop(&mut child);
                wait_closed(&closed);
                return Err(PrimalError::TimedOut { limit, log: log(&tail) });
            }
            Ok(None) => thread::sleep(POLL),
            Err(error) => {
                stop(&mut child);
                return Err(PrimalError::Failed { status: format!("lost: {error}"), log: log(&tail) });
            }
        }
    }
}

/// Read `stream` to its end on a thread of its own; `_open` is dropped there.
fn drain(stream: Box<dyn Read + Send>, tail: Arc<Mutex<Tail>>, _open: Sender<()>) {
    thread::spawn(move || {
        let _open = _open;
        let mut reader = BufReader::new(stream);
        let mut line = Vec::new();
        // The limit keeps a line that never ends from filling the memory.
        while matches!(reader.by_ref().take(1 << 16).read_until(b'\n', &mut line), Ok(read) if read > 0) {
            tail.lock().unwrap_or_else(PoisonError::into_inner).push(&line);
            line.clear();
        }
    });
}

fn wait_closed(closed: &Receiver<()>) {
    // Nothing is ever sent: this returns when all senders are gone, or after the grace.
    let _ = closed.recv_timeout(GRACE);
}

fn judge(status: ExitStatus, log: String) -> Result<(), PrimalError> {
    if status.success() {
        return Ok(());
    }
    if status.code() == Some(NOT_INSTALLED_CODE) {
        let reason = log.lines().find_map(|line| line.strip_prefix(NOT_INSTALLED_TEXT)).map(str::trim);
        return Err(PrimalError::NotInstalled(reason.map_or(log.clone(), str::to_owned)));
    }
    let status = match (status.code(), status.signal()) {
        (Some(code), _) => format!("exit code {code}"),
        (None, Some(signal)) => format!("ended by signal {signal}"),
        (None, None) => "ended abnormally".to_owned(),
    };
    Err(PrimalError::Failed { status, log })
}

/// End the process, its group and everything it started: first asked, then forced.
fn stop(child: &mut Child) {
    // MPI puts each rank into a group of its own, so the group of the launcher is not enough.
    let family = descendants(child.id());
    signal("TERM", child.id(), &[]);
    let asked = Instant::now();
    while asked.elapsed() < GRACE && !matches!(child.try_wait(), Ok(Some(_))) {
        thread::sleep(POLL);
    }
    signal("KILL", child.id(), &family);
    // Both fail only where the process is gone already.
    let _ = child.kill();
    let _ = child.wait();
}

fn signal(name: &str, group: u32, processes: &[u32]) {
    // The shell's built-in `kill` spares a dependency for two system calls.
    for target in std::iter::once(format!("-{group}")).chain(processes.iter().map(u32::to_string)) {
        let _ = Command::new("/bin/sh")
            .args(["-c", "kill -s \"$0\" -- \"$1\"", name, &target])
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .status();
    }
}

/// All processes that descend from `ancestor` now, from `/proc`; empty where there is none.
fn descendants(ancestor: u32) -> Vec<u32> {
    let parents: Vec<(u32, u32)> = fs::read_dir("/proc")
        .into_iter()
        .flatten()
        .filter_map(|entry| {
            let process: u32 = entry.ok()?.file_name().to_str()?.parse().ok()?;
            let stat = fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
            // pid (name) state parent …; the name may hold anything, parentheses included.
            let parent = stat.rsplit_once(')')?.1.split_whitespace().nth(1)?.parse().ok()?;
            Some((process, parent))
        })
        .collect();
    let mut found = vec![ancestor];
    let mut next = 0;
    while next < found.len() {
        let parent = found[next];
        found.extend(parents.iter().filter(|(_, p)| *p == parent).map(|(process, _)| *process));
        next += 1;
    }
    found.split_off(1)
}

#[cfg(test)]
#[path = "process_tests.rs"]
mod tests;
