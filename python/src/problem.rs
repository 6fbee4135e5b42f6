//! A scene on its mesh, as dictionaries.

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use hypercircle::elasticity::{Anisotropic, Elasticity, Matrix, Orthotropic};
use hypercircle::problem::{Condition, Interface, Problem};
use hypercircle::scene::Body;

/// Everything that is asked on the mesh: see [`super::scene::Scene::problem`].
pub fn problem_entry<'py>(py: Python<'py>, problem: Problem) -> PyResult<Bound<'py, PyDict>> {
    let Problem { scene, mesh, conditions, interfaces, .. } = problem;
    let numpy = py.import("numpy")?;
    let numbers = |rows: Vec<[f64; 2]>| super::arrays::made(py, rows);
    let indices = |rows: Bound<'py, PyAny>| numpy.call_method1("asarray", (rows, "intp"));
    let out = PyDict::new(py);
    out.set_item("kinematics", scene.kinematics.name())?;
    out.set_item("thickness", scene.thickness)?;
    out.set_item("bodies", list(py, &scene.bodies, body_entry)?)?;
    out.set_item("points", numbers(mesh.points.iter().map(|p| scene.as_written(*p)).collect())?)?;
    let quadrilaterals: Vec<[usize; 4]> = mesh.quadrilaterals().map(|cell| cell.corners).collect();
    let quadrilaterals = indices(quadrilaterals.into_pyobject(py)?.into_any())?.call_method1("reshape", (-1, 4))?;
    out.set_item("quadrilaterals", quadrilaterals)?;
    out.set_item("triangles", indices(mesh.triangles.into_pyobject(py)?)?)?;
    out.set_item("body", indices(mesh.body.into_pyobject(py)?)?)?;
    let names: Vec<Option<&str>> =
        mesh.edges.iter().map(|e| e.name.and_then(|name| mesh.names.get(name)).map(String::as_str)).collect();
    out.set_item("boundaries", names)?;
    let edges: Vec<[usize; 2]> = mesh.edges.iter().map(|e| e.vertices).collect();
    out.set_item("edges", indices(edges.into_pyobject(py)?)?)?;
    out.set_item("triangle_edges", indices(mesh.triangle_edges.into_pyobject(py)?)?)?;
    let known = list(py, &conditions, condition_entry)?;
    out.set_item("conditions", known)?;
    out.set_item("interfaces", list(py, &interfaces, interface_entry)?)?;
    Ok(out)
}

/// A list of what `entry` makes of each.
pub fn list<'py, T>(
    py: Python<'py>,
    all: &[T],
    entry: impl Fn(Python<'py>, &T) -> PyResult<Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyList>> {
    PyList::new(py, all.iter().map(|one| entry(py, one)).collect::<PyResult<Vec<_>>>()?)
}

/// A body: `name`, `body_force` and the constants of its material: `young` and `poisson`, or `orthotropic` with `young`, `poisson`,
/// `shear` and `angle`, or a matrix, `stiffness` or `compliance`, and `angle`. A `body_force` that is not constant has `value` and `gradient`.
pub fn body_entry<'py>(py: Python<'py>, body: &Body) -> PyResult<Bound<'py, PyDict>> {
    let entry = PyDict::new(py);
    entry.set_item("name", &body.name)?;
    match &body.elasticity {
        Elasticity::Isotropic { young, poisson } => {
            entry.set_item("young", young)?;
            entry.set_item("poisson", poisson)?;
        }
        Elasticity::Orthotropic(Orthotropic { young, poisson, shear, angle }) => {
            let law = PyDict::new(py);
            law.set_item("young", young)?;
            law.set_item("poisson", poisson)?;
            law.set_item("shear", shear)?;
            law.set_item("angle", angle)?;
            entry.set_item("orthotropic", law)?;
        }
        Elasticity::Anisotropic(Anisotropic { kind, matrix, angle }) => {
            match matrix {
                Matrix::Three(rows) => entry.set_item(kind.key(), rows.map(|row| row.to_vec()).to_vec())?,
                Matrix::Six(rows) => entry.set_item(kind.key(), rows.map(|row| row.to_vec()).to_vec())?,
            }
            entry.set_item("angle", angle)?;
        }
    }
    let force = body.body_force.as_affine();
    if force.is_constant() {
        entry.set_item("body_force", force.value)?;
    } else {
        let field = PyDict::new(py);
        field.set_item("value", force.value)?;
        field.set_item("gradient", force.gradient)?;
        entry.set_item("body_force", field)?;
    }
    Ok(entry)
}

fn condition_entry<'py>(py: Python<'py>, condition: &Condition) -> PyResult<Bound<'py, PyDict>> {
    let entry = PyDict::new(py);
    let kind = match condition {
        Condition::Interior => "interior",
        Condition::Axis => "axis",
        Condition::Traction(values) => {
            entry.set_item("values", *values)?;
            "traction"
        }
        Condition::Clamped([first, last]) => {
            match first == last {
                true => entry.set_item("displacement", *first)?,
                false => entry.set_item("displacement", [*first, *last])?,
            }
            "clamped"
        }
        Condition::Roller { direction, displacement } => {
            entry.set_item("normal", *direction)?;
            entry.set_item("displacement", *displacement)?;
            "roller"
        }
        Condition::Contact { .. } => "contact",
        Condition::Elastic { .. } => "elastic",
    };
    entry.set_item("kind", kind)?;
    Ok(entry)
}

fn interface_entry<'py>(py: Python<'py>, interface: &Interface) -> PyResult<Bound<'py, PyDict>> {
    let pairs = PyList::empty(py);
    for pair in &interface.pairs {
        let entry = PyDict::new(py);
        entry.set_item("edges", pair.edges)?;
        entry.set_item("first", pair.first)?;
        entry.set_item("second", pair.second)?;
        entry.set_item("normal", pair.normal)?;
        entry.set_item("direction", pair.direction.ends)?;
        entry.set_item("length", pair.length)?;
        entry.set_item("gap", pair.gap)?;
        if let Some(k) = pair.stiffness {
            entry.set_item("stiffness", k)?;
        }
        if !pair.bow.is_none() {
            entry.set_item("gap_polynomial", pair.gap_polynomial())?;
        }
        pairs.append(entry)?;
    }
    let out = PyDict::new(py);
    out.set_item("name", &interface.name)?;
    out.set_item("pairs", pairs)?;
    Ok(out)
}
