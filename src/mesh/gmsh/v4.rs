//! `$Entities`, `$Nodes` and `$Elements` of MSH 4.1.

use std::rc::Rc;

use super::content::{Content, Element, element_type};
use super::cursor::Cursor;
use crate::mesh::MeshError;

pub(super) fn entities(cursor: &mut Cursor, content: &mut Content) -> Result<(), MeshError> {
    let counts = [cursor.size()?, cursor.size()?, cursor.size()?, cursor.size()?];
    for (dimension, count) in (0..).zip(counts) {
        for _ in 0..count {
            let tag = cursor.int()?;
            for _ in 0..if dimension == 0 { 3 } else { 6 } {
                cursor.double()?;
            }
            let mut physical = Vec::new();
            for _ in 0..cursor.size()? {
                // The sign is the orientation of the curve in its group.
                physical.push(cursor.int()?.saturating_abs());
            }
            if dimension > 0 {
                for _ in 0..cursor.size()? {
                    cursor.int()?;
                }
            }
            if content.entities.insert((dimension, tag), physical.into()).is_some() {
                let what = format!("the entity {tag} of dimension {dimension} is there twice");
                return Err(cursor.fault(what, "the file is damaged: write it again"));
            }
        }
    }
    Ok(())
}

pub(super) fn nodes(cursor: &mut Cursor, content: &mut Content) -> Result<(), MeshError> {
    let (blocks, total) = head(cursor)?;
    let mut read = 0_u64;
    for _ in 0..blocks {
        let dimension = cursor.int()?;
        cursor.int()?;
        let parametric = cursor.int()? != 0;
        let count = cursor.size()?;
        let mut tags = Vec::new();
        for _ in 0..count {
            tags.push(cursor.size()?);
        }
        for tag in tags {
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

pub(super) fn elements(cursor: &mut Cursor, content: &mut Content) -> Result<(), MeshError> {
    let (blocks, total) = head(cursor)?;
    let mut read = 0_u64;
    for _ in 0..blocks {
        let (dimension, entity) = (cursor.int()?, cursor.int()?);
        let number = cursor.int()?;
        let (kind, node_count) = element_type(number).map_err(|(what, remedy)| cursor.fault(what, remedy))?;
        let count = cursor.size()?;
        let physical = content.entities.get(&(dimension, entity)).cloned().unwrap_or_else(|| [].into());
        for _ in 0..count {
            let tag = cursor.size()?;
            let nodes = (0..node_count).map(|_| cursor.size()).collect::<Result<Vec<_>, _>>()?;
            if let Some(kind) = kind {
                content.elements.push(Element { kind, tag, nodes, physical: Rc::clone(&physical) });
            }
        }
        read = read.saturating_add(count);
    }
    agree(cursor, read, total, "elements")
}

/// Number of blocks and of entries; the smallest and largest tag are of no use here.
fn head(cursor: &mut Cursor) -> Result<(u64, u64), MeshError> {
    let head = (cursor.size()?, cursor.size()?);
    cursor.size()?;
    cursor.size()?;
    Ok(head)
}

fn agree(cursor: &Cursor, read: u64, total: u64, things: &str) -> Result<(), MeshError> {
    if read == total {
        return Ok(());
    }
    let what = format!("the section announces {total} {things}, its blocks have {read}");
    Err(cursor.fault(what, "the file is damaged: write it again"))
}
