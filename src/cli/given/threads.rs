//! The threads that a run shares its work among.

use std::sync::mpsc::{Sender, channel};
use std::thread;

use rayon::{ThreadBuilder, ThreadPoolBuilder};

/// Starts the pool of this process and gives the number of its threads: those asked for, but no more than the machine has
/// processors for, and fewer where the system refuses that many.
pub fn start(wanted: u32) -> usize {
    let processors = thread::available_parallelism().map_or(1, usize::from);
    let most = (wanted as usize).clamp(1, processors);
    // The pool of a process can be built only once: its threads are there before it is.
    let mut ready: Vec<Sender<ThreadBuilder>> = match most {
        1 => Vec::new(),
        _ => (0..most).map_while(|_| waiting()).collect(),
    };
    if ready.len() < 2 {
        // This thread does the work alone. A second command in one process keeps the pool of the first.
        let _ = ThreadPoolBuilder::new().num_threads(1).use_current_thread().build_global();
        return 1;
    }
    let threads = ready.len();
    let _ = ThreadPoolBuilder::new()
        .num_threads(threads)
        .spawn_handler(|work| {
            if let Some(thread) = ready.pop() {
                let _ = thread.send(work);
            }
            Ok(())
        })
        .build_global();
    threads
}

/// A thread that waits for what it is to do; `None` where the system has no more of them.
fn waiting() -> Option<Sender<ThreadBuilder>> {
    let (send, receive) = channel::<ThreadBuilder>();
    let work = move || {
        if let Ok(work) = receive.recv() {
            work.run();
        }
    };
    thread::Builder::new().spawn(work).ok().map(|_| send)
}
