//! The sides and nodes of surfaces, and of those that `COMBINE` makes of others.

use std::collections::HashSet;

use super::keyword::{Place, shown};
use super::resolve::{DEFINE, Resolver, Surface};
use super::scope::{Of, Operation, Patch};
use super::side::{LABELS, Label};
use crate::mesh::MeshError;

impl Resolver<'_> {
    /// A surface of the scope, if there is such a one.
    pub fn surface(&mut self, name: &str) -> Result<Option<Surface>, MeshError> {
        let key = name.to_ascii_uppercase();
        if let Some(found) = self.surfaces.get(&key) {
            return Ok(Some(found.clone()));
        }
        let Some(patches) = self.scope.surfaces.get(name) else { return Ok(None) };
        let (mut nodes, mut sides, mut flat) = (Vec::new(), Vec::new(), false);
        for patch in patches {
            match patch {
                Patch::Nodes(entry) => nodes.extend(self.members(Of::Nodes, entry, None)?),
                Patch::Sides(entry, label) => {
                    let tags = self.members(Of::Elements, entry, None)?;
                    sides.extend(self.sides(&tags, *label, &entry.place)?);
                    flat |= matches!(label, Label::Flat | Label::Face(_));
                }
                Patch::Combined(operation, names, place) => {
                    self.enter(None, name, place)?;
                    sides.extend(self.combined(*operation, names, place)?);
                    self.open.pop();
                }
            }
            if !nodes.is_empty() && !sides.is_empty() {
                let what = format!("the surface '{}' is one of nodes and one of elements", shown(name));
                return Err(patch.place().fault(what, "give the two surfaces names of their own"));
            }
        }
        if sides.is_empty() && flat {
            self.remarks.flat(name);
        }
        let surface = if nodes.is_empty() { Surface::Sides(sides) } else { Surface::Nodes(nodes) };
        self.surfaces.insert(key, surface.clone());
        Ok(Some(surface))
    }

    fn sides(&self, tags: &[u64], label: Label, place: &Place) -> Result<Vec<[u64; 2]>, MeshError> {
        let mut sides = Vec::new();
        // Elements that are no cells have no sides here.
        for cell in tags.iter().filter_map(|tag| self.cells.get(tag)) {
            sides.extend(label.sides(cell).map_err(|what| place.fault(what, LABELS))?);
        }
        Ok(sides)
    }

    fn combined(&mut self, operation: Operation, names: &[String], place: &Place) -> Result<Vec<[u64; 2]>, MeshError> {
        let mut all: Option<Vec<[u64; 2]>> = None;
        for name in names {
            let found = match self.surface(name)? {
                None => self.qualified(name).and_then(|(instance, rest)| instance.surfaces.get(rest).cloned()),
                some => some,
            };
            let sides = match found {
                Some(Surface::Sides(sides)) => sides,
                Some(Surface::Nodes(_)) => {
                    let what = format!("the surface '{}' is one of nodes, which cannot be combined", shown(name));
                    return Err(place.fault(what, "combine surfaces of elements"));
                }
                None => return Err(place.fault(format!("there is no surface '{}'", shown(name)), DEFINE)),
            };
            all = Some(match all {
                None => sides,
                Some(before) => operation.of(before, sides),
            });
        }
        Ok(all.unwrap_or_default())
    }
}

impl Operation {
    /// One surface of two, as pairs of nodes in either order.
    fn of(self, mut one: Vec<[u64; 2]>, other: Vec<[u64; 2]>) -> Vec<[u64; 2]> {
        let pair = |[a, b]: [u64; 2]| [a.min(b), a.max(b)];
        let (first, second): (HashSet<_>, HashSet<_>) =
            (one.iter().map(|&side| pair(side)).collect(), other.iter().map(|&side| pair(side)).collect());
        match self {
            Operation::Union => one.extend(other.into_iter().filter(|&side| !first.contains(&pair(side)))),
            Operation::Intersection => one.retain(|&side| second.contains(&pair(side))),
            Operation::Difference => one.retain(|&side| !second.contains(&pair(side))),
        }
        one
    }
}
