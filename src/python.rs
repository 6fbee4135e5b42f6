//! The library from Python, for tests that hold it against independent models.
//!
//! Arrays are nested lists; whatever cannot be computed raises `ValueError` with the message of the library.

mod workbench;

use std::path::Path;

use clap::ValueEnum;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::cli::options::Method;
use crate::cli::session::method as solver;
use crate::dual::Options;
use crate::element::subtriangle::{self, Moments};
use crate::element::{Block, Compliance, Elements, EquilibriumElement, MAX_DEGREE, SideValues, block};
use crate::problem::{Condition, Interface, Problem};
use crate::scene::{Kinematics, Scene};
use crate::study;

fn fault(error: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}

fn kinematics_named(name: &str) -> PyResult<Kinematics> {
    match name {
        "plane-strain" => Ok(Kinematics::PlaneStrain),
        "plane-stress" => Ok(Kinematics::PlaneStress),
        other => Err(fault(format!("kinematics '{other}': use plane-strain or plane-stress"))),
    }
}

/// A counter-clockwise triangle with finite corners.
fn proper(corners: [[f64; 2]; 3]) -> PyResult<[[f64; 2]; 3]> {
    let [a, b, c] = corners;
    let twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    if twice > 0.0 && twice.is_finite() {
        Ok(corners)
    } else {
        Err(fault(format!("the corners {corners:?} are no counter-clockwise triangle")))
    }
}

/// Modes of the block element on a counter-clockwise triangle: `traction` 12 × 9, `stress` 9 × 3 × 9 (node, component,
/// mode), `particular_traction` 12, `particular_stress` 9 × 3, `particular_energy`.
///
/// # Errors
/// `ValueError` for a triangle or a material that is none.
#[pyfunction]
#[pyo3(signature = (corners, young, poisson, kinematics, body_force = [0.0, 0.0]))]
fn element<'py>(
    py: Python<'py>,
    corners: [[f64; 2]; 3],
    young: f64,
    poisson: f64,
    kinematics: &str,
    body_force: [f64; 2],
) -> PyResult<Bound<'py, PyDict>> {
    let corners = proper(corners)?;
    let elastic = young > 0.0 && young.is_finite() && poisson > -1.0 && poisson < 0.5;
    if !elastic || !body_force.iter().all(|f| f.is_finite()) {
        return Err(fault("young must be above zero, poisson in (-1, 1/2), and body_force finite"));
    }
    let material = Compliance::new(kinematics_named(kinematics)?, young, poisson);
    let modes = Block.modes(corners, &material, body_force);
    let count = modes.parameters();
    let fields = Block.mode_stresses(corners, &modes);
    let value = |node: usize, c: usize| (0..count).map(|k| fields[k][node][c]).collect::<Vec<f64>>();
    let stress: Vec<Vec<Vec<f64>>> = (0..9).map(|node| (0..3).map(|c| value(node, c)).collect()).collect();
    let row = |i: usize| modes.tractions().map(|mode| mode[i]).collect::<Vec<f64>>();
    let traction: Vec<Vec<f64>> = (0..Block.tractions()).map(row).collect();
    let mut particular = vec![[0.0; 3]; 9];
    Block.stresses(corners, body_force, &modes, &vec![0.0; count], 1.0, &mut particular);
    let out = PyDict::new(py);
    out.set_item("traction", traction)?;
    out.set_item("stress", stress)?;
    out.set_item("particular_traction", modes.particular_traction().to_vec())?;
    out.set_item("particular_stress", particular.iter().map(|v| v.to_vec()).collect::<Vec<_>>())?;
    out.set_item("particular_energy", modes.particular_energy())?;
    Ok(out)
}

/// The flexibility f of (3.2), 7 × 7, of a triangle about its centre of gravity, for the constants α, β, γ.
///
/// # Errors
/// `ValueError` for a triangle that is none.
#[pyfunction]
fn flexibility(corners: [[f64; 2]; 3], constants: [f64; 3]) -> PyResult<Vec<Vec<f64>>> {
    let f = subtriangle::flexibility(&Moments::new(proper(corners)?), constants);
    Ok((0..7).map(|i| (0..7).map(|j| f[(i, j)]).collect()).collect())
}

/// The side matrix C of (3.4), 4 × 7, of the side from `a` to `b`.
///
/// # Errors
/// `ValueError` where the two points are one.
#[pyfunction]
fn side_map(a: [f64; 2], b: [f64; 2]) -> PyResult<Vec<Vec<f64>>> {
    let length = (b[0] - a[0]).hypot(b[1] - a[1]);
    if length == 0.0 || !length.is_finite() {
        return Err(fault(format!("{a:?} and {b:?} are not the ends of a side")));
    }
    let c = subtriangle::side_map(a, b);
    Ok((0..4).map(|i| (0..7).map(|j| c[(i, j)]).collect()).collect())
}

fn load(path: &str) -> PyResult<Problem> {
    Problem::load(Scene::read(Path::new(path)).map_err(fault)?).map_err(fault)
}

/// Stresses of one degree, or of a degree for each of `triangles` triangles.
fn elements(degree: Option<usize>, degrees: Option<Vec<usize>>, triangles: usize) -> PyResult<Elements> {
    let known = |p: usize| match p {
        1..=MAX_DEGREE => Ok(p),
        _ => Err(fault(format!("degree {p}: stresses have degrees 1 to {MAX_DEGREE}"))),
    };
    match (degree, degrees) {
        (Some(_), Some(_)) => Err(fault("give degree or degrees, not both")),
        (degree, None) => Ok(Elements::Uniform(block(known(degree.unwrap_or(1))?))),
        (None, Some(degrees)) if degrees.len() != triangles => {
            Err(fault(format!("{} degrees for {triangles} triangles", degrees.len())))
        }
        (None, Some(degrees)) => {
            let all: PyResult<Vec<u8>> = degrees.into_iter().map(|p| Ok(known(p)? as u8)).collect();
            Ok(Elements::Blocks(all?.into()))
        }
    }
}

/// The dual solution of a scene: energies, bracket, `contact_traction` (interface, pair, coefficient), `degrees` (triangle),
/// `stress` (triangle, node, component), `moments` (edge, coefficient, component), `closed`, and `quantities`: for each of the
/// scene `name`, `kind`, `value` (`None` where it is not known), the ends `lower` and `upper` of the interval that holds the exact
/// value (infinite where nothing is guaranteed), `first_order`, `exact_by_statics`, and the `reason` why an end is missing.
///
/// `degree` is the polynomial degree of the stresses, 1 where nothing is said; `degrees` has one for each triangle. A triangle of
/// degree p has (p + 1)(p + 2)/2 nodes on each of its three parts, an edge p + 1 coefficients with the larger of the degrees at
/// it.
///
/// # Errors
/// `ValueError` where the scene or a degree is refused, or where there is no solution.
#[pyfunction]
#[pyo3(signature = (scene, method = "condensed", degree = None, degrees = None))]
fn solve<'py>(
    py: Python<'py>,
    scene: &str,
    method: &str,
    degree: Option<usize>,
    degrees: Option<Vec<usize>>,
) -> PyResult<Bound<'py, PyDict>> {
    let method = Method::from_str(method, false).map_err(fault)?;
    let problem = load(scene)?;
    let elements = elements(degree, degrees, problem.mesh.triangles.len())?;
    study::refuse_quantities(&problem).map_err(fault)?;
    let keep_factor = !problem.scene.quantities.is_empty();
    let options = Options { elements, keep_factor, ..Options::default() };
    let (certified, answers) = py
        .detach(|| {
            let certified = study::certify(problem, solver(method).as_ref(), &options).map_err(|e| e.to_string())?;
            let answers = study::answers(&certified, &options, |_| true);
            Ok::<_, String>((certified, answers))
        })
        .map_err(fault)?;
    let study::Certified { dual, bracket, .. } = &certified;
    let complementary = &bracket.complementary;
    let out = PyDict::new(py);
    out.set_item("method", dual.method)?;
    out.set_item("energy", complementary.lower())?;
    out.set_item("lower", bracket.lower())?;
    out.set_item("upper", bracket.free.as_ref().ok().map(|free| free.upper()))?;
    out.set_item("gap_local", bracket.free.as_ref().ok().map(|free| free.local.total))?;
    out.set_item("complementary", complementary.strain)?;
    out.set_item("support_work", complementary.support_work)?;
    out.set_item("gap_work", complementary.gap_work)?;
    let traction = |t: &SideValues<f64>| t.iter().map(<[f64]>::to_vec).collect::<Vec<_>>();
    out.set_item("contact_traction", dual.contact_traction.iter().map(traction).collect::<Vec<_>>())?;
    out.set_item("closed", dual.closed.values())?;
    out.set_item("degrees", (0..dual.stress.len()).map(|t| dual.stress.degree(t)).collect::<Vec<_>>())?;
    let stress: Vec<Vec<[f64; 3]>> = (0..dual.stress.len()).map(|t| dual.stress.block(t).to_vec()).collect();
    out.set_item("stress", stress)?;
    out.set_item("moments", dual.moments.iter().map(<[[f64; 2]]>::to_vec).collect::<Vec<_>>())?;
    out.set_item("equilibrium_residual", dual.equilibrium.residual())?;
    out.set_item("iterations", dual.iterations)?;
    out.set_item("unknowns", dual.unknowns)?;
    let quantities = PyList::empty(py);
    for answer in &answers {
        quantities.append(quantity_entry(py, answer)?)?;
    }
    out.set_item("quantities", quantities)?;
    Ok(out)
}

fn quantity_entry<'py>(py: Python<'py>, answer: &study::Answer) -> PyResult<Bound<'py, PyDict>> {
    let interval = &answer.interval;
    let entry = PyDict::new(py);
    entry.set_item("name", &answer.name)?;
    entry.set_item("kind", answer.kind.name())?;
    entry.set_item("value", Some(interval.value).filter(|value| value.is_finite()))?;
    entry.set_item("lower", interval.ends[0])?;
    entry.set_item("upper", interval.ends[1])?;
    entry.set_item("first_order", interval.first_order)?;
    entry.set_item("exact_by_statics", interval.exact_by_statics)?;
    entry.set_item("reason", interval.reasons.iter().flatten().next())?;
    Ok(entry)
}

/// A scene on its mesh: `points`, `triangles`, `body`, `edges`, `triangle_edges`, `conditions` of the edges,
/// `interfaces`, `bodies`, `kinematics`, `thickness`.
///
/// # Errors
/// `ValueError` where scene or mesh are refused.
#[pyfunction]
fn problem<'py>(py: Python<'py>, scene: &str) -> PyResult<Bound<'py, PyDict>> {
    let Problem { scene, mesh, conditions, interfaces, .. } = load(scene)?;
    let out = PyDict::new(py);
    let strain = scene.kinematics == Kinematics::PlaneStrain;
    out.set_item("kinematics", if strain { "plane-strain" } else { "plane-stress" })?;
    out.set_item("thickness", scene.thickness)?;
    let bodies = PyList::empty(py);
    for body in &scene.bodies {
        let entry = PyDict::new(py);
        entry.set_item("name", &body.name)?;
        entry.set_item("young", body.young)?;
        entry.set_item("poisson", body.poisson)?;
        entry.set_item("body_force", body.body_force)?;
        bodies.append(entry)?;
    }
    out.set_item("bodies", bodies)?;
    out.set_item("points", mesh.points.iter().map(|p| scene.as_written(*p)).collect::<Vec<_>>())?;
    out.set_item("triangles", mesh.triangles)?;
    out.set_item("body", mesh.body)?;
    out.set_item("edges", mesh.edges.iter().map(|e| e.vertices).collect::<Vec<_>>())?;
    out.set_item("triangle_edges", mesh.triangle_edges)?;
    let list = PyList::empty(py);
    for condition in &conditions {
        list.append(condition_entry(py, condition)?)?;
    }
    out.set_item("conditions", list)?;
    let list = PyList::empty(py);
    for interface in &interfaces {
        list.append(interface_entry(py, interface)?)?;
    }
    out.set_item("interfaces", list)?;
    Ok(out)
}

fn condition_entry<'py>(py: Python<'py>, condition: &Condition) -> PyResult<Bound<'py, PyDict>> {
    let entry = PyDict::new(py);
    let kind = match condition {
        Condition::Interior => "interior",
        Condition::Traction(values) => {
            entry.set_item("values", *values)?;
            "traction"
        }
        Condition::Clamped(displacement) => {
            entry.set_item("displacement", *displacement)?;
            "clamped"
        }
        Condition::Roller => "roller",
        Condition::Contact { .. } => "contact",
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
        entry.set_item("length", pair.length)?;
        entry.set_item("gap", pair.gap)?;
        pairs.append(entry)?;
    }
    let out = PyDict::new(py);
    out.set_item("name", &interface.name)?;
    out.set_item("pairs", pairs)?;
    Ok(out)
}

/// The module `hypercircle`.
#[pymodule]
fn hypercircle(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_function(wrap_pyfunction!(element, module)?)?;
    module.add_function(wrap_pyfunction!(flexibility, module)?)?;
    module.add_function(wrap_pyfunction!(side_map, module)?)?;
    module.add_function(wrap_pyfunction!(solve, module)?)?;
    module.add_function(wrap_pyfunction!(problem, module)?)?;
    module.add_function(wrap_pyfunction!(workbench::workbench, module)?)
}
