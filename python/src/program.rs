//! The command `hypercircle`, as `pip install` puts it beside the module.

use std::ffi::OsString;
use std::path::PathBuf;

use pyo3::prelude::*;

use hypercircle::budget::ExitOnExhaustion;
use hypercircle::cli::{Started, main_of};

/// A command that the system refuses memory says so, from the module as from the program.
#[global_allocator]
static ALLOCATOR: ExitOnExhaustion = ExitOnExhaustion;

/// Runs the command line in `sys.argv`, as the script `hypercircle` does, and gives its exit code. The process is then that of the
/// program: it ends by the signals that end a program.
#[pyfunction]
pub fn main(py: Python<'_>) -> PyResult<u8> {
    let words: Vec<OsString> = py.import("sys")?.getattr("argv")?.extract()?;
    let code: PathBuf = py.import("hypercircle")?.getattr("__file__")?.extract()?;
    let script = words.first().map(PathBuf::from).and_then(|script| script.canonicalize().ok());
    let started = Started { program: script.filter(|script| script.is_file()), code: Some(library_of(code)), words };
    Ok(py.detach(|| main_of(started)) as u8)
}

/// The library of a module that maturin wraps in a folder: `hypercircle/__init__.py` stands beside it.
fn library_of(module: PathBuf) -> PathBuf {
    let beside = module.parent().and_then(|folder| std::fs::read_dir(folder).ok()).into_iter().flatten().flatten();
    let is_library = |path: &PathBuf| path.extension().is_some_and(|end| end == "so");
    beside.map(|entry| entry.path()).find(is_library).unwrap_or(module)
}
