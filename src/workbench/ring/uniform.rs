//! Strains that are the same everywhere, the hoop with them, in energy and in nodal forces.
//!
//! Radial and axial stretching are in equilibrium by themselves: their nodal forces are 2π ∮ σn N r ds. A shear that is the same
//! everywhere needs a body force, and is looked at by its energy alone.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, Vector4};

use super::away;
use crate::report::text::number::percent;
use crate::workbench::displacement::{DisplacementElement, Shape, largest, sweep};
use crate::workbench::finding::{Fault, Measured, Property};
use crate::workbench::material::Material;
use crate::workbench::outline::{Outline, side_weights};

pub const ENERGY: Property<DisplacementElement> = Property {
    name: "patch-energy",
    asks: "a strain that is the same everywhere, the hoop with it, stores 2π ∫ ½ σ:ε r dA",
    usual: true,
    measure: energy,
};

pub const FORCES: Property<DisplacementElement> = Property {
    name: "patch-forces",
    asks: "radial and axial stretching give the nodal forces 2π ∮ σn N r ds of their stress",
    usual: true,
    measure: forces,
};

pub const DISTORTED: Property<DisplacementElement> = Property {
    name: "patch-distorted",
    asks: "energy and nodal forces of such strains on distorted shapes, at the axis and away from it",
    usual: true,
    measure: distorted,
};

/// Distances from the axis of the shapes that a formula is looked at.
const AWAY: [f64; 3] = [0.0, 0.4, 30.0];

/// The strains (rr, zz, tt, γ) of the three states.
const STATES: [[f64; 4]; 3] = [[1.0, 0.0, 1.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]];

/// Their displacements at the nodes, one a column; axial ones about the first node.
fn states(nodes: &[[f64; 2]]) -> DMatrix<f64> {
    let mut u = DMatrix::zeros(2 * nodes.len(), 3);
    for (n, [r, z]) in nodes.iter().enumerate() {
        u[(2 * n, 0)] = *r;
        u[(2 * n + 1, 1)] = z - nodes[0][1];
        u[(2 * n + 1, 2)] = r - nodes[0][0];
    }
    u
}

/// 2π ∫ r dA.
fn volume(nodes: &[[f64; 2]], outline: &Outline) -> f64 {
    let of = |k: usize| {
        let [a, b] = [0, 1].map(|i| nodes[outline.corners[(k + i) % outline.corners.len()]]);
        (a[0] * b[1] - b[0] * a[1]) * (a[0] + b[0]) / 6.0
    };
    TAU * (0..outline.corners.len()).map(of).sum::<f64>()
}

/// Twice the energies of the states as K has them, and as they must be.
fn energies(k: &DMatrix<f64>, nodes: &[[f64; 2]], outline: &Outline, material: &Material) -> [DMatrix<f64>; 2] {
    let u = states(nodes);
    let found = u.tr_mul(&(k * &u));
    let (d, volume) = (material.hooke_of_rings(), volume(nodes, outline));
    let exact = DMatrix::from_fn(3, 3, |i, j| volume * Vector4::from(STATES[i]).dot(&(d * Vector4::from(STATES[j]))));
    [found, exact]
}

/// Nodal forces of radial and axial stretching as K has them, and as they must be.
fn nodal_forces(k: &DMatrix<f64>, nodes: &[[f64; 2]], outline: &Outline, material: &Material) -> [DMatrix<f64>; 2] {
    let found = (k * states(nodes)).columns(0, 2).into_owned();
    let mut exact = DMatrix::zeros(2 * nodes.len(), 2);
    for state in 0..2 {
        let stress = material.hooke_of_rings() * Vector4::from(STATES[state]);
        for side in &outline.sides {
            let (a, b) = (nodes[side[0]], nodes[side[side.len() - 1]]);
            let radius = |s: f64| a[0] + s * (b[0] - a[0]);
            let force = [stress[0] * (b[1] - a[1]), stress[1] * (a[0] - b[0])];
            for (&node, weight) in side.iter().zip(side_weights(nodes, side, radius)) {
                (0..2).for_each(|c| exact[(2 * node + c, state)] += TAU * weight * force[c]);
            }
        }
    }
    [found, exact]
}

/// How far what is found is from what is exact, relative to the largest entry.
fn off([found, exact]: &[DMatrix<f64>; 2]) -> f64 {
    (found - exact).amax() / exact.amax()
}

fn energy(e: &DisplacementElement) -> Result<Measured, Fault> {
    let both = energies(&e.matrix, &e.nodes, &e.outline, &e.material()?);
    let value = off(&both);
    let sentence = if value <= e.precision {
        "Strains that are the same everywhere store what they must".to_string()
    } else {
        let part = |i: usize| percent(both[0][(i, i)] / both[1][(i, i)]);
        format!(
            "Radial stretching, axial stretching and shear store {}, {} and {} of what they must",
            part(0),
            part(1),
            part(2)
        )
    };
    Ok(Measured::new(value, e.precision, sentence))
}

fn forces(e: &DisplacementElement) -> Result<Measured, Fault> {
    let value = off(&nodal_forces(&e.matrix, &e.nodes, &e.outline, &e.material()?));
    let sentence = match value <= e.precision {
        true => "Nodal forces of radial and axial stretching are those of their stress",
        false => "Nodal forces of radial or axial stretching are not those of their stress",
    };
    Ok(Measured::new(value, e.precision, sentence))
}

fn distorted(e: &DisplacementElement) -> Result<Measured, Fault> {
    let at = |shape: &Shape, by: f64| Shape {
        name: format!("{}, {by} away from the axis", shape.name),
        corners: away(&shape.corners, by),
    };
    let shapes = sweep(e.outline.corners.len());
    let shapes = AWAY.iter().flat_map(|&by| shapes.iter().map(move |shape| at(shape, by)));
    let (value, worst, count) = largest(e, shapes, |k, nodes, outline, material| {
        // Radii cancel in differences: rounding grows with the distance, in sizes of the shape.
        let by = nodes.iter().map(|x| x[0]).fold(f64::INFINITY, f64::min) / outline.size;
        off(&energies(k, nodes, outline, material)).max(off(&nodal_forces(k, nodes, outline, material))) / (1.0 + by)
    })?;
    let sentence = match value <= e.precision {
        true => format!("Energy and nodal forces of such strains are right on {count} shapes and places"),
        false => format!("Energy or nodal forces of such strains are wrong on the element {worst}"),
    };
    Ok(Measured::new(value, e.precision, sentence))
}
