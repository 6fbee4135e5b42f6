//! The mesh as it was read or made, before contacts move its vertices and cut its triangles.

use crate::mesh::Triangulation;

/// Where a mesh whose contact sides were made to match comes from.
///
/// A triangle that nothing was put into keeps its index and its corners.
#[derive(Debug, Clone, PartialEq)]
pub struct Uncut {
    /// The mesh before.
    pub mesh: Triangulation,
    /// Of every triangle of the mesh after, the triangle of the mesh before that it is a part of, or is.
    pub parent: Vec<usize>,
    /// Of every vertex of the mesh before, the one of the mesh after that it became.
    vertex: Vec<usize>,
    /// Of every vertex of the mesh after, the first of those before that became it.
    origin: Vec<Option<usize>>,
}

impl Uncut {
    /// The mesh `before`; `vertex` has the number after of each of its vertices, and of those that were put in, which follow them.
    pub(in crate::mesh) fn new(mesh: Triangulation, parent: Vec<usize>, mut vertex: Vec<usize>) -> Self {
        let count = vertex.iter().max().map_or(0, |last| last + 1);
        vertex.truncate(mesh.points.len());
        let mut origin = vec![None; count];
        for (v, &now) in vertex.iter().enumerate() {
            origin[now].get_or_insert(v);
        }
        Uncut { mesh, parent, vertex, origin }
    }

    /// True if triangle `t` of `after` is a part of its parent alone.
    pub fn is_cut(&self, after: &Triangulation, t: usize) -> bool {
        after.triangles[t] != self.corners_after(self.parent[t])
    }

    /// True if any triangle of `after` is a part of another.
    pub fn any_is_cut(&self, after: &Triangulation) -> bool {
        after.triangles.len() != self.mesh.triangles.len()
    }

    /// The vertices of the mesh after that the corners of triangle `parent` of the mesh before became.
    pub fn corners_after(&self, parent: usize) -> [usize; 3] {
        self.mesh.triangles[parent].map(|v| self.vertex[v])
    }

    /// Where vertex `v` of the mesh after was before; `None` where it was put in.
    pub fn place_before(&self, v: usize) -> Option<[f64; 2]> {
        self.origin.get(v).copied().flatten().map(|v| self.mesh.points[v])
    }
}
