//! Which cells of a file make which body.

use std::collections::HashSet;

use super::{list, named_cells, sorted};
use crate::mesh::error::{MeshError, shown_by};
use crate::mesh::topology::labels::suggestion;
use crate::mesh::{Map, RawMesh};
use crate::scene::{Group, Note, Scene};

/// Cells of bodies that are chosen by number or set.
pub(super) fn chosen(raw: &mut RawMesh, scene: &Scene) -> Result<(), MeshError> {
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
            return Err(MeshError::cells(scene, what, format!("the file has the {there}{}", shown_by(scene))));
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
pub(super) fn only(raw: &mut RawMesh, scene: &Scene, notes: &mut Vec<Note>) {
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
