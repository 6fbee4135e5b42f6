//! The threads that a run shares its work among.

use rayon::ThreadPoolBuilder;

/// Starts the pool of this process and gives the number of its threads: those asked for, but no more than the machine has
/// processors for, and fewer where the system refuses that many.
pub fn start(wanted: u32) -> usize {
    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    let mut threads = (wanted as usize).clamp(1, processors);
    // The global pool can be tried only once, so others are tried before.
    while threads > 1 && ThreadPoolBuilder::new().num_threads(threads).build().is_err() {
        threads /= 2;
    }
    let mut pool = ThreadPoolBuilder::new().num_threads(threads);
    if threads == 1 && ThreadPoolBuilder::new().num_threads(1).build().is_err() {
        // Not even one more thread is to be had; this one does the work alone.
        pool = pool.use_current_thread();
    }
    // A second command in one process keeps the pool of the first.
    let _ = pool.build_global();
    threads
}
