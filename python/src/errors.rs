//! Failures as Python exceptions, with the words of the command line.

use pyo3::create_exception;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;

use hypercircle::cli::{CliError, Exit};

create_exception!(
    hypercircle,
    InputError,
    PyValueError,
    "A scene, mesh, field, matrix or option that cannot be used. `remedy` says what to do."
);
create_exception!(
    hypercircle,
    InfeasibleError,
    PyRuntimeError,
    "The scene has no equilibrium: something moves, and nothing holds it. `remedy` says what to do."
);
create_exception!(
    hypercircle,
    SolveError,
    PyRuntimeError,
    "A solver gave no answer, or would take more memory than it may. `remedy` says what to do."
);

/// Adds the exceptions to the module; `remedy` is there before one is raised.
pub fn add(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    let all = [py.get_type::<InputError>(), py.get_type::<InfeasibleError>(), py.get_type::<SolveError>()];
    for (name, exception) in ["InputError", "InfeasibleError", "SolveError"].into_iter().zip(all) {
        exception.setattr("remedy", "")?;
        module.add(name, exception)?;
    }
    Ok(())
}

/// An [`InputError`] of a message that ends with its remedy, after a semicolon.
pub fn fault(error: impl std::fmt::Display) -> PyErr {
    raised(Exit::BadInput, error.to_string(), "")
}

/// The exception for an answer that ends with `exit`.
pub fn raised(exit: Exit, message: String, remedy: &str) -> PyErr {
    let (message, remedy) = match (remedy, message.rsplit_once("; ")) {
        ("", None) => (message, String::new()),
        ("", Some((_, end))) => (message.clone(), end.to_string()),
        (remedy, _) if message.ends_with(remedy) => (message, remedy.to_string()),
        (remedy, _) => (format!("{message}; {remedy}"), remedy.to_string()),
    };
    let error = match exit {
        Exit::NoEquilibrium => InfeasibleError::new_err(message),
        Exit::Failed | Exit::NotInstalled => SolveError::new_err(message),
        Exit::BadInput | Exit::Agree | Exit::Disagree => InputError::new_err(message),
    };
    Python::attach(|py| match error.value(py).setattr("remedy", remedy) {
        Ok(()) => error,
        Err(other) => other,
    })
}

/// The exception for an error of the command line.
pub fn told(error: CliError) -> PyErr {
    match &error {
        CliError::Scene(scene) => raised(error.exit(), scene.to_string(), &scene.remedy()),
        CliError::Stopped { message, remedy, exit } => raised(*exit, message.clone(), remedy),
    }
}
