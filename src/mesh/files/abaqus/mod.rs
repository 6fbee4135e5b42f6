//! Reader of the mesh in decks of Abaqus and CalculiX: nodes, plane elements, sets and surfaces, with included files, parts
//! and instances.

mod deck;
mod element;
#[cfg(test)]
mod tests;

use std::collections::{HashMap, HashSet};
use std::path::Path;
use std::rc::Rc;

use deck::{Deck, Keyword};
use element::{Family, family};

use super::content::{Content, Element, Kind};
use crate::mesh::{MeshError, RawMesh};
use crate::scene::Note;

const DAMAGED: &str = "correct the deck, or export the mesh again";

/// Reads the deck in `text`; `file` is for messages, and included files start in its folder.
///
/// # Errors
/// [`MeshError::Format`] with the line, or [`MeshError::File`].
pub(in crate::mesh) fn parse(text: &[u8], file: &Path) -> Result<(RawMesh, Vec<Note>), MeshError> {
    let deck: Vec<Keyword> = Deck::read(text, file)?.into_iter().take_while(|keyword| keyword.name != "STEP").collect();
    let is_cell = |keyword: &Keyword| match keyword.parameter("TYPE").map(family) {
        Some(Family::Plane(kind, _)) => kind != Kind::Line,
        Some(Family::Space) => true,
        _ => false,
    };
    let all_rigid = !deck.iter().any(|keyword| keyword.name == "ELEMENT" && is_cell(keyword));
    let mut reader = Reader { all_rigid, ..Reader::default() };
    for keyword in deck {
        reader.take(&keyword)?;
    }
    let whole = match reader.inside {
        None => reader.whole.joined(reader.scope).0,
        Some(_) => return Err(MeshError::file(file, "*PART has no *END PART", DAMAGED)),
    };
    whole.content(file)?.into_raw(file)
}

/// Names as the deck writes them first; Abaqus takes upper and lower case for the same.
type Names<T> = Vec<(String, T)>;

fn of<'a, T: Default>(names: &'a mut Names<T>, name: &str) -> &'a mut T {
    let at = names.iter().position(|(known, _)| known.eq_ignore_ascii_case(name)).unwrap_or_else(|| {
        names.push((name.to_owned(), T::default()));
        names.len() - 1
    });
    &mut names[at].1
}

fn find<'a, T>(names: &'a Names<T>, name: &str) -> Option<&'a T> {
    names.iter().find(|(known, _)| known.eq_ignore_ascii_case(name)).map(|(_, value)| value)
}

/// Nodes, elements and sets between `*PART` and `*END PART`, or of a deck without parts.
#[derive(Default, Clone)]
struct Part {
    nodes: HashMap<u64, [f64; 3]>,
    /// In the order of the deck.
    elements: Vec<(Kind, u64, Vec<u64>)>,
    node_sets: Names<Vec<u64>>,
    element_sets: Names<Vec<u64>>,
    /// Elements with a side, from 1.
    surfaces: Names<Vec<(u64, usize)>>,
}

#[derive(Default)]
struct Reader {
    /// Of the part that is read, or of what stands outside all parts.
    scope: Part,
    parts: HashMap<String, Part>,
    /// The instances put together so far.
    whole: Part,
    /// True if all cells of the deck are rigid.
    all_rigid: bool,
    /// The part that is read.
    inside: Option<String>,
    /// By how much the numbers of an instance are moved, by its name in upper case.
    moved: HashMap<String, u64>,
}

impl Reader {
    fn take(&mut self, keyword: &Keyword) -> Result<(), MeshError> {
        let named = |key: &str| keyword.parameter(key);
        // A set of the assembly counts in the numbers of its instance.
        let instance = named("INSTANCE").map(str::to_ascii_uppercase);
        let moved = instance.and_then(|name| self.moved.get(&name)).copied().unwrap_or(0);
        match keyword.name.as_str() {
            "NODE" => {
                let mut tags = Vec::new();
                for line in &keyword.lines {
                    let tag = line.whole(0)?;
                    let coordinate = |i: usize| if i < line.fields.len() { line.number(i) } else { Ok(0.0) };
                    let point = [coordinate(1)?, coordinate(2)?, coordinate(3)?];
                    if self.scope.nodes.insert(tag, point).is_some_and(|before| before != point) {
                        return Err(line.fault(format!("node {tag} is there twice, at two places"), DAMAGED));
                    }
                    tags.push(tag);
                }
                if let Some(set) = named("NSET") {
                    of(&mut self.scope.node_sets, set).extend(tags);
                }
            }
            "ELEMENT" => self.elements(keyword)?,
            "NSET" => {
                let (Some(set), part) = (named("NSET"), &mut self.scope) else {
                    return Err(keyword.fault("*NSET has no NSET=", DAMAGED));
                };
                let mut tags = numbers(keyword, &part.node_sets, moved)?;
                if let Some(elements) = named("ELSET") {
                    let of_set = find(&part.element_sets, elements).cloned().unwrap_or_default();
                    let of_set: HashSet<u64> = of_set.into_iter().collect();
                    tags.extend(part.elements.iter().filter(|(_, tag, _)| of_set.contains(tag)).flat_map(|e| &e.2));
                }
                of(&mut part.node_sets, set).extend(tags);
            }
            "ELSET" => {
                let Some(set) = named("ELSET") else { return Err(keyword.fault("*ELSET has no ELSET=", DAMAGED)) };
                let tags = numbers(keyword, &self.scope.element_sets, moved)?;
                of(&mut self.scope.element_sets, set).extend(tags);
            }
            "SURFACE" => self.surface(keyword)?,
            "PART" => {
                let name = named("NAME").unwrap_or_default().to_ascii_uppercase();
                self.whole = std::mem::take(&mut self.whole).joined(std::mem::take(&mut self.scope)).0;
                self.inside = Some(name);
            }
            "END PART" => {
                if let Some(name) = self.inside.take() {
                    self.parts.insert(name, std::mem::take(&mut self.scope));
                }
            }
            "INSTANCE" => self.instance(keyword)?,
            "NGEN" | "NFILL" | "NCOPY" | "ELGEN" | "ELCOPY" | "SYSTEM" => {
                let what = format!("*{} makes nodes or elements that the deck does not list", keyword.name);
                return Err(keyword.fault(what, "write the deck with all of them listed"));
            }
            _ => {}
        }
        Ok(())
    }

    fn elements(&mut self, keyword: &Keyword) -> Result<(), MeshError> {
        let Some(name) = keyword.parameter("TYPE") else { return Err(keyword.fault("*ELEMENT has no TYPE=", DAMAGED)) };
        let (kind, count) = match family(name) {
            Family::Plane(kind, count) => (kind, count),
            Family::Rigid(kind, count) if self.all_rigid => (kind, count),
            Family::Rigid(..) | Family::Idle => return Ok(()),
            Family::Space => {
                let numbers: usize = keyword.lines.iter().map(|line| line.fields.len()).sum();
                let nodes = name.to_ascii_uppercase().split_once("3D").and_then(|(_, rest)| {
                    let digits = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
                    rest[..digits].parse::<usize>().ok().filter(|n| *n > 0 && *n < 100)
                });
                let count = nodes.map_or(String::new(), |nodes| format!(", {} of them here", numbers / (nodes + 1)));
                let what = format!("elements {name} are cells in space{count}");
                return Err(keyword.fault(what, "this program is plane: write CPE, CPS or CAX elements"));
            }
            Family::Unknown => {
                let what = format!("elements {name} are not known");
                let remedy = "plane elements are CPEn, CPSn, CPEGn, CAXn, Sn, M3Dn with 3, 4, 6 or 8 nodes";
                return Err(keyword.fault(what, remedy));
            }
        };
        let mut tags = Vec::new();
        let mut fields: Vec<u64> = Vec::new();
        for line in &keyword.lines {
            // An element goes on in the next line until it has all its nodes.
            for i in 0..line.fields.len() {
                fields.push(line.whole(i)?);
            }
            if fields.len() > count {
                let nodes = fields[1..=count].to_vec();
                tags.push(fields[0]);
                self.scope.elements.push((kind, fields[0], nodes));
                fields.clear();
            }
        }
        if let (Some(tag), Some(line)) = (fields.first(), keyword.lines.last()) {
            let what = format!("element {tag} of type {name} has {} nodes, not {count}", fields.len() - 1);
            return Err(line.fault(what, DAMAGED));
        }
        if let Some(set) = keyword.parameter("ELSET") {
            of(&mut self.scope.element_sets, set).extend(tags);
        }
        Ok(())
    }

    fn surface(&mut self, keyword: &Keyword) -> Result<(), MeshError> {
        let Some(name) = keyword.parameter("NAME") else { return Err(keyword.fault("*SURFACE has no NAME=", DAMAGED)) };
        let of_nodes = keyword.parameter("TYPE").is_some_and(|kind| kind.eq_ignore_ascii_case("NODE"));
        for line in keyword.lines.iter().filter(|line| !line.fields.is_empty()) {
            let first = &line.fields[0];
            let number = first.parse::<u64>().ok();
            if of_nodes {
                let tags = number.map(|tag| vec![tag]).or_else(|| find(&self.scope.node_sets, first).cloned());
                let Some(tags) = tags else {
                    return Err(line.fault(format!("there is no node set '{first}'"), DAMAGED));
                };
                of(&mut self.scope.node_sets, name).extend(tags);
                continue;
            }
            let tags = number.map(|tag| vec![tag]).or_else(|| find(&self.scope.element_sets, first).cloned());
            let Some(tags) = tags else {
                return Err(line.fault(format!("there is no element set '{first}'"), DAMAGED));
            };
            let side = line.fields.get(1).map(|side| side.to_ascii_uppercase()).unwrap_or_default();
            let sides: Vec<usize> = match side.strip_prefix('S').and_then(|n| n.parse::<usize>().ok()) {
                Some(n) if (1..=4).contains(&n) => vec![n],
                // Without a side it is the free surface of these elements.
                _ => (1..=4).collect(),
            };
            let faces = tags.into_iter().flat_map(|tag| sides.iter().map(move |&side| (tag, side)));
            of(&mut self.scope.surfaces, name).extend(faces);
        }
        Ok(())
    }

    /// Puts the part of an instance in its place.
    fn instance(&mut self, keyword: &Keyword) -> Result<(), MeshError> {
        let name = keyword.parameter("NAME").unwrap_or_default().to_owned();
        let part = keyword.parameter("PART").unwrap_or_default().to_ascii_uppercase();
        let Some(mut part) = self.parts.get(&part).cloned() else {
            return Err(keyword.fault(format!("there is no *PART '{part}' for this instance"), DAMAGED));
        };
        let row = |i: usize| -> Result<Vec<f64>, MeshError> {
            let Some(line) = keyword.lines.get(i) else { return Ok(Vec::new()) };
            (0..line.fields.len()).map(|k| line.number(k)).collect()
        };
        let (shift, turn) = (row(0)?, row(1)?);
        for point in part.nodes.values_mut() {
            for (x, by) in point.iter_mut().zip(&shift) {
                *x += by;
            }
            if let [ax, ay, _, bx, by, bz, angle] = *turn.as_slice() {
                if (bx - ax).hypot(by - ay) > 1e-9 * (bz - turn[2]).abs() {
                    let what = format!("instance '{name}' is turned about an axis that is not that of z");
                    return Err(keyword.fault(what, "this program is plane: turn it in its plane"));
                }
                let (sin, cos) = (angle.to_radians() * (bz - turn[2]).signum()).sin_cos();
                let (dx, dy) = (point[0] - ax, point[1] - ay);
                (point[0], point[1]) = (ax + cos * dx - sin * dy, ay + sin * dx + cos * dy);
            }
        }
        // All of an instance is a set of its name, and its sets can be told from those of others by it.
        let all: Vec<u64> = part.elements.iter().map(|(_, tag, _)| *tag).collect();
        part.element_sets.push((name.clone(), all));
        let (whole, moved) = std::mem::take(&mut self.whole).joined(part);
        self.whole = whole;
        self.moved.insert(name.to_ascii_uppercase(), moved);
        Ok(())
    }
}

/// The numbers of a set, `moved` by so much: listed, by `GENERATE`, or those of other sets.
fn numbers(keyword: &Keyword, sets: &Names<Vec<u64>>, moved: u64) -> Result<Vec<u64>, MeshError> {
    let mut tags = Vec::new();
    let generate = keyword.parameter("GENERATE").is_some();
    for line in &keyword.lines {
        if generate {
            let (first, last) = (line.whole(0)?, line.whole(1)?);
            let step = if line.fields.len() > 2 { line.whole(2)?.max(1) } else { 1 };
            if (last.saturating_sub(first)) / step > 100_000_000 {
                return Err(line.fault(format!("{first} to {last} are too many numbers"), DAMAGED));
            }
            let step = usize::try_from(step).unwrap_or(usize::MAX);
            tags.extend((first..=last).step_by(step).map(|tag| tag.saturating_add(moved)));
            continue;
        }
        for (i, field) in line.fields.iter().enumerate() {
            match (field.parse::<u64>(), find(sets, field)) {
                (Ok(tag), _) => tags.push(tag.saturating_add(moved)),
                (Err(_), Some(other)) => tags.extend(other),
                // Instance.set in sets of the assembly; a number that is none is an error.
                (Err(_), None) if field.starts_with(|c: char| c.is_ascii_digit() || c == '-') => {
                    tags.push(line.whole(i)?);
                }
                (Err(_), None) => {}
            }
        }
    }
    Ok(tags)
}

impl Part {
    /// This part and `other`, whose numbers are moved beyond those of this one where both have the same; also by how much.
    fn joined(mut self, other: Part) -> (Part, u64) {
        if self.nodes.is_empty() && self.elements.is_empty() {
            return (other, 0);
        }
        let clash = other.nodes.keys().any(|tag| self.nodes.contains_key(tag));
        let highest =
            |part: &Part| part.nodes.keys().copied().chain(part.elements.iter().map(|e| e.1)).max().unwrap_or(0);
        let by = if clash { highest(&self) } else { 0 };
        let moved = |tag: u64| tag.saturating_add(by);
        self.nodes.extend(other.nodes.into_iter().map(|(tag, point)| (moved(tag), point)));
        let elements = other.elements.into_iter();
        self.elements
            .extend(elements.map(|(kind, tag, nodes)| (kind, moved(tag), nodes.into_iter().map(moved).collect())));
        for (name, tags) in other.node_sets {
            of(&mut self.node_sets, &name).extend(tags.into_iter().map(moved));
        }
        for (name, tags) in other.element_sets {
            of(&mut self.element_sets, &name).extend(tags.into_iter().map(moved));
        }
        for (name, sides) in other.surfaces {
            of(&mut self.surfaces, &name).extend(sides.into_iter().map(|(tag, side)| (moved(tag), side)));
        }
        (self, by)
    }

    fn content(self, file: &Path) -> Result<Content, MeshError> {
        if self.elements.iter().all(|(kind, _, _)| *kind == Kind::Line) {
            return Err(MeshError::file(file, "the deck has no plane element", "write nodes and elements into it"));
        }
        let mut sets_of: HashMap<u64, Vec<i32>> = HashMap::new();
        let mut content = Content { nodes: self.nodes, numbers: Some(HashMap::new()), ..Content::default() };
        for ((name, tags), number) in self.element_sets.iter().zip(1..) {
            content.names.extend([((1, number), name.clone()), ((2, number), name.clone())]);
            for tag in tags {
                let sets = sets_of.entry(*tag).or_default();
                if sets.last() != Some(&number) {
                    sets.push(number);
                }
            }
        }
        let cells = self.elements.iter().filter(|(kind, _, _)| *kind != Kind::Line);
        let corners: HashMap<u64, (Kind, Vec<u64>)> =
            cells.map(|(kind, tag, nodes)| (*tag, (*kind, nodes[..kind.corners()].to_vec()))).collect();
        let mut lists: HashMap<Vec<i32>, Rc<[i32]>> = HashMap::new();
        let edges: HashSet<[u64; 2]> = corners.values().flat_map(|(_, nodes)| sides_of(nodes)).collect();
        for (kind, tag, mut nodes) in self.elements {
            if kind == Kind::Line {
                middle_last(&mut nodes, &content.nodes);
                // A truss or beam beside the cells is no boundary of theirs.
                if !edges.contains(&sorted([nodes[0], nodes[1]])) {
                    continue;
                }
            }
            let sets = sets_of.get(&tag).cloned().unwrap_or_default();
            let physical = Rc::clone(lists.entry(sets).or_insert_with_key(|sets| sets.as_slice().into()));
            content.elements.push(Element { kind, tag, nodes, physical, entity: None });
        }
        content.node_sets = self.node_sets;
        content.surfaces = self
            .surfaces
            .into_iter()
            .map(|(name, sides)| {
                let ends = |(tag, side): (u64, usize)| {
                    let (kind, nodes) = corners.get(&tag)?;
                    let n = kind.corners();
                    (side <= n && n > 2).then(|| [nodes[side - 1], nodes[side % n]])
                };
                (name, sides.into_iter().filter_map(ends).collect())
            })
            .collect();
        Ok(content)
    }
}

fn sorted([a, b]: [u64; 2]) -> [u64; 2] {
    [a.min(b), a.max(b)]
}

/// The sides between these corners, each with its smaller number first.
fn sides_of(corners: &[u64]) -> impl Iterator<Item = [u64; 2]> {
    (0..corners.len()).map(|i| sorted([corners[i], corners[(i + 1) % corners.len()]]))
}

/// Puts the node between the two ends of a second-order line last: writers differ in its place.
fn middle_last(nodes: &mut [u64], points: &HashMap<u64, [f64; 3]>) {
    let known: Vec<[f64; 3]> = nodes.iter().filter_map(|tag| points.get(tag).copied()).collect();
    let ([_, _, _], [p, q, r]) = (&*nodes, known.as_slice()) else { return };
    let far = |a: &[f64; 3], b: &[f64; 3]| (a[0] - b[0]).hypot(a[1] - b[1]);
    let lengths = [far(q, r), far(p, r), far(p, q)];
    let middle = (0..3).max_by(|&i, &j| lengths[i].total_cmp(&lengths[j])).unwrap_or(2);
    nodes[middle..].rotate_left(1);
}
