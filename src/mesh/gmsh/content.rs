//! What a mesh file contains, whatever its version, and how it becomes a [`RawMesh`].

use std::collections::HashMap;
use std::path::Path;
use std::rc::Rc;

use crate::mesh::{MeshError, RawMesh, Shared};
use crate::scene::Note;

/// Deviation from the plane, and of a mid-node from the middle, in parts of a length, that counts as round-off.
const ROUND_OFF: f64 = 1e-9;

/// The cells that are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::mesh) enum Kind {
    Line,
    Triangle,
}

/// A line or triangle with its mid-nodes.
pub(in crate::mesh) struct Element {
    pub kind: Kind,
    /// Tag in the file, for messages.
    pub tag: u64,
    /// Node tags; corners first, then the middles of (0, 1), (1, 2), (2, 0).
    pub nodes: Vec<u64>,
    /// Physical tags; none means untagged. The elements of an entity share the list.
    pub physical: Rc<[i32]>,
}

/// The sections that matter.
#[derive(Default)]
pub(in crate::mesh) struct Content {
    /// Name by dimension and physical tag.
    pub names: HashMap<(i32, i32), String>,
    /// Physical tags by dimension and tag of an elementary entity (version 4).
    pub entities: HashMap<(i32, i32), Rc<[i32]>>,
    /// Coordinates by node tag.
    pub nodes: HashMap<u64, [f64; 3]>,
    pub elements: Vec<Element>,
}

/// Shape and number of nodes of an element type; shape `None` is a point, which is ignored.
pub(in crate::mesh) fn element_type(number: i32) -> Result<(Option<Kind>, usize), (String, &'static str)> {
    const TRIANGLES: &str = "mesh with triangles (no recombination, no subdivision into quadrangles)";
    const FLAT: &str = "this program is plane: save the surfaces only";
    const ORDER: &str = "mesh with straight triangles (Mesh.ElementOrder = 1)";
    let unusable = |what: &str, remedy| Err((format!("element type {number}, {what}, cannot be used"), remedy));
    match number {
        1 => Ok((Some(Kind::Line), 2)),
        2 => Ok((Some(Kind::Triangle), 3)),
        8 => Ok((Some(Kind::Line), 3)),
        9 => Ok((Some(Kind::Triangle), 6)),
        15 => Ok((None, 1)),
        3 | 10 | 16 => unusable("a quadrangle", TRIANGLES),
        4..=7 | 11..=14 | 17..=19 | 29..=31 => unusable("a cell in space", FLAT),
        20..=28 => unusable("a cell of third or higher order", ORDER),
        _ => unusable("unknown", TRIANGLES),
    }
}

impl Content {
    /// Triangles and named segments in the plane.
    pub fn into_raw(self, file: &Path) -> Result<(RawMesh, Vec<Note>), MeshError> {
        let mut order: Vec<u64> = self.nodes.keys().copied().collect();
        order.sort_unstable();
        let index: HashMap<u64, usize> = order.iter().enumerate().map(|(i, tag)| (*tag, i)).collect();
        let position: Vec<[f64; 3]> = order.iter().map(|tag| self.nodes[tag]).collect();
        let mut raw = RawMesh { points: position.iter().map(|p| [p[0], p[1]]).collect(), ..RawMesh::default() };
        let mut quadratic = 0_usize;
        // The list that the last of `raw.shared` was made of, with its dimension.
        let mut shared: Option<(i32, Rc<[i32]>)> = None;
        for element in &self.elements {
            let mut nodes = Vec::with_capacity(element.nodes.len());
            for tag in &element.nodes {
                let Some(&node) = index.get(tag) else {
                    let what = format!("element {} uses node {tag}, which is not in $Nodes", element.tag);
                    return Err(MeshError::file(file, what, "the file is damaged: write it again"));
                };
                nodes.push(node);
            }
            plane(file, element.tag, &nodes, &position)?;
            let corners = if element.kind == Kind::Line { 2 } else { 3 };
            if nodes.len() > corners {
                straight(file, element.tag, &nodes, corners, &raw.points)?;
                quadratic += usize::from(element.kind == Kind::Triangle);
            }
            let name = |dimension: i32, tag: i32| {
                self.names.get(&(dimension, tag)).cloned().unwrap_or_else(|| tag.to_string())
            };
            let dimension = if element.kind == Kind::Line { 1 } else { 2 };
            match (&*element.physical, element.kind) {
                ([], Kind::Line) => {}
                ([], Kind::Triangle) => raw.triangles.push(([nodes[0], nodes[1], nodes[2]], String::new())),
                ([tag], Kind::Line) => raw.segments.push(([nodes[0], nodes[1]], name(1, *tag))),
                ([tag], Kind::Triangle) => raw.triangles.push(([nodes[0], nodes[1], nodes[2]], name(2, *tag))),
                (tags, kind) => {
                    // With many tags and many elements, their product is what must not be stored.
                    let same = |(d, list): &(i32, Rc<[i32]>)| *d == dimension && Rc::ptr_eq(list, &element.physical);
                    if !shared.as_ref().is_some_and(same) {
                        let names = tags.iter().map(|&tag| name(dimension, tag)).collect();
                        raw.shared.push(Shared { names, ..Shared::default() });
                        shared = Some((dimension, Rc::clone(&element.physical)));
                    }
                    if let Some(list) = raw.shared.last_mut() {
                        match kind {
                            Kind::Line => list.segments.push([nodes[0], nodes[1]]),
                            Kind::Triangle => list.triangles.push([nodes[0], nodes[1], nodes[2]]),
                        }
                    }
                }
            }
        }
        let note = (quadratic > 0).then(|| Note {
            weakens_guarantee: false,
            text: format!("the mid-nodes of {quadratic} straight quadratic triangles were dropped"),
        });
        Ok((raw, note.into_iter().collect()))
    }
}

fn plane(file: &Path, tag: u64, nodes: &[usize], position: &[[f64; 3]]) -> Result<(), MeshError> {
    for &node in nodes {
        let [x, y, z] = position[node];
        let size = nodes.iter().flat_map(|&n| position[n]).map(f64::abs).fold(0.0, f64::max);
        if z.abs() > ROUND_OFF * size {
            let what = format!("element {tag} has a node at ({x}, {y}, {z}), outside the plane z = 0");
            return Err(MeshError::file(file, what, "put the geometry into the plane z = 0"));
        }
    }
    Ok(())
}

fn straight(file: &Path, tag: u64, nodes: &[usize], corners: usize, points: &[[f64; 2]]) -> Result<(), MeshError> {
    for (i, &node) in nodes[corners..].iter().enumerate() {
        let [a, b, middle] = [nodes[i % corners], nodes[(i + 1) % corners], node].map(|n| points[n]);
        let off = (0.5 * (a[0] + b[0]) - middle[0]).hypot(0.5 * (a[1] + b[1]) - middle[1]);
        if off > ROUND_OFF * (b[0] - a[0]).hypot(b[1] - a[1]) {
            let [x, y] = middle;
            let what = format!("element {tag} is curved: its mid-node ({x}, {y}) is not halfway");
            return Err(MeshError::file(file, what, "mesh with straight triangles (Mesh.ElementOrder = 1)"));
        }
    }
    Ok(())
}
