//! Work that may be given up on its way: whoever waits for it no longer wants it.
//!
//! The thread that does the work carries a flag. Where it passes a point at which nothing is half done, it looks at the flag and
//! unwinds; processes that it waits for are ended.

use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

thread_local! {
    static UNWANTED: RefCell<Option<Arc<AtomicBool>>> = const { RefCell::new(None) };
}

/// Work was given up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Interrupted;

/// Does `work` on this thread until it ends or `unwanted` becomes true.
///
/// # Errors
/// [`Interrupted`].
pub fn interruptible<T>(unwanted: Arc<AtomicBool>, work: impl FnOnce() -> T) -> Result<T, Interrupted> {
    struct Reset(Option<Arc<AtomicBool>>);
    impl Drop for Reset {
        fn drop(&mut self) {
            UNWANTED.set(self.0.take());
        }
    }
    let _reset = Reset(UNWANTED.replace(Some(unwanted)));
    catch_unwind(AssertUnwindSafe(work)).map_err(|cause| match cause.downcast::<Interrupted>() {
        Ok(interrupted) => *interrupted,
        Err(other) => resume_unwind(other),
    })
}

/// Unwinds to [`interruptible`] where nobody wants the work of this thread any more.
pub fn stop_if_unwanted() {
    if unwanted().is_some_and(|flag| flag.load(Ordering::Relaxed)) {
        // No message: nothing is wrong.
        resume_unwind(Box::new(Interrupted));
    }
}

/// The flag of this thread, if it has one.
pub(super) fn unwanted() -> Option<Arc<AtomicBool>> {
    UNWANTED.with_borrow(Clone::clone)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_ends_at_the_next_point_and_the_thread_goes_on() {
        let flag = Arc::new(AtomicBool::new(false));
        let mut steps = 0;
        let ended = interruptible(Arc::clone(&flag), || {
            loop {
                stop_if_unwanted();
                steps += 1;
                flag.store(steps == 3, Ordering::Relaxed);
            }
        });
        assert_eq!((ended, steps), (Err::<(), _>(Interrupted), 3));
        stop_if_unwanted();
        assert_eq!(interruptible(Arc::default(), || 7), Ok(7));
    }

    #[test]
    fn a_process_that_is_waited_for_ends_with_the_work() {
        let flag = Arc::new(AtomicBool::new(false));
        let later = Arc::clone(&flag);
        std::thread::spawn(move || {
            std::thread::sleep(std::time::Duration::from_millis(100));
            later.store(true, Ordering::Relaxed);
        });
        let ended = interruptible(flag, || {
            let mut command = std::process::Command::new("sleep");
            let ended = super::super::supervise(command.arg("60"), std::time::Duration::MAX);
            assert!(matches!(ended.expect("started").outcome, super::super::Outcome::TimedOut));
            stop_if_unwanted();
        });
        assert_eq!(ended, Err(Interrupted));
    }
}
