//! How far a curve lies beside the edges that stand for it, as the edges themselves tell.
//!
//! On an edge of length l between two others the curve has the curvatures κ of the circles through the vertices at its two
//! ends and their neighbours, and lies about ½ κ l² t (1 − t) beside the chord at the part t of it.

use std::collections::HashMap;

use crate::mesh::Triangulation;

/// Cosine of the angle between two edges beyond which the vertex between them is a corner: 30°, as far as coordinates are rounded.
pub const CORNER: f64 = 0.866_025_40;
/// Part of what the curvatures tell by which a vertex on the curve may lie elsewhere.
const SLACK: f64 = 0.15;
/// Angle between two edges below which they are in line.
const IN_LINE: f64 = 1e-6;
/// Factor between the curvatures of two sides that are one curve.
const ALIKE: f64 = 2.5;

/// The curvatures of a contact side at its vertices.
pub(in crate::mesh) struct Curvatures<'a> {
    mesh: &'a Triangulation,
    /// By vertex, positive where the outline turns to the left; none at its ends and at corners.
    at: HashMap<usize, f64>,
}

impl<'a> Curvatures<'a> {
    /// Those of the boundary `name`.
    pub fn of(mesh: &'a Triangulation, name: &str) -> Self {
        // Edges have their body on the left: one ends at a vertex, one begins there.
        let mut ways: HashMap<usize, [Option<usize>; 2]> = HashMap::new();
        for e in mesh.boundary(name) {
            let [a, b] = mesh.edges[e].vertices;
            ways.entry(a).or_default()[1] = Some(b);
            ways.entry(b).or_default()[0] = Some(a);
        }
        let curvature = |(v, way): (usize, [Option<usize>; 2])| {
            let [p, q] = [way[0]?, way[1]?].map(|w| mesh.points[w]);
            let here = mesh.points[v];
            let [before, after] = [[here[0] - p[0], here[1] - p[1]], [q[0] - here[0], q[1] - here[1]]];
            let cross = before[0] * after[1] - before[1] * after[0];
            let dot = before[0] * after[0] + before[1] * after[1];
            let lengths = before[0].hypot(before[1]) * after[0].hypot(after[1]);
            let across = (q[0] - p[0]).hypot(q[1] - p[1]);
            let bent = if cross.abs() > IN_LINE * lengths { 2.0 * cross / (lengths * across) } else { 0.0 };
            (dot >= CORNER * lengths).then_some((v, bent))
        };
        Curvatures { mesh, at: ways.into_iter().filter_map(curvature).collect() }
    }

    /// How far `p` lies beside edge `e`, if that is where the curve of this side passes it. `other` has the curvature of the
    /// side that `p` is vertex `v` of.
    pub fn passes(&self, e: usize, p: [f64; 2], other: &Curvatures, v: usize) -> Option<f64> {
        let [a, b] = self.mesh.edges[e].vertices;
        let own: Vec<f64> = [a, b].iter().filter_map(|v| self.at.get(v).copied()).collect();
        let (length, normal) = self.mesh.edge_frame(e);
        let from = self.mesh.points[a];
        let [x, y] = [p[0] - from[0], p[1] - from[1]];
        // With n to the right of the way along the edge, the way is (−n_y, n_x).
        let along = (y * normal[0] - x * normal[1]) / length;
        let off = x * normal[0] + y * normal[1];
        let bulge = |k: f64| 0.5 * k * length * length * along * (1.0 - along);
        let [least, most] =
            [own.iter().copied().fold(f64::INFINITY, f64::min), own.iter().copied().fold(f64::NEG_INFINITY, f64::max)];
        let slack = SLACK * bulge(least.abs().max(most.abs()));
        let on_curve = bulge(least) - slack <= off && off <= bulge(most) + slack;
        // The other side runs the other way.
        let alike = other.at.get(&v).is_none_or(|k| {
            let opposite = -k;
            opposite * least > 0.0
                && opposite.abs() <= ALIKE * most.abs().max(least.abs())
                && ALIKE * opposite.abs() >= most.abs().min(least.abs())
        });
        let inside = along > 0.0 && along < 1.0 && least * most > 0.0;
        (inside && on_curve && alike).then_some(off.abs())
    }
}
