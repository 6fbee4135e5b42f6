//! `$Entities`, `$Nodes` and `$Elements` of MSH 4.0 and 4.1.

use std::rc::Rc;

use super::Minor;
use super::cursor::Cursor;
use super::partitions::Partitions;
use super::v2::{self, Shape};
use crate::mesh::MeshError;
use crate::mesh::files::content::{Content, Element};

pub(super) fn entities(cursor: &mut Cursor, content: &mut Content, minor: Minor) -> Result<(), MeshError> {
    let counts = [cursor.size()?, cursor.size()?, cursor.size()?, cursor.size()?];
    for (dimension, count) in (0..).zip(counts) {
        for _ in 0..count {
            let tag = entity_tag(cursor, content)?;
            let physical = physical_of_entity(cursor, content, dimension, minor)?;
            if content.entities.insert((dimension, tag), physical).is_some() {
                let what = format!("the entity {tag} of dimension {dimension} is there twice");
                return Err(cursor.fault(what, "the file is damaged: write it again"));
            }
        }
    }
    Ok(())
}

/// Physical tags of an entity, which stand behind its box and before the entities around it.
pub(super) fn physical_of_entity(
    cursor: &mut Cursor,
    content: &mut Content,
    dimension: i32,
    minor: Minor,
) -> Result<Rc<[i32]>, MeshError> {
    // A point is its own box in version 4.1.
    for _ in 0..if dimension == 0 && minor == Minor::One { 3 } else { 6 } {
        cursor.double()?;
    }
    let mut physical = Vec::new();
    for _ in 0..cursor.size()? {
        // The sign is the orientation of the curve in its group.
        physical.push(content.tag(cursor.entity()?.saturating_abs()));
    }
    if dimension > 0 {
        for _ in 0..cursor.size()? {
            cursor.entity()?;
        }
    }
    Ok(physical.into())
}

pub(super) fn nodes(cursor: &mut Cursor, content: &mut Content, minor: Minor) -> Result<(), MeshError> {
    let (blocks, total) = head(cursor, minor)?;
    let mut read = 0_u64;
    for _ in 0..blocks {
        let (dimension, _) = entity(cursor, content, minor)?;
        let parametric = cursor.int()? != 0;
        let count = cursor.size()?;
        let mut tags = Vec::new();
        if minor == Minor::One {
            for _ in 0..count {
                tags.push(cursor.size()?);
            }
        }
        for i in 0..count {
            let tag = match minor {
                Minor::Zero => number(cursor)?,
                Minor::One => tags[i as usize],
            };
            let point = [cursor.double()?, cursor.double()?, cursor.double()?];
            for _ in 0..if parametric { dimension.clamp(0, 3) } else { 0 } {
                cursor.double()?;
            }
            super::add_node(cursor, content, tag, point)?;
        }
        read = read.saturating_add(count);
    }
    agree(cursor, read, total, "nodes")
}

pub(super) fn elements(
    cursor: &mut Cursor,
    content: &mut Content,
    minor: Minor,
    partitions: &mut Partitions,
) -> Result<(), MeshError> {
    let (blocks, total) = head(cursor, minor)?;
    let mut read = 0_u64;
    for _ in 0..blocks {
        let (dimension, entity) = entity(cursor, content, minor)?;
        let code = cursor.int()?;
        let (shape, node_count) = v2::shape(cursor, code)?;
        let count = cursor.size()?;
        let physical = content.entities.get(&(dimension, entity)).cloned().unwrap_or_else(|| [].into());
        let part = partitions.get_mut(&(dimension, entity));
        let entity = part.map_or(Some(entity), |part| {
            part.has_elements |= count > 0;
            part.parent
        });
        let read_number = |cursor: &mut Cursor| if minor == Minor::Zero { number(cursor) } else { cursor.size() };
        for _ in 0..count {
            let tag = read_number(cursor)?;
            let nodes = (0..node_count).map(|_| read_number(cursor)).collect::<Result<Vec<_>, _>>()?;
            match shape {
                Shape::Plane(kind) => {
                    let physical = Rc::clone(&physical);
                    content.elements.push(Element { kind, tag, nodes, physical, entity });
                }
                Shape::Solid(name) => content.solid(name, &nodes),
                Shape::Point => {}
            }
        }
        read = read.saturating_add(count);
    }
    agree(cursor, read, total, "elements")
}

/// The tag of an entity, which the file may write with more digits than a scene has.
pub(super) fn entity_tag(cursor: &mut Cursor, content: &mut Content) -> Result<i32, MeshError> {
    Ok(content.tag(cursor.entity()?))
}

/// Dimension and tag of the entity of a block.
fn entity(cursor: &mut Cursor, content: &mut Content, minor: Minor) -> Result<(i32, i32), MeshError> {
    if minor == Minor::Zero {
        let tag = entity_tag(cursor, content)?;
        return Ok((cursor.int()?, tag));
    }
    Ok((cursor.int()?, entity_tag(cursor, content)?))
}

/// A node or element number of version 4.0, a 4-byte integer in binary.
fn number(cursor: &mut Cursor) -> Result<u64, MeshError> {
    let number = cursor.int()?;
    u64::try_from(number)
        .map_err(|_| cursor.fault(format!("the number {number} is negative"), "the file is damaged: write it again"))
}

/// Number of blocks and of entries; version 4.1 has the smallest and largest tag too, which are of no use here.
fn head(cursor: &mut Cursor, minor: Minor) -> Result<(u64, u64), MeshError> {
    let head = (cursor.size()?, cursor.size()?);
    if minor == Minor::One {
        cursor.size()?;
        cursor.size()?;
    }
    Ok(head)
}

fn agree(cursor: &Cursor, read: u64, total: u64, things: &str) -> Result<(), MeshError> {
    if read == total {
        return Ok(());
    }
    let what = format!("the section announces {total} {things}, its blocks have {read}");
    Err(cursor.fault(what, "the file is damaged: write it again"))
}
