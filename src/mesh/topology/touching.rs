//! Lines along which two bodies, or two parts of one, touch and nothing is said about it.

use std::collections::BTreeMap;

use super::boxes::{BoxTree, around};
use super::labels::contact_names;
use crate::mesh::Triangulation;
use crate::mesh::error::at;
use crate::scene::{Note, Scene, counted};
use crate::vector::dot;

/// Distance from a line, in parts of the length of an edge on it, at which two edges touch: files have seven digits.
const CLOSE: f64 = 1e-6;
/// Cosine between opposite normals beyond which they do.
const FACING: f64 = 1.0 - 1e-9;

/// Edges of two bodies, or of one, that lie on each other without a contact or a bond.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Touching {
    /// The bodies, the first of the scene first; twice the same where one is cut open.
    pub bodies: [usize; 2],
    /// The edges on both sides.
    pub edges: Vec<usize>,
}

/// All lines of that kind, by bodies.
pub fn touching(mesh: &Triangulation, scene: &Scene) -> Vec<Touching> {
    let sides = contact_names(scene);
    let said = |e: usize| mesh.edges[e].name.is_some_and(|n| sides.contains(&mesh.names[n].as_str()));
    let outline: Vec<usize> = (0..mesh.edges.len()).filter(|&e| mesh.edges[e].is_boundary() && !said(e)).collect();
    let ends = |e: usize| mesh.edges[e].vertices.map(|v| mesh.points[v]);
    let body = |e: usize| mesh.edges[e].triangles[0].map(|t| mesh.body[t]);
    let margin = |e: usize| CLOSE * mesh.edge_frame(e).0;
    let tree = BoxTree::new(outline.iter().map(|&e| around(&ends(e), margin(e))).collect());
    let mut found: BTreeMap<[usize; 2], Vec<usize>> = BTreeMap::new();
    for &e in &outline {
        let [a, b] = ends(e);
        let middle = [0, 1].map(|c| 0.5 * (a[c] + b[c]));
        let (length, normal) = mesh.edge_frame(e);
        let faces = |f: &usize| {
            let (other, opposite) = mesh.edge_frame(*f);
            let p = ends(*f)[0];
            let from = [middle[0] - p[0], middle[1] - p[1]];
            // Positions along the other edge are counted the way round in which it is passed.
            let along = opposite[0] * from[1] - opposite[1] * from[0];
            dot(normal, opposite) < -FACING
                && dot(from, opposite).abs() <= CLOSE * length.max(other)
                && (0.0..=other).contains(&along)
        };
        // The shorter of two edges has its middle on the other.
        for f in tree.meeting(&[middle, middle]).into_iter().map(|i| outline[i]).filter(|f| *f != e && faces(f)) {
            let (Some(own), Some(other)) = (body(e), body(f)) else { continue };
            let pair = found.entry([own.min(other), own.max(other)]).or_default();
            pair.extend([e, f]);
        }
    }
    let lines = found.into_iter().map(|(bodies, mut edges)| {
        edges.sort_unstable();
        edges.dedup();
        Touching { bodies, edges }
    });
    lines.collect()
}

/// A warning for each of them.
pub(in crate::mesh) fn notes(mesh: &Triangulation, scene: &Scene) -> Vec<Note> {
    touching(mesh, scene).iter().map(|line| Note { weakens_guarantee: false, text: line.told(mesh, scene) }).collect()
}

impl Touching {
    /// In words, for whom nothing was said about it may be news.
    pub fn told(&self, mesh: &Triangulation, scene: &Scene) -> String {
        let [first, second] = self.bodies.map(|body| &scene.bodies[body].name);
        let own =
            self.edges.iter().filter(|e| mesh.edges[**e].triangles[0].is_some_and(|t| mesh.body[t] == self.bodies[0]));
        let edges = if first == second { self.edges.len() / 2 } else { own.count() };
        let place = self
            .place(mesh)
            .map_or_else(String::new, |[from, to]| format!(" between {} and {}", at(scene, from), at(scene, to)));
        let edges = counted(edges, "edge");
        if first == second {
            format!(
                "body '{first}' is cut open along {edges}{place}: the two sides are free of each other; name both in a contact where they \
                 may touch, in a bond where they hold together, or merge their vertices if the body is whole"
            )
        } else {
            format!(
                "bodies '{first}' and '{second}' touch along {edges}{place} without a contact or a bond: they are free of each other"
            )
        }
    }

    /// The first and the last of its vertices in (x, y) order.
    fn place(&self, mesh: &Triangulation) -> Option<[[f64; 2]; 2]> {
        let points = || self.edges.iter().flat_map(|e| mesh.edges[*e].vertices).map(|v| mesh.points[v]);
        let order = |a: &[f64; 2], b: &[f64; 2]| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1]));
        Some([points().min_by(order)?, points().max_by(order)?])
    }
}
