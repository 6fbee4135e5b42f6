//! The element workbench from Python.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use nalgebra::DMatrix;
use pyo3::exceptions::PyException;
use pyo3::prelude::*;

use crate::errors::fault;
use crate::kinematics::kinematics_named;
use crate::own_element::{is_element, spanned};
use hypercircle::scene::Kinematics;
use hypercircle::workbench::stress::SolverElement;
use hypercircle::workbench::{DisplacementElement, Material, Options, Order, Report, is_property};

/// How exact the entries of an array in single precision are, relative to the largest.
const SINGLE: f64 = 1e-5;

/// Rows of numbers as a matrix.
fn matrix(object: &Bound<'_, PyAny>) -> Result<DMatrix<f64>, String> {
    let rows: Vec<Vec<f64>> = object.extract().map_err(|e| format!("a matrix is an array of rows of numbers: {e}"))?;
    let columns = rows.first().map_or(0, Vec::len);
    match rows.iter().position(|row| row.len() != columns) {
        Some(i) => Err(format!("row {i} has {} numbers and row 0 has {columns}", rows[i].len())),
        None => Ok(DMatrix::from_row_slice(rows.len(), columns, &rows.concat())),
    }
}

/// Raises what ended a formula, if anything did.
fn raised(ended: &Mutex<Option<PyErr>>) -> PyResult<()> {
    ended.lock().unwrap_or_else(PoisonError::into_inner).take().map_or(Ok(()), Err)
}

/// K with two rows a node, by the Python callable `stiffness(nodes, young, poisson)`.
fn called(
    stiffness: &Py<PyAny>,
    nodes: &[[f64; 2]],
    material: &Material,
    order: Order,
    ended: &Mutex<Option<PyErr>>,
) -> Result<DMatrix<f64>, String> {
    Python::attach(|py| {
        let mut ended = ended.lock().unwrap_or_else(PoisonError::into_inner);
        if ended.is_some() {
            return Err("interrupted".to_string());
        }
        let rows: Vec<Vec<f64>> = nodes.iter().map(|x| x.to_vec()).collect();
        let array = py.import("numpy").and_then(|numpy| numpy.call_method1("array", (rows,)));
        let found = array.and_then(|nodes| stiffness.call1(py, (nodes, material.young, material.poisson)));
        let found = found.and_then(|k| py.check_signals().map(|()| k)).map_err(|error| {
            let said = error.to_string();
            // What is no error of the formula ends the call: ctrl-C, and an exit.
            if !error.is_instance_of::<PyException>(py) {
                *ended = Some(error);
            }
            said
        })?;
        drop(ended);
        let k = matrix(found.bind(py))?;
        let (count, size) = (nodes.len(), 2 * nodes.len());
        if k.shape() != (size, size) {
            return Err(format!("K is {} × {} for {count} nodes", k.nrows(), k.ncols()));
        }
        let place = |i: usize| order.place(count, i / 2, i % 2);
        Ok(DMatrix::from_fn(size, size, |i, j| material.thickness * k[(place(i), place(j))]))
    })
}

/// What is right and what is wrong with a displacement element: a dictionary with `passed`, `verdict`, `diagnosis` (`cause`, `explained`,
/// `sentence`, or `None`), `hint` (what to say of the input, or `None`), `untold` (what a matrix of one shape cannot tell; `None` with a
/// formula) and `findings`, each with `name`, `asks`, `claim`, `value`, `allowed`, `passed` and `sentence`.
///
/// `element` is a stiffness matrix (an array of 2n rows), or what makes one: a callable `stiffness(nodes, young, poisson)`, or an object
/// with such a method. It is given an n × 2 array and returns K per unit thickness; with it shapes, Poisson's ratios and solved
/// scenes are looked at too. `nodes` are n points (x, y). `order` is `interleaved` (x0, y0, x1, …) or `blocked` (x0, x1, …, y0, …).
/// `waive` and `claim` name properties that the element does not claim, and that it claims beside the usual ones. With `out`,
/// report.json, report.html and junit.xml go into that folder. `passed` is `None` for a property that was not made.
///
/// An object with `degree` and a method `stresses(corners)` is an equilibrium element: its stresses are looked at, and `waive`, `claim` and
/// `out` are all that it takes. `stresses` is given a 3 × 2 array and returns m fields that span its space, m × 3 subtriangles × nodes ×
/// (xx, yy, xy); subtriangle i has the corners (a_{i+1}, a_{i+2}, centroid), and nodes as `Solution.stress_points` has them. A method
/// `particular(corners, body_force)` may return the field that balances a body force.
///
/// With `kinematics = "axisymmetric"` points are (r, z), and K is that of the full turn about r = 0.
///
/// Raises `InputError` for a matrix, nodes or a material that are none.
#[pyfunction]
#[pyo3(signature = (element, nodes = None, young = None, poisson = None, kinematics = "plane-strain", thickness = 1.0, order = "interleaved",
    precision = None, waive = Vec::new(), claim = Vec::new(), name = "element", out = None))]
#[allow(clippy::too_many_arguments)]
pub fn workbench<'py>(
    py: Python<'py>,
    element: &Bound<'py, PyAny>,
    nodes: Option<Vec<[f64; 2]>>,
    young: Option<f64>,
    poisson: Option<f64>,
    kinematics: &str,
    thickness: f64,
    order: &str,
    precision: Option<f64>,
    waive: Vec<String>,
    claim: Vec<String>,
    name: &str,
    out: Option<PathBuf>,
) -> PyResult<Bound<'py, PyAny>> {
    let order = match order {
        "interleaved" => Order::Interleaved,
        "blocked" => Order::Blocked,
        other => return Err(fault(format!("order '{other}': use interleaved or blocked"))),
    };
    if let Some(name) = waive.iter().chain(&claim).find(|name| !is_property(name)) {
        return Err(fault(format!("no property is called '{name}'; the findings name them")));
    }
    let options = Options { waived: waive, claimed: claim };
    if is_element(element)? {
        if nodes.is_some() || young.is_some() || poisson.is_some() {
            return Err(fault(
                "an equilibrium element is looked at on triangles and materials of many kinds; leave out nodes, young and poisson",
            ));
        }
        let own = spanned(element)?;
        let report = py.detach(move || Report::of_stress(&SolverElement(own), &options));
        if let Some(reason) = own.fault() {
            return Err(fault(reason));
        }
        return written(py, &report, out);
    }
    let nodes = nodes.ok_or_else(|| fault("a displacement element has nodes; give one row x, y for each"))?;
    let state = kinematics_named(kinematics)?;
    let material = |young, poisson| Material::new(state, young, poisson, thickness).map_err(fault);
    let given = match (young, poisson) {
        (Some(young), Some(poisson)) => Some(material(young, poisson)?),
        (None, None)
            if state == Kinematics::Axisymmetric
                && !element.is_callable()
                && element.getattr_opt("stiffness")?.is_none() =>
        {
            return Err(fault("a matrix of a body of revolution is held against its material; give young and poisson"));
        }
        (None, None) => None,
        _ => return Err(fault("give young and poisson, or neither")),
    };
    let method = element.getattr_opt("stiffness")?.or_else(|| element.is_callable().then(|| element.clone()));
    let ended = Arc::new(Mutex::new(None));
    let made = match method {
        Some(stiffness) => {
            let (stiffness, ended) = (stiffness.unbind(), Arc::clone(&ended));
            let usual = material(1.0, 0.3)?;
            DisplacementElement::of_formula(name, nodes, given.unwrap_or(usual), move |nodes, material| {
                called(&stiffness, nodes, material, order, &ended)
            })
        }
        None => matrix(element).and_then(|k| DisplacementElement::of_matrix(name, &k, nodes, order, given)),
    };
    raised(&ended)?;
    let made = made.map_err(fault)?;
    let usual = made.precision;
    let is_single = element.getattr_opt("dtype")?.is_some_and(|kind| kind.to_string() == "float32");
    let precision = precision.or(is_single.then_some(SINGLE));
    let said = precision.map(hypercircle::workbench::precision).transpose().map_err(fault)?;
    let made = made.with_precision(said.unwrap_or(usual));
    // The formula comes back for the interpreter.
    let report = py.detach(move || Report::of_displacement(&made, &options));
    raised(&ended)?;
    written(py, &report, out)
}

/// The report as a dictionary, and in the folder `out`.
fn written<'py>(py: Python<'py>, report: &Report, out: Option<PathBuf>) -> PyResult<Bound<'py, PyAny>> {
    if let Some(out) = out {
        report.write(&out).map_err(fault)?;
    }
    super::from_json(py, serde_json::to_string(report))
}
