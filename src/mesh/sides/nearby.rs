//! Vertices of facing contact sides that are nearly one.
//!
//! Put into the other side as it is, a vertex a millionth of an edge beside another one makes a needle, and a displacement
//! model finds pressures there that are made of rounding. One of the two is moved instead: onto the other where the sides
//! coincide, along its own edge to the position of the other where they are matched along a direction.

use std::collections::HashMap;

use super::along::{Facing, facing, outward, turned};
use crate::mesh::Triangulation;
use crate::mesh::topology::boxes::{BoxTree, around};
use crate::scene::{Joint, Note, Scene};
use crate::vector::distance;

/// Part of an edge within which two vertices are one, and within which a vertex lies on it.
pub(in crate::mesh) const CLOSE: f64 = 1e-6;

/// Part of the shortest edge of its side by which a vertex is moved at most, and of the area of a triangle that it takes.
const ROOM: f64 = 0.01;
const SPOILT: f64 = 0.5;

/// Part of the size of the mesh that counts as round-off; mesh generators compute points on curves to about 1e-12.
pub(in crate::mesh) const ROUND_OFF: f64 = 1e-10;

/// Largest extent of the mesh.
pub(in crate::mesh) fn extent(mesh: &Triangulation) -> f64 {
    let [lower, upper] = around(&mesh.points, 0.0);
    (upper[0] - lower[0]).max(upper[1] - lower[1])
}

/// A vertex of a contact side.
#[derive(Debug, Clone, Copy)]
pub(in crate::mesh) struct SideVertex {
    /// Its number.
    pub vertex: usize,
    /// Length of the shortest edge of the side there …
    shortest: f64,
    /// … and of the longest.
    longest: f64,
}

impl SideVertex {
    /// The distance within which this vertex and one of the other side are one: so near that an edge of either side would be cut
    /// beside its end, and much less than the edges there.
    fn reach(&self, other: &SideVertex) -> f64 {
        (CLOSE * self.longest.max(other.longest)).min(ROOM * self.shortest.min(other.shortest))
    }
}

/// The vertices of edges with these lengths, in the order of their numbers.
fn vertices_of(edges: impl Iterator<Item = ([usize; 2], f64)>) -> Vec<SideVertex> {
    let mut found: HashMap<usize, SideVertex> = HashMap::new();
    for (ends, length) in edges {
        for vertex in ends {
            let own = found.entry(vertex).or_insert(SideVertex { vertex, shortest: length, longest: length });
            (own.shortest, own.longest) = (own.shortest.min(length), own.longest.max(length));
        }
    }
    let mut vertices: Vec<SideVertex> = found.into_values().collect();
    vertices.sort_unstable_by_key(|v| v.vertex);
    vertices
}

/// The vertices of the boundary `name`.
pub(in crate::mesh) fn side_vertices(mesh: &Triangulation, name: &str) -> Vec<SideVertex> {
    vertices_of(mesh.boundary(name).into_iter().map(|e| (mesh.edges[e].vertices, mesh.edge_frame(e).0)))
}

/// Makes one of vertices of facing sides that are nearly one: gives them the same coordinates, or the same position across the
/// direction of their contact. All contacts at once, because a vertex may belong to several.
pub(in crate::mesh) fn snap(mesh: &mut Triangulation, scene: &Scene, notes: &mut Vec<Note>) {
    let mut moves = Moves::new(mesh);
    moves.onto_each_other(scene);
    moves.along_directions(scene);
    let round_off = ROUND_OFF * extent(moves.mesh);
    if moves.farthest > round_off {
        let weakens_guarantee = moves.changed > round_off;
        let how = if weakens_guarantee { "" } else { ", along straight edges of their own" };
        let text = format!(
            "contact sides coincide only up to {:.1e}: vertices were moved by that much to match{how}",
            moves.farthest
        );
        notes.push(Note { weakens_guarantee, text });
    }
}

/// Vertices on the move.
struct Moves<'a> {
    mesh: &'a mut Triangulation,
    /// The boundary edges and the triangles at each vertex of a contact side.
    edges: HashMap<usize, Vec<usize>>,
    triangles: HashMap<usize, Vec<usize>>,
    /// Vertices whose place is what others were moved for.
    stays: Vec<bool>,
    /// How far one was moved at most.
    farthest: f64,
    /// How far that took the outline of a body from what it was, or the end of a condition on it.
    changed: f64,
}

impl<'a> Moves<'a> {
    fn new(mesh: &'a mut Triangulation) -> Self {
        let stays = vec![false; mesh.points.len()];
        let (mut edges, mut triangles): (HashMap<usize, Vec<usize>>, HashMap<usize, Vec<usize>>) = Default::default();
        for (e, edge) in mesh.edges.iter().enumerate().filter(|(_, edge)| edge.is_boundary()) {
            edge.vertices.iter().for_each(|v| edges.entry(*v).or_default().push(e));
        }
        for (t, corners) in mesh.triangles.iter().enumerate() {
            corners.iter().filter(|v| edges.contains_key(v)).for_each(|v| triangles.entry(*v).or_default().push(t));
        }
        Moves { mesh, edges, triangles, stays, farthest: 0.0, changed: 0.0 }
    }

    /// Contacts without a direction, and bonds: vertices get the coordinates of the one of them with the lowest number.
    fn onto_each_other(&mut self, scene: &Scene) {
        let mut leader: Vec<usize> = (0..self.mesh.points.len()).collect();
        let find = |leader: &[usize], mut v: usize| {
            while leader[v] != v {
                v = leader[v];
            }
            v
        };
        for joint in scene.joints().filter(|joint| joint.direction.is_none()) {
            let [first, second] = [0, 1].map(|i| side_vertices(self.mesh, &joint.sides[i]));
            first.iter().chain(&second).for_each(|v| self.stays[v.vertex] = true);
            if second.is_empty() {
                continue;
            }
            let points = &self.mesh.points;
            let tree = BoxTree::new(second.iter().map(|v| [points[v.vertex]; 2]).collect());
            let longest = second.iter().fold(0.0_f64, |m, v| m.max(v.longest));
            for v in first {
                let farthest = (CLOSE * v.longest.max(longest)).min(ROOM * v.shortest);
                for i in tree.meeting(&around(&[points[v.vertex]], farthest)) {
                    let w = &second[i];
                    if distance(points[v.vertex], points[w.vertex]) <= v.reach(w) {
                        let (a, b) = (find(&leader, v.vertex), find(&leader, w.vertex));
                        leader[a.max(b)] = a.min(b);
                    }
                }
            }
        }
        for v in 0..leader.len() {
            self.put(v, self.mesh.points[find(&leader, v)]);
        }
    }

    /// Contacts along a direction: of two vertices one slides along its edge, that of the second side where it can.
    fn along_directions(&mut self, scene: &Scene) {
        for Joint { sides: names, direction, .. } in scene.joints() {
            let Some(given) = direction else { continue };
            let d = outward(self.mesh, [&names[0], &names[1]], given);
            let sides = [facing(self.mesh, &names[0], d), turned(facing(self.mesh, &names[1], d.map(|x| -x)))];
            let [first, second] = [0, 1].map(|i| positions(&sides[i]));
            for (at, v) in &first {
                let (above, below) = second.split_at(second.partition_point(|(s, _)| s < at));
                for (to, w) in above.last().into_iter().chain(below.first()) {
                    let apart = (at - to).abs();
                    if apart == 0.0 || v.vertex == w.vertex || apart > v.reach(w) {
                        continue;
                    }
                    self.slide([(v.vertex, &sides[0], *to), (w.vertex, &sides[1], *at)]);
                }
            }
        }
    }

    /// Of two vertices, each with its side and the position of the other, slides the one that changes less; the second of two
    /// that change nothing.
    fn slide(&mut self, both: [(usize, &[Facing], f64); 2]) {
        let round_off = ROUND_OFF * extent(self.mesh);
        let mut ways: Vec<(f64, usize, [f64; 2])> = Vec::new();
        for (v, side, position) in both.into_iter().rev().filter(|(v, ..)| !self.stays[*v]) {
            if let Some(to) = slid(self.mesh, v, side, position).filter(|to| self.is_sound(v, *to)) {
                ways.push((self.change(v, to).max(round_off), v, to));
            }
        }
        if let Some(&(_, v, to)) = ways.iter().min_by(|a, b| a.0.total_cmp(&b.0)) {
            self.put(v, to);
            both.iter().for_each(|(v, ..)| self.stays[*v] = true);
        }
    }

    /// Moves a vertex, unless a triangle would suffer.
    fn put(&mut self, v: usize, to: [f64; 2]) {
        if self.mesh.points[v] != to && self.is_sound(v, to) {
            self.farthest = self.farthest.max(distance(self.mesh.points[v], to));
            self.changed = self.changed.max(self.change(v, to));
            self.mesh.points[v] = to;
        }
    }

    /// True if all triangles keep most of their area when `v` moves.
    fn is_sound(&self, v: usize, to: [f64; 2]) -> bool {
        let keeps = |&t: &usize| {
            let moved = self.mesh.triangles[t].map(|w| if w == v { to } else { self.mesh.points[w] });
            twice_area(moved) > SPOILT * twice_area(self.mesh.corners(t))
        };
        self.triangles.get(&v).is_none_or(|triangles| triangles.iter().all(keeps))
    }

    /// How far the outline is from what it was when `v` moves: nothing on a straight edge, all of the way where the outline or a
    /// condition on it ends.
    fn change(&self, v: usize, to: [f64; 2]) -> f64 {
        let from = self.mesh.points[v];
        let edges = self.edges.get(&v).map_or(&[][..], Vec::as_slice);
        let body = |t: &usize| self.mesh.body[*t];
        let own = self.triangles.get(&v).map_or(&[][..], Vec::as_slice);
        let is_one_body = own.windows(2).all(|w| body(&w[0]) == body(&w[1]));
        let &[e, f] = edges else { return distance(from, to) };
        if self.mesh.edges[e].name != self.mesh.edges[f].name || !is_one_body {
            return distance(from, to);
        }
        let other = |e: usize| self.mesh.edges[e].vertices.into_iter().find(|w| *w != v).map(|w| self.mesh.points[w]);
        let (Some(a), Some(b)) = (other(e), other(f)) else { return distance(from, to) };
        let off = |p: [f64; 2], corner: [f64; 2]| distance_to(p, [a, corner]).min(distance_to(p, [corner, b]));
        off(from, to).max(off(to, from))
    }
}

/// The vertices of a side with their positions across the direction, ascending.
fn positions(side: &[Facing]) -> Vec<(f64, SideVertex)> {
    let mut at: HashMap<usize, f64> = HashMap::new();
    for f in side {
        f.vertices.into_iter().zip(f.span).for_each(|(v, s)| _ = at.insert(v, s));
    }
    let vertices = vertices_of(side.iter().map(|f| (f.vertices, f.span[1] - f.span[0])));
    let mut found: Vec<_> = vertices.into_iter().map(|v| (at[&v.vertex], v)).collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found
}

/// The point of the edge of `v`, or of its line, at a position across the direction.
fn slid(mesh: &Triangulation, v: usize, side: &[Facing], position: f64) -> Option<[f64; 2]> {
    let own = || side.iter().filter(|f| f.vertices.contains(&v));
    let over = own().find(|f| f.span[0] <= position && position <= f.span[1]).or_else(|| own().next())?;
    let t = (position - over.span[0]) / (over.span[1] - over.span[0]);
    let [p, q] = over.vertices.map(|v| mesh.points[v]);
    t.is_finite().then(|| [0, 1].map(|c| p[c] + t * (q[c] - p[c])))
}

fn twice_area([p, q, r]: [[f64; 2]; 3]) -> f64 {
    (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
}

/// Distance of `p` from a segment.
pub(in crate::mesh) fn distance_to(p: [f64; 2], [a, b]: [[f64; 2]; 2]) -> f64 {
    let d = [b[0] - a[0], b[1] - a[1]];
    let along = ((p[0] - a[0]) * d[0] + (p[1] - a[1]) * d[1]) / (d[0] * d[0] + d[1] * d[1]);
    let t = along.clamp(0.0, 1.0);
    distance(p, [a[0] + t * d[0], a[1] + t * d[1]])
}
