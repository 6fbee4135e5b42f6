//! The boundary of a triangle in terms of unknowns.
//!
//! A triangle has twelve traction values (see [`crate::element::Modes`]): x and y at both ends of each side. An edge has
//! ends and a normal of its own, and its second triangle runs along it the other way round.

use super::unknowns::{Component, EdgeMoments, Unknowns};
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
        let normal = match unknowns.edges[side.edge] {
            // Their components are along the axes, or along the direction of contact.
            EdgeMoments::Free(_) | EdgeMoments::Given(_) | EdgeMoments::Contact(_) => [0.0; 2],
            EdgeMoments::Tangential(_) => mesh.edge_frame(side.edge).1,
        };
        (side, unknowns.components(side.edge, side.end, normal))
    })
}

/// An edge whose four moments are unknowns, as a side of a triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FreeEdge {
    /// Its first unknown.
    pub first: usize,
    /// Places among the traction values of the triangle, unknown by unknown.
    pub at: [usize; 4],
}

impl FreeEdge {
    /// Its unknowns with their places.
    pub fn unknowns(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        (self.first..).zip(self.at)
    }
}

/// The sides of triangle `t` if all are such edges, as those of most triangles are: what [`rows`] says, in less time.
pub fn free_edges(mesh: &Triangulation, unknowns: &Unknowns, t: usize) -> Option<[FreeEdge; 3]> {
    let mut out = [FreeEdge { first: 0, at: [0; 4] }; 3];
    for (side, edge) in mesh.triangle_edges[t].into_iter().enumerate() {
        let EdgeMoments::Free(first) = unknowns.edges[edge] else { return None };
        let flipped = mesh.edges[edge].triangles[0] != Some(t);
        let order = if flipped { [2, 3, 0, 1] } else { [0, 1, 2, 3] };
        out[side] = FreeEdge { first, at: order.map(|i| 4 * side + i) };
    }
    Some(out)
}
