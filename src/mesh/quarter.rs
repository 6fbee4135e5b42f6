//! Uniform refinement.

use super::labels::pair;
use super::{Map, Triangulation};

/// The middle of an edge; the same bits from either end, so that contact sides keep matching.
pub(crate) fn middle(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]
}

impl Triangulation {
    /// Every triangle cut into four similar ones by the middles of its edges. Vertices keep their index; the middle
    /// of edge e becomes vertex `points.len()` + e; triangle t becomes 4t … 4t + 3, the last one in the middle.
    pub fn quartered(&self) -> Triangulation {
        let first = self.points.len();
        let mut points = self.points.clone();
        points.extend(self.edges.iter().map(|e| middle(self.points[e.vertices[0]], self.points[e.vertices[1]])));
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
        Triangulation::connect(points, triangles, body, self.names.clone(), &label)
    }
}
