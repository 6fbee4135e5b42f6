//! `$Nodes` and `$Elements` of MSH 2. The counts are text in binary files too.

use super::cursor::{Cursor, Encoding};
use crate::mesh::MeshError;
use crate::mesh::cells::solids::solid_type;
use crate::mesh::files::content::{Content, Element, element_type};

pub(super) fn nodes(cursor: &mut Cursor, content: &mut Content) -> Result<(), MeshError> {
    let count = text_count(cursor)?;
    for _ in 0..count {
        let tag = tag(cursor)?;
        let point = [cursor.double()?, cursor.double()?, cursor.double()?];
        super::add_node(cursor, content, tag, point)?;
    }
    Ok(())
}

pub(super) fn elements(cursor: &mut Cursor, content: &mut Content) -> Result<(), MeshError> {
    let mut left = text_count(cursor)?;
    while left > 0 {
        // In text each element has its own header; in binary one header serves a run of elements.
        let text = cursor.encoding == Encoding::Text;
        let first_tag = if text { Some(tag(cursor)?) } else { None };
        let number = cursor.int()?;
        let solid = solid_type(number);
        let (kind, node_count) = match solid {
            Some((_, nodes)) => (None, nodes),
            None => element_type(number).map_err(|(what, remedy)| cursor.fault(what, remedy))?,
        };
        let run = if text { 1 } else { u64::try_from(cursor.int()?).unwrap_or(0) };
        if run == 0 || run > left {
            let what = format!("a run of {run} elements where {left} are left");
            return Err(cursor.fault(what, "the file is damaged: write it again"));
        }
        let tags = cursor.int()?;
        for _ in 0..run {
            let tag_of_element = match first_tag {
                Some(tag) => tag,
                None => tag(cursor)?,
            };
            let (mut physical, mut entity) = (0, None);
            for i in 0..tags {
                let value = cursor.int()?;
                match i {
                    0 => physical = value,
                    1 => entity = Some(value),
                    _ => {}
                }
            }
            let nodes = (0..node_count).map(|_| tag(cursor)).collect::<Result<Vec<_>, _>>()?;
            if let Some((name, _)) = solid {
                content.solid(name, &nodes);
            }
            if let Some(kind) = kind {
                let physical = if physical == 0 { Vec::new() } else { vec![physical.saturating_abs()] };
                content.elements.push(Element { kind, tag: tag_of_element, nodes, physical: physical.into(), entity });
            }
        }
        left -= run;
    }
    Ok(())
}

fn text_count(cursor: &mut Cursor) -> Result<u64, MeshError> {
    cursor.in_text(|cursor| {
        let count = cursor.size()?;
        cursor.line();
        Ok(count)
    })
}

/// A node or element number; a 4-byte integer in binary.
fn tag(cursor: &mut Cursor) -> Result<u64, MeshError> {
    let tag = cursor.int()?;
    u64::try_from(tag)
        .map_err(|_| cursor.fault(format!("the number {tag} is negative"), "the file is damaged: write it again"))
}
