//! An equilibrium element as a Python class.

use pyo3::prelude::*;

use crate::errors::fault;
use hypercircle::element::spanned::{Balances, Corners, Nodal};
use hypercircle::element::{EquilibriumElement, MAX_DEGREE, Spanned};
use hypercircle::problem::Problem;
use hypercircle::workbench::stress::{Fields, divergence, inner_jump};

/// Largest violation of equilibrium by stresses, relative to their size, where a bound rests on it.
const BALANCED: f64 = 1e-9;

/// True if an object is such an element.
pub fn is_element(object: &Bound<'_, PyAny>) -> PyResult<bool> {
    Ok(object.getattr_opt("stresses")?.is_some_and(|method| method.is_callable()))
}

/// The element of a Python object with a `degree` and a method `stresses(corners)`, and where it likes `particular(corners, body_force)`
/// and a `name`. It stays for as long as the program runs.
///
/// # Errors
/// `InputError` for an object that is no element; what its methods raise.
pub fn spanned(object: &Bound<'_, PyAny>) -> PyResult<&'static Spanned> {
    if !is_element(object)? {
        return Err(fault(
            "an element has an attribute degree and a method stresses(corners); write them as docs/workbench.md shows",
        ));
    }
    let missing = || fault("the element has no degree; give its class an attribute degree, the degree of its stresses");
    let degree: usize = object.getattr_opt("degree")?.ok_or_else(missing)?.extract()?;
    if !(1..=MAX_DEGREE).contains(&degree) {
        return Err(fault(format!("degree {degree} of the element is not in 1..={MAX_DEGREE}; use one of these")));
    }
    let name: String = match object.getattr_opt("name")? {
        Some(name) => name.extract()?,
        None => object.get_type().name()?.extract()?,
    };
    let method = object.getattr("stresses")?.unbind();
    let spans = move |corners: Corners| called(&method, corners, None).and_then(|array| fields(&array));
    let balances = object.getattr_opt("particular")?.map(Bound::unbind).map(|method| -> Box<Balances> {
        Box::new(move |corners, force| {
            let array = called(&method, corners, Some(force))?;
            let one = Python::attach(|py| array.bind(py).call_method1("__getitem__", (py.None(),)).map(Bound::unbind));
            fields(&one.map_err(|e| e.to_string())?).map(|mut all| all.swap_remove(0))
        })
    });
    let element = Spanned::new(Box::leak(name.into_boxed_str()), degree, Box::new(spans), balances);
    // The dual methods borrow their elements for ever.
    Ok(Box::leak(Box::new(element.map_err(|reason| fault(format!("stresses of the element: {reason}")))?)))
}

/// The return value of a method for corners, and for a body force, as an array of numbers.
fn called(method: &Py<PyAny>, corners: Corners, force: Option<[f64; 2]>) -> Result<Py<PyAny>, String> {
    Python::attach(|py| {
        let numpy = py.import("numpy")?;
        let corners = numpy.call_method1("array", (corners.map(|p| p.to_vec()).to_vec(),))?;
        let found = match force {
            Some(force) => method.call1(py, (corners, numpy.call_method1("array", (force.to_vec(),))?))?,
            None => method.call1(py, (corners,))?,
        };
        numpy.call_method1("asarray", (found, "float64")).map(Bound::unbind)
    })
    .map_err(|error: PyErr| error.to_string())
}

/// m fields from an array m × 3 × nodes × 3.
fn fields(array: &Py<PyAny>) -> Result<Vec<Nodal>, String> {
    Python::attach(|py| {
        let array = array.bind(py);
        let shape: Vec<usize> = array.getattr("shape").and_then(|s| s.extract()).map_err(|e: PyErr| e.to_string())?;
        let [count, 3, nodes, 3] = shape[..] else {
            return Err(format!(
                "an array of the shape {shape:?}; fields × 3 subtriangles × nodes × 3 (xx, yy, xy) is wanted"
            ));
        };
        let flat = array.call_method1("reshape", ((count, 3 * nodes, 3),)).and_then(|rows| rows.call_method0("tolist"));
        flat.and_then(|rows| rows.extract()).map_err(|e| e.to_string())
    })
}

/// Checks that the stresses of `element` balance on every triangle of `problem`: bounds are guaranteed only where they do.
///
/// # Errors
/// The error that a method raised, or the first triangle on which they do not balance.
pub fn balanced(element: &'static Spanned, problem: &Problem) -> Result<(), String> {
    let (mesh, materials) = (&problem.mesh, problem.materials());
    for (t, &body) in mesh.body.iter().enumerate() {
        if !problem.body_force(t).is_constant() {
            let body = &problem.scene.bodies[body].name;
            return Err(format!(
                "the body force of {body} is not constant, and {} is told of constant ones alone: solve with degree = 2",
                element.name()
            ));
        }
        let force = problem.force_on(t).mean();
        let fields = Fields::of(element, mesh.corners(t), &materials[body], force);
        if let Some(reason) = element.fault() {
            return Err(reason);
        }
        let corners = mesh.corners(t).map(|p| problem.scene.as_written(p));
        for (what, off) in [("divergence", divergence(&fields)), ("jump of tractions inside", inner_jump(&fields))] {
            if off.is_nan() || off > BALANCED {
                return Err(format!(
                    "{} has stresses with a {what} of {off:.1e} of their size on the triangle {corners:?}: no bound follows from \
                     them; hypercircle.workbench(element) says more",
                    element.name()
                ));
            }
        }
    }
    Ok(())
}
