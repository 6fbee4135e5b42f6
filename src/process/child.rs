//! A process under supervision: it can neither hang, nor flood the memory, nor be left behind.

use std::io::{self, Read};
use std::os::unix::process::CommandExt;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, Sender};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use rustix::process::{Pid, Signal, WaitId, WaitIdOptions, kill_process, kill_process_group, waitid};

use super::interrupt;
use super::tail::Tail;

/// How long a process may take to end after it was asked to, and its pipes to close after it ended.
pub const GRACE: Duration = Duration::from_secs(2);
const POLL: Duration = Duration::from_millis(5);

/// Processes that a signal to this one has to end, too.
static LIVING: Mutex<Vec<Pid>> = Mutex::new(Vec::new());

/// How a process ended.
#[derive(Debug)]
pub enum Outcome {
    /// By itself.
    Exit(ExitStatus),
    /// It was ended after the time it was allowed, or because nobody waited for it any more.
    TimedOut,
    /// It could not be watched, and was ended.
    Lost(io::Error),
}

/// The end of a process.
#[derive(Debug)]
pub struct Ended {
    /// How.
    pub outcome: Outcome,
    /// The last lines it printed: of standard output, then of standard error.
    pub log: Vec<String>,
}

impl Ended {
    /// The last lines as one text, for a message.
    pub fn text(&self) -> String {
        if self.log.is_empty() { "(nothing was printed)".to_owned() } else { self.log.join("\n") }
    }
}

/// Starts `command` in a process group of its own, and waits for its end, for at most `limit`. Standard input is a pipe
/// that is never written to: its end tells the process that this one is gone. What it started and left running in its
/// group ends with it, and so does it itself where nobody wants the work of this thread any more.
///
/// # Errors
/// The process could not be started.
pub fn supervise(command: &mut Command, limit: Duration) -> io::Result<Ended> {
    supervise_unless(command, limit, &interrupt::unwanted().unwrap_or_default())
}

/// Runs a process that nobody waits for any more once `unwanted` is true: it is then ended as if its time were over.
///
/// # Errors
/// The process could not be started.
pub fn supervise_unless(command: &mut Command, limit: Duration, unwanted: &AtomicBool) -> io::Result<Ended> {
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).process_group(0);
    let started = Instant::now();
    let mut child = Supervised::start(command)?;
    let tails = [(); 2].map(|()| Arc::new(Mutex::new(Tail::default())));
    let (open, closed) = mpsc::channel();
    let streams: [Option<Box<dyn Read + Send>>; 2] =
        [child.child.stdout.take().map(|s| Box::new(s) as _), child.child.stderr.take().map(|s| Box::new(s) as _)];
    let mut drained = Ok(());
    for (stream, tail) in streams.into_iter().zip(&tails) {
        if let Some(stream) = stream {
            drained = drained.and_then(|()| drain(stream, Arc::clone(tail), open.clone()));
        }
    }
    drop(open);
    let outcome = match drained {
        Ok(()) => child.wait(started, limit, unwanted),
        Err(error) => Outcome::Lost(error),
    };
    if !matches!(outcome, Outcome::Exit(_)) {
        child.stop();
    }
    // Descendants may keep the pipes open for as long as they live; nothing they print matters any more.
    wait_closed(&closed);
    let log = tails.iter().flat_map(|tail| unpoisoned(tail).lines()).collect();
    Ok(Ended { outcome, log })
}

/// Ends every process that is under supervision now, and what it started, at once: this process is about to end. Nobody who waits for
/// one of them is told of it, and none is started any more: what they would say or write could come before the end.
pub(super) fn end_all() {
    let living = unpoisoned(&LIVING);
    for pid in living.iter() {
        let family = descendants(*pid);
        kill(*pid, Signal::KILL, &family);
    }
    std::mem::forget(living);
}

struct Supervised {
    child: Child,
    pid: Pid,
}

impl Supervised {
    fn start(command: &mut Command) -> io::Result<Self> {
        // A signal that arrives between the start and the entry would miss the process.
        let mut living = unpoisoned(&LIVING);
        let child = command.spawn()?;
        let pid = Pid::from_child(&child);
        living.push(pid);
        Ok(Supervised { child, pid })
    }

    fn wait(&mut self, started: Instant, limit: Duration, unwanted: &AtomicBool) -> Outcome {
        loop {
            // The process stays unreaped, and its number its own, until its group has been ended.
            let look = WaitIdOptions::EXITED | WaitIdOptions::NOHANG | WaitIdOptions::NOWAIT;
            match waitid(WaitId::Pid(self.pid), look) {
                Ok(Some(_)) => {
                    let _ = kill_process_group(self.pid, Signal::KILL);
                    return self.child.wait().map_or_else(Outcome::Lost, Outcome::Exit);
                }
                Ok(None) if started.elapsed() >= limit || unwanted.load(Ordering::Relaxed) => return Outcome::TimedOut,
                Ok(None) | Err(rustix::io::Errno::INTR) => thread::sleep(POLL),
                Err(error) => return Outcome::Lost(error.into()),
            }
        }
    }

    /// Ends the process, its group and everything it started: first asked, then forced.
    fn stop(&mut self) {
        // MPI puts each rank into a group of its own, so the group of the launcher is not enough.
        let family = descendants(self.pid);
        let _ = kill_process_group(self.pid, Signal::TERM);
        let asked = Instant::now();
        let gone = WaitIdOptions::EXITED | WaitIdOptions::NOHANG | WaitIdOptions::NOWAIT;
        while asked.elapsed() < GRACE && matches!(waitid(WaitId::Pid(self.pid), gone), Ok(None)) {
            thread::sleep(POLL);
        }
        kill(self.pid, Signal::KILL, &family);
        // Both fail only where the process is gone already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Drop for Supervised {
    fn drop(&mut self) {
        unpoisoned(&LIVING).retain(|pid| *pid != self.pid);
    }
}

/// Signals a group and `others`; whoever is gone already is spared an error.
fn kill(group: Pid, signal: Signal, others: &[Pid]) {
    let _ = kill_process_group(group, signal);
    for process in others {
        let _ = kill_process(*process, signal);
    }
}

/// Reads `stream` to its end on a thread of its own; `_open` is dropped there.
fn drain(mut stream: Box<dyn Read + Send>, tail: Arc<Mutex<Tail>>, _open: Sender<()>) -> io::Result<()> {
    let work = move || {
        let _open = _open;
        let mut buffer = vec![0; 1 << 16];
        loop {
            match stream.read(&mut buffer) {
                Ok(0) => return,
                Ok(read) => unpoisoned(&tail).push(&buffer[..read]),
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(_) => return,
            }
        }
    };
    thread::Builder::new().spawn(work).map(|_| ())
}

fn wait_closed(closed: &Receiver<()>) {
    // Nothing is ever sent: this returns when all senders are gone, or after the grace.
    let _ = closed.recv_timeout(GRACE);
}

fn unpoisoned<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// All processes that descend from `ancestor` now, from `/proc`; empty where there is none.
fn descendants(ancestor: Pid) -> Vec<Pid> {
    let number = |text: &str| text.parse().ok().and_then(Pid::from_raw);
    let parents: Vec<(Pid, Pid)> = std::fs::read_dir("/proc")
        .into_iter()
        .flatten()
        .filter_map(|entry| {
            let process = number(entry.ok()?.file_name().to_str()?)?;
            let stat = std::fs::read_to_string(format!("/proc/{}/stat", process.as_raw_nonzero())).ok()?;
            // pid (name) state parent …; the name may hold anything, parentheses included.
            let parent = number(stat.rsplit_once(')')?.1.split_whitespace().nth(1)?)?;
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
#[path = "child_tests.rs"]
mod tests;
