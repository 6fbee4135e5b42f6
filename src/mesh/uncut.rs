//! The mesh as it was read or made, before contacts move its vertices and cut its triangles.

use super::Triangulation;

/// Where a mesh whose contact sides were made to match comes from.
///
/// Vertices of the mesh before keep their index, new ones follow; a triangle that nothing was put into keeps its index and its
/// corners.
#[derive(Debug, Clone, PartialEq)]
pub struct Uncut {
    /// The mesh before.
    pub mesh: Triangulation,
    /// Of every triangle of the mesh after, the triangle of the mesh before that it is a part of, or is.
    pub parent: Vec<usize>,
}

impl Uncut {
    /// Whether triangle `t` of `after` is a part of its parent alone.
    pub fn is_cut(&self, after: &Triangulation, t: usize) -> bool {
        after.triangles[t] != self.mesh.triangles[self.parent[t]]
    }

    /// Whether any triangle of `after` is a part of another.
    pub fn any_is_cut(&self, after: &Triangulation) -> bool {
        after.triangles.len() != self.mesh.triangles.len()
    }
}
