//! Content of a mesh file in any format, and its conversion to a [`RawMesh`].

use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::Path;
use std::rc::Rc;

use super::plane::Plane;
use crate::mesh::cells::quadrilateral;
use crate::mesh::cells::solids::Solids;
use crate::mesh::select::{Cells, Entity, Sets};
use crate::mesh::{MeshError, RawMesh, Shared};
use crate::scene::Note;

/// Deviation of a side from its chord, in parts of its length, that counts as round-off.
const ROUND_OFF: f64 = 1e-9;

/// Half of the last of seven digits, which many formats have, in parts of a coordinate, and the largest part of a side that they may put a
/// node between its corners beside it: the corners are where it is by the same rounding.
const SEVEN_DIGITS: f64 = 1e-6;
const BARELY: f64 = 1e-5;

/// Of the length of a side the distance from its corners at which no node between them lies, however curved the side is.
const FARTHEST: f64 = 2.0;

/// The shapes of cells that are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::mesh) enum Kind {
    Line,
    Triangle,
    Quadrilateral,
}

impl Kind {
    /// Number of corners.
    pub fn corners(self) -> usize {
        match self {
            Kind::Line => 2,
            Kind::Triangle => 3,
            Kind::Quadrilateral => 4,
        }
    }

    fn dimension(self) -> i32 {
        if self == Kind::Line { 1 } else { 2 }
    }

    /// Number of sides, each of which may have a node in its middle.
    fn sides(self) -> usize {
        if self == Kind::Line { 1 } else { self.corners() }
    }

    /// The name of a cell of this shape with so many nodes.
    pub fn told(self, nodes: usize) -> String {
        let shape = match self {
            Kind::Line => "line",
            Kind::Triangle => "triangle",
            Kind::Quadrilateral => "quadrilateral",
        };
        match nodes == self.corners() {
            true => shape.to_string(),
            false => format!("{shape} with {nodes} nodes"),
        }
    }

    /// True if a cell of this shape may have so many nodes: its corners, those with mid-nodes, and the quadrilateral with
    /// one in its centre.
    pub fn takes(self, nodes: usize) -> bool {
        let (corners, sides) = (self.corners(), self.sides());
        nodes == corners || nodes == corners + sides || (self == Kind::Quadrilateral && nodes == 9)
    }
}

/// A cell with its mid-nodes.
pub(in crate::mesh) struct Element {
    pub kind: Kind,
    /// Tag in the file, for messages.
    pub tag: u64,
    /// Node tags; corners first, then the middles of the sides (0, 1), (1, 2), …, then the centre.
    pub nodes: Vec<u64>,
    /// Physical tags; none means untagged. The elements of an entity share the list.
    pub physical: Rc<[i32]>,
    /// Tag of the elementary entity, where the format has such.
    pub entity: Option<i32>,
}

/// The sections that matter.
#[derive(Default)]
pub(in crate::mesh) struct Content {
    /// Name by dimension and physical tag.
    pub names: HashMap<(i32, i32), String>,
    /// Names by the numbers that the file itself has, where `names` has others.
    pub numbers: Option<HashMap<(i32, i32), String>>,
    /// Tags with more digits than a tag of a scene has, and the place of each: the stand-in of the first is the least tag.
    pub long: (Vec<i64>, HashMap<i64, usize>),
    /// Physical tags by dimension and tag of an elementary entity (version 4).
    pub entities: HashMap<(i32, i32), Rc<[i32]>>,
    /// Coordinates by node tag.
    pub nodes: HashMap<u64, [f64; 3]>,
    pub elements: Vec<Element>,
    /// Cells that this program has no use for.
    pub solids: Vec<Solids>,
    /// Node tags by the name of their set.
    pub node_sets: Vec<(String, Vec<u64>)>,
    /// Sides of cells by the name of their surface: pairs of node tags.
    pub surfaces: Vec<(String, Vec<[u64; 2]>)>,
}

/// Shape and number of nodes of a Gmsh element type; shape `None` is a point, which is ignored.
pub(in crate::mesh) fn element_type(number: i32) -> Result<(Option<Kind>, usize), (String, &'static str)> {
    const PLANE: &str = "mesh with triangles or quadrilaterals of first or second order";
    let unusable = |what: &str, remedy| Err((format!("element type {number}, {what}, cannot be used"), remedy));
    match number {
        1 => Ok((Some(Kind::Line), 2)),
        2 => Ok((Some(Kind::Triangle), 3)),
        3 => Ok((Some(Kind::Quadrilateral), 4)),
        8 => Ok((Some(Kind::Line), 3)),
        9 => Ok((Some(Kind::Triangle), 6)),
        10 => Ok((Some(Kind::Quadrilateral), 9)),
        15 => Ok((None, 1)),
        16 => Ok((Some(Kind::Quadrilateral), 8)),
        20..=28 => unusable("a cell of third or higher order", PLANE),
        _ => unusable("unknown", PLANE),
    }
}

impl Content {
    /// Triangles and named segments in the plane; quadrilaterals are cut in two, and the chord of a curved side stands for it.
    pub fn into_raw(mut self, file: &Path) -> Result<(RawMesh, Vec<Note>), MeshError> {
        self.no_solids(file)?;
        let turned = self.laid_down();
        let mut order: Vec<u64> = self.nodes.keys().copied().collect();
        order.sort_unstable();
        let index: HashMap<u64, usize> = order.iter().enumerate().map(|(i, tag)| (*tag, i)).collect();
        let position: Vec<[f64; 3]> = order.iter().map(|tag| self.nodes[tag]).collect();
        let plane = Plane::of(&self.elements, &index, &position);
        let mut raw = RawMesh { points: position.iter().map(|p| [p[0], p[1]]).collect(), ..RawMesh::default() };
        let mut counts = Counts::default();
        let mut sets = self.sets(&index);
        // The list that the last of `raw.shared` was made of, with its dimension.
        let mut shared: Option<(i32, Rc<[i32]>)> = None;
        let mut entity: Option<(i32, i32)> = None;
        for element in &self.elements {
            let mut nodes = Vec::with_capacity(element.nodes.len());
            for tag in &element.nodes {
                let Some(&node) = index.get(tag) else {
                    let what = format!("element {} uses node {tag}, which is not among its nodes", element.tag);
                    return Err(MeshError::file(file, what, "the file is damaged: write it again"));
                };
                nodes.push(node);
            }
            if !plane.holds(&nodes, &position) {
                return Err(plane.left(&self.elements, file, &index, &position));
            }
            let corners = element.kind.corners();
            if nodes.len() > corners {
                counts.second_order(element.kind, &nodes, &raw.points).map_err(|what| {
                    MeshError::file(file, what, "write the nodes of a cell as Gmsh has them: corners, the middles of the sides from corner to corner, centre")
                })?;
            }
            let cells = cut(file, element, &nodes[..corners], &raw.points, &mut counts)?;
            if let ([a, b, c, d], [_, _]) = (&nodes[..corners], cells.triangles.as_slice()) {
                raw.quadrilaterals.push([*a, *b, *c, *d]);
            }
            let dimension = element.kind.dimension();
            if let Some(tag) = element.entity.filter(|tag| self.long_tag(*tag).is_none()) {
                if entity != Some((dimension, tag)) {
                    entity = Some((dimension, tag));
                    sets.entities.push(Entity { dimension, tag, cells: Cells::default() });
                }
                if let Some(last) = sets.entities.last_mut() {
                    last.cells.extend(&cells);
                }
            }
            let name = |tag: i32| {
                let number = || self.long_tag(tag).unwrap_or(i64::from(tag)).to_string();
                self.names.get(&(dimension, tag)).cloned().unwrap_or_else(number)
            };
            match &*element.physical {
                [] => raw.triangles.extend(cells.triangles.iter().map(|t| (*t, String::new()))),
                [tag] => {
                    raw.segments.extend(cells.segments.iter().map(|s| (*s, name(*tag))));
                    raw.triangles.extend(cells.triangles.iter().map(|t| (*t, name(*tag))));
                }
                tags => {
                    // With many tags and many elements, their product is what must not be stored.
                    let same = |(d, list): &(i32, Rc<[i32]>)| *d == dimension && Rc::ptr_eq(list, &element.physical);
                    if !shared.as_ref().is_some_and(same) {
                        let names = tags.iter().map(|&tag| name(tag)).collect();
                        raw.shared.push(Shared { names, ..Shared::default() });
                        shared = Some((dimension, Rc::clone(&element.physical)));
                    }
                    if let Some(list) = raw.shared.last_mut() {
                        list.segments.extend(&cells.segments);
                        list.triangles.extend(&cells.triangles);
                    }
                }
            }
        }
        raw.sets = sets;
        Ok((raw, turned.into_iter().chain(counts.notes()).collect()))
    }

    /// The tag itself, or a stand-in that no file has for one with too many digits.
    pub fn tag(&mut self, tag: i64) -> i32 {
        i32::try_from(tag).unwrap_or_else(|_| {
            let (tags, places) = &mut self.long;
            let place = *places.entry(tag).or_insert(tags.len());
            if place == tags.len() {
                tags.push(tag);
            }
            i32::MIN.saturating_add(i32::try_from(place).unwrap_or(i32::MAX))
        })
    }

    /// The tag that this one stands for, if it does.
    fn long_tag(&self, tag: i32) -> Option<i64> {
        self.long.0.get(usize::try_from(i64::from(tag) - i64::from(i32::MIN)).ok()?).copied()
    }

    /// How many cells of each kind there are.
    pub fn kinds(&self) -> BTreeMap<String, usize> {
        let mut kinds = BTreeMap::new();
        for element in &self.elements {
            *kinds.entry(element.kind.told(element.nodes.len())).or_default() += 1;
        }
        kinds
    }

    fn sets(&self, index: &HashMap<u64, usize>) -> Sets {
        let known = |tags: &Vec<u64>| tags.iter().filter_map(|tag| index.get(tag).copied()).collect();
        let numbers = self.numbers.as_ref().unwrap_or(&self.names).iter();
        let numbers = numbers.filter(|((_, tag), _)| self.long_tag(*tag).is_none());
        let side = |[a, b]: &[u64; 2]| Some([*index.get(a)?, *index.get(b)?]);
        Sets {
            numbers: numbers.map(|(key, name)| (*key, name.clone())).collect(),
            kinds: self.kinds(),
            entities: Vec::new(),
            made_for: Vec::new(),
            nodes: self.node_sets.iter().map(|(name, tags)| (name.clone(), known(tags))).collect(),
            surfaces: self
                .surfaces
                .iter()
                .map(|(name, sides)| (name.clone(), sides.iter().filter_map(side).collect()))
                .collect(),
        }
    }
}

/// The segment or the triangles that stand for an element; its corners are `nodes`.
fn cut(
    file: &Path,
    element: &Element,
    nodes: &[usize],
    points: &[[f64; 2]],
    counts: &mut Counts,
) -> Result<Cells, MeshError> {
    let mut cells = Cells::default();
    match *nodes {
        [a, b] => cells.segments.push([a, b]),
        [a, b, c] => cells.triangles.push([a, b, c]),
        [a, b, c, d] => {
            let Some(parts) = quadrilateral::cut([a, b, c, d], points) else {
                let corners: Vec<String> =
                    nodes.iter().map(|&n| format!("({}, {})", points[n][0], points[n][1])).collect();
                let what =
                    format!("element {} is a quadrilateral that folds over: {}", element.tag, corners.join(", "));
                return Err(MeshError::file(file, what, "give its corners in order around it, without crossing sides"));
            };
            counts.quadrilaterals += 1;
            cells.triangles = parts;
        }
        _ => {}
    }
    Ok(cells)
}

/// Numbers of cells that were changed while they were read.
#[derive(Default)]
struct Counts {
    quadrilaterals: usize,
    second_order: usize,
    /// Sides that their chords stand for.
    curved: HashSet<[usize; 2]>,
    /// Largest distance of a mid-node from its chord, and the length of that chord.
    off: [f64; 2],
}

impl Counts {
    /// Counts a second-order cell, and those of its sides that are curved.
    ///
    /// # Errors
    /// A description of a node that is farther than [`FARTHEST`] from the corners of its side.
    fn second_order(&mut self, kind: Kind, nodes: &[usize], points: &[[f64; 2]]) -> Result<(), String> {
        self.second_order += usize::from(kind != Kind::Line);
        let corners = kind.corners();
        for (i, &node) in nodes[corners..].iter().take(kind.sides()).enumerate() {
            let ends = [nodes[i % corners], nodes[(i + 1) % corners]];
            let [a, b, middle] = [ends[0], ends[1], node].map(|n| points[n]);
            let (along, from) = ([b[0] - a[0], b[1] - a[1]], [middle[0] - a[0], middle[1] - a[1]]);
            let length = along[0].hypot(along[1]);
            if from[0].hypot(from[1]) > FARTHEST * length {
                return Err(format!(
                    "the node at ({}, {}) should be between the corners at ({}, {}) and ({}, {}), and is more than twice their distance away",
                    middle[0], middle[1], a[0], a[1], b[0], b[1]
                ));
            }
            let beside = (along[0] * from[1] - along[1] * from[0]).abs() / length;
            let digits = SEVEN_DIGITS * [a, b].as_flattened().iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            if beside > (ROUND_OFF * length).max(digits.min(BARELY * length)) {
                self.curved.insert([ends[0].min(ends[1]), ends[0].max(ends[1])]);
                if beside > self.off[0] {
                    self.off = [beside, length];
                }
            }
        }
        Ok(())
    }

    fn notes(self) -> Vec<Note> {
        let note = |text: String, weakens_guarantee| Note { weakens_guarantee, text };
        let mut notes = Vec::new();
        if self.quadrilaterals > 0 {
            let text = format!(
                "{} quadrilaterals were cut into triangles, each along the diagonal that gives the better two.",
                self.quadrilaterals
            );
            notes.push(note(text, false));
        }
        if self.second_order > 0 {
            let text = format!("The mid-nodes of {} second-order cells were dropped.", self.second_order);
            notes.push(note(text, false));
        }
        if !self.curved.is_empty() {
            let [off, length] = self.off;
            let sides = match self.curved.len() {
                1 => "1 curved side of the mesh file is represented by its chord".to_string(),
                n => format!("{n} curved sides of the mesh file are represented by their chords"),
            };
            let text = format!(
                "{sides}, up to {off:.2e} beside the middle of the side ({:.2} % of its length): the bounds are those of the bodies \
                 with straight sides.",
                100.0 * off / length
            );
            notes.push(note(text, true));
        }
        notes
    }
}
