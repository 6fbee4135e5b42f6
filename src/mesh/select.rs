//! Bodies and boundaries that the scene chooses from what a mesh holds: by set, by number, or by where edges lie.

use std::collections::{HashMap, HashSet};

use super::error::MeshError;
use super::labels::{Pair, pair, suggestion, used_names};
use super::{Map, RawMesh};
use crate::scene::{Boundary, Edges, Group, Note, Scene};

/// Distance from a line, box or circle, in parts of the largest coordinate of mesh and choice, that counts as on it.
const ON: f64 = 1e-6;

/// Cells by their vertices.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Cells {
    /// Triangles.
    pub triangles: Vec<[usize; 3]>,
    /// Segments.
    pub segments: Vec<[usize; 2]>,
}

impl Cells {
    /// Adds the cells of `other`.
    pub(super) fn extend(&mut self, other: &Cells) {
        self.triangles.extend(&other.triangles);
        self.segments.extend(&other.segments);
    }
}

/// Cells of an elementary entity.
#[derive(Debug, Clone, PartialEq)]
pub struct Entity {
    /// 1 or 2.
    pub dimension: i32,
    /// Its number.
    pub tag: i32,
    /// Its cells, or some of them.
    pub cells: Cells,
}

/// What a file groups beside its named cells.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Sets {
    /// Names of physical groups by dimension and number.
    pub numbers: HashMap<(i32, i32), String>,
    /// Cells by elementary entity.
    pub entities: Vec<Entity>,
    /// Vertices by node set.
    pub nodes: Vec<(String, Vec<usize>)>,
    /// Sides of cells by surface.
    pub surfaces: Vec<(String, Vec<[usize; 2]>)>,
}

impl Sets {
    fn entity(&self, dimension: i32, tag: i32) -> impl Iterator<Item = &Cells> {
        self.entities.iter().filter(move |e| (e.dimension, e.tag) == (dimension, tag)).map(|e| &e.cells)
    }

    /// Sorted numbers of entities and groups of this dimension.
    fn tags(&self, dimension: i32) -> Vec<i32> {
        let entities = self.entities.iter().map(|e| (e.dimension, e.tag));
        let mut tags: Vec<i32> =
            entities.chain(self.numbers.keys().copied()).filter(|(d, _)| *d == dimension).map(|(_, tag)| tag).collect();
        tags.sort_unstable();
        tags.dedup();
        tags
    }
}

/// Gives cells and edges the names by which `scene` calls them.
///
/// # Errors
/// [`MeshError`] where something that the scene chooses is not there.
pub(super) fn select(raw: &mut RawMesh, scene: &Scene, notes: &mut Vec<Note>) -> Result<(), MeshError> {
    bodies(raw, scene)?;
    only_body(raw, scene, notes);
    let boundaries: Vec<Boundary> = scene.boundaries.iter().cloned().chain(sets_by_name(raw, scene)).collect();
    if boundaries.is_empty() {
        return Ok(());
    }
    let cells: Vec<([usize; 3], &str)> = named_cells(raw).collect();
    let outline = Outline::new(raw, &cells, scene);
    let mut chosen = Vec::with_capacity(boundaries.len());
    for boundary in &boundaries {
        let edges = outline.edges(boundary)?;
        if edges.is_empty() {
            return Err(outline.nothing(boundary));
        }
        chosen.push(edges);
    }
    let named = raw.segments.iter().filter(|(_, name)| boundaries.iter().any(|b| b.name == *name));
    let mut there: HashSet<(Pair, String)> = named.map(|([a, b], name)| (pair(*a, *b), name.clone())).collect();
    for (boundary, edges) in boundaries.iter().zip(chosen) {
        for [a, b] in edges {
            if there.insert((pair(a, b), boundary.name.clone())) {
                raw.segments.push(([a, b], boundary.name.clone()));
            }
        }
    }
    Ok(())
}

/// Node sets and surfaces whose names conditions use as they are: no segment of the file and no table of the scene has them.
fn sets_by_name(raw: &RawMesh, scene: &Scene) -> Vec<Boundary> {
    let mut names: Vec<&str> = used_names(scene);
    names.sort_unstable();
    names.dedup();
    let sets = || raw.sets.nodes.iter().map(|(name, _)| name).chain(raw.sets.surfaces.iter().map(|(name, _)| name));
    names.retain(|name| {
        let segments = raw
            .segments
            .iter()
            .map(|(_, n)| n)
            .chain(raw.shared.iter().filter(|l| !l.segments.is_empty()).flat_map(|l| &l.names));
        sets().any(|set| set == name)
            && scene.boundaries.iter().all(|boundary| boundary.name != *name)
            && !segments.into_iter().any(|n| n == name)
    });
    let set =
        |name: &str| Boundary { name: name.to_owned(), body: None, edges: Edges::Group(Group::Set(name.to_owned())) };
    names.into_iter().map(set).collect()
}

/// Cells with every name of theirs.
fn named_cells(raw: &RawMesh) -> impl Iterator<Item = ([usize; 3], &str)> {
    let shared = raw
        .shared
        .iter()
        .flat_map(|list| list.triangles.iter().flat_map(|cell| list.names.iter().map(|name| (*cell, name.as_str()))));
    raw.triangles.iter().map(|(cell, name)| (*cell, name.as_str())).chain(shared)
}

fn sorted(mut cell: [usize; 3]) -> [usize; 3] {
    cell.sort_unstable();
    cell
}

/// Cells of bodies that are chosen by number or set.
fn bodies(raw: &mut RawMesh, scene: &Scene) -> Result<(), MeshError> {
    if scene.cells.is_empty() {
        return Ok(());
    }
    let mut body_of: Map<[usize; 3], usize> = Map::default();
    for chosen in &scene.cells {
        let body = &scene.bodies[chosen.body].name;
        let name = match &chosen.group {
            Group::Set(name) => name.clone(),
            Group::Tag(tag) => raw.sets.numbers.get(&(2, *tag)).cloned().unwrap_or_else(|| tag.to_string()),
        };
        let mut cells: Vec<[usize; 3]> = named_cells(raw).filter(|(_, n)| *n == name).map(|(cell, _)| cell).collect();
        if let (true, Group::Tag(tag)) = (cells.is_empty(), &chosen.group) {
            cells = raw.sets.entity(2, *tag).flat_map(|cells| &cells.triangles).copied().collect();
        }
        if cells.is_empty() {
            let mut names: Vec<&str> = named_cells(raw).map(|(_, name)| name).filter(|n| !n.is_empty()).collect();
            names.sort_unstable();
            names.dedup();
            let (kind, there) = match &chosen.group {
                Group::Set(name) => {
                    (format!("set '{name}'"), format!("sets {}{}", list(&names), suggestion(name, &names)))
                }
                Group::Tag(tag) => (format!("tag {tag}"), format!("tags {}", list(&raw.sets.tags(2)))),
            };
            let what = format!("body '{body}' of the scene is the cells of {kind}, and no cell is in it");
            return Err(MeshError::cells(scene, what, format!("the file has the {there}")));
        }
        for cell in cells {
            if let Some(other) = body_of.insert(sorted(cell), chosen.body).filter(|other| *other != chosen.body) {
                let what =
                    format!("a cell is in what makes body '{}' and in what makes '{body}'", scene.bodies[other].name);
                return Err(MeshError::cells(scene, what, "give the two bodies cells of their own"));
            }
        }
    }
    // A group of the file may be called as a body that is made of other cells.
    let made: HashSet<&str> = scene.cells.iter().map(|chosen| scene.bodies[chosen.body].name.as_str()).collect();
    let name_of = |cell: &[usize; 3]| body_of.get(&sorted(*cell)).map(|&body| scene.bodies[body].name.clone());
    for (cell, name) in &mut raw.triangles {
        match name_of(cell) {
            Some(body) => *name = body,
            None if made.contains(name.as_str()) => *name = format!("{name} of the file"),
            None => {}
        }
    }
    for list in &mut raw.shared {
        let mut rest = Vec::new();
        for cell in std::mem::take(&mut list.triangles) {
            match name_of(&cell) {
                Some(body) => raw.triangles.push((cell, body)),
                None => rest.push(cell),
            }
        }
        list.triangles = rest;
        if !list.triangles.is_empty() {
            let clash = list.names.iter_mut().filter(|name| made.contains(name.as_str()));
            clash.for_each(|name| *name = format!("{name} of the file"));
        }
    }
    Ok(())
}

/// All cells of a file that names none belong to the only body of the scene.
fn only_body(raw: &mut RawMesh, scene: &Scene, notes: &mut Vec<Note>) {
    let ([body], true) = (scene.bodies.as_slice(), scene.cells.is_empty()) else { return };
    let mut groups: HashSet<&str> = named_cells(raw).map(|(_, name)| name).collect();
    let number = |name: &str| name.is_empty() || name.parse::<i64>().is_ok();
    if groups.contains(body.name.as_str()) {
        return;
    }
    if groups.len() > 1 && !groups.iter().all(|name| number(name)) {
        let all: HashSet<[usize; 3]> = named_cells(raw).map(|(cell, _)| sorted(cell)).collect();
        let whole = |name: &&&str| {
            let cells = named_cells(raw).filter(|(_, n)| n == *name).map(|(cell, _)| sorted(cell));
            cells.collect::<HashSet<_>>().len() == all.len()
        };
        let Some(one) = groups.iter().find(whole) else { return };
        groups = HashSet::from([*one]);
    }
    groups.remove("");
    let told = match groups.into_iter().collect::<Vec<_>>().as_slice() {
        [] => None,
        [one] => Some(format!("'{one}'")),
        several => Some(list(several)),
    };
    if let Some(told) = told {
        let text = format!(
            "All cells were taken for body '{}', the only one of the scene; the file calls them {told}.",
            body.name
        );
        notes.push(Note { weakens_guarantee: false, text });
    }
    let name = body.name.clone();
    raw.triangles.iter_mut().for_each(|(_, of)| of.clone_from(&name));
    for list in raw.shared.iter_mut().filter(|list| !list.triangles.is_empty()) {
        raw.triangles.extend(std::mem::take(&mut list.triangles).into_iter().map(|cell| (cell, name.clone())));
    }
}

fn list<T: ToString>(names: &[T]) -> String {
    match names {
        [] => "none".to_string(),
        some => some.iter().map(T::to_string).collect::<Vec<_>>().join(", "),
    }
}

/// An edge of the outline of a body, with the body on its left.
struct Side {
    vertices: [usize; 2],
    /// Index into the bodies of the scene.
    body: Option<usize>,
    /// Whether another body has the edge too.
    shared: bool,
}

/// The edges that a mesh has on one side only, and those between two bodies, once for each.
struct Outline<'a> {
    raw: &'a RawMesh,
    scene: &'a Scene,
    cells: &'a [([usize; 3], &'a str)],
    sides: Vec<Side>,
    /// Largest coordinate.
    size: f64,
}

impl<'a> Outline<'a> {
    fn new(raw: &'a RawMesh, cells: &'a [([usize; 3], &'a str)], scene: &'a Scene) -> Self {
        let body_of = |name: &str| scene.bodies.iter().position(|body| body.name == name);
        let mut of: Map<[usize; 3], Option<usize>> = Map::default();
        for (cell, name) in cells {
            let body = of.entry(sorted(*cell)).or_default();
            *body = body.or(body_of(name));
        }
        let mut sides: Map<Pair, Vec<([usize; 2], Option<usize>)>> = Map::default();
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
        Outline { raw, scene, cells, sides, size }
    }

    /// The edges of `boundary`, each with its body on the left.
    fn edges(&self, boundary: &Boundary) -> Result<Vec<[usize; 2]>, MeshError> {
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

    /// Whether `boundary` may have this edge: one between two bodies only where it names its own.
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
            self.cells.iter().filter(|(_, n)| *n == name).map(|(cell, _)| sorted(*cell)).collect();
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
                names.extend(self.cells.iter().map(|(_, n)| *n).filter(|n| !n.is_empty()));
                names.sort_unstable();
                names.dedup();
                let remedy = format!("the file has the sets {}{}", list(&names), suggestion(&name, &names));
                let what = format!("is the set '{name}', of which no edge lies on the outline");
                Err(MeshError::boundary(self.scene, &boundary.name, what, remedy))
            }
            (true, Group::Tag(tag)) => {
                let what = format!("is the entity {tag}, of which no edge lies on the outline");
                let remedy = format!("the file has curves with the tags {}", list(&sets.tags(1)));
                Err(MeshError::boundary(self.scene, &boundary.name, what, remedy))
            }
        }
    }

    /// What to say of a boundary that chose no edge.
    fn nothing(&self, boundary: &Boundary) -> MeshError {
        let kind = match boundary.edges {
            Edges::Line(_) => "on this segment",
            Edges::Box(_) => "inside this box",
            Edges::Circle { .. } => "with its ends on this circle",
            Edges::Normal { .. } => "with such a normal",
            Edges::Group(_) => "of this group",
        };
        let offered = self.sides.iter().filter(|side| self.offered(side, boundary));
        let points = offered.flat_map(|side| side.vertices).map(|v| self.scene.as_written(self.raw.points[v]));
        let [mut low, mut high] = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        for p in points {
            low = [low[0].min(p[0]), low[1].min(p[1])];
            high = [high[0].max(p[0]), high[1].max(p[1])];
        }
        let of = boundary.body.map_or(String::new(), |body| format!(" of body '{}'", self.scene.bodies[body].name));
        let what = format!("has no edge: none of the outline{of} lies {kind}");
        let remedy = match low[0] <= high[0] {
            true => format!(
                "the outline{of} lies between ({}, {}) and ({}, {}), and an edge is taken where both its ends are",
                low[0], low[1], high[0], high[1]
            ),
            false => "the mesh has no such outline".to_string(),
        };
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
