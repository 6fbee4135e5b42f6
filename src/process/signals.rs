//! Signals that ask this process to end: what it started and its temporary folders go first.

use std::io::Write;
use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError, mpsc};

use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::iterator::Signals;
use signal_hook::low_level::emulate_default_handler;

use super::{child, scratch};

/// Message for a signal that ends this process.
static LAST_WORDS: Mutex<Option<String>> = Mutex::new(None);

/// Held while files change places, which is not to be left half done.
static CHANGING: Mutex<()> = Mutex::new(());

/// Waits on a thread of its own for an interrupt, a request to terminate or the end of the terminal. Then the processes
/// under supervision end, the temporary folders are removed, and this process ends by that signal, as if it had not been
/// waited for. A signal that is ignored, as `nohup` does, stays ignored. Returns when the thread waits.
pub fn watch() {
    let ignored = ignored();
    let waited_for: Vec<i32> = [SIGINT, SIGTERM, SIGHUP].into_iter().filter(|s| ignored & 1 << (s - 1) == 0).collect();
    let (ready, waits) = mpsc::channel::<()>();
    let work = move || {
        let Ok(mut signals) = Signals::new(waited_for) else { return };
        drop(ready);
        if let Some(signal) = signals.forever().next() {
            let _unbroken = unbroken();
            child::end_all();
            scratch::remove_all();
            if let Some(words) = last_words().take() {
                let _ = writeln!(std::io::stderr(), "{words}");
            }
            let _ = emulate_default_handler(signal);
        }
    };
    // Without a thread, signals end the process as they always do, and the next one cleans up.
    let _ = std::thread::Builder::new().name("signals".into()).spawn(work);
    // Nothing is sent: this returns when the other end is gone.
    let _ = waits.recv();
}

/// Said when a signal ends this process, as long as this value lives.
#[derive(Debug)]
pub struct LastWords(());

impl LastWords {
    /// That runs are kept in `folder`, and how to go on, which `needs` something.
    pub fn kept_in(folder: &Path, needs: &str) -> Self {
        *last_words() = Some(format!(
            "interrupted: the runs that have ended are kept in {}; the same command with --resume goes on from there{needs}",
            folder.display()
        ));
        LastWords(())
    }
}

impl Drop for LastWords {
    fn drop(&mut self) {
        *last_words() = None;
    }
}

fn last_words() -> MutexGuard<'static, Option<String>> {
    LAST_WORDS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// As long as the result is held, no such signal ends this process.
pub fn unbroken() -> MutexGuard<'static, ()> {
    CHANGING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// One bit for each signal that this process ignores.
fn ignored() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}
