//! The block element, and the formulas (3.2) and (3.4), for those who hold an element formulation of their own against it.

use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::fault;
use crate::kinematics::kinematics_named;
use hypercircle::element::subtriangle::{self, Moments};
use hypercircle::element::{Block, EquilibriumElement, Material, Section};
use hypercircle::scene::Kinematics;

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
/// Raises `InputError` for a triangle or a material that is none.
#[pyfunction]
#[pyo3(signature = (corners, young, poisson, kinematics, body_force = [0.0, 0.0]))]
pub fn element<'py>(
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
    let kinematics = kinematics_named(kinematics)?;
    if kinematics == Kinematics::Axisymmetric {
        return Err(fault(
            "the block element is one of plane strain and plane stress; use plane-strain or plane-stress",
        ));
    }
    let material = Material::isotropic(kinematics, young, poisson);
    let modes = Block.modes(corners, &material, &body_force.into());
    let count = modes.parameters();
    let fields = Section::Slice.mode_stresses(&Block, corners, &modes);
    let value = |node: usize, c: usize| (0..count).map(|k| fields[k][node][c]).collect::<Vec<f64>>();
    let stress: Vec<Vec<Vec<f64>>> = (0..9).map(|node| (0..3).map(|c| value(node, c)).collect()).collect();
    let row = |i: usize| modes.tractions().map(|mode| mode[i]).collect::<Vec<f64>>();
    let traction: Vec<Vec<f64>> = (0..Block.tractions()).map(row).collect();
    let mut particular = vec![[0.0; 3]; 9];
    Block.stresses(corners, &body_force.into(), &modes, &vec![0.0; count], 1.0, &mut particular);
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
/// Raises `InputError` for a triangle that is none.
#[pyfunction]
pub fn flexibility(corners: [[f64; 2]; 3], constants: [f64; 3]) -> PyResult<Vec<Vec<f64>>> {
    let f = subtriangle::flexibility(&Moments::new(proper(corners)?), constants);
    Ok((0..7).map(|i| (0..7).map(|j| f[(i, j)]).collect()).collect())
}

/// The side matrix C of (3.4), 4 × 7, of the side from `a` to `b`.
///
/// Raises `InputError` where the two points are one.
#[pyfunction]
pub fn side_map(a: [f64; 2], b: [f64; 2]) -> PyResult<Vec<Vec<f64>>> {
    let length = (b[0] - a[0]).hypot(b[1] - a[1]);
    if length == 0.0 || !length.is_finite() {
        return Err(fault(format!("{a:?} and {b:?} are not the ends of a side")));
    }
    let c = subtriangle::side_map(a, b);
    Ok((0..4).map(|i| (0..7).map(|j| c[(i, j)]).collect()).collect())
}
