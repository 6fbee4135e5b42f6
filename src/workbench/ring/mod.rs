//! Displacement elements of bodies of revolution: what their matrices must have.
//!
//! Nodes are (r, z), K is that of the full turn about r = 0. The states that every element has to meet are those with the displacements
//! (r, 0), (0, z) and (0, r): the strains (1, 0, 1, 0), (0, 1, 0, 0) and γ = 1 throughout, the same everywhere and with the hoop.

mod diagnosis;
mod frame;
mod reference;
mod rigid;
mod uniform;

use nalgebra::DMatrix;

pub use diagnosis::diagnose;

use super::displacement::{DisplacementElement, definite, frame as of_plane, symmetry};
use super::finding::Property;

/// Properties checked on an element of a body of revolution, in the order of a report.
pub const PROPERTIES: &[Property<DisplacementElement>] = &[
    symmetry::SYMMETRY,
    rigid::MOTION,
    rigid::FORCE,
    rigid::RANK,
    definite::DEFINITE,
    uniform::ENERGY,
    uniform::FORCES,
    uniform::DISTORTED,
    frame::REFLECTION,
    frame::SCALING,
    of_plane::RENUMBERING,
    frame::PLANE_LIMIT,
    reference::REFERENCE,
];

/// The shift of all nodes along the axis, of length one.
fn shift(count: usize) -> DMatrix<f64> {
    let mut shift = DMatrix::zeros(2 * count, 1);
    (0..count).for_each(|n| shift[2 * n + 1] = 1.0 / (count as f64).sqrt());
    shift
}

/// Corners moved away from the axis by so many lengths of one.
fn away(corners: &[[f64; 2]], by: f64) -> Vec<[f64; 2]> {
    let least = corners.iter().map(|x| x[0]).fold(f64::INFINITY, f64::min);
    corners.iter().map(|[r, z]| [r - least + by, *z]).collect()
}
