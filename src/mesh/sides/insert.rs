//! New vertices on boundary edges.

use crate::mesh::topology::labels::{Pair, pair};
use crate::mesh::{Map, Triangulation};

impl Triangulation {
    /// Puts vertices on boundary edges, given as (edge, point); the triangle that owns the edge is cut from its
    /// opposite corner. New vertices and triangles are appended, and to `parent` the entry of the triangle that a new one was cut
    /// out of.
    ///
    /// # Errors
    /// A point that lies so far beside its edge that a triangle would turn over.
    pub(crate) fn with_inserted(
        &self,
        at: &[(usize, [f64; 2])],
        parent: &mut Vec<usize>,
    ) -> Result<Triangulation, [f64; 2]> {
        let mut on_edge: Map<usize, Vec<[f64; 2]>> = Map::default();
        for (edge, point) in at {
            on_edge.entry(*edge).or_default().push(*point);
        }
        let mut edges: Vec<usize> = on_edge.keys().copied().collect();
        edges.sort_unstable();
        let mut owner: Map<Pair, usize> = Map::default();
        for &e in &edges {
            let [a, b] = self.edges[e].vertices;
            owner.extend(self.edges[e].triangles[0].map(|t| (pair(a, b), t)));
        }
        let (mut points, mut triangles, mut body) = (self.points.clone(), self.triangles.clone(), self.body.clone());
        let mut label = self.label();
        for e in edges {
            let [a, b] = self.edges[e].vertices;
            let Some(&t) = owner.get(&pair(a, b)) else { continue };
            let Some(&c) = triangles[t].iter().find(|v| **v != a && **v != b) else { continue };
            let name = label.remove(&pair(a, b));
            let mut way = vec![a];
            way.extend(sorted(&on_edge[&e], points[a]).into_iter().map(|p| {
                points.push(p);
                points.len() - 1
            }));
            way.push(b);
            for (i, step) in way.windows(2).enumerate() {
                let child = [step[0], step[1], c];
                let [p, q, r] = child.map(|v| points[v]);
                let positive = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]) > 0.0;
                if !positive {
                    return Err(q);
                }
                if i == 0 {
                    triangles[t] = child;
                } else {
                    triangles.push(child);
                    body.push(body[t]);
                    parent.push(parent[t]);
                }
                label.extend(name.map(|n| (pair(step[0], step[1]), n)));
            }
            // The edge from b to c now belongs to the last child.
            if way.len() > 2
                && let Some(other) = owner.get_mut(&pair(b, c))
            {
                *other = triangles.len() - 1;
            }
        }
        let same = |t: usize| (triangles[t] == self.triangles[t]).then_some(t);
        let cells = self.cells.kept(same);
        let mut mesh = Triangulation::connect(points, triangles, body, self.names.clone(), &label);
        mesh.cells = cells;
        Ok(mesh)
    }
}

/// The points by their distance from the start of the edge, each once.
fn sorted(points: &[[f64; 2]], start: [f64; 2]) -> Vec<[f64; 2]> {
    let distance = |p: &[f64; 2]| (p[0] - start[0]).hypot(p[1] - start[1]);
    let mut points = points.to_vec();
    points.sort_by(|p, q| distance(p).total_cmp(&distance(q)));
    points.dedup();
    points
}
