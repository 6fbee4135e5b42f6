//! Parts of the module that are written in Python: tables, notebooks, pictures, fields of other programs, jobs.

use std::ffi::CString;
use std::path::Path;

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyDict, PyModule};

use crate::errors::{fault, raised};
use crate::line::Line;
use hypercircle::cli::Exit;

static BESIDE: PyOnceLock<Py<PyModule>> = PyOnceLock::new();

/// The module of `beside.py`.
fn beside(py: Python<'_>) -> PyResult<&Bound<'_, PyModule>> {
    let made = || -> PyResult<Py<PyModule>> {
        let text = CString::new(include_str!("beside.py")).map_err(fault)?;
        Ok(PyModule::from_code(py, &text, c"hypercircle/beside.py", c"hypercircle.beside")?.unbind())
    };
    Ok(BESIDE.get_or_try_init(py, made)?.bind(py))
}

/// `ValueError` as the error of this module that says so.
fn known(error: PyErr) -> PyErr {
    Python::attach(
        |py| if error.get_type(py).is(py.get_type::<PyValueError>()) { fault(error.value(py)) } else { error },
    )
}

/// The text of a scene whose tables are dictionaries.
///
/// # Errors
/// `InputError` for values that no scene has.
pub fn toml(data: &Bound<'_, PyDict>) -> PyResult<String> {
    beside(data.py())?.call_method1("toml", (data,)).map_err(known)?.extract()
}

/// A copy of a part of a report, to be handed out: a change of it changes no verdict.
///
/// # Errors
/// Of the interpreter alone.
pub fn copied<'py>(part: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    beside(part.py())?.call_method1("copied", (part,))
}

/// A list of a report as columns.
///
/// # Errors
/// `InputError` where the report has no such list.
pub fn table<'py>(report: &Bound<'py, PyAny>, name: &str) -> PyResult<Bound<'py, PyAny>> {
    beside(report.py())?.call_method1("table", (report, name)).map_err(known)
}

/// A report for a notebook.
///
/// # Errors
/// Of the interpreter alone.
pub fn page<'py>(report: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    beside(report.py())?.call_method1("page", (report,))
}

/// `solution` as a grid of PyVista.
///
/// # Errors
/// `ImportError` without PyVista.
pub fn grid<'py>(solution: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    beside(solution.py())?.call_method1("grid", (solution,))
}

/// The chart of a scene in a file, in the folder `out`: what `chart.json` holds.
///
/// # Errors
/// What the command line refuses.
pub fn chart<'py>(py: Python<'py>, scene: &Path, out: &Path, options: Line) -> PyResult<Bound<'py, PyAny>> {
    kept(beside(py)?.call_method1("chart", (scene, out, options.words()))?)
}

/// What a command left in its folder, or why it was refused.
fn kept(found: Bound<'_, PyAny>) -> PyResult<Bound<'_, PyAny>> {
    let (exit, said, kept): (i32, String, Bound<'_, PyAny>) = found.extract()?;
    match kept.is_none() {
        false => Ok(kept),
        true => Err(raised(Exit::of(u8::try_from(exit).unwrap_or(3)), said, "")),
    }
}

/// A picture of `solution`.
///
/// # Errors
/// `InputError` for a value that there is none of, `ImportError` without matplotlib.
pub fn plot<'py>(
    solution: &Bound<'py, PyAny>,
    value: &Bound<'py, PyAny>,
    ax: Option<&Bound<'py, PyAny>>,
    deformed: f64,
    colorbar: bool,
    options: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let py = solution.py();
    let none = PyDict::new(py);
    beside(py)?.call_method1("plot", (solution, value, ax, deformed, colorbar, options.unwrap_or(&none))).map_err(known)
}

/// Points, triangles and displacement of a field of another program, to be handed to `certify` or `diagnose`: of a `dolfinx.fem.Function`,
/// of a scikit-fem basis with its `values`, or of a `meshio.Mesh`, whose point data is called `name`. Real Lagrange vectors of degree 1 and 2
/// on straight-sided triangles are taken.
///
/// Raises `InputError` for others, `TypeError` for what is no field.
#[pyfunction]
#[pyo3(signature = (of, values = None, name = None))]
pub fn field<'py>(
    py: Python<'py>,
    of: &Bound<'py, PyAny>,
    values: Option<&Bound<'py, PyAny>>,
    name: Option<&str>,
) -> PyResult<Bound<'py, PyAny>> {
    beside(py)?.call_method1("field", (of, values, name)).map_err(known)
}

/// Gives many scenes, files and folders of them, to `command` (`verify`, `solve` or `certify`), each in a process of its own and `jobs` at a
/// time, with the reports and one page of them in the folder `out`. `options` are words of the command line, such as `["--refine", "1"]`.
/// Returns what `job.json` holds, a dictionary; `exit` is 0 where all agree.
///
/// Raises `InputError` where the command line is refused. Ctrl-C ends the processes.
#[pyfunction]
#[pyo3(signature = (scenes, command = "verify", *, out, jobs = 1, options = Vec::new()))]
pub fn job<'py>(
    py: Python<'py>,
    scenes: &Bound<'py, PyAny>,
    command: &str,
    out: &Bound<'py, PyAny>,
    jobs: i64,
    options: Vec<String>,
) -> PyResult<Bound<'py, PyAny>> {
    if !["verify", "solve", "certify"].contains(&command) {
        return Err(fault(format!("command '{command}': use one of verify, solve, certify")));
    }
    kept(beside(py)?.call_method1("job", (scenes, command, out, jobs, options))?)
}
