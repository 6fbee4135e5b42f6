//! `$PartitionedEntities` of MSH 4: the parts of entities belong to the physical groups of their parents.

use std::collections::HashMap;
use std::path::Path;

use super::Minor;
use super::cursor::{Cursor, Encoding};
use super::v4;
use crate::mesh::MeshError;
use crate::mesh::files::content::Content;

/// Parts of entities by dimension and tag.
pub(super) type Partitions = HashMap<(i32, i32), Part>;

/// A part of an entity, or the border between two parts.
pub(super) struct Part {
    /// Tag of the entity that it is a part of; none for a border.
    pub parent: Option<i32>,
    /// True where the file has elements of it.
    pub has_elements: bool,
    /// True where it is in a physical group.
    grouped: bool,
}

/// Reads the parts of entities and gives each the physical tags of its parent, unless it has its own.
pub(super) fn entities(cursor: &mut Cursor, content: &mut Content, minor: Minor) -> Result<Partitions, MeshError> {
    if minor == Minor::Zero && cursor.encoding != Encoding::Text {
        return Err(cursor.fault("the mesh is partitioned, in binary MSH 4.0", super::SAVE_AGAIN));
    }
    cursor.size()?;
    for _ in 0..cursor.size()? {
        // An entity of ghosts and its partition; their cells are those of other entities.
        cursor.entity()?;
        cursor.entity()?;
    }
    let counts = [cursor.size()?, cursor.size()?, cursor.size()?, cursor.size()?];
    let mut partitions = Partitions::new();
    for (dimension, count) in (0..).zip(counts) {
        for _ in 0..count {
            let tag = v4::entity_tag(cursor, content)?;
            let (of, parent) = (cursor.int()?, v4::entity_tag(cursor, content)?);
            for _ in 0..cursor.size()? {
                cursor.int()?;
            }
            let own = v4::physical_of_entity(cursor, content, dimension, minor)?;
            let parent = Some(parent).filter(|_| of == dimension);
            let inherited = || content.entities.get(&(dimension, parent?)).cloned();
            let physical = if own.is_empty() { inherited().unwrap_or(own) } else { own };
            let part = Part { parent, has_elements: false, grouped: !physical.is_empty() };
            if partitions.insert((dimension, tag), part).is_some() {
                let what = format!("the part {tag} of dimension {dimension} is there twice");
                return Err(cursor.fault(what, "the file is damaged: write it again"));
            }
            content.entities.insert((dimension, tag), physical);
        }
    }
    Ok(partitions)
}

/// Refuses a file that has the elements of some partitions and not of others: Gmsh writes one file for each where it is told to.
pub(super) fn whole(partitions: &Partitions, file: &Path) -> Result<(), MeshError> {
    let surfaces = || partitions.iter().filter(|((dimension, _), part)| *dimension == 2 && part.parent.is_some());
    // Where there are physical groups, only what is in one is saved.
    let groups = surfaces().any(|(_, part)| part.grouped);
    let saved: Vec<_> = surfaces().filter(|(_, part)| part.grouped || !groups).collect();
    let absent = saved.iter().filter(|(_, part)| !part.has_elements).count();
    if absent == 0 {
        return Ok(());
    }
    let what = format!("it has no elements of {absent} of the {} parts of its surfaces", saved.len());
    Err(MeshError::file(
        file,
        what,
        "save all partitions in one file (Mesh.PartitionSplitMeshFiles = 0), or save the mesh without partitions",
    ))
}
