//! The library from Python: scenes, solutions, certificates, and the element workbench.
//!
//! A thin layer: options are read by the command line, runs are those of its commands, and errors have its words. Arrays of
//! numbers are NumPy's.

mod answers;
mod arrays;
mod aside;
mod beside;
mod certificate;
mod element;
mod errors;
mod kinematics;
mod line;
mod own_element;
mod problem;
mod program;
mod scene;
mod solution;
mod workbench;

use pyo3::prelude::*;

/// The Python object that a text in JSON represents.
fn from_json(py: Python<'_>, text: serde_json::Result<String>) -> PyResult<Bound<'_, PyAny>> {
    py.import("json")?.call_method1("loads", (text.map_err(errors::fault)?,))
}

/// Guaranteed two-sided energy bounds for contact, and what is wrong with an element or a field.
#[pymodule]
fn hypercircle(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    errors::add(module)?;
    module.add_class::<scene::Scene>()?;
    module.add_class::<solution::Solution>()?;
    module.add_class::<answers::Quantity>()?;
    module.add_class::<answers::ContactAnswer>()?;
    module.add_class::<certificate::Certificate>()?;
    module.add_function(wrap_pyfunction!(beside::field, module)?)?;
    module.add_function(wrap_pyfunction!(beside::job, module)?)?;
    module.add_function(wrap_pyfunction!(program::main, module)?)?;
    module.add_function(wrap_pyfunction!(workbench::workbench, module)?)?;
    module.add_function(wrap_pyfunction!(element::element, module)?)?;
    module.add_function(wrap_pyfunction!(element::flexibility, module)?)?;
    module.add_function(wrap_pyfunction!(element::side_map, module)?)
}
