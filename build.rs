//! Tells the program which commit a release is built from: `--version` says it.

use std::path::Path;
use std::process::Command;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-env-changed=HYPERCIRCLE_COMMIT");
    let given = std::env::var("HYPERCIRCLE_COMMIT").ok().filter(|commit| !commit.is_empty());
    // What is built for tests changes with every line, and is not built again for a commit.
    let release = std::env::var("PROFILE").is_ok_and(|profile| profile == "release");
    if let Some(commit) = given.or_else(|| release.then(checked_out).flatten()) {
        println!("cargo::rustc-env=HYPERCIRCLE_COMMIT={commit}");
    }
}

/// The commit of the working tree, where the sources are one and not a package unpacked in somebody else's.
fn checked_out() -> Option<String> {
    if !Path::new(".git").exists() {
        return None;
    }
    for name in [".git/HEAD", ".git/logs/HEAD"] {
        if Path::new(name).exists() {
            println!("cargo::rerun-if-changed={name}");
        }
    }
    let output = Command::new("git")
        .args(["describe", "--always", "--dirty=, changed", "--abbrev=40", "--exclude=*"])
        .output()
        .ok()?;
    let commit = String::from_utf8(output.stdout).ok()?.trim().to_string();
    (output.status.success() && !commit.is_empty()).then_some(commit)
}
