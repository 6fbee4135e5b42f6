//! How a ring depends on where it lies: along the axis not at all, with its size in proportion, and far from the axis like a slice.

use std::f64::consts::TAU;

use super::away;
use crate::scene::Kinematics;
use crate::workbench::displacement::frame::mirrored;
use crate::workbench::displacement::{DisplacementElement, hooke_seen, irregular, nodes_on};
use crate::workbench::finding::{Fault, Measured, Property};
use crate::workbench::material::Material;
use crate::workbench::outline::Outline;

pub const REFLECTION: Property<DisplacementElement> = Property {
    name: "reflection",
    asks: "the mirror image below a plane across the axis has the mirror image of K",
    usual: true,
    measure: |e| mirrored(e, &away(&irregular(e.outline.corners.len()), NEAR), [[1.0, 0.0], [0.0, -1.0]]),
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

/// The nodes on the shape without symmetry, at this distance from the axis.
fn nodes_at(e: &DisplacementElement, by: f64) -> Result<Vec<[f64; 2]>, Fault> {
    Ok(nodes_on(&e.layout()?, &away(&irregular(e.outline.corners.len()), by)))
}

fn scaled(e: &DisplacementElement) -> Result<Measured, Fault> {
    e.formula()?;
    let (nodes, material) = (nodes_at(e, NEAR)?, e.material()?);
    let there: Vec<[f64; 2]> = nodes.iter().map(|[r, z]| [1e3 * r, 1e3 * z - 70.0]).collect();
    let expected = e.stiffness(&nodes, &material)? * 1e3;
    let value = (e.stiffness(&there, &material)? - &expected).amax() / expected.amax();
    let verb = if value <= e.precision { "changes K as it must" } else { "changes K otherwise than it must" };
    let text = format!("Another size and place along the axis {verb}, relative to the largest entry");
    Ok(Measured::new(value, e.precision, text))
}

fn far(e: &DisplacementElement) -> Result<Measured, Fault> {
    e.formula()?;
    let (nodes, material) = (nodes_at(e, FAR)?, e.material()?);
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
