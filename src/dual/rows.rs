//! The boundary of a triangle in terms of unknowns.
//!
//! A triangle has twelve traction values (see [`crate::element::Modes`]): x and y at both ends of each side. An edge has
//! ends and a normal of its own, and its second triangle runs along it the other way round.

use super::unknowns::{Component, Unknowns};
use crate::mesh::Triangulation;

/// One end of one side of a triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SideEnd {
    /// Place of its x value among the traction values; y follows.
    pub at: usize,
    /// The edge.
    pub edge: usize,
    /// Which end of the edge.
    pub end: usize,
}

/// The ends of the sides of triangle `t`, in the order of its traction values.
pub fn side_ends(mesh: &Triangulation, t: usize) -> impl Iterator<Item = SideEnd> {
    mesh.triangle_edges[t].into_iter().enumerate().flat_map(move |(side, edge)| {
        let flipped = usize::from(mesh.edges[edge].triangles[0] != Some(t));
        [0, 1].map(|node| SideEnd { at: 4 * side + 2 * node, edge, end: node ^ flipped })
    })
}

/// The ends of the sides of triangle `t` with the components that their moments, and so their tractions, are taken in.
pub fn rows(mesh: &Triangulation, unknowns: &Unknowns, t: usize) -> impl Iterator<Item = (SideEnd, [Component; 2])> {
    side_ends(mesh, t).map(|side| {
        let (_, normal) = mesh.edge_frame(side.edge);
        (side, unknowns.components(side.edge, side.end, normal))
    })
}
