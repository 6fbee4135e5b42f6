//! `$Nodes` and `$Elements` of MSH 2. The counts are text in binary files too.

use super::cursor::{Cursor, Encoding};
use crate::mesh::MeshError;
use crate::mesh::cells::solids::solid_type;
use crate::mesh::files::content::{Content, Element, Kind, element_type};

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
        let (shape, node_count) = shape(cursor, number)?;
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
                let value = cursor.entity()?;
                match i {
                    0 => physical = value,
                    1 => entity = i32::try_from(value).ok(),
                    _ => {}
                }
            }
            let nodes = (0..node_count).map(|_| tag(cursor)).collect::<Result<Vec<_>, _>>()?;
            add(content, shape, tag_of_element, nodes, physical, entity);
        }
        left -= run;
    }
    Ok(())
}

/// What an element is.
#[derive(Clone, Copy)]
pub(super) enum Shape {
    Plane(Kind),
    Solid(&'static str),
    Point,
}

/// Shape and number of nodes of an element type.
pub(super) fn shape(cursor: &Cursor, number: i32) -> Result<(Shape, usize), MeshError> {
    if let Some((name, nodes)) = solid_type(number) {
        return Ok((Shape::Solid(name), nodes));
    }
    let (kind, nodes) = element_type(number).map_err(|(what, remedy)| cursor.fault(what, remedy))?;
    Ok((kind.map_or(Shape::Point, Shape::Plane), nodes))
}

/// Adds an element; the physical tag 0 is none.
pub(super) fn add(content: &mut Content, shape: Shape, tag: u64, nodes: Vec<u64>, physical: i64, entity: Option<i32>) {
    match shape {
        Shape::Plane(kind) => {
            let physical = if physical == 0 { Vec::new() } else { vec![content.tag(physical.saturating_abs())] };
            content.elements.push(Element { kind, tag, nodes, physical: physical.into(), entity });
        }
        Shape::Solid(name) => content.solid(name, &nodes),
        Shape::Point => {}
    }
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
