//! The mesh of all scopes together, with the names that their sets and surfaces have in it.

use std::collections::{HashMap, HashSet};
use std::path::Path;
use std::rc::Rc;

use super::names::Names;
use super::remarks::Remarks;
use super::resolve::{Resolved, Surface};
use super::scope::Cell;
use crate::mesh::MeshError;
use crate::mesh::files::content::{Content, Element, Kind};

/// The names that the assembly gives: they mean its own sets where those of instances are called the same.
struct Given {
    /// To cells.
    cells: HashSet<String>,
    /// To anything, since all of it may be a boundary.
    any: HashSet<String>,
}

impl Given {
    fn new(scopes: &[Resolved]) -> Given {
        let upper = |name: &str| name.to_ascii_uppercase();
        let instances = scopes.iter().map(|scope| scope.name.as_str()).filter(|name| !name.is_empty());
        let mut cells: HashSet<String> = instances.map(upper).collect();
        let Some(assembly) = scopes.last() else { return Given { any: cells.clone(), cells } };
        cells.extend(assembly.element_sets.iter().map(|(name, _)| upper(name)));
        let others = assembly.node_sets.iter().map(|(name, _)| name);
        let others = others.chain(assembly.surfaces.iter().map(|(name, _)| name));
        let any = cells.iter().cloned().chain(others.map(upper)).collect();
        Given { cells, any }
    }
}

/// Sets of cells, each with the name of its cells and that of its lines.
type CellSets = Vec<([String; 2], Vec<u64>)>;

/// What the names of all scopes stand for.
#[derive(Default)]
struct Merged {
    cells: CellSets,
    /// Positions in `cells` by both names in upper case.
    index: HashMap<[String; 2], usize>,
    nodes: Names<Vec<u64>>,
    sides: Names<Vec<[u64; 2]>>,
    /// Parts that have a name, in upper case.
    parts: HashMap<String, String>,
}

impl Merged {
    fn cells(&mut self, names: [String; 2], tags: &[u64]) {
        let next = self.cells.len();
        let at = *self.index.entry(names.each_ref().map(|name| name.to_ascii_uppercase())).or_insert(next);
        if at == next {
            self.cells.push((names, Vec::new()));
        }
        self.cells[at].1.extend(tags);
    }

    /// Adds the sets and surfaces of a scope; a name of an instance that the assembly gives to its own becomes `instance.name`.
    fn add(&mut self, scope: &Resolved, given: &Given, remarks: &mut Remarks) {
        let called = |name: &str, taken: &HashSet<String>| match taken.contains(&name.to_ascii_uppercase()) {
            true if !scope.name.is_empty() => format!("{}.{name}", scope.name),
            _ => name.to_owned(),
        };
        for (name, tags) in scope.element_sets.iter() {
            self.cells([called(name, &given.cells), called(name, &given.any)], tags);
        }
        for (name, tags) in scope.node_sets.iter() {
            self.nodes.of(&called(name, &given.any)).extend(&**tags);
        }
        for (name, surface) in scope.surfaces.iter() {
            match surface {
                Surface::Sides(sides) => self.sides.of(&called(name, &given.any)).extend(sides),
                Surface::Nodes(nodes) => match scope.node_sets.get(name) {
                    None => self.nodes.of(&called(name, &given.any)).extend(nodes),
                    Some(set) if **set != **nodes => remarks.doubled(name),
                    Some(_) => {}
                },
            }
        }
        self.common(scope, given, remarks);
    }

    /// Remarks on names that another part has too, whose sets are then one.
    fn common(&mut self, scope: &Resolved, given: &Given, remarks: &mut Remarks) {
        if scope.name.is_empty() {
            return;
        }
        let names = scope.element_sets.iter().map(|(name, _)| name).chain(scope.node_sets.iter().map(|(name, _)| name));
        for name in names.chain(scope.surfaces.iter().map(|(name, _)| name)) {
            let key = name.to_ascii_uppercase();
            if given.any.contains(&key) {
                continue;
            }
            let part = self.parts.entry(key).or_insert_with(|| scope.part.clone());
            if *part != scope.part {
                remarks.common(name);
            }
        }
    }
}

/// Puts `scopes` together, of which the last is the assembly.
///
/// # Errors
/// [`MeshError::File`] where there is no plane cell.
pub(super) fn content(scopes: Vec<Resolved>, file: &Path, remarks: &mut Remarks) -> Result<Content, MeshError> {
    if scopes.iter().flat_map(|scope| &scope.mesh.cells).all(|cell| cell.kind == Kind::Line) {
        return Err(MeshError::file(file, "the deck has no plane element", "write nodes and elements into it"));
    }
    let (given, mut merged) = (Given::new(&scopes), Merged::default());
    for scope in &scopes {
        merged.add(scope, &given, remarks);
        if !scope.name.is_empty() {
            let all: Vec<u64> = scope.mesh.cells.iter().map(|cell| cell.tag).collect();
            let own = scopes.last().is_some_and(|assembly| assembly.element_sets.has(&scope.name));
            if !own {
                merged.cells([scope.name.clone(), scope.name.clone()], &all);
            }
        }
    }
    let mut content = Content { numbers: Some(HashMap::new()), ..Content::default() };
    let mut sets_of: HashMap<u64, Vec<i32>> = HashMap::new();
    for (([cells, lines], tags), number) in merged.cells.into_iter().zip(1..) {
        content.names.extend([((1, number), lines), ((2, number), cells)]);
        for tag in tags {
            let sets = sets_of.entry(tag).or_default();
            if sets.last() != Some(&number) {
                sets.push(number);
            }
        }
    }
    let mut cells = Vec::new();
    for scope in scopes {
        content.nodes.extend(scope.mesh.nodes);
        cells.extend(scope.mesh.cells);
    }
    content.elements = elements(cells, &sets_of);
    content.node_sets = merged.nodes.into_iter().collect();
    content.surfaces = merged.sides.into_iter().collect();
    Ok(content)
}

/// The cells, and the lines along their sides: a truss or beam elsewhere is no boundary of theirs.
fn elements(cells: Vec<Cell>, sets_of: &HashMap<u64, Vec<i32>>) -> Vec<Element> {
    let plane = cells.iter().filter(|cell| cell.kind != Kind::Line);
    let edges: HashSet<[u64; 2]> = plane.flat_map(|cell| sides_of(&cell.nodes[..cell.kind.corners()])).collect();
    let mut lists: HashMap<Vec<i32>, Rc<[i32]>> = HashMap::new();
    let beside = |cell: &Cell| cell.kind != Kind::Line || edges.contains(&sorted([cell.nodes[0], cell.nodes[1]]));
    let element = |Cell { kind, tag, nodes, .. }: Cell| {
        let sets = sets_of.get(&tag).cloned().unwrap_or_default();
        let physical = Rc::clone(lists.entry(sets).or_insert_with_key(|sets| sets.as_slice().into()));
        Element { kind, tag, nodes, physical, entity: None }
    };
    cells.into_iter().filter(beside).map(element).collect()
}

fn sorted([a, b]: [u64; 2]) -> [u64; 2] {
    [a.min(b), a.max(b)]
}

/// The sides between these corners, each with its smaller number first.
fn sides_of(corners: &[u64]) -> impl Iterator<Item = [u64; 2]> {
    (0..corners.len()).map(|i| sorted([corners[i], corners[(i + 1) % corners.len()]]))
}
