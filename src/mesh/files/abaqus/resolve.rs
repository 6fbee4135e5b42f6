//! The members of sets and surfaces, once all of a deck is read: a set may be listed before it is defined.

use std::collections::{HashMap, HashSet};
use std::rc::Rc;

use super::DAMAGED;
use super::keyword::{Place, shown};
use super::names::Names;
use super::remarks::Remarks;
use super::scope::{Cell, Entry, Member, Mesh, Of, Scope};
use crate::mesh::MeshError;

/// How deep sets may be listed in sets that are defined later.
const DEEPEST: usize = 64;
pub(super) const DEFINE: &str = "define it in the deck, or correct the name; sets of an instance are INSTANCE.SET";

/// A surface with its nodes, or with its sides as pairs of nodes.
#[derive(Clone)]
pub(super) enum Surface {
    Nodes(Vec<u64>),
    Sides(Vec<[u64; 2]>),
}

/// A scope whose sets and surfaces are numbers.
pub(super) struct Resolved {
    /// Name of the instance; empty for what stands outside all parts.
    pub name: String,
    /// Name of its part.
    pub part: String,
    pub mesh: Mesh,
    pub node_sets: Names<Rc<[u64]>>,
    pub element_sets: Names<Rc<[u64]>>,
    pub surfaces: Names<Surface>,
}

impl Resolved {
    fn sets(&self, of: Of) -> &Names<Rc<[u64]>> {
        match of {
            Of::Nodes => &self.node_sets,
            Of::Elements => &self.element_sets,
        }
    }

    /// The set of this name, or the node or element of this number.
    fn named(&self, of: Of, name: &str) -> Option<Rc<[u64]>> {
        let number = || name.parse::<u64>().ok().map(|tag| tag.saturating_add(self.mesh.moved));
        let one = || number().filter(|&tag| self.mesh.has(of, tag)).map(|tag| Rc::from([tag]));
        self.sets(of).get(name).cloned().or_else(one)
    }
}

/// Resolves the sets and surfaces of `scope`, which may name those of `instances`; `assembly` is the name in front of theirs.
///
/// # Errors
/// A member that is not there, with its line.
pub(super) fn resolve(
    mut scope: Scope,
    instances: &[Resolved],
    assembly: &str,
    remarks: &mut Remarks,
) -> Result<Resolved, MeshError> {
    scope.mesh.check()?;
    scope.mesh.middles_last();
    let mut resolver = Resolver {
        scope: &scope,
        instances: instances.iter().map(|instance| (instance.name.to_ascii_uppercase(), instance)).collect(),
        assembly,
        cells: cells(&scope, instances),
        found: HashMap::new(),
        surfaces: HashMap::new(),
        open: Vec::new(),
        remarks,
    };
    let (mut node_sets, mut element_sets, mut surfaces) = (Names::default(), Names::default(), Names::default());
    for (of, sets) in [(Of::Nodes, &mut node_sets), (Of::Elements, &mut element_sets)] {
        for (name, _) in scope.sets(of).iter() {
            if let Some(tags) = resolver.set(of, name)? {
                sets.put(name, tags);
            }
        }
    }
    for (name, _) in scope.surfaces.iter() {
        if let Some(surface) = resolver.surface(name)? {
            surfaces.put(name, surface);
        }
    }
    drop(resolver);
    let mesh = scope.mesh;
    Ok(Resolved { name: String::new(), part: String::new(), mesh, node_sets, element_sets, surfaces })
}

/// All cells by number, where a set or a surface may ask for their nodes.
fn cells<'a>(scope: &'a Scope, instances: &'a [Resolved]) -> HashMap<u64, &'a Cell> {
    if scope.surfaces.iter().next().is_none() && scope.node_sets.iter().next().is_none() {
        return HashMap::new();
    }
    let meshes = instances.iter().map(|instance| &instance.mesh).chain([&scope.mesh]);
    meshes.flat_map(|mesh| &mesh.cells).map(|cell| (cell.tag, cell)).collect()
}

/// The scope that is being resolved, with what is known of it.
pub(super) struct Resolver<'a> {
    pub scope: &'a Scope,
    /// By their names in upper case.
    instances: HashMap<String, &'a Resolved>,
    assembly: &'a str,
    /// Cells by number, of the instances too.
    pub cells: HashMap<u64, &'a Cell>,
    /// Sets by their names in upper case.
    found: HashMap<(Of, String), Rc<[u64]>>,
    /// Surfaces likewise.
    pub surfaces: HashMap<String, Surface>,
    /// The sets and surfaces that are being resolved, each listed in the one before it.
    pub open: Vec<(Option<Of>, String)>,
    pub remarks: &'a mut Remarks,
}

impl<'a> Resolver<'a> {
    /// The numbers in a set of the scope, each once, if there is such a set.
    fn set(&mut self, of: Of, name: &str) -> Result<Option<Rc<[u64]>>, MeshError> {
        let key = (of, name.to_ascii_uppercase());
        if let Some(found) = self.found.get(&key) {
            return Ok(Some(Rc::clone(found)));
        }
        let Some(entries) = self.scope.sets(of).get(name) else { return Ok(None) };
        let (mut tags, mut there) = (Vec::new(), HashSet::new());
        for entry in entries {
            self.enter(Some(of), name, &entry.place)?;
            let more = self.members(of, entry, Some(name))?;
            tags.extend(more.into_iter().filter(|tag| there.insert(*tag)));
            self.open.pop();
        }
        let tags: Rc<[u64]> = tags.into();
        self.found.insert(key, Rc::clone(&tags));
        Ok(Some(tags))
    }

    /// Notes that a set, or a surface, is being resolved; refuses one that lists itself by way of others.
    pub fn enter(&mut self, of: Option<Of>, name: &str, place: &Place) -> Result<(), MeshError> {
        let key = (of, name.to_ascii_uppercase());
        if self.open.contains(&key) {
            return Err(place.fault(format!("'{name}' lists itself by way of other names"), DAMAGED));
        }
        if self.open.len() >= DEEPEST {
            let what =
                format!("'{name}' is listed in more than {DEEPEST} sets that are defined before it, one in another");
            return Err(place.fault(what, "define sets before they are listed"));
        }
        self.open.push(key);
        Ok(())
    }

    /// The numbers of an entry. A number that is not there is remarked upon where the entry is of the set `set`, and else an error.
    pub fn members(&mut self, of: Of, entry: &Entry, set: Option<&str>) -> Result<Vec<u64>, MeshError> {
        let instance = match &entry.instance {
            Some(name) => Some(self.instance(name, &entry.place)?),
            None => None,
        };
        let mesh = instance.map_or(&self.scope.mesh, |instance| &instance.mesh);
        let mut tags = Vec::new();
        for member in &entry.members {
            match member {
                Member::Number(number) => match (number.saturating_add(mesh.moved), set) {
                    (tag, _) if mesh.has(of, tag) => tags.push(tag),
                    (_, Some(set)) => self.remarks.stray(set, *number),
                    (_, None) => {
                        let what = format!("there is no {} {number}", of.told());
                        return Err(entry.place.fault(what, DAMAGED));
                    }
                },
                Member::Range(range) => tags.extend(mesh.within(of, *range)),
                // A set that lists itself gains nothing by it.
                Member::Named(name) if set.is_some_and(|set| set.eq_ignore_ascii_case(name)) && instance.is_none() => {}
                Member::Named(name) => tags.extend(&*self.named(of, instance, name, &entry.place)?),
                Member::NodesOf(elements) => {
                    let elements = self.named(Of::Elements, instance, elements, &entry.place)?;
                    tags.extend(elements.iter().filter_map(|tag| self.cells.get(tag)).flat_map(|cell| &cell.nodes));
                }
                Member::All => tags.extend(mesh.cells.iter().map(|cell| cell.tag)),
            }
        }
        Ok(tags)
    }

    fn instance(&self, name: &str, place: &Place) -> Result<&'a Resolved, MeshError> {
        self.instances.get(&name.to_ascii_uppercase()).copied().ok_or_else(|| {
            place.fault(format!("there is no *INSTANCE '{}'", shown(name)), "correct INSTANCE=, or define the instance")
        })
    }

    /// The numbers that a name in an entry stands for.
    fn named(
        &mut self,
        of: Of,
        instance: Option<&'a Resolved>,
        name: &str,
        place: &Place,
    ) -> Result<Rc<[u64]>, MeshError> {
        let found = match instance {
            Some(instance) => instance.named(of, name),
            None => match self.set(of, name)? {
                None => self.qualified(name).and_then(|(instance, rest)| instance.named(of, rest)),
                some => some,
            },
        };
        let among = instance.map_or(String::new(), |instance| format!(" in the instance '{}'", instance.name));
        found.ok_or_else(|| place.fault(format!("there is no {} set '{}'{among}", of.told(), shown(name)), DEFINE))
    }

    /// Parts `instance.name`, or `assembly.instance.name`.
    pub fn qualified<'n>(&self, name: &'n str) -> Option<(&'a Resolved, &'n str)> {
        let in_assembly = name
            .get(..self.assembly.len())
            .filter(|start| !start.is_empty() && start.eq_ignore_ascii_case(self.assembly))
            .and_then(|start| name[start.len()..].strip_prefix('.'));
        [Some(name), in_assembly].into_iter().flatten().find_map(|name| {
            // Names may have dots in them.
            name.match_indices('.').find_map(|(at, _)| {
                let instance = self.instances.get(&name[..at].to_ascii_uppercase())?;
                Some((*instance, &name[at + 1..]))
            })
        })
    }
}
