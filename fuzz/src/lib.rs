//! The targets of fuzzing: functions of bytes that have to end soon, take little memory and not panic.
//!
//! `fuzz_targets/` gives them to libFuzzer, `tests/library/fuzzed.rs` to `cargo test`. Each follows its input as far as a run
//! of the program would: what is accepted is meshed, solved, compared and reported, as long as it is small.

pub mod exchange;
pub mod field;
pub mod msh;
pub mod scene;
pub mod setting;

/// A target: its name, which is that of its corpus, and its function.
pub type Target = (&'static str, fn(&[u8]));

/// Every target.
pub const TARGETS: [Target; 4] =
    [("scene", scene::run), ("msh", msh::run), ("exchange", exchange::run), ("field", field::run)];
