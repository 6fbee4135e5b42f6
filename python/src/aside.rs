//! Work beside the interpreter: its other threads run meanwhile, and ctrl-C ends it.

use std::fmt::Display;
use std::panic::resume_unwind;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, Thread};
use std::time::Duration;

use pyo3::prelude::*;
use rayon::ThreadPoolBuilder;

use crate::errors::raised;
use hypercircle::cli::Exit;
use hypercircle::process::{Interrupted, interruptible};

/// Stack of a thread: that of the first thread of a program.
const STACK: usize = 8 << 20;

/// At most one thread for each processor.
pub fn threads(wanted: u32) -> usize {
    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    (wanted as usize).clamp(1, processors)
}

/// How often Python is asked whether somebody pressed ctrl-C.
const PULSE: Duration = Duration::from_millis(50);

/// Wakes the thread that waits for the end of some work, however that ends.
struct Over<'a> {
    is_over: &'a AtomicBool,
    waits: Thread,
}

impl Drop for Over<'_> {
    fn drop(&mut self) {
        self.is_over.store(true, Ordering::Release);
        self.waits.unpark();
    }
}

/// Does `work` on that many threads of its own, with the interpreter released. A signal that Python turns into an exception, as it does
/// ctrl-C, ends the work at its next step, and is that exception.
///
/// # Errors
/// `SolveError` where the system refuses the threads, and what a signal raises.
pub fn aside<T: Send>(py: Python<'_>, threads: usize, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    let refused =
        |error: &dyn Display| raised(Exit::Failed, format!("threads={threads}: {error}"), "ask for fewer threads");
    let pool = ThreadPoolBuilder::new().num_threads(threads).stack_size(STACK).build().map_err(|e| refused(&e))?;
    let unwanted = Arc::new(AtomicBool::new(false));
    let (flag, is_over) = (Arc::clone(&unwanted), AtomicBool::new(false));
    let over = Over { is_over: &is_over, waits: thread::current() };
    let job = move || {
        let _over = over;
        interruptible(flag, work)
    };
    thread::scope(|scope| {
        let run = thread::Builder::new().spawn_scoped(scope, || pool.install(job)).map_err(|e| refused(&e))?;
        let mut signal = Ok(());
        while !is_over.load(Ordering::Acquire) {
            py.detach(|| thread::park_timeout(PULSE));
            if let (Err(error), true) = (py.check_signals(), signal.is_ok()) {
                signal = Err(error);
                unwanted.store(true, Ordering::Relaxed);
            }
        }
        let found = py.detach(|| run.join()).unwrap_or_else(|cause| resume_unwind(cause));
        signal?;
        found.map_err(|Interrupted| raised(Exit::Failed, "the work was given up".to_string(), ""))
    })
}
