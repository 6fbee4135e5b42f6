//! Bodies and boundaries that the scene chooses from what a mesh holds: by set, by number, or by where edges lie.

mod bodies;
mod outline;

use std::collections::{BTreeMap, HashMap, HashSet};

use outline::Outline;

use super::RawMesh;
use super::error::MeshError;
use super::topology::labels::{Pair, pair, used_names};
use crate::scene::{Boundary, Edges, Group, Kinematics, Note, Scene};

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

/// Sets of a file beside its named cells.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Sets {
    /// Kinds of cells with their numbers.
    pub kinds: BTreeMap<String, usize>,
    /// Names of physical groups by dimension and number.
    pub numbers: HashMap<(i32, i32), String>,
    /// Cells by elementary entity.
    pub entities: Vec<Entity>,
    /// Vertices by node set.
    pub nodes: Vec<(String, Vec<usize>)>,
    /// Sides of cells by surface.
    pub surfaces: Vec<(String, Vec<[usize; 2]>)>,
    /// Kinematics that elements of the file are made for, each with the name of one.
    pub made_for: Vec<(Kinematics, String)>,
}

impl Sets {
    /// Notes where elements of the file are made for other kinematics than those of `scene`.
    pub(in crate::mesh) fn contradictions(&self, scene: &Scene) -> Vec<Note> {
        let others = self.made_for.iter().filter(|(kinematics, _)| *kinematics != scene.kinematics);
        let note = |(kinematics, name): &(Kinematics, String)| {
            let [of, own] = [*kinematics, scene.kinematics].map(Kinematics::name);
            let text = format!("elements {name} of the mesh file are made for {of}, and the scene is solved in {own}");
            Note { weakens_guarantee: false, text }
        };
        others.map(note).collect()
    }

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
    let boundaries: Vec<Boundary> = scene.boundaries.iter().cloned().chain(sets_by_name(raw, scene)).collect();
    let groups: Vec<([usize; 3], String)> = match boundaries.is_empty() {
        true => Vec::new(),
        false => named_cells(raw).map(|(cell, name)| (cell, name.to_owned())).collect(),
    };
    bodies::chosen(raw, scene)?;
    bodies::only(raw, scene, notes);
    if boundaries.is_empty() {
        return Ok(());
    }
    let outline = Outline::new(raw, &groups, scene);
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

/// Sets of nodes, sides and cells whose names conditions use as they are: no segment of the file, no body and no table of the
/// scene has them.
fn sets_by_name(raw: &RawMesh, scene: &Scene) -> Vec<Boundary> {
    let mut names: Vec<&str> = used_names(scene);
    names.sort_unstable();
    names.dedup();
    let cells: HashSet<&str> = named_cells(raw).map(|(_, name)| name).collect();
    let body = |name: &str| scene.bodies.iter().any(|body| body.name == name);
    let sets = || raw.sets.nodes.iter().map(|(name, _)| name).chain(raw.sets.surfaces.iter().map(|(name, _)| name));
    names.retain(|name| {
        let segments = raw
            .segments
            .iter()
            .map(|(_, n)| n)
            .chain(raw.shared.iter().filter(|l| !l.segments.is_empty()).flat_map(|l| &l.names));
        (sets().any(|set| set == name) || (cells.contains(name) && !body(name)))
            && scene.boundaries.iter().all(|boundary| boundary.name != *name)
            && !segments.into_iter().any(|n| n == name)
    });
    let set =
        |name: &str| Boundary { name: name.to_owned(), body: None, edges: Edges::Group(Group::Set(name.to_owned())) };
    names.into_iter().map(set).collect()
}

/// Cells with every name of theirs, one at a time.
pub(super) fn named_cells(raw: &RawMesh) -> impl Iterator<Item = ([usize; 3], &str)> {
    let shared = raw
        .shared
        .iter()
        .flat_map(|list| list.triangles.iter().flat_map(|cell| list.names.iter().map(|name| (*cell, name.as_str()))));
    raw.triangles.iter().map(|(cell, name)| (*cell, name.as_str())).chain(shared)
}

pub(super) fn sorted(mut cell: [usize; 3]) -> [usize; 3] {
    cell.sort_unstable();
    cell
}

fn list<T: ToString>(names: &[T]) -> String {
    match names {
        [] => "none".to_string(),
        some => some.iter().map(T::to_string).collect::<Vec<_>>().join(", "),
    }
}
