//! `--version` in full: what a report of a defect needs.

use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::process::{Outcome, Scratch, python, supervise};
use crate::study::locked_version;

/// Libraries whose release can change a number.
const LIBRARIES: [&str; 4] = ["faer", "clarabel", "nalgebra", "private-gemm-x86"];
/// How long an interpreter may take to name its packages.
const PATIENCE: Duration = Duration::from_secs(20);
/// Prints its version, and those of the packages that take part.
const SCRIPT: &str = "import sys, importlib.metadata as m\n\
    def version(name):\n    try: return m.version(name)\n    except m.PackageNotFoundError: return None\n\
    print('python', sys.version.split()[0])\n\
    for name, package in (('dolfinx', 'fenics-dolfinx'), ('petsc4py', 'petsc4py'), ('meshio', 'meshio')):\n    \
        print(name, version(package) or 'not found')\n";

/// The program, its libraries, the build, and the reference with the interpreter that it would run in.
pub fn long() -> String {
    let build = if cfg!(debug_assertions) { "dev" } else { "release" };
    let commit = option_env!("HYPERCIRCLE_COMMIT").filter(|commit| !commit.is_empty()).unwrap_or("not known");
    let system = format!("{}-{}", std::env::consts::ARCH, std::env::consts::OS);
    let mut lines = vec![
        format!("hypercircle {}", env!("CARGO_PKG_VERSION")),
        format!("commit: {commit}"),
        format!("build: {build}, {system}"),
    ];
    lines.extend(LIBRARIES.iter().filter_map(|name| Some(format!("{name}: {}", locked_version(name)?))));
    let interpreter = std::env::var_os("HYPERCIRCLE_PYTHON").map_or_else(|| "/usr/bin/python3".into(), PathBuf::from);
    lines.push(format!("interpreter: {}", interpreter.display()));
    match packages(&interpreter) {
        Some(packages) => lines.extend(packages.iter().filter_map(|line| {
            let (name, version) = line.split_once(' ')?;
            Some(format!("{name}: {version}"))
        })),
        None => lines.push("python: not found".to_string()),
    }
    lines.join("\n")
}

fn packages(interpreter: &Path) -> Option<Vec<String>> {
    let program = python::find(interpreter)?;
    let scratch = Scratch::new().ok()?;
    let mut command = python::command(&program, SCRIPT, scratch.path(), &[], None).ok()?;
    let ended = supervise(&mut command, PATIENCE).ok()?;
    matches!(ended.outcome, Outcome::Exit(status) if status.success()).then_some(ended.log)
}
