//! Nodes, elements, sets and surfaces of one numbering, as the deck defines them: of a part, of an instance, or of what
//! stands outside all parts.

use std::collections::{HashMap, HashSet};

use super::keyword::{Line, Place};
use super::names::Names;
use super::side::Label;
use crate::mesh::MeshError;
use crate::mesh::files::content::Kind;

/// An element that is a cell of the mesh or a line.
#[derive(Clone)]
pub(super) struct Cell {
    pub kind: Kind,
    /// True if its surfaces are counted as those of shells.
    pub shell: bool,
    pub tag: u64,
    /// The corners, then the middles of the sides; of a line both ends, then its middle.
    pub nodes: Vec<u64>,
    pub place: Place,
}

/// An element without a shape of its own, but with nodes enough for one: a user's, or a surface.
#[derive(Clone)]
pub(super) struct Shapeless {
    /// Its type.
    pub name: String,
    pub nodes: Vec<u64>,
    pub place: Place,
}

#[derive(Default, Clone)]
pub(super) struct Mesh {
    pub nodes: HashMap<u64, [f64; 3]>,
    /// In the order of the deck.
    pub cells: Vec<Cell>,
    /// Numbers of all elements: those that are no cells, such as springs, are in sets too.
    pub elements: HashSet<u64>,
    pub shapeless: Vec<Shapeless>,
    /// By how much the numbers are above those of the deck.
    pub moved: u64,
}

/// Whether a set is one of nodes or of elements.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Of {
    Nodes,
    Elements,
}

impl Of {
    pub fn told(self) -> &'static str {
        match self {
            Of::Nodes => "node",
            Of::Elements => "element",
        }
    }
}

impl Mesh {
    pub fn has(&self, of: Of, tag: u64) -> bool {
        match of {
            Of::Nodes => self.nodes.contains_key(&tag),
            Of::Elements => self.elements.contains(&tag),
        }
    }

    /// The numbers that are there of every `step`-th from `first` to `last`, which the deck counts.
    pub fn within(&self, of: Of, [first, last, step]: [u64; 3]) -> Vec<u64> {
        let there = if of == Of::Nodes { self.nodes.len() } else { self.elements.len() };
        // A deck may claim more numbers than fit into memory.
        if usize::try_from(last.saturating_sub(first) / step).is_ok_and(|count| count / 4 <= there) {
            let step = usize::try_from(step).unwrap_or(usize::MAX);
            let tags = (first..=last).step_by(step).map(|tag| tag.saturating_add(self.moved));
            return tags.filter(|&tag| self.has(of, tag)).collect();
        }
        let in_range = |tag: u64| (first..=last).contains(&tag) && (tag - first).is_multiple_of(step);
        let taken = |tag: &u64| tag.checked_sub(self.moved).is_some_and(in_range);
        let mut tags: Vec<u64> = match of {
            Of::Nodes => self.nodes.keys().copied().filter(taken).collect(),
            Of::Elements => self.elements.iter().copied().filter(taken).collect(),
        };
        tags.sort_unstable();
        tags
    }

    /// The largest number of a node or an element.
    pub fn highest(&self) -> u64 {
        self.nodes.keys().chain(&self.elements).copied().max().unwrap_or(0)
    }

    /// The same mesh with all its numbers higher by `by`; they must have room.
    pub fn above(self, by: u64) -> Mesh {
        let up = |tag: u64| tag.saturating_add(by);
        let cell = |cell: Cell| Cell { tag: up(cell.tag), nodes: cell.nodes.into_iter().map(up).collect(), ..cell };
        let shapeless = |own: Shapeless| Shapeless { nodes: own.nodes.into_iter().map(up).collect(), ..own };
        Mesh {
            nodes: self.nodes.into_iter().map(|(tag, point)| (up(tag), point)).collect(),
            cells: self.cells.into_iter().map(cell).collect(),
            elements: self.elements.into_iter().map(up).collect(),
            shapeless: self.shapeless.into_iter().map(shapeless).collect(),
            moved: up(self.moved),
        }
    }

    /// Puts the node between the two ends of second-order lines last: writers differ in its place.
    pub fn middles_last(&mut self) {
        let far = |a: &[f64; 3], b: &[f64; 3]| (a[0] - b[0]).hypot(a[1] - b[1]);
        for nodes in self.cells.iter_mut().filter(|cell| cell.kind == Kind::Line).map(|cell| &mut cell.nodes) {
            let known: Vec<[f64; 3]> = nodes.iter().filter_map(|tag| self.nodes.get(tag).copied()).collect();
            let [p, q, r] = known.as_slice() else { continue };
            let lengths = [far(q, r), far(p, r), far(p, q)];
            let middle = (0..3).max_by(|&i, &j| lengths[i].total_cmp(&lengths[j])).unwrap_or(2);
            nodes[middle..].rotate_left(1);
        }
    }

    /// Refuses an element without a shape where no cell stands on its nodes: a body would lack it.
    fn check_shapeless(&self) -> Result<(), MeshError> {
        if self.shapeless.is_empty() {
            return Ok(());
        }
        let cells = self.cells.iter().filter(|cell| cell.kind != Kind::Line);
        let covered: HashSet<u64> = cells.flat_map(|cell| &cell.nodes).copied().collect();
        let is_lost = |own: &&Shapeless| own.nodes.iter().any(|node| !covered.contains(node));
        let Some(Shapeless { name, place, .. }) = self.shapeless.iter().find(is_lost) else { return Ok(()) };
        let what = format!("elements {name} have no shape that is known, and no plane element stands on their nodes");
        Err(place.fault(what, "write them as CPS4, CPE4 or the like, in the order of their corners"))
    }

    /// Refuses an element with a node that is not there, and one without a shape where no cell stands on its nodes.
    pub fn check(&self) -> Result<(), MeshError> {
        self.check_shapeless()?;
        for cell in &self.cells {
            if let Some(node) = cell.nodes.iter().find(|node| !self.nodes.contains_key(node)) {
                let [tag, node] = [cell.tag, *node].map(|number| number.saturating_sub(self.moved));
                let what = format!("element {tag} uses node {node}, which is not among its nodes");
                return Err(cell.place.fault(what, "list the node under *NODE, or correct the element"));
            }
        }
        Ok(())
    }
}

/// Members of a set or a surface.
#[derive(Clone)]
pub(super) enum Member {
    Number(u64),
    /// First, last and step, from `GENERATE`.
    Range([u64; 3]),
    /// Another set, or `instance.number`.
    Named(String),
    /// The nodes of a set of elements.
    NodesOf(String),
    /// All elements.
    All,
}

/// The members that one line lists.
#[derive(Clone)]
pub(super) struct Entry {
    pub members: Vec<Member>,
    /// The instance in whose numbers they are.
    pub instance: Option<String>,
    pub place: Place,
}

/// One line of a surface.
#[derive(Clone)]
pub(super) enum Patch {
    Nodes(Entry),
    Sides(Entry, Label),
    /// Other surfaces, put together.
    Combined(Operation, Vec<String>, Place),
}

impl Patch {
    pub fn place(&self) -> &Place {
        match self {
            Patch::Nodes(entry) | Patch::Sides(entry, _) => &entry.place,
            Patch::Combined(_, _, place) => place,
        }
    }
}

/// How `COMBINE` makes one surface of others.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Operation {
    Union,
    Intersection,
    Difference,
}

#[derive(Default, Clone)]
pub(super) struct Scope {
    pub mesh: Mesh,
    pub node_sets: Names<Vec<Entry>>,
    pub element_sets: Names<Vec<Entry>>,
    pub surfaces: Names<Vec<Patch>>,
}

impl Scope {
    pub fn sets(&self, of: Of) -> &Names<Vec<Entry>> {
        match of {
            Of::Nodes => &self.node_sets,
            Of::Elements => &self.element_sets,
        }
    }

    pub fn set(&mut self, of: Of, name: &str) -> &mut Vec<Entry> {
        match of {
            Of::Nodes => self.node_sets.of(name),
            Of::Elements => self.element_sets.of(name),
        }
    }

    /// Puts `tags` into a set, where a name of one is given.
    pub fn list(&mut self, of: Of, name: Option<&str>, tags: &[u64], place: &Place) {
        if let Some(name) = name {
            let members = tags.iter().map(|&tag| Member::Number(tag)).collect();
            self.set(of, name).push(Entry { members, instance: None, place: place.clone() });
        }
    }
}

/// The member that a field names.
pub(super) fn member(field: &str) -> Member {
    field.parse().map_or_else(|_| Member::Named(field.to_owned()), Member::Number)
}

/// The members that a line of a set lists, or generates.
pub(super) fn members(line: &Line, generate: bool) -> Result<Vec<Member>, MeshError> {
    if !generate {
        return Ok(line.fields.iter().filter(|field| !field.is_empty()).map(|field| member(field)).collect());
    }
    if line.fields.is_empty() {
        return Ok(Vec::new());
    }
    let step = if line.fields.len() > 2 { line.whole(2)?.max(1) } else { 1 };
    let [first, last] = [line.whole(0)?, line.whole(1)?];
    if first > last {
        let what = format!("it generates numbers from {first} to {last}, and there are none");
        return Err(line.fault(what, "write the smaller number first"));
    }
    Ok(vec![Member::Range([first, last, step])])
}
