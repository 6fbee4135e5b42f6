//! An inventory of a mesh file: its cells by body, its boundaries and sets, and the outline by line and circle.

mod outline;
mod regions;
mod starting;

use std::collections::{BTreeMap, HashSet};
use std::path::{Path, PathBuf};
use std::time::Duration;

pub use outline::{Piece, Shape};
pub use regions::Region;
pub use starting::starting_scene;

use super::files::file;
use super::select::{named_cells, sorted};
use super::topology::labels::{Pair, pair};
use super::topology::touching::notes;
use super::{MeshError, RawMesh, Triangulation, chosen};
use crate::scene::{Kinematics, Note, Scene, toml_key, toml_string};

/// Edges that a file names or numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Its name, or its number.
    pub name: String,
    /// Keys that choose it in a table of `[[boundaries]]`; none where conditions may use the name as it is.
    pub keys: Option<String>,
    /// Number of its edges, or of its nodes where it is a set of nodes.
    pub members: usize,
    /// Its edges that lie on the outline.
    pub on_outline: Vec<[usize; 2]>,
    /// Sum of the lengths of its edges on the outline.
    pub length: f64,
}

/// Contents of a mesh file.
#[derive(Debug, Clone, PartialEq)]
pub struct Inventory {
    /// The file.
    pub file: PathBuf,
    /// Coordinates of the vertices.
    pub points: Vec<[f64; 2]>,
    /// Each triangle once; a quadrilateral is two.
    pub triangles: Vec<[usize; 3]>,
    /// Index into `bodies` of each triangle.
    pub body: Vec<usize>,
    /// Kinds of cells as the file has them, with their numbers.
    pub kinds: BTreeMap<String, usize>,
    /// The kinematics that all its elements are made for, where their names say so, and such a name.
    pub made_for: Option<(Kinematics, String)>,
    /// Groups of cells that together make the whole mesh, each cell in one.
    pub bodies: Vec<Region>,
    /// All other groups and entities of cells.
    pub groups: Vec<Region>,
    /// Named or numbered segments.
    pub boundaries: Vec<Curve>,
    /// Sets of nodes.
    pub node_sets: Vec<Curve>,
    /// Sets of sides of cells.
    pub surfaces: Vec<Curve>,
    /// Segments by elementary entity.
    pub entities: Vec<Curve>,
    /// The outline of the bodies, and the edges between two of them.
    pub outline: Vec<Piece>,
    /// Notes on changes made while the file was read.
    pub notes: Vec<Note>,
}

impl Inventory {
    /// Reads `file`, giving a program that helps with it at most `limit`.
    ///
    /// # Errors
    /// [`MeshError`] when it cannot be read, or has no plane cells.
    pub fn read(file: &Path, limit: Duration) -> Result<Self, MeshError> {
        let (raw, notes) = file::read(file, limit)?;
        Self::of(&raw, notes, file)
    }

    /// The inventory of what a reader made of `file`.
    ///
    /// # Errors
    /// [`MeshError`] when there are no plane cells, or they refer to vertices that are not there.
    pub fn of(raw: &RawMesh, notes: Vec<Note>, file: &Path) -> Result<Self, MeshError> {
        let mut seen: HashSet<[usize; 3]> = HashSet::new();
        let triangles: Vec<[usize; 3]> =
            named_cells(raw).map(|(cell, _)| cell).filter(|cell| seen.insert(sorted(*cell))).collect();
        if triangles.is_empty() {
            let there: Vec<String> = raw.sets.kinds.iter().map(|(kind, n)| format!("{n} × {kind}")).collect();
            let found = if there.is_empty() { "no cells".to_string() } else { there.join(", ") };
            let what = format!("it holds no plane cells: {found} and {} nodes were found", raw.points.len());
            return Err(MeshError::file(
                file,
                what,
                "mesh the surfaces with triangles or quadrilaterals and save them",
            ));
        }
        let segments = raw.segments.iter().map(|(s, _)| s).chain(raw.shared.iter().flat_map(|list| &list.segments));
        let wrong = |v: &&usize| **v >= raw.points.len() || !raw.points[**v].iter().all(|x| x.is_finite());
        if let Some(v) = triangles.iter().flatten().chain(segments.flatten()).find(wrong) {
            let what = format!("a cell refers to vertex {}, which has no finite coordinates in it", v + 1);
            return Err(MeshError::file(file, what, "write the mesh again"));
        }
        let (bodies, groups, body) = regions::divide(raw, &triangles);
        let sides = outline::sides(&raw.points, &triangles, &body);
        let curves = Curves { raw, on: sides.iter().map(|side| pair(side.vertices[0], side.vertices[1])).collect() };
        let named = curves.named();
        let of_file: HashSet<Pair> = named.iter().flat_map(|c| &c.on_outline).map(|[a, b]| pair(*a, *b)).collect();
        let taken: HashSet<&str> = named.iter().map(|curve| curve.name.as_str()).collect();
        let outline = outline::pieces(&raw.points, &sides, &bodies, &of_file, &taken);
        let mut inventory = Inventory {
            file: file.to_path_buf(),
            kinds: raw.sets.kinds.clone(),
            made_for: match &*raw.sets.made_for {
                [one] => Some(one.clone()),
                _ => None,
            },
            boundaries: named,
            node_sets: curves.node_sets(),
            surfaces: curves.surfaces(),
            entities: curves.entities(),
            points: raw.points.clone(),
            triangles,
            body,
            bodies,
            groups,
            outline,
            notes,
        };
        inventory.notes.extend(inventory.told_of_scenes(raw.clone()));
        Ok(inventory)
    }

    /// Notes on sides that lie on each other without being joined, or one that says why no scene can be made of this mesh.
    fn told_of_scenes(&self, raw: RawMesh) -> Vec<Note> {
        let name = self.file.file_name().unwrap_or_default().to_string_lossy();
        let Ok(scene) = Scene::parse(&starting_scene(self, &name, &name), &self.file) else { return Vec::new() };
        let chosen = chosen(scene, raw, &mut Vec::new());
        match chosen.and_then(|(scene, raw)| Ok((Triangulation::new(raw, &scene)?.0, scene))) {
            Ok((mesh, scene)) => notes(&mesh, &scene),
            Err(error) => {
                let text = format!("a scene of this mesh is refused as it is: {error}");
                vec![Note { weakens_guarantee: false, text }]
            }
        }
    }

    /// The names that the file has for edges of a piece of the outline, and whether one of them has all of it.
    pub fn names_on(&self, piece: &Piece) -> (Vec<&str>, bool) {
        let own: HashSet<Pair> = piece.edges.iter().map(|[a, b]| pair(*a, *b)).collect();
        let on = |curve: &Curve| curve.on_outline.iter().filter(|[a, b]| own.contains(&pair(*a, *b))).count();
        let curves = self.boundaries.iter().chain(&self.surfaces).chain(&self.node_sets);
        let found: Vec<(&Curve, usize)> = curves.map(|curve| (curve, on(curve))).filter(|(_, n)| *n > 0).collect();
        let names = found.iter().map(|(curve, _)| curve.name.as_str()).collect();
        (names, found.iter().any(|(_, n)| *n == own.len()))
    }

    /// The lines of a table `[bodies.NAME]` that choose the cells of a body, without its material.
    pub fn body_lines(&self, region: &Region) -> Vec<String> {
        let mut lines = vec![format!("[bodies.{}]", toml_key(&region.body))];
        lines.extend(region.keys.clone());
        lines
    }

    /// The lines of a table of `[[boundaries]]` for a piece of the outline.
    pub fn piece_lines(&self, piece: &Piece) -> Vec<String> {
        let mut lines = vec!["[[boundaries]]".to_string(), format!("name = {}", toml_string(&piece.name))];
        if self.bodies.len() > 1 {
            lines.push(format!("body = {}", toml_string(&self.bodies[piece.body].body)));
        }
        lines.push(piece.shape.key());
        lines
    }

    /// The lines of a table of `[[boundaries]]` for a curve of the file; none where its name is enough.
    pub fn curve_lines(&self, curve: &Curve) -> Vec<String> {
        let table = |keys: &String| {
            let name = format!("curve_{}", curve.name);
            vec!["[[boundaries]]".to_string(), format!("name = {}", toml_string(&name)), keys.clone()]
        };
        curve.keys.as_ref().map_or_else(Vec::new, table)
    }
}

/// The curves of a file.
struct Curves<'a> {
    raw: &'a RawMesh,
    /// The edges of the outline.
    on: HashSet<Pair>,
}

impl Curves<'_> {
    fn curve(&self, name: &str, keys: Option<String>, edges: &[[usize; 2]], members: usize) -> Curve {
        let points = &self.raw.points;
        let mut seen = HashSet::new();
        let on_outline: Vec<[usize; 2]> = edges
            .iter()
            .copied()
            .filter(|[a, b]| self.on.contains(&pair(*a, *b)) && seen.insert(pair(*a, *b)))
            .collect();
        let length = on_outline.iter().map(|e| outline::length(e.map(|v| points[v]))).sum();
        Curve { name: name.to_string(), keys, members, on_outline, length }
    }

    fn named(&self) -> Vec<Curve> {
        let mut by_name: BTreeMap<&str, Vec<[usize; 2]>> = BTreeMap::new();
        for (segment, name) in &self.raw.segments {
            by_name.entry(name).or_default().push(*segment);
        }
        for list in self.raw.shared.iter().filter(|list| !list.segments.is_empty()) {
            for name in &list.names {
                by_name.entry(name).or_default().extend(&list.segments);
            }
        }
        let named = by_name.into_iter().filter(|(name, _)| !name.is_empty());
        named.map(|(name, edges)| self.curve(name, None, &edges, edges.len())).collect()
    }

    fn node_sets(&self) -> Vec<Curve> {
        let set = |(name, nodes): &(String, Vec<usize>)| {
            let within: HashSet<usize> = nodes.iter().copied().collect();
            let mut edges: Vec<[usize; 2]> =
                self.on.iter().filter(|e| e.iter().all(|v| within.contains(v))).copied().collect();
            edges.sort_unstable();
            self.curve(name, None, &edges, within.len())
        };
        self.raw.sets.nodes.iter().map(set).collect()
    }

    fn surfaces(&self) -> Vec<Curve> {
        self.raw.sets.surfaces.iter().map(|(name, sides)| self.curve(name, None, sides, sides.len())).collect()
    }

    fn entities(&self) -> Vec<Curve> {
        let mut by_tag: BTreeMap<i32, Vec<[usize; 2]>> = BTreeMap::new();
        for entity in self.raw.sets.entities.iter().filter(|entity| entity.dimension == 1) {
            by_tag.entry(entity.tag).or_default().extend(&entity.cells.segments);
        }
        // A physical group goes before an entity of its number.
        let group = |tag: &i32| {
            let called = self.raw.sets.numbers.contains_key(&(1, *tag));
            called || self.raw.segments.iter().any(|(_, name)| *name == tag.to_string())
        };
        by_tag.retain(|tag, _| !group(tag));
        let of = |(tag, edges): (i32, Vec<[usize; 2]>)| {
            self.curve(&tag.to_string(), Some(format!("tag = {tag}")), &edges, edges.len())
        };
        by_tag.into_iter().map(of).collect()
    }
}
