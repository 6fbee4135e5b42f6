//! Largest resident memory of this process and of those it starts, as Linux counts it.

use std::fs;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread::{self, JoinHandle};
use std::time::Duration;

const EVERY: Duration = Duration::from_millis(10);

/// VmHWM of a process in bytes; `None` where there is no such file.
fn peak_of(process: &str) -> Option<u64> {
    let status = fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kilobytes: u64 = line.split_whitespace().next()?.parse().ok()?;
    Some(1024 * kilobytes)
}

/// VmHWM of this process.
pub fn own_peak() -> Option<u64> {
    peak_of("self")
}

/// Watches the processes that this one starts; the mark is a maximum, so the last look before the end is enough.
pub struct Watch {
    ended: Arc<AtomicBool>,
    largest: Arc<AtomicU64>,
    thread: Option<JoinHandle<()>>,
}

impl Watch {
    /// Starts to watch.
    pub fn start() -> Self {
        let (ended, largest) = (Arc::new(AtomicBool::new(false)), Arc::new(AtomicU64::new(0)));
        let (stop, peak) = (Arc::clone(&ended), Arc::clone(&largest));
        let watch = move || {
            while !stop.load(Ordering::Relaxed) {
                for process in descendants() {
                    if let Some(bytes) = peak_of(&process.to_string()) {
                        peak.fetch_max(bytes, Ordering::Relaxed);
                    }
                }
                thread::sleep(EVERY);
            }
        };
        // Where the system has no more threads, nothing is seen.
        Watch { ended, largest, thread: thread::Builder::new().spawn(watch).ok() }
    }

    /// The largest process seen.
    pub fn finish(mut self) -> Option<u64> {
        self.ended.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            // A watch that failed has seen what it has seen.
            let _ = thread.join();
        }
        Some(self.largest.load(Ordering::Relaxed)).filter(|bytes| *bytes > 0)
    }
}

/// All processes below this one, from the children that the kernel lists for every thread.
fn descendants() -> Vec<u32> {
    let mut found = vec![std::process::id()];
    let mut next = 0;
    while next < found.len() {
        let threads = fs::read_dir(format!("/proc/{}/task", found[next]));
        for task in threads.into_iter().flatten().flatten() {
            let children = fs::read_to_string(task.path().join("children")).unwrap_or_default();
            found.extend(children.split_whitespace().filter_map(|pid| pid.parse::<u32>().ok()));
        }
        next += 1;
    }
    found.split_off(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_that_was_touched_is_counted() {
        let Some(before) = own_peak() else { return };
        let block = vec![1_u8; 64 << 20];
        let touched: usize = block.iter().step_by(4096).map(|&b| usize::from(b)).sum();
        assert!(touched > 0);
        drop(block);
        assert!(own_peak().expect("counted before") >= before.max(64 << 20));
    }

    #[test]
    fn a_child_is_seen() {
        let watch = Watch::start();
        let mut child = std::process::Command::new("sleep").arg("0.3").spawn().expect("sleep exists");
        child.wait().expect("it ends");
        if own_peak().is_some() {
            assert!(watch.finish().is_some_and(|bytes| bytes > 100_000));
        }
    }
}
