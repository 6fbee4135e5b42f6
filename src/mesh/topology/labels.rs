//! Which edge carries which name, and which edges are cut open because a contact runs along them.

use std::collections::{HashMap, HashSet};

use crate::mesh::cells::Cells;
use crate::mesh::error::{MeshError, at, shown_by};
use crate::mesh::refinement::halves::HalfEdges;
use crate::mesh::{Map, RawMesh};
use crate::scene::Note;
use crate::scene::{BoundaryUse, ContactSides, Extent, Joint, MeshSource, Scene, Target};

/// An edge without direction.
pub(in crate::mesh) type Pair = [usize; 2];

/// An edge as seen from a triangle: (triangle, local edge).
pub(in crate::mesh) type Side = (usize, usize);

/// The key of the edge between two vertices.
pub(in crate::mesh) fn pair(a: usize, b: usize) -> Pair {
    [a.min(b), a.max(b)]
}

/// Names of edges before vertices are split.
#[derive(Default)]
pub(in crate::mesh) struct Labels {
    /// Distinct names in order of appearance.
    pub names: Vec<String>,
    /// Their places.
    place: HashMap<String, usize>,
    /// Name of edge i (opposite corner i) of a triangle.
    pub of: Map<Side, usize>,
    /// Interior edges along which a contact separates two bodies.
    pub cut: HashSet<Pair>,
}

impl Labels {
    fn put(&mut self, side: Side, name: &str) {
        let index = match self.place.get(name) {
            Some(&index) => index,
            None => {
                self.names.push(name.to_string());
                self.place.insert(name.to_string(), self.names.len() - 1);
                self.names.len() - 1
            }
        };
        self.of.insert(side, index);
    }
}

/// The boundaries to which the scene gives a condition, or of which it wants a quantity.
pub(crate) fn used_names(scene: &Scene) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    names.extend(scene.supports.iter().map(|s| s.on.as_str()));
    names.extend(scene.tractions.iter().map(|t| t.on.as_str()));
    names.extend(contact_names(scene));
    names.extend(scene.quantities.iter().filter_map(|quantity| match &quantity.target {
        Target::Displacement { of: Extent::Boundary(name), .. } => Some(name.as_str()),
        _ => None,
    }));
    names
}

/// The sides of contacts and bonds.
pub(crate) fn contact_names(scene: &Scene) -> Vec<&str> {
    let rigid = scene.contacts.iter().filter_map(|contact| match &contact.sides {
        ContactSides::Between(_) => None,
        ContactSides::Rigid(name) => Some(name),
    });
    scene.joints().flat_map(|joint| joint.sides).chain(rigid).map(String::as_str).collect()
}

/// Gives the named segments of `raw` to the edges of its cells.
pub(in crate::mesh) fn assign(
    raw: &RawMesh,
    cells: &Cells,
    halves: &HalfEdges,
    scene: &Scene,
    notes: &mut Vec<Note>,
) -> Result<Labels, MeshError> {
    let used = used_names(scene);
    let cuts = cuts_of_polygons(raw, cells, halves, scene);
    let mut order: Vec<Pair> = Vec::new();
    let mut on: Map<Pair, Vec<&str>> = Map::default();
    let mut idle: Vec<&str> = Vec::new();
    for ([a, b], name) in &raw.segments {
        let key = pair(*a, *b);
        if name.is_empty() {
            continue;
        }
        if halves.joining(*a, *b).next().is_none() {
            if used.contains(&name.as_str()) {
                let ends = [*a, *b].map(|v| at(scene, raw.points[v]));
                let what = format!("has the segment {} to {}, which is no edge of a triangle", ends[0], ends[1]);
                return Err(MeshError::boundary(scene, name, what, "mesh curves and surfaces together"));
            }
            idle.push(name);
            continue;
        }
        let names = on.entry(key).or_default();
        if names.is_empty() {
            order.push(key);
        }
        names.push(name);
    }
    let mut labels = Labels::default();
    let conditions: HashSet<&str> = used.iter().copied().collect();
    for key in order {
        let mut seen = HashSet::new();
        let names: Vec<&str> = on[&key].iter().copied().filter(|name| seen.insert(*name)).collect();
        let carrying: Vec<&str> = names.iter().copied().filter(|name| conditions.contains(name)).collect();
        if carrying.is_empty() {
            idle.extend(&names);
        }
        let place = key.map(|v| at(scene, raw.points[v])).join(" to ");
        let sides: Vec<Side> = halves.joining(key[0], key[1]).map(|side| (side / 3, side % 3)).collect();
        if let Some(both) = cuts.get(&key) {
            both.iter().for_each(|(side, name)| labels.put(*side, name));
            labels.cut.insert(key);
            continue;
        }
        match (sides.as_slice(), carrying.as_slice()) {
            ([side], []) => labels.put(*side, names[0]),
            ([side], [name]) => labels.put(*side, name),
            ([_], [first, second, ..]) => {
                let what = format!("shares the edge {place} with '{second}', and the scene uses both");
                return Err(MeshError::boundary(scene, first, what, "put every curve into one of the two only"));
            }
            (_, []) => {}
            (both, carrying) => {
                for (side, name) in facing(raw, cells, both, carrying, &place, scene)? {
                    labels.put(side, name);
                }
                labels.cut.insert(key);
            }
        }
    }
    check_names(&labels, &used, scene)?;
    check_bodies(raw, scene)?;
    note_idle(idle, scene, notes);
    Ok(labels)
}

/// The two sides of an edge along which a contact separates two bodies, or cuts one: the name that the contact
/// lists first goes to the body that the scene lists first, unless `[[boundaries]]` says whose it is.
fn facing<'a>(
    raw: &RawMesh,
    cells: &Cells,
    both: &[Side],
    carrying: &[&'a str],
    place: &str,
    scene: &Scene,
) -> Result<[(Side, &'a str); 2], MeshError> {
    let name = carrying[0];
    let joint = scene.joints().find(|joint| joint.sides.iter().any(|n| n == name));
    let Some(Joint { kind, sides: [first, second], .. }) = joint else {
        return Err(MeshError::boundary(
            scene,
            name,
            format!("carries a condition or quantity, but its edge {place} has a triangle on both sides"),
            "conditions and mean displacements belong on the outer boundary of a body",
        ));
    };
    let (sides, bodies) = match both {
        [one, other] => ([*one, *other], [cells.body[one.0], cells.body[other.0]]),
        _ => ([(0, 0); 2], [0, 0]),
    };
    let find = |wanted: &str| carrying.iter().copied().find(|n| *n == wanted);
    match (find(first), find(second), carrying.len()) {
        (Some(first), Some(second), 2) => {
            let forward = match [first, second].map(|name| body_of(name, scene)) {
                [Some(body), _] if bodies.contains(&body) => bodies[0] == body,
                [_, Some(body)] if bodies.contains(&body) => bodies[1] == body,
                _ if bodies[0] == bodies[1] => first_of_one(raw, cells, sides),
                _ => bodies[0] < bodies[1],
            };
            let (early, late) = if forward { (sides[0], sides[1]) } else { (sides[1], sides[0]) };
            Ok([(early, first), (late, second)])
        }
        _ => Err(MeshError::boundary(
            scene,
            name,
            format!(
                "is a side of the {kind} {first}|{second}, but {} the edge {place}, which has the names {}",
                owners(bodies, scene),
                carrying.join(", ")
            ),
            format!(
                "put the curve into both physical curves '{first}' and '{second}', or give each body its own curve"
            ),
        )),
    }
}

/// Who has triangles on both sides of an edge.
fn owners(bodies: [usize; 2], scene: &Scene) -> String {
    let [first, second] = bodies.map(|body| &scene.bodies[body].name);
    match first == second {
        true => format!("body '{first}' has triangles on both sides of"),
        false => format!("the bodies '{first}' and '{second}' share"),
    }
}

/// True if the first of two sides of an edge inside a body is that below it, or on its left where it is upright.
fn first_of_one(raw: &RawMesh, cells: &Cells, sides: [Side; 2]) -> bool {
    let corners = cells.triangles[sides[0].0];
    let [a, b] = [1, 2].map(|i| raw.points[corners[(sides[0].1 + i) % 3]]);
    // The outward normal (dy, −dx) points up, or to the right.
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    -dx > 0.0 || dx == 0.0 && dy > 0.0
}

/// Edges that two polygons of one body share and both name: a cut, each side of which has the name that its polygon gives it.
fn cuts_of_polygons<'a>(
    raw: &'a RawMesh,
    cells: &Cells,
    halves: &HalfEdges,
    scene: &Scene,
) -> HashMap<Pair, Vec<(Side, &'a str)>> {
    let mut found: HashMap<Pair, Vec<(Side, &str)>> = HashMap::new();
    if !matches!(scene.mesh, MeshSource::Geometry { .. }) {
        return found;
    }
    for ([a, b], name) in raw.segments.iter().filter(|(_, name)| !name.is_empty()) {
        // A polygon lies on the left of its pieces.
        let own = halves.joining(*a, *b).find(|side| HalfEdges::ends(&cells.triangles, *side) == [*a, *b]);
        if let Some(side) = own {
            let sides = found.entry(pair(*a, *b)).or_default();
            if sides.iter().all(|(other, _)| *other != (side / 3, side % 3)) {
                sides.push(((side / 3, side % 3), name.as_str()));
            }
        }
    }
    found.retain(|_, sides| sides.len() == 2);
    found
}

/// The body on whose outline the scene puts this boundary, where it says so.
fn body_of(name: &str, scene: &Scene) -> Option<usize> {
    scene.boundaries.iter().filter(|boundary| boundary.name == name).find_map(|boundary| boundary.body)
}

/// Every name of the scene is on an edge.
fn check_names(labels: &Labels, used: &[&str], scene: &Scene) -> Result<(), MeshError> {
    for name in used {
        if !labels.names.iter().any(|n| n == name) {
            let existing: Vec<&str> = labels.names.iter().map(String::as_str).collect();
            let remedy = match existing.as_slice() {
                [] => "no boundary has a name: put the curves into physical curves and save them, or add a [[boundaries]] that says \
                       which edges it has"
                    .to_string(),
                _ => format!("the boundaries are {}{}", existing.join(", "), suggestion(name, &existing)),
            };
            let remedy = format!("{remedy}{}", shown_by(scene));
            let conditions = scene.boundary_names_used();
            let by_quantity = !conditions.iter().any(|(n, by)| n == name && !matches!(by, BoundaryUse::Quantity(_)));
            let bodies: Vec<&str> = scene.bodies.iter().map(|body| body.name.as_str()).collect();
            let remedy = match by_quantity {
                true => format!("{remedy}; the bodies are {}{}", bodies.join(", "), suggestion(name, &bodies)),
                false => remedy,
            };
            return Err(MeshError::boundary(scene, name, "does not exist", remedy));
        }
    }
    Ok(())
}

/// A body whose mean displacement is wanted shares its name with no boundary.
fn check_bodies(raw: &RawMesh, scene: &Scene) -> Result<(), MeshError> {
    for quantity in &scene.quantities {
        let Target::Displacement { of: Extent::Body(body), .. } = quantity.target else { continue };
        let name = &scene.bodies[body].name;
        if raw.segments.iter().any(|(_, boundary)| boundary == name) {
            let what = format!("has the name of a body, and quantity '{}' may mean either", quantity.name);
            return Err(MeshError::boundary(scene, name, what, "give the curve another name"));
        }
    }
    Ok(())
}

/// A remark for each physical curve that has no part in the scene.
fn note_idle(mut idle: Vec<&str>, scene: &Scene, notes: &mut Vec<Note>) {
    if let MeshSource::Geometry { .. } = scene.mesh {
        return;
    }
    idle.sort_unstable();
    idle.dedup();
    let text = |name: &str| match scene.boundaries.iter().any(|boundary| boundary.name == name) {
        true => format!("no condition uses the boundary '{name}': it is free of traction"),
        false => format!("the scene does not mention the physical curve '{name}': it is free of traction"),
    };
    notes.extend(idle.into_iter().map(|name| Note { weakens_guarantee: false, text: text(name) }));
}

/// `; did you mean 'x'?` when one of `names` is close to `name`.
pub(crate) fn suggestion(name: &str, names: &[&str]) -> String {
    let distance = |other: &&&str| strsim::damerau_levenshtein(name, other);
    match names.iter().filter(|n| !n.is_empty()).min_by_key(distance) {
        Some(best) if distance(&best) * 2 <= name.chars().count() => format!("; did you mean '{best}'?"),
        _ => String::new(),
    }
}
