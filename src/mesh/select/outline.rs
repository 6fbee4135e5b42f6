//! The outline of the bodies, and which of its edges a boundary of the scene takes.

use std::collections::HashSet;

use super::{list, named_cells, sorted};
use crate::mesh::error::{MeshError, shown_by};
use crate::mesh::topology::labels::{Pair, pair, suggestion};
use crate::mesh::{Map, RawMesh};
use crate::scene::{Boundary, Edges, Group, Scene};

/// Distance from a line, box or circle, in parts of the largest coordinate of mesh and choice, that counts as on it.
const ON: f64 = 1e-6;

/// An edge of the outline of a body, with the body on its left.
struct Side {
    vertices: [usize; 2],
    /// Index into the bodies of the scene.
    body: Option<usize>,
    /// True if another body has the edge too.
    shared: bool,
}

/// The edges that a mesh has on one side only, and those between two bodies, once for each.
pub(super) struct Outline<'a> {
    raw: &'a RawMesh,
    scene: &'a Scene,
    /// Cells by the names that the file gives them.
    groups: &'a [([usize; 3], String)],
    sides: Vec<Side>,
    /// Largest coordinate.
    size: f64,
}

/// An edge as a cell runs round it, and the body of the cell.
type Of = ([usize; 2], Option<usize>);

impl<'a> Outline<'a> {
    pub(super) fn new(raw: &'a RawMesh, groups: &'a [([usize; 3], String)], scene: &'a Scene) -> Self {
        let cells: Vec<([usize; 3], &str)> = named_cells(raw).collect();
        let body_of = |name: &str| scene.bodies.iter().position(|body| body.name == name);
        let mut of: Map<[usize; 3], Option<usize>> = Map::default();
        for (cell, name) in &cells {
            let body = of.entry(sorted(*cell)).or_default();
            *body = body.or(body_of(name));
        }
        let mut sides: Map<Pair, Vec<Of>> = Map::default();
        let mut order = Vec::new();
        let mut seen: HashSet<[usize; 3]> = HashSet::new();
        for (cell, _) in cells.iter().filter(|(cell, _)| cell.iter().all(|&v| v < raw.points.len())) {
            let key = sorted(*cell);
            if !seen.insert(key) {
                continue;
            }
            let [p, q, r] = cell.map(|v| raw.points[v]);
            let left = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]) > 0.0;
            for i in 0..3 {
                let (a, b) = (cell[i], cell[(i + 1) % 3]);
                let list = sides.entry(pair(a, b)).or_default();
                if list.is_empty() {
                    order.push(pair(a, b));
                }
                list.push((if left { [a, b] } else { [b, a] }, of[&key]));
            }
        }
        let outer = |key: &Pair| match sides[key].as_slice() {
            [(vertices, body)] => vec![Side { vertices: *vertices, body: *body, shared: false }],
            [(one, a), (other, b)] if a != b => {
                vec![Side { vertices: *one, body: *a, shared: true }, Side { vertices: *other, body: *b, shared: true }]
            }
            _ => Vec::new(),
        };
        let sides = order.iter().flat_map(outer).collect();
        let size = raw.points.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
        Outline { raw, scene, groups, sides, size }
    }

    /// The edges of `boundary`, each with its body on the left.
    pub(super) fn edges(&self, boundary: &Boundary) -> Result<Vec<[usize; 2]>, MeshError> {
        let on: Box<dyn Fn([usize; 2]) -> bool> = match &boundary.edges {
            Edges::Line([a, b]) => {
                let (a, b, near) = (*a, *b, self.near(&[*a, *b]));
                Box::new(move |v| v.iter().all(|&v| distance(self.raw.points[v], a, b) <= near))
            }
            Edges::Box([p, q]) => {
                let (p, q, near) = (*p, *q, self.near(&[*p, *q]));
                let inside =
                    move |x: [f64; 2]| (0..2).all(|c| x[c] >= p[c].min(q[c]) - near && x[c] <= p[c].max(q[c]) + near);
                Box::new(move |v| v.iter().all(|&v| inside(self.raw.points[v])))
            }
            Edges::Circle { centre, radius } => {
                let ([x, y], radius) = (*centre, *radius);
                let near = self.near(&[*centre]).max(ON * radius);
                let off = move |p: [f64; 2]| ((p[0] - x).hypot(p[1] - y) - radius).abs();
                // The side of a square has its ends on a circle too; an arc's chord spans less than a quarter of it.
                let short = move |[p, q]: [[f64; 2]; 2]| (p[0] - q[0]).hypot(p[1] - q[1]) < 1.4 * radius;
                Box::new(move |v| {
                    let ends = v.map(|v| self.raw.points[v]);
                    ends.iter().all(|p| off(*p) <= near) && short(ends)
                })
            }
            Edges::Normal { direction: [x, y], angle } => {
                let (x, y, least) = (*x, *y, (angle.to_radians() * (1.0 + 1e-12)).cos());
                Box::new(move |v| {
                    let [p, q] = v.map(|v| self.raw.points[v]);
                    let (dx, dy) = (q[0] - p[0], q[1] - p[1]);
                    (dy * x - dx * y) >= (least - 1e-12) * dx.hypot(dy)
                })
            }
            Edges::Group(group) => return self.group(boundary, group),
        };
        Ok(self
            .sides
            .iter()
            .filter(|side| self.offered(side, boundary) && on(side.vertices))
            .map(|s| s.vertices)
            .collect())
    }

    /// True if `boundary` may have this edge: one between two bodies only where it names its own.
    fn offered(&self, side: &Side, boundary: &Boundary) -> bool {
        boundary.body.map_or(!side.shared, |body| side.body == Some(body))
    }

    fn near(&self, points: &[[f64; 2]]) -> f64 {
        ON * points.iter().flatten().fold(self.size, |m, x| m.max(x.abs()))
    }

    /// The edges of a group of the file: its own segments, the outline of its cells, or the outline between its nodes.
    fn group(&self, boundary: &Boundary, group: &Group) -> Result<Vec<[usize; 2]>, MeshError> {
        let sets = &self.raw.sets;
        let name = match group {
            Group::Set(name) => name.clone(),
            Group::Tag(tag) => sets.numbers.get(&(1, *tag)).cloned().unwrap_or_else(|| tag.to_string()),
        };
        let segments = self.raw.segments.iter().filter(|(_, n)| *n == name).map(|(s, _)| *s);
        let lists = self.raw.shared.iter().filter(|list| list.names.contains(&name));
        let mut segments: Vec<[usize; 2]> =
            segments.chain(lists.flat_map(|list| list.segments.iter().copied())).collect();
        match group {
            Group::Tag(tag) if segments.is_empty() => {
                segments.extend(sets.entity(1, *tag).flat_map(|cells| &cells.segments));
            }
            Group::Set(_) => {
                let surfaces = sets.surfaces.iter().filter(|(n, _)| *n == name);
                segments.extend(surfaces.flat_map(|(_, sides)| sides.iter()));
            }
            Group::Tag(_) => {}
        }
        if !segments.is_empty() {
            let wanted: HashSet<Pair> = segments.iter().map(|[a, b]| pair(*a, *b)).collect();
            let own = |side: &&Side| boundary.body.is_none_or(|body| side.body == Some(body));
            let found =
                self.sides.iter().filter(own).filter(|side| wanted.contains(&pair(side.vertices[0], side.vertices[1])));
            return Ok(found.map(|side| side.vertices).collect());
        }
        if let Some((_, nodes)) = sets.nodes.iter().find(|(n, _)| *n == name) {
            let nodes: HashSet<usize> = nodes.iter().copied().collect();
            let all = |side: &&Side| side.vertices.iter().all(|v| nodes.contains(v));
            return Ok(self
                .sides
                .iter()
                .filter(|s| self.offered(s, boundary))
                .filter(all)
                .map(|s| s.vertices)
                .collect());
        }
        let cells: HashSet<[usize; 3]> =
            self.groups.iter().filter(|(_, n)| *n == name).map(|(cell, _)| sorted(*cell)).collect();
        let mut edges: HashSet<Pair> = HashSet::new();
        for [a, b, c] in cells {
            edges.extend([pair(a, b), pair(b, c), pair(c, a)]);
        }
        let of_cells = |side: &&Side| edges.contains(&pair(side.vertices[0], side.vertices[1]));
        let found: Vec<[usize; 2]> =
            self.sides.iter().filter(|s| self.offered(s, boundary)).filter(of_cells).map(|s| s.vertices).collect();
        match (found.is_empty(), group) {
            (false, _) => Ok(found),
            (true, Group::Set(_)) => {
                let mut names: Vec<&str> = sets.nodes.iter().map(|(n, _)| n.as_str()).collect();
                names.extend(sets.surfaces.iter().map(|(n, _)| n.as_str()));
                names.extend(self.raw.segments.iter().map(|(_, n)| n.as_str()));
                names.extend(self.groups.iter().map(|(_, n)| n.as_str()).filter(|n| !n.is_empty()));
                names.sort_unstable();
                names.dedup();
                let remedy = format!(
                    "the file has the sets {}{}{}",
                    list(&names),
                    suggestion(&name, &names),
                    shown_by(self.scene)
                );
                let what = format!("is the set '{name}', of which no edge lies on the outline");
                Err(MeshError::boundary(self.scene, &boundary.name, what, remedy))
            }
            (true, Group::Tag(tag)) => {
                let what = format!("is the entity {tag}, of which no edge lies on the outline");
                let remedy =
                    format!("the file has curves with the tags {}{}", list(&sets.tags(1)), shown_by(self.scene));
                Err(MeshError::boundary(self.scene, &boundary.name, what, remedy))
            }
        }
    }

    /// The error for a boundary that chose no edge.
    pub(super) fn nothing(&self, boundary: &Boundary) -> MeshError {
        let kind = match boundary.edges {
            Edges::Line(_) => "lies on this segment",
            Edges::Box(_) => "lies inside this box",
            Edges::Circle { .. } => "lies with its ends on this circle",
            Edges::Normal { .. } => "has such a normal",
            Edges::Group(_) => "belongs to this group",
        };
        let offered = self.sides.iter().filter(|side| self.offered(side, boundary));
        let points = offered.flat_map(|side| side.vertices).map(|v| self.scene.as_written(self.raw.points[v]));
        let [mut low, mut high] = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        for p in points {
            low = [low[0].min(p[0]), low[1].min(p[1])];
            high = [high[0].max(p[0]), high[1].max(p[1])];
        }
        let of = boundary.body.map_or(String::new(), |body| format!(" of body '{}'", self.scene.bodies[body].name));
        let what = format!("has no edge: none of the outline{of} {kind}");
        let remedy = match low[0] <= high[0] {
            true => format!(
                "the outline{of} lies between ({}, {}) and ({}, {}), and an edge is taken where both its ends are",
                low[0], low[1], high[0], high[1]
            ),
            false => "the mesh has no such outline".to_string(),
        };
        let remedy = format!("{remedy}{}", shown_by(self.scene));
        MeshError::boundary(self.scene, &boundary.name, what, remedy)
    }
}

/// Distance of `p` from the segment between `a` and `b`.
fn distance(p: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let (along, from) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let length = along[0] * along[0] + along[1] * along[1];
    let s = ((along[0] * from[0] + along[1] * from[1]) / length).clamp(0.0, 1.0);
    (from[0] - s * along[0]).hypot(from[1] - s * along[1])
}
