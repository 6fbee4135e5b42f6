//! Signals that ask this process to end: what it started and its temporary folders go first.

use std::sync::{Mutex, MutexGuard, PoisonError};

use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::iterator::Signals;
use signal_hook::low_level::emulate_default_handler;

use super::{child, scratch};

/// Held while files change places, which is not to be left half done.
static CHANGING: Mutex<()> = Mutex::new(());

/// Waits on a thread of its own for an interrupt, a request to terminate or the end of the terminal. Then the processes
/// under supervision end, the temporary folders are removed, and this process ends by that signal, as if it had not been
/// waited for. A signal that is ignored, as `nohup` does, stays ignored.
pub fn watch() {
    let ignored = ignored();
    let waited_for: Vec<i32> = [SIGINT, SIGTERM, SIGHUP].into_iter().filter(|s| ignored & 1 << (s - 1) == 0).collect();
    let work = move || {
        let Ok(mut signals) = Signals::new(waited_for) else { return };
        if let Some(signal) = signals.forever().next() {
            let _unbroken = unbroken();
            child::end_all();
            scratch::remove_all();
            let _ = emulate_default_handler(signal);
        }
    };
    // Without a thread, signals end the process as they always do, and the next one cleans up.
    let _ = std::thread::Builder::new().name("signals".into()).spawn(work);
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
