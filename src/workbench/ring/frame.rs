//! How a ring depends on where it lies: along the axis not at all, with its size in proportion, and far from the axis like a slice.

use std::f64::consts::TAU;

use nalgebra::DMatrix;

use super::away;
use crate::scene::Kinematics;
use crate::workbench::displacement::{DisplacementElement, hooke_seen, irregular, nodes_on, places};
use crate::workbench::finding::{Fault, Measured, Property};
use crate::workbench::material::Material;
use crate::workbench::outline::Outline;

pub const REFLECTION: Property<DisplacementElement> = Property {
    name: "reflection",
    asks: "the mirror image below a plane across the axis has the mirror image of K",
    usual: true,
    measure: reflected,
};

pub const SCALING: Property<DisplacementElement> = Property {
    name: "scaling",
    asks: "K grows in proportion to the size of the ring, wherever along the axis it lies",
    usual: true,
    measure: scaled,
};

pub const PLANE_LIMIT: Property<DisplacementElement> = Property {
    name: "plane-limit",
    asks: "far from the axis K/(2πr) stores under constant strains what a slice in plane strain stores",
    usual: true,
    measure: far,
};

/// How far, in sizes of the element.
const FAR: f64 = 1e5;
/// Distance from the axis where a place of one's own is needed.
const NEAR: f64 = 0.5;

fn here(e: &DisplacementElement) -> Vec<[f64; 2]> {
    away(&irregular(e.outline.corners.len()), NEAR)
}

fn compared(e: &DisplacementElement, what: &str, found: &DMatrix<f64>, expected: &DMatrix<f64>) -> Measured {
    let value = (found - expected).amax() / expected.amax();
    let verb = if value <= e.precision { "changes K as it must" } else { "changes K otherwise than it must" };
    Measured::new(value, e.precision, format!("{what} {verb}, relative to the largest entry"))
}

fn scaled(e: &DisplacementElement) -> Result<Measured, Fault> {
    e.formula()?;
    let (layout, material) = (e.layout()?, e.material()?);
    let nodes = nodes_on(&layout, &here(e));
    let there: Vec<[f64; 2]> = nodes.iter().map(|[r, z]| [1e3 * r, 1e3 * z - 70.0]).collect();
    let expected = e.stiffness(&nodes, &material)? * 1e3;
    Ok(compared(e, "Another size and place along the axis", &e.stiffness(&there, &material)?, &expected))
}

fn reflected(e: &DisplacementElement) -> Result<Measured, Fault> {
    e.formula()?;
    let (layout, material, at) = (e.layout()?, e.material()?, here(e));
    let corners = at.len();
    let below = |[r, z]: [f64; 2]| [r, -z];
    // Counter-clockwise again: the corners in reverse.
    let image: Vec<[f64; 2]> = (0..corners).map(|k| below(at[(corners - k) % corners])).collect();
    let (nodes, there) = (nodes_on(&layout, &at), nodes_on(&layout, &image));
    let from = places(&there.iter().map(|x| below(*x)).collect::<Vec<_>>(), &nodes)?;
    let k = e.stiffness(&nodes, &material)?;
    let sign = |i: usize| if i.is_multiple_of(2) { 1.0 } else { -1.0 };
    let place = |i: usize| 2 * from[i / 2] + i % 2;
    let expected = DMatrix::from_fn(k.nrows(), k.ncols(), |i, j| sign(i) * sign(j) * k[(place(i), place(j))]);
    Ok(compared(e, "A mirror image", &e.stiffness(&there, &material)?, &expected))
}

fn far(e: &DisplacementElement) -> Result<Measured, Fault> {
    e.formula()?;
    let (layout, material) = (e.layout()?, e.material()?);
    let nodes = nodes_on(&layout, &away(&irregular(e.outline.corners.len()), FAR));
    let Some(outline) = Outline::of(&nodes) else { return Err(Fault::NotMade("it has no area".into())) };
    let seen = hooke_seen(&(e.stiffness(&nodes, &material)? / (TAU * FAR)), &nodes, &outline);
    let exact = Material { kinematics: Kinematics::PlaneStrain, ..material }.hooke();
    let value = (seen - exact).amax() / exact.amax();
    let sentence = match value <= 10.0 / FAR {
        true => "Far from the axis constant strains store what they store in plane strain",
        false => "Far from the axis constant strains do not store what they store in plane strain",
    };
    Ok(Measured::new(value, 10.0 / FAR, sentence))
}
