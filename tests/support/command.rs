//! Starts the program as a user does.
#![allow(dead_code)]

use std::ffi::OsStr;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// The program.
pub const PROGRAM: &str = env!("CARGO_BIN_EXE_hypercircle");

/// True if FEniCSx is expected; the environment says so where it is known to be missing, and the dual side is then tried alone.
pub fn with_reference() -> bool {
    std::env::var_os("HYPERCIRCLE_WITHOUT_REFERENCE").is_none_or(|value| value != "1")
}

/// The file of the scene `name` in `cases/`.
pub fn case(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("cases").join(format!("{name}.toml"))
}

/// The program with `arguments`, its current folder being `folder`, and with nothing to read.
pub fn hypercircle<A: AsRef<OsStr>>(folder: &Path, arguments: impl IntoIterator<Item = A>) -> Command {
    let mut command = Command::new(PROGRAM);
    command.args(arguments).current_dir(folder).env_remove("RUST_BACKTRACE");
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// Runs `command` and returns its output.
pub fn run(mut command: Command) -> Output {
    command.output().expect("the program starts")
}

/// The text of a run on standard error.
pub fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Asserts that the run `what` ended with `code` and said every one of `fragments`, wherever its lines break; gives what
/// it said.
#[track_caller]
pub fn ended(what: &str, output: &Output, code: i32, fragments: &[&str]) -> String {
    let said = said(output);
    assert_eq!(output.status.code(), Some(code), "{what}: {said}");
    assert!(!said.contains("panicked") && !said.contains("internal error"), "{what}: {said}");
    let line = said.split_whitespace().collect::<Vec<_>>().join(" ");
    for fragment in fragments {
        assert!(said.contains(fragment) || line.contains(fragment), "{what}: no `{fragment}` in\n{said}");
    }
    said
}

/// An executable script of the shell.
pub fn script(path: PathBuf, body: &str) -> PathBuf {
    std::fs::write(&path, format!("#!/bin/sh\n{body}\n")).expect("writable");
    std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).expect("ours");
    path
}
