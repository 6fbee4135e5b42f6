//! Uniform refinement.

use crate::mesh::topology::labels::pair;
use crate::mesh::{Curved, Map, Triangulation};

/// The middle of an edge; the same bits from either end, so that contact sides keep matching.
pub(crate) fn middle(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]
}

impl Triangulation {
    /// The point that divides edge `e`: its middle, or the nearest point of the circle that it stands for.
    pub(in crate::mesh) fn division(&self, e: usize, curved: &Curved) -> [f64; 2] {
        let [a, b] = self.edges[e].vertices.map(|v| self.points[v]);
        let m = middle(a, b);
        curved.get(&e).map_or(m, |circle| circle.nearest(m))
    }

    /// Every triangle cut into four by the middles of its edges, similar ones where no edge is `curved`. Vertices keep their
    /// index; the middle of edge e becomes vertex `points.len()` + e; triangle t becomes 4t … 4t + 3, the last one in the
    /// middle.
    pub fn quartered(&self, curved: &Curved) -> Triangulation {
        let first = self.points.len();
        let mut points = self.points.clone();
        points.extend((0..self.edges.len()).map(|e| self.division(e, curved)));
        let mut triangles = Vec::with_capacity(4 * self.triangles.len());
        for (corners, edges) in self.triangles.iter().zip(&self.triangle_edges) {
            let [a, b, c] = *corners;
            let [p, q, r] = edges.map(|e| first + e);
            triangles.extend([[a, r, q], [r, b, p], [q, p, c], [p, q, r]]);
        }
        let body = self.body.iter().flat_map(|&b| [b; 4]).collect();
        let mut label = Map::default();
        for (e, edge) in self.edges.iter().enumerate() {
            if let Some(name) = edge.name {
                label.extend(edge.vertices.map(|v| (pair(v, first + e), name)));
            }
        }
        let mut mesh = Triangulation::connect(points, triangles, body, self.names.clone(), &label);
        mesh.cells = self.quartered_cells();
        mesh
    }
}
