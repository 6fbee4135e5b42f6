//! Several mesh files as one mesh: each with its prefix, scale and place.

use std::collections::HashSet;
use std::time::Duration;

use super::file;
use crate::mesh::select::{Sets, named_cells};
use crate::mesh::topology::labels;
use crate::mesh::{MeshError, RawMesh};
use crate::scene::{Edges, Group, Note, Part, Scene};

/// Reads the files of `parts` and puts them together.
///
/// # Errors
/// A file cannot be read, or the scene uses a name or a tag that two of them have.
pub(in crate::mesh) fn read(parts: &[Part], scene: &Scene, limit: Duration) -> Result<(RawMesh, Vec<Note>), MeshError> {
    let (mut whole, mut notes) = (RawMesh::default(), Vec::new());
    let mut before: Vec<(&Part, Names)> = Vec::new();
    for part in parts {
        let (mut raw, of_file) = file::read(&part.file, limit)?;
        raw.points.iter_mut().for_each(|p| *p = part.place(*p));
        rename(&mut raw, &part.prefix);
        let names = Names::of(&raw);
        for (other, theirs) in &before {
            names.clash(theirs, [other, part], scene)?;
        }
        before.push((part, names));
        append(&mut whole, raw);
        let told = |note: Note| Note { text: format!("{}: {}", part.file.display(), note.text), ..note };
        notes.extend(of_file.into_iter().map(told));
    }
    Ok((whole, notes))
}

/// Puts `prefix` before every name. Cells without one are called by the prefix itself, without what separates it from names.
fn rename(raw: &mut RawMesh, prefix: &str) {
    if prefix.is_empty() {
        return;
    }
    // Groups without a name are called by their numbers, and are still found by them.
    let cells: Vec<i32> = named_cells(raw).filter_map(|(_, name)| name.parse().ok()).collect();
    let lists = raw.shared.iter().filter(|list| !list.segments.is_empty()).flat_map(|list| &list.names);
    let curves: Vec<i32> =
        raw.segments.iter().map(|(_, name)| name).chain(lists).filter_map(|n| n.parse().ok()).collect();
    for (dimension, tags) in [(2, cells), (1, curves)] {
        for tag in tags {
            raw.sets.numbers.entry((dimension, tag)).or_insert_with(|| tag.to_string());
        }
    }
    let alone = prefix.trim_end_matches(['_', '-', '.', ':', '/', ' ']);
    let own = |name: &mut String| {
        if !name.is_empty() {
            name.insert_str(0, prefix);
        }
    };
    for (_, name) in &mut raw.triangles {
        match name.is_empty() {
            true => *name = alone.to_string(),
            false => own(name),
        }
    }
    raw.segments.iter_mut().for_each(|(_, name)| own(name));
    raw.shared.iter_mut().flat_map(|list| &mut list.names).for_each(own);
    let Sets { numbers, nodes, surfaces, .. } = &mut raw.sets;
    numbers.values_mut().chain(nodes.iter_mut().map(|(name, _)| name)).for_each(own);
    surfaces.iter_mut().for_each(|(name, _)| own(name));
}

/// The names and numbers of a part.
struct Names {
    cells: HashSet<String>,
    edges: HashSet<String>,
    tags: HashSet<(i32, i32)>,
}

impl Names {
    fn of(raw: &RawMesh) -> Self {
        let cells = named_cells(raw).map(|(_, name)| name.to_string()).filter(|name| !name.is_empty()).collect();
        let lists = raw.shared.iter().filter(|list| !list.segments.is_empty()).flat_map(|list| &list.names);
        let segments = raw.segments.iter().map(|(_, name)| name).chain(lists);
        let sets = raw.sets.nodes.iter().map(|(name, _)| name).chain(raw.sets.surfaces.iter().map(|(name, _)| name));
        let entities = raw.sets.entities.iter().map(|entity| (entity.dimension, entity.tag));
        Names {
            cells,
            edges: segments.chain(sets).filter(|name| !name.is_empty()).cloned().collect(),
            tags: raw.sets.numbers.keys().copied().chain(entities).collect(),
        }
    }

    /// Refuses what `scene` uses and both parts have.
    fn clash(&self, other: &Names, parts: [&Part; 2], scene: &Scene) -> Result<(), MeshError> {
        let of_boundaries = scene.boundaries.iter().filter_map(|boundary| match &boundary.edges {
            Edges::Group(group) => Some((1, group)),
            _ => None,
        });
        let groups: Vec<(i32, &Group)> =
            of_boundaries.chain(scene.cells.iter().map(|cells| (2, &cells.group))).collect();
        let sets = |of: i32| {
            groups.iter().filter_map(move |(dimension, group)| match group {
                Group::Set(name) if *dimension == of => Some(name.as_str()),
                _ => None,
            })
        };
        let [one, two] = parts.map(|part| part.file.display());
        let twice = |what: String, remedy: &str| {
            Err(MeshError::cells(scene, format!("{what} is in {one} and in {two}"), remedy))
        };
        let chosen = |index: usize| scene.cells.iter().any(|cells| cells.body == index);
        let bodies = scene.bodies.iter().enumerate().filter(|(i, _)| !chosen(*i)).map(|(_, body)| body.name.as_str());
        let mut cells = bodies.chain(sets(2));
        if let Some(name) = cells.find(|name| self.cells.contains(*name) && other.cells.contains(*name)) {
            return twice(format!("the group of cells '{name}'"), "give one of the two parts a `prefix`");
        }
        let used =
            labels::used_names(scene).into_iter().filter(|name| scene.boundaries.iter().all(|b| b.name != *name));
        let mut edges = used.chain(sets(1));
        if let Some(name) = edges.find(|name| self.edges.contains(*name) && other.edges.contains(*name)) {
            return twice(format!("the boundary '{name}'"), "give one of the two parts a `prefix`");
        }
        let tag = groups.iter().find_map(|(dimension, group)| match group {
            Group::Tag(tag) if self.tags.contains(&(*dimension, *tag)) && other.tags.contains(&(*dimension, *tag)) => {
                Some(*tag)
            }
            _ => None,
        });
        match tag {
            Some(tag) => twice(format!("the tag {tag}"), "choose by name, `set`, or place instead"),
            None => Ok(()),
        }
    }
}

/// Adds the cells of `part`, which keep vertices of their own.
fn append(whole: &mut RawMesh, part: RawMesh) {
    let first = whole.points.len();
    let RawMesh { points, triangles, segments, shared, sets, quadrilaterals } = part;
    whole.points.extend(points);
    let cell = |cell: [usize; 3]| cell.map(|v| v + first);
    let edge = |edge: [usize; 2]| edge.map(|v| v + first);
    whole.quadrilaterals.extend(quadrilaterals.into_iter().map(|corners| corners.map(|v| v + first)));
    whole.triangles.extend(triangles.into_iter().map(|(t, name)| (cell(t), name)));
    whole.segments.extend(segments.into_iter().map(|(s, name)| (edge(s), name)));
    whole.shared.extend(shared.into_iter().map(|mut list| {
        list.triangles.iter_mut().for_each(|t| *t = cell(*t));
        list.segments.iter_mut().for_each(|s| *s = edge(*s));
        list
    }));
    for (kind, count) in sets.kinds {
        *whole.sets.kinds.entry(kind).or_default() += count;
    }
    whole.sets.numbers.extend(sets.numbers);
    whole.sets.made_for.extend(sets.made_for);
    whole.sets.entities.extend(sets.entities.into_iter().map(|mut entity| {
        entity.cells.triangles.iter_mut().for_each(|t| *t = cell(*t));
        entity.cells.segments.iter_mut().for_each(|s| *s = edge(*s));
        entity
    }));
    whole
        .sets
        .nodes
        .extend(sets.nodes.into_iter().map(|(name, nodes)| (name, nodes.iter().map(|v| v + first).collect())));
    whole
        .sets
        .surfaces
        .extend(sets.surfaces.into_iter().map(|(name, sides)| (name, sides.into_iter().map(edge).collect())));
}
