//! Strains that are the same everywhere, the hoop with them, in energy and in nodal forces.
//!
//! Radial and axial stretching are in equilibrium by themselves: their nodal forces are 2π ∮ σn N r ds. A shear that is the same
//! everywhere needs a body force, and is looked at by its energy alone.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, Matrix3, Vector4};

use super::away;
use crate::report::text::number::percent;
use crate::workbench::displacement::{DisplacementElement, nodes_on, sweep};
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
pub(super) fn states(nodes: &[[f64; 2]]) -> DMatrix<f64> {
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
fn energies(k: &DMatrix<f64>, nodes: &[[f64; 2]], outline: &Outline, material: &Material) -> [Matrix3<f64>; 2] {
    let u = states(nodes);
    let found = u.tr_mul(&(k * &u));
    let (d, volume) = (material.hooke_of_rings(), volume(nodes, outline));
    let exact = Matrix3::from_fn(|i, j| volume * Vector4::from(STATES[i]).dot(&(d * Vector4::from(STATES[j]))));
    [Matrix3::from_fn(|i, j| found[(i, j)]), exact]
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

fn off<R: nalgebra::Dim, C: nalgebra::Dim, S: nalgebra::Storage<f64, R, C>>(
    [found, exact]: [&nalgebra::Matrix<f64, R, C, S>; 2],
) -> f64 {
    let most = found.iter().zip(exact.iter()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    most / exact.amax()
}

fn energy(e: &DisplacementElement) -> Result<Measured, Fault> {
    let [found, exact] = energies(&e.matrix, &e.nodes, &e.outline, &e.material()?);
    let value = off([&found, &exact]);
    let sentence = if value <= e.precision {
        "Strains that are the same everywhere store what they must".to_string()
    } else {
        let part = |i: usize| percent(found[(i, i)] / exact[(i, i)]);
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
    let [found, exact] = nodal_forces(&e.matrix, &e.nodes, &e.outline, &e.material()?);
    let value = off([&found, &exact]);
    let sentence = match value <= e.precision {
        true => "Nodal forces of radial and axial stretching are those of their stress",
        false => "Nodal forces of radial or axial stretching are not those of their stress",
    };
    Ok(Measured::new(value, e.precision, sentence))
}

fn distorted(e: &DisplacementElement) -> Result<Measured, Fault> {
    e.formula()?;
    let (layout, material, corners) = (e.layout()?, e.material()?, e.outline.corners.len());
    let (mut value, mut worst, mut count) = (0.0_f64, String::new(), 0);
    let shapes = sweep(corners);
    for (shape, by) in shapes.iter().flat_map(|shape| AWAY.map(|by| (shape, by))) {
        let nodes = nodes_on(&layout, &away(&shape.corners, by));
        let Some(outline) = Outline::of(&nodes) else { continue };
        let k = e.stiffness(&nodes, &material)?;
        let [found, exact] = energies(&k, &nodes, &outline, &material);
        let [acting, wanted] = nodal_forces(&k, &nodes, &outline, &material);
        // Radii cancel in differences: rounding grows with the distance, in sizes of the shape.
        let own = off([&found, &exact]).max(off([&acting, &wanted])) / (1.0 + by);
        if own > value || worst.is_empty() {
            worst = format!("{}, {by} away from the axis", shape.name);
        }
        value = value.max(own);
        count += 1;
    }
    let sentence = match value <= e.precision {
        true => format!("Energy and nodal forces of such strains are right on {count} shapes and places"),
        false => format!("Energy or nodal forces of such strains are wrong on the element {worst}"),
    };
    Ok(Measured::new(value, e.precision, sentence))
}
