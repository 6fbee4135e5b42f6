//! The cells of a file by name, set and number, and which of these groups make the bodies of a scene.

use std::collections::{BTreeMap, HashMap, HashSet};

use crate::mesh::RawMesh;
use crate::mesh::select::{named_cells, sorted};
use crate::scene::toml_string;

/// A group of cells.
#[derive(Debug, Clone, PartialEq)]
pub struct Region {
    /// Name or number in the file; empty where it has none.
    pub name: String,
    /// The name that a scene gives the body.
    pub body: String,
    /// The key that chooses its cells in the table of the body; none where the name of the body does.
    pub keys: Option<String>,
    /// Number of triangles, two for a quadrilateral.
    pub triangles: usize,
    /// Area.
    pub area: f64,
    /// Lower left and upper right corner of the box around it.
    pub extent: [[f64; 2]; 2],
}

type Members = Vec<usize>;

/// The groups that divide the mesh into bodies, the other groups, and the body of each triangle.
pub(super) fn divide(raw: &RawMesh, triangles: &[[usize; 3]]) -> (Vec<Region>, Vec<Region>, Vec<usize>) {
    let index: HashMap<[usize; 3], usize> = triangles.iter().enumerate().map(|(t, c)| (sorted(*c), t)).collect();
    let mut named: BTreeMap<String, Members> = BTreeMap::new();
    for (cell, name) in named_cells(raw).filter(|(_, name)| !name.is_empty()) {
        named.entry(name.to_string()).or_default().push(index[&sorted(cell)]);
    }
    let mut numbered: BTreeMap<i32, Members> = BTreeMap::new();
    for entity in raw.sets.entities.iter().filter(|entity| entity.dimension == 2) {
        let cells = entity.cells.triangles.iter().filter_map(|cell| index.get(&sorted(*cell)));
        numbered.entry(entity.tag).or_default().extend(cells);
    }
    // A physical group goes before an entity of its number.
    numbered.retain(|tag, _| !raw.sets.numbers.contains_key(&(2, *tag)) && !named.contains_key(&tag.to_string()));
    let distinct = |members: &mut Members| {
        members.sort_unstable();
        members.dedup();
    };
    named.values_mut().chain(numbered.values_mut()).for_each(distinct);
    let all = triangles.len();
    let shape = |members: &Members| measured(raw, triangles, members);
    let by_name: Vec<(Region, Members)> =
        named.into_iter().map(|(n, m)| (called(&n, &raw.sets.numbers, shape(&m)), m)).collect();
    let by_number: Vec<(Region, Members)> = numbered.into_iter().map(|(t, m)| (entity(t, shape(&m)), m)).collect();
    let named = by_name.len();
    let list: Vec<(Region, Members)> = by_name.into_iter().chain(by_number).collect();
    let ways = [0..named, named..list.len(), 0..list.len()];
    let chosen = ways.into_iter().find_map(|way| partition(&list, way, all)).unwrap_or_default();
    let mut body = vec![0; all];
    let (mut bodies, mut groups) = (Vec::new(), Vec::new());
    for (i, (region, members)) in list.into_iter().enumerate() {
        if chosen.contains(&i) {
            members.iter().for_each(|&t| body[t] = bodies.len());
            bodies.push(region);
        } else {
            groups.push(region);
        }
    }
    if bodies.is_empty() {
        let members: Members = (0..all).collect();
        bodies.push(Region { body: "body".to_string(), ..shape(&members) });
    }
    (bodies, groups, body)
}

/// Of the groups `among`, taken from the largest on, disjoint ones that have all cells together; one with all cells only where there
/// are no others.
fn partition(groups: &[(Region, Members)], among: std::ops::Range<usize>, all: usize) -> Option<Vec<usize>> {
    let mut order: Vec<usize> = among.collect();
    // Names such as Surface1 are a program's, others their author's.
    let generated = |name: &str| name.ends_with(|c: char| c.is_ascii_digit());
    order.sort_by_key(|&i| (std::cmp::Reverse(groups[i].1.len()), generated(&groups[i].0.name)));
    let parts = order.iter().copied().filter(|&i| groups[i].1.len() < all);
    let mut taken: HashSet<usize> = HashSet::new();
    let mut chosen = Vec::new();
    for i in parts {
        let members = &groups[i].1;
        if !members.is_empty() && members.iter().all(|t| !taken.contains(t)) {
            taken.extend(members);
            chosen.push(i);
        }
    }
    if taken.len() == all {
        chosen.sort_unstable();
        return Some(chosen);
    }
    order.into_iter().find(|&i| groups[i].1.len() == all).map(|i| vec![i])
}

/// A group by name, or by number where its name is one, and no other group has that number.
fn called(name: &str, numbers: &HashMap<(i32, i32), String>, shape: Region) -> Region {
    let name = name.to_string();
    match name.parse::<i32>() {
        Ok(tag) if numbers.get(&(2, tag)).is_some_and(|other| *other != name) => {
            Region { body: format!("body_{tag}"), keys: Some(format!("set = {}", toml_string(&name))), name, ..shape }
        }
        Ok(tag) => Region { name, ..entity(tag, shape) },
        Err(_) => Region { body: name.clone(), name, ..shape },
    }
}

fn entity(tag: i32, shape: Region) -> Region {
    Region { name: tag.to_string(), body: format!("body_{tag}"), keys: Some(format!("tag = {tag}")), ..shape }
}

fn measured(raw: &RawMesh, triangles: &[[usize; 3]], members: &Members) -> Region {
    let mut extent = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    let mut area = 0.0;
    for &t in members {
        let [p, q, r] = triangles[t].map(|v| raw.points[v]);
        area += 0.5 * ((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])).abs();
        for p in [p, q, r] {
            extent[0] = [extent[0][0].min(p[0]), extent[0][1].min(p[1])];
            extent[1] = [extent[1][0].max(p[0]), extent[1][1].max(p[1])];
        }
    }
    Region { name: String::new(), body: String::new(), keys: None, triangles: members.len(), area, extent }
}

impl Region {
    /// The key that chooses these cells as a body of another name.
    pub fn key(&self) -> String {
        self.keys.clone().unwrap_or_else(|| format!("set = {}", toml_string(&self.name)))
    }
}
