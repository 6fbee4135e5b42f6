//! Which triangle of a file every triangle of a scene's mesh is, or is a part of.
//!
//! The mesh knows the triangles that were there before contact cut them: a file that has exactly these is recognised by them, one
//! triangle for one, however close contact has put its vertices to others. Triangles are matched by their corners, in any
//! numbering and orientation. A file may also have the triangles of the scene's mesh itself, or larger ones that these fill.

use super::{FieldError, ForeignField};
use crate::mesh::error::at;
use crate::mesh::{Triangulation, Uncut};
use crate::problem::Problem;
use crate::scene::Scene;
use crate::vector::distance;

/// Distance, in parts of the longest edge of a triangle, within which two points are one.
const CLOSE: f64 = 1e-6;
/// As [`CLOSE`], for coordinates that a writer has rounded to five or six digits: in parts of the largest coordinate of the file,
/// and of the longest edge, beyond which a triangle would be another one.
const ROUNDED: f64 = 1e-5;
const DISTORTED: f64 = 0.02;
/// Barycentric coordinates this far below zero are inside.
const INSIDE: f64 = 1e-6;
/// A barycentric coordinate this close to one is at the corner.
pub(super) const AT_CORNER: f64 = 1e-6;
/// Part of a triangle that its parts may leave open or fill twice, by rounding.
const UNFILLED: f64 = 1e-3;
/// Pairs of triangles that are tried when parents are looked for.
const MOST_PAIRS: usize = 4_000_000;
/// A direction along no line that meshes are likely to follow: sorted along it, few centroids are close neighbours.
const DIRECTION: [f64; 2] = [0.540_302_305_868_139_8, 0.841_470_984_807_896_5];
const REMEDY: &str = "certify on the mesh of the field: name it as file under [mesh] in the scene";

/// Where a triangle of a mesh is in a file.
pub(super) enum Place {
    /// It is the triangle of this number, whose corners of these numbers are its corners, in order.
    Same(usize, [usize; 3]),
    /// It is a part of a triangle of the file.
    Part {
        /// Number of that triangle.
        number: usize,
        /// Where its corners are in the mesh.
        corners: [[f64; 2]; 3],
        /// The vertices of the mesh that they are, where the mesh knows.
        vertices: Option<[usize; 3]>,
    },
}

impl Place {
    /// The number of the triangle of the file.
    pub fn number(&self) -> usize {
        match self {
            Place::Same(number, _) | Place::Part { number, .. } => *number,
        }
    }

    /// Corners of the triangle of the file that are vertices of the mesh, as far as triangle `t` of the mesh says: (node, vertex).
    pub fn known(&self, field: &ForeignField, problem: &Problem, t: usize) -> Vec<(usize, usize)> {
        let (mesh, nodes) = (&problem.mesh, &field.triangles[self.number()].nodes);
        let own = mesh.triangles[t];
        match self {
            Place::Same(_, order) => (0..3).map(|i| (nodes[order[i]], own[i])).collect(),
            Place::Part { vertices: Some(vertices), .. } => (0..3).map(|i| (nodes[i], vertices[i])).collect(),
            Place::Part { corners, .. } => {
                let at = |v: usize| barycentric(corners, mesh.points[v]).iter().position(|l| *l > 1.0 - AT_CORNER);
                own.iter().filter_map(|v| Some((nodes[at(*v)?], *v))).collect()
            }
        }
    }
}

/// Where all triangles of a mesh are in a file.
pub(super) struct Places {
    /// Triangle by triangle.
    pub triangles: Vec<Place>,
    /// True if the file has the triangles from before contact cut some of them.
    pub uncut: bool,
}

/// Where every triangle of the mesh of `problem` is in `field`: by points that are equal but for round-off, and where that finds no
/// place for every triangle, by points that a writer has rounded.
pub(super) fn places(field: &ForeignField, problem: &Problem) -> Result<Places, FieldError> {
    let scene = &problem.scene;
    let within = |nearness: Nearness| {
        let before = problem.uncut.as_deref().map(|uncut| before(field, uncut, &problem.mesh, scene, nearness));
        match before {
            Some(Ok(found)) => Ok(found),
            before => after(field, &problem.mesh, scene, nearness)
                // What the file of the mesh has is what its reader knows.
                .map_err(|fault| before.and_then(Result::err).unwrap_or(fault)),
        }
    };
    within(round_off).or_else(|_| within(tolerance))
}

/// By the triangles from before contact cut them.
fn before(
    field: &ForeignField,
    uncut: &Uncut,
    mesh: &Triangulation,
    scene: &Scene,
    nearness: Nearness,
) -> Result<Places, FieldError> {
    let (partners, strays) = partners(field, &uncut.mesh, scene, nearness)?;
    if let Some(number) = strays.first() {
        return Err(lost(field, &uncut.mesh, scene, Lost::Field(*number)));
    }
    let place = |t: usize| {
        let parent = uncut.parent[t];
        let (number, order) = partners[parent].ok_or(Lost::Mesh(parent))?;
        if !uncut.is_cut(mesh, t) {
            return Ok(Place::Same(number, order));
        }
        let mut vertices = [0; 3];
        let corners = uncut.corners_after(parent);
        (0..3).for_each(|i| vertices[order[i]] = corners[i]);
        Ok(Place::Part { number, corners: vertices.map(|v| mesh.points[v]), vertices: Some(vertices) })
    };
    let triangles: Result<Vec<Place>, Lost> = (0..mesh.triangles.len()).map(place).collect();
    let triangles = triangles.map_err(|gone| lost(field, &uncut.mesh, scene, gone))?;
    Ok(Places { triangles, uncut: uncut.any_is_cut(mesh) })
}

/// By the triangles of the mesh itself, or larger ones that they fill.
fn after(field: &ForeignField, mesh: &Triangulation, scene: &Scene, nearness: Nearness) -> Result<Places, FieldError> {
    let (partners, strays) = partners(field, mesh, scene, nearness)?;
    let parents = parents(field, mesh, &partners, &strays, nearness).map_err(|gone| lost(field, mesh, scene, gone))?;
    let place = |(partner, parent): (&Option<(usize, [usize; 3])>, Option<usize>)| match (partner, parent) {
        (Some((number, order)), _) => Some(Place::Same(*number, *order)),
        (None, Some(number)) => Some(Place::Part { number, corners: corners(field, number), vertices: None }),
        (None, None) => None,
    };
    // Every triangle has a partner or a parent.
    Ok(Places { triangles: partners.iter().zip(parents).filter_map(place).collect(), uncut: false })
}

/// Per triangle of a mesh, the triangle of a field that is the same, with the corners that are its corners, in order.
type Partners = Vec<Option<(usize, [usize; 3])>>;
/// Per triangle of a mesh that has no partner, the triangle of a field that it is a part of.
type Parents = Vec<Option<usize>>;
/// How near points of a triangle are that are one.
type Nearness = fn(&ForeignField, &[[f64; 2]; 3]) -> f64;

/// The triangles of `mesh` that `field` has, and those of `field` that `mesh` has not.
fn partners(
    field: &ForeignField,
    mesh: &Triangulation,
    scene: &Scene,
    nearness: Nearness,
) -> Result<(Partners, Vec<usize>), FieldError> {
    let along = |p: [f64; 2]| DIRECTION[0] * p[0] + DIRECTION[1] * p[1];
    let mut order: Vec<(f64, usize)> =
        (0..mesh.triangles.len()).map(|t| (along(centroid(&mesh.corners(t))), t)).collect();
    order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let mut found: Partners = vec![None; mesh.triangles.len()];
    let mut strays = Vec::new();
    for number in 0..field.triangles.len() {
        let corners = corners(field, number);
        let close = nearness(field, &corners);
        let place = along(centroid(&corners));
        let start = order.partition_point(|(key, _)| *key < place - close);
        let near = order[start..].iter().take_while(|(key, _)| *key <= place + close);
        let partners = near.filter_map(|(_, t)| Some((*t, same_corners(&mesh.corners(*t), &corners, close)?)));
        // Of two that overlap within the tolerance, one that is still free, and of those the nearest.
        let rank = |t: usize, off: f64| (found[t].is_some(), off);
        let nearest = partners.min_by(|(s, a), (t, b)| {
            let (a, b) = (rank(*s, a.1), rank(*t, b.1));
            a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
        });
        let Some((t, (permutation, _))) = nearest else {
            strays.push(number);
            continue;
        };
        if let Some((other, _)) = found[t] {
            let first = field.triangles[other].cell + 1;
            let what = format!("{} is there twice, as cell {first} too", describe(field, scene, number));
            return Err(field.fault(what, "write every cell once"));
        }
        found[t] = Some((number, permutation));
    }
    Ok((found, strays))
}

/// A triangle of a field, or of a mesh, without counterpart.
enum Lost {
    Field(usize),
    Mesh(usize),
}

fn lost(field: &ForeignField, mesh: &Triangulation, scene: &Scene, gone: Lost) -> FieldError {
    let what = match gone {
        Lost::Field(number) => {
            format!("{} is not in the mesh of the scene", describe(field, scene, number))
        }
        Lost::Mesh(t) => {
            let corners = mesh.corners(t).map(|p| at(scene, p)).join(", ");
            format!("the triangle {corners} of the scene's mesh is not in it")
        }
    };
    field.fault(what, REMEDY)
}

/// The triangles among `strays` that those of `mesh` without a partner are parts of; the parts fill them.
fn parents(
    field: &ForeignField,
    mesh: &Triangulation,
    found: &Partners,
    strays: &[usize],
    nearness: Nearness,
) -> Result<Parents, Lost> {
    let mut parents: Parents = vec![None; found.len()];
    let alone: Vec<usize> = (0..found.len()).filter(|t| found[*t].is_none()).collect();
    let first_lost = |t: usize| strays.first().map_or(Lost::Mesh(t), |number| Lost::Field(*number));
    if let Some(t) = alone.first().filter(|_| alone.len() * strays.len() > MOST_PAIRS) {
        return Err(first_lost(*t));
    }
    let mut filled = vec![0.0; strays.len()];
    for t in alone {
        let own = mesh.corners(t);
        let parent = strays.iter().position(|number| {
            let outer = corners(field, *number);
            // A field may be rounded where the mesh is not.
            let slack = INSIDE.max(nearness(field, &outer) / longest(&outer));
            own.iter().all(|p| barycentric(&outer, *p).iter().all(|l| *l > -slack))
        });
        let place = parent.ok_or_else(|| first_lost(t))?;
        filled[place] += mesh.area(t) / area(&corners(field, strays[place])).abs();
        parents[t] = Some(strays[place]);
    }
    match filled.iter().position(|part| (part - 1.0).abs() > UNFILLED) {
        Some(place) => Err(Lost::Field(strays[place])),
        None => Ok(parents),
    }
}

fn area([a, b, c]: &[[f64; 2]; 3]) -> f64 {
    0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
}

/// Barycentric coordinates of a point.
pub(super) fn barycentric(corners: &[[f64; 2]; 3], point: [f64; 2]) -> [f64; 3] {
    let [a, b, c] = *corners;
    let whole = area(corners);
    [area(&[point, b, c]) / whole, area(&[a, point, c]) / whole, area(&[a, b, point]) / whole]
}

/// The corners of `found` that are those of `wanted`, if the two triangles are one, and how far they are off.
fn same_corners(wanted: &[[f64; 2]; 3], found: &[[f64; 2]; 3], close: f64) -> Option<([usize; 3], f64)> {
    const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]];
    let off = |order: &[usize; 3]| (0..3).map(|i| distance(wanted[i], found[order[i]])).fold(0.0, f64::max);
    ORDERS.into_iter().map(|order| (order, off(&order))).find(|(_, off)| *off <= close)
}

/// Within what distance points of a triangle are one: that of a writer that rounds coordinates to few digits.
pub(super) fn tolerance(field: &ForeignField, corners: &[[f64; 2]; 3]) -> f64 {
    tolerance_of(field, longest(corners))
}

/// As [`tolerance`], for cells with edges of this length.
pub(super) fn tolerance_of(field: &ForeignField, length: f64) -> f64 {
    round_off_of(field, length).max((ROUNDED * field.far).min(DISTORTED * length))
}

/// Within what distance they are one but for round-off, in single precision where the file is.
pub(super) fn round_off(field: &ForeignField, corners: &[[f64; 2]; 3]) -> f64 {
    round_off_of(field, longest(corners))
}

fn round_off_of(field: &ForeignField, length: f64) -> f64 {
    CLOSE * length + if field.single { f64::from(f32::EPSILON) * field.far } else { 0.0 }
}

fn longest(corners: &[[f64; 2]; 3]) -> f64 {
    (0..3).map(|i| distance(corners[i], corners[(i + 1) % 3])).fold(0.0, f64::max)
}

fn centroid(corners: &[[f64; 2]; 3]) -> [f64; 2] {
    [0, 1].map(|c| (corners[0][c] + corners[1][c] + corners[2][c]) / 3.0)
}

/// A cell by its number and corners.
fn describe(field: &ForeignField, scene: &Scene, number: usize) -> String {
    let cell = field.triangles[number].cell;
    let nodes = &field.cells[cell];
    let (kind, count) = if [3, 6].contains(&nodes.len()) { ("triangle", 3) } else { ("quadrilateral", 4) };
    let corners: Vec<String> = nodes[..count].iter().map(|n| at(scene, field.points[*n])).collect();
    format!("{kind} {} with the corners {}", cell + 1, corners.join(", "))
}

/// The field with those of its quadrilaterals cut along the other diagonal whose triangles are not in the mesh of `problem`; `None`
/// where there are none.
pub(super) fn turned(field: &ForeignField, problem: &Problem) -> Option<ForeignField> {
    let mesh = problem.uncut.as_deref().map_or(&problem.mesh, |uncut| &uncut.mesh);
    let (_, strays) = partners(field, mesh, &problem.scene, tolerance).ok()?;
    let mut turned = field.clone();
    for pair in strays.windows(2).filter(|pair| field.triangles[pair[0]].cell == field.triangles[pair[1]].cell) {
        let [a, b, c, d] = *field.cells[field.triangles[pair[0]].cell].get(..4)? else { return None };
        let first = &field.triangles[pair[0]].nodes;
        let other =
            if first.contains(&a) && first.contains(&c) { [[a, b, d], [b, c, d]] } else { [[a, b, c], [a, c, d]] };
        for (number, nodes) in pair.iter().zip(other) {
            turned.triangles[*number].nodes = nodes.to_vec();
        }
    }
    (turned != *field).then_some(turned)
}

/// The corners of a triangle of a field.
fn corners(field: &ForeignField, number: usize) -> [[f64; 2]; 3] {
    [0, 1, 2].map(|i| field.points[field.triangles[number].nodes[i]])
}
