//! Restricts sums over triangles, edges and contact pairs to the entities this rank owns.

use crate::mesh::Triangulation;

/// All of a problem, or what one of several ranks counts; each triangle and each pair is counted by one of them.
#[derive(Debug, Clone, Copy)]
pub struct Counted<'a>(Option<[&'a [bool]; 2]>);

impl<'a> Counted<'a> {
    /// All of it.
    pub const ALL: Counted<'static> = Counted(None);

    /// These triangles, and these contact pairs, one interface after the other.
    pub fn of(triangles: &'a [bool], pairs: &'a [bool]) -> Self {
        Counted(Some([triangles, pairs]))
    }

    /// True if triangle `t` is counted.
    pub fn triangle(self, t: usize) -> bool {
        self.0.is_none_or(|[triangles, _]| triangles[t])
    }

    /// True if contact pair `p` is counted.
    pub fn pair(self, p: usize) -> bool {
        self.0.is_none_or(|[_, pairs]| pairs[p])
    }

    /// True if edge `e` of the boundary is counted, which it is with its triangle.
    pub fn boundary_edge(self, mesh: &Triangulation, e: usize) -> bool {
        mesh.edges[e].triangles[0].is_none_or(|t| self.triangle(t))
    }
}
