//! Work that Python does not wait for: other threads of the interpreter run meanwhile.

use pyo3::prelude::*;
use rayon::ThreadPoolBuilder;

use super::errors::raised;
use crate::cli::Exit;

/// Stack of a thread: that of the first thread of a program.
const STACK: usize = 8 << 20;

/// At most one thread for each processor.
pub fn threads(wanted: u32) -> usize {
    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    (wanted as usize).clamp(1, processors)
}

/// Does `work` on that many threads of its own, with the interpreter released.
///
/// # Errors
/// `SolveError` where the system refuses the threads.
pub fn aside<T: Send>(py: Python<'_>, threads: usize, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    let pool = ThreadPoolBuilder::new().num_threads(threads).stack_size(STACK).build();
    let pool = pool.map_err(|e| raised(Exit::Failed, format!("threads={threads}: {e}"), "ask for fewer threads"))?;
    Ok(py.detach(|| pool.install(work)))
}
