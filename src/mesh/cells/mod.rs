//! The cells of a [`RawMesh`]: each a proper triangle, turned counter-clockwise, in exactly one body of the scene.

pub mod file_cells;
pub(super) mod overlap;
pub mod quadrilateral;
pub(super) mod solids;

use std::collections::{HashMap, HashSet};

use super::error::{MeshError, at, shown_by};
use super::topology::labels::suggestion;
use super::{Map, RawMesh};
use crate::scene::Note;
use crate::scene::Scene;

/// Twice the area over the square of the longest edge, below which a triangle counts as degenerate. The test is
/// relative, so that slivers of aspect ratio 1e6 and meshes in micrometres pass.
const FLATNESS: f64 = 1e-14;

/// Checked cells; the indices still refer to the points of the raw mesh.
pub(in crate::mesh) struct Cells {
    /// Counter-clockwise.
    pub triangles: Vec<[usize; 3]>,
    /// Index into the scene's bodies.
    pub body: Vec<usize>,
}

/// Checks every cell of `raw` against the bodies of `scene`.
pub(in crate::mesh) fn check(raw: &RawMesh, scene: &Scene, notes: &mut Vec<Note>) -> Result<Cells, MeshError> {
    if raw.triangles.is_empty() {
        return Err(MeshError::cells(
            scene,
            "there is no triangle in it",
            "mesh the surfaces with triangles and put them into physical surfaces",
        ));
    }
    check_points(raw, scene)?;
    let body_of: HashMap<&str, usize> = scene.bodies.iter().enumerate().map(|(i, b)| (b.name.as_str(), i)).collect();
    let mut seen: Map<[usize; 3], (usize, usize)> = Map::default();
    seen.reserve(raw.triangles.len());
    let mut strangers = Vec::new();
    let mut cells = Cells { triangles: Vec::with_capacity(raw.triangles.len()), body: Vec::new() };
    for (number, (corners, name)) in raw.triangles.iter().enumerate() {
        let turned = proper(raw, number, scene)?;
        let mut key = *corners;
        key.sort_unstable();
        let Some(&body) = body_of.get(name.as_str()) else {
            strangers.push((number, key));
            continue;
        };
        if let Some((first, other)) = seen.insert(key, (number, body)) {
            return Err(twice(raw, scene, [first, number], [other, body]));
        }
        cells.triangles.push(turned);
        cells.body.push(body);
    }
    let mut ignored: Vec<&str> = Vec::new();
    let mut known: HashSet<&str> = HashSet::new();
    for (number, key) in strangers {
        let name = raw.triangles[number].1.as_str();
        match seen.get(&key) {
            Some(_) if name.is_empty() => {}
            Some(_) if known.insert(name) => ignored.push(name),
            Some(_) => {}
            None => return Err(homeless(raw, scene, number)),
        }
    }
    if !ignored.is_empty() {
        notes.push(Note {
            weakens_guarantee: false,
            text: format!(
                "some triangles are also in the physical surface {}, which is no body of the scene and was ignored",
                ignored.join(", ")
            ),
        });
    }
    for (index, body) in scene.bodies.iter().enumerate() {
        if !cells.body.contains(&index) {
            let mut names: Vec<&str> = raw.triangles.iter().map(|(_, name)| name.as_str()).collect();
            names.sort_unstable();
            names.dedup();
            return Err(MeshError::cells(
                scene,
                format!("body '{}' of the scene has no triangle", body.name),
                format!(
                    "name a physical surface (or geometry.polygons.body) so{}{}",
                    suggestion(&body.name, &names),
                    shown_by(scene)
                ),
            ));
        }
    }
    Ok(cells)
}

fn check_points(raw: &RawMesh, scene: &Scene) -> Result<(), MeshError> {
    for (i, p) in raw.points.iter().enumerate() {
        if !p.iter().all(|x| x.is_finite()) {
            return Err(MeshError::cells(
                scene,
                format!("vertex {} has the coordinates {}, which are not finite", i + 1, at(scene, *p)),
                "write the mesh again",
            ));
        }
    }
    let corners = raw.triangles.iter().flat_map(|(t, _)| t).chain(raw.segments.iter().flat_map(|(s, _)| s));
    match corners.copied().find(|&v| v >= raw.points.len()) {
        Some(v) => Err(MeshError::cells(
            scene,
            format!("a cell refers to vertex {}, but there are {} vertices", v + 1, raw.points.len()),
            "write the mesh again",
        )),
        None => Ok(()),
    }
}

/// The triangle, counter-clockwise, if it has an area.
fn proper(raw: &RawMesh, number: usize, scene: &Scene) -> Result<[usize; 3], MeshError> {
    let [i, j, k] = raw.triangles[number].0;
    if i == j || j == k || k == i {
        let (what, remedy) = (format!("{} has a vertex twice", describe(raw, scene, number)), "remove it");
        return Err(MeshError::cells(scene, what, remedy));
    }
    let [a, b, c] = [i, j, k].map(|v| raw.points[v]);
    let double_area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    let longest =
        [[a, b], [b, c], [c, a]].iter().map(|[p, q]| (q[0] - p[0]).powi(2) + (q[1] - p[1]).powi(2)).fold(0.0, f64::max);
    let enough = double_area.abs() > FLATNESS * longest;
    if !enough {
        return Err(MeshError::cells(
            scene,
            format!("{} has zero area (twice its area is {double_area:e})", describe(raw, scene, number)),
            "remove degenerate triangles, or merge the vertices that coincide",
        ));
    }
    Ok(if double_area > 0.0 { [i, j, k] } else { [i, k, j] })
}

fn twice(raw: &RawMesh, scene: &Scene, numbers: [usize; 2], bodies: [usize; 2]) -> MeshError {
    let names = bodies.map(|b| scene.bodies[b].name.as_str());
    if bodies[0] == bodies[1] {
        let what = format!("{} is a duplicate of triangle {}", describe(raw, scene, numbers[1]), numbers[0] + 1);
        MeshError::cells(scene, what, "remove one of the two")
    } else {
        let what = format!(
            "{} is doubly tagged: it is in body '{}' and in body '{}'",
            describe(raw, scene, numbers[1]),
            names[0],
            names[1]
        );
        MeshError::cells(scene, what, "put every surface into one physical surface only")
    }
}

fn homeless(raw: &RawMesh, scene: &Scene, number: usize) -> MeshError {
    let name = raw.triangles[number].1.as_str();
    let bodies: Vec<&str> = scene.bodies.iter().map(|b| b.name.as_str()).collect();
    if name.is_empty() {
        return MeshError::cells(
            scene,
            format!("{} is untagged: it is in no physical surface", describe(raw, scene, number)),
            format!("put it into one that is named as a body ({})", bodies.join(", ")),
        );
    }
    MeshError::cells(
        scene,
        format!("{} is in '{name}', which is no body of the scene", describe(raw, scene, number)),
        format!("add [bodies.{name}] to the scene, or rename the physical surface{}", suggestion(name, &bodies)),
    )
}

fn describe(raw: &RawMesh, scene: &Scene, number: usize) -> String {
    let [a, b, c] = raw.triangles[number].0.map(|v| at(scene, raw.points[v]));
    format!("triangle {} with the corners {a}, {b}, {c}", number + 1)
}
