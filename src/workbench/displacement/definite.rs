//! No motion gives energy away.

use nalgebra::DMatrix;

use super::{DisplacementElement, nodes_on, shapes};
use crate::workbench::finding::{Fault, Measured, Property};

pub const DEFINITE: Property<DisplacementElement> = Property {
    name: "definiteness",
    asks: "no eigenvalue of K is below zero: every motion stores energy or none",
    usual: true,
    measure: one,
};

pub const SWEEP: Property<DisplacementElement> = Property {
    name: "definiteness-sweep",
    asks: "no eigenvalue of K is below zero, over shapes and Poisson's ratios",
    usual: true,
    measure: sweep,
};

/// Poisson's ratios of the sweep.
const POISSON: [f64; 5] = [-0.9, 0.0, 0.3, 0.49, 0.4999];

/// Least and largest eigenvalue of the symmetric part.
fn ends(k: &DMatrix<f64>) -> [f64; 2] {
    let values = (0.5 * (k + k.transpose())).symmetric_eigenvalues();
    [values.min(), values.max()]
}

/// By how much the least eigenvalue is below zero, relative to the largest one in absolute value.
fn below_zero(k: &DMatrix<f64>) -> f64 {
    let [least, most] = ends(k);
    (-least).max(0.0) / least.abs().max(most.abs())
}

fn one(e: &DisplacementElement) -> Result<Measured, Fault> {
    let value = below_zero(&e.matrix);
    let [_, most] = ends(&e.matrix);
    let sentence = if value <= e.precision {
        "No eigenvalue of K is below zero, relative to the largest"
    } else if most <= e.precision * e.size() {
        "No eigenvalue of K is above zero: the matrix has the wrong sign"
    } else {
        "An eigenvalue of K is below zero, relative to the largest: a motion gives energy away"
    };
    Ok(Measured::new(value, e.precision, sentence))
}

fn sweep(e: &DisplacementElement) -> Result<Measured, Fault> {
    e.formula()?;
    let (layout, material) = (e.layout()?, e.material()?);
    let shapes = shapes::sweep(e.outline.corners.len());
    let (mut value, mut worst) = (0.0_f64, String::new());
    for shape in &shapes {
        let nodes = nodes_on(&layout, &shape.corners);
        for poisson in POISSON {
            let k = e.stiffness(&nodes, &material.with_poisson(poisson))?;
            let below = below_zero(&k);
            if below > value || worst.is_empty() {
                worst = format!("{}, ν = {poisson}", shape.name);
            }
            value = value.max(below);
        }
    }
    let state = material.kinematics.words();
    let count = POISSON.len() * shapes.len();
    let sentence = match value <= e.precision {
        true => format!("No eigenvalue is below zero on {count} shapes and Poisson's ratios in {state}"),
        false => format!("An eigenvalue is below zero on the element {worst}, relative to the largest"),
    };
    Ok(Measured::new(value, e.precision, sentence))
}
