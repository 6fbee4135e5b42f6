//! The last resort where memory runs out all the same: a line and an exit code in place of an abort.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::io::Write;

/// Exit code of a solver that failed.
const FAILED: i32 = 3;

thread_local! {
    /// True if a failed allocation on this thread is handed back to whoever asked.
    static ASKED: Cell<bool> = const { Cell::new(false) };
}

/// The system's allocator, except that the process ends with a message and exit code 3 when there is no more memory.
///
/// An allocator may not unwind, and Rust aborts where it is told that memory ran out. Inside [`fallible`] the failure is
/// handed back instead.
#[derive(Debug, Clone, Copy, Default)]
pub struct ExitOnExhaustion;

impl ExitOnExhaustion {
    fn judge(pointer: *mut u8, size: usize) -> *mut u8 {
        if pointer.is_null() && !ASKED.try_with(Cell::get).unwrap_or(false) {
            give_up(size);
        }
        pointer
    }
}

// SAFETY: every call goes to the system's allocator as it is; what is added neither touches the memory nor unwinds.
unsafe impl GlobalAlloc for ExitOnExhaustion {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        Self::judge(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        Self::judge(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        Self::judge(unsafe { System.realloc(pointer, layout, size) }, size)
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        unsafe { System.dealloc(pointer, layout) }
    }
}

/// Runs `work` with allocations that may fail: they give null, for calls like [`Vec::try_reserve_exact`]; all others in
/// it abort as they would without [`ExitOnExhaustion`], so that `work` is such a call and nothing else.
pub fn fallible<T>(work: impl FnOnce() -> T) -> T {
    struct Reset(bool);
    impl Drop for Reset {
        fn drop(&mut self) {
            ASKED.set(self.0);
        }
    }
    let _reset = Reset(ASKED.replace(true));
    work()
}

#[cold]
fn give_up(size: usize) -> ! {
    // The text is put together on the stack: there is nothing else to put it.
    let mut text = [0_u8; 256];
    let mut rest = &mut text[..];
    let _ = writeln!(
        rest,
        "  x out of memory: {size} more bytes were refused by the system\n  help: use a coarser mesh, or give the program \
         more memory (a limit may be set with ulimit -v)"
    );
    let left = rest.len();
    let length = text.len() - left;
    // Where nobody listens, the exit code tells.
    let _ = std::io::stderr().write_all(&text[..length]);
    std::process::exit(FAILED)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn allocations_that_may_fail_hand_the_failure_back() {
        // As a global allocator would, without being one.
        let huge = Layout::from_size_align(1 << 62, 8).expect("a layout");
        // SAFETY: the layout has a size; a null pointer is not used.
        let found = fallible(|| unsafe { ExitOnExhaustion.alloc(huge) });
        // A compiler may leave out an allocation of which nothing but its address is asked.
        assert!(std::hint::black_box(found).is_null());
        assert!(!ASKED.get(), "only for the time of the call");
    }
}
