//! The triangles of a field, found again in the mesh of a scene.
//!
//! Triangles are matched by their centroids and then corner by corner. Points are not enough: bodies that meet at a
//! contact have two vertices at equal coordinates, and which point belongs to which body only the triangles say. A file
//! that has merged such points gives both vertices the same displacement; one that has a point of its own for every
//! triangle is read as the continuous field it must be.
//!
//! Contacts put vertices of one side and kinks of the gap into the edges of a mesh, and cut the triangles there. A triangle that is
//! not in the file is then looked for inside one that is, whose polynomial it has.

use super::{FieldError, ForeignField};
use crate::compare::Numbering;
use crate::mesh::Triangulation;
use crate::mesh::error::at;
use crate::problem::Problem;
use crate::scene::Scene;
use crate::vector::distance;

/// Distance, in parts of the longest edge of a triangle, within which two points are one.
const CLOSE: f64 = 1e-6;
/// The same for coordinates that a writer has rounded to five or six digits: in parts of the largest coordinate of the file,
/// and of the longest edge, beyond which a triangle would be another one.
const ROUNDED: f64 = 1e-5;
const DISTORTED: f64 = 0.02;
/// Difference between two values of one point, in parts of the largest displacement, that counts as round-off.
const JUMP: f64 = 1e-6;
/// A direction along no line that meshes are likely to follow: sorted along it, few centroids are close neighbours.
const DIRECTION: [f64; 2] = [0.540_302_305_868_139_8, 0.841_470_984_807_896_5];
const REMEDY: &str = "certify on the mesh of the field: name it as file under [mesh] in the scene";

/// Values on the vertices and edges of a mesh.
pub(super) struct Matched {
    pub degree: usize,
    pub vertex: Vec<[f64; 2]>,
    pub middle: Vec<[f64; 2]>,
    /// Where nodes and triangles are in the file.
    pub numbering: Numbering,
    /// How many vertices of the mesh are no points of the file.
    pub inserted: usize,
    /// How far a point of the file is from its vertex at most, where that is more than round-off.
    pub off: Option<f64>,
}

/// Brings `field` onto the mesh of `problem`.
pub(super) fn onto(field: &ForeignField, problem: &Problem) -> Result<Matched, FieldError> {
    let (mesh, scene) = (&problem.mesh, &problem.scene);
    let moved = field.about(scene.origin);
    let field = moved.as_ref().unwrap_or(field);
    let (partners, parents) = partners(field, mesh, scene)?;
    let size = field.values.iter().flatten().flatten().fold(0.0_f64, |m, v| m.max(v.abs()));
    let mut vertex: Vec<Option<[f64; 2]>> = vec![None; mesh.points.len()];
    let mut middle: Vec<Option<[f64; 2]>> = vec![None; mesh.edges.len()];
    let mut degree = 1;
    let mut numbering = Numbering {
        nodes: vec![None; mesh.points.len() + mesh.edges.len()],
        triangles: partners.iter().zip(&parents).map(|(own, parent)| own.map(|p| p.0).or(*parent)).collect(),
        files: field.files.clone(),
    };
    let mut off = None;
    let value = |node: usize| {
        field.values[node].ok_or_else(|| {
            let what =
                format!("there is no finite displacement at point {} {}", node + 1, at(scene, field.points[node]));
            field.fault(what, "write a finite value at every point of a triangle")
        })
    };
    let put = |slot: &mut Option<[f64; 2]>, u: [f64; 2], point: [f64; 2]| match slot {
        Some(other) if (other[0] - u[0]).abs().max((other[1] - u[1]).abs()) > JUMP * size => {
            let what = format!("the displacement jumps inside a body, at {}", at(scene, point));
            Err(field.fault(what, "only a continuous field has an energy: write it in a continuous space"))
        }
        Some(_) => Ok(()),
        None => {
            *slot = Some(u);
            Ok(())
        }
    };
    for (t, partner) in partners.into_iter().enumerate() {
        let Some((number, corners)) = partner else { continue };
        let nodes = &field.triangles[number];
        let u = [value(nodes[corners[0]])?, value(nodes[corners[1]])?, value(nodes[corners[2]])?];
        for i in 0..3 {
            let v = mesh.triangles[t][i];
            put(&mut vertex[v], u[i], mesh.points[v])?;
            numbering.nodes[v].get_or_insert(nodes[corners[i]]);
            let away = distance(field.points[nodes[corners[i]]], mesh.points[v]);
            if away > round_off(field, &mesh.corners(t)) && off.is_none_or(|most| most < away) {
                off = Some(away);
            }
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let mean = |a: [f64; 2], b: [f64; 2]| [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
            let ends = [mesh.triangles[t][j], mesh.triangles[t][k]].map(|v| mesh.points[v]);
            let halfway = mean(ends[0], ends[1]);
            let between = match nodes.get(middle_node(corners[j], corners[k])) {
                Some(&node) => {
                    degree = 2;
                    if distance(field.points[node], halfway) > tolerance(field, &mesh.corners(t)) {
                        let what = format!(
                            "triangle {} is curved: its mid-node {} is not halfway",
                            number + 1,
                            at(scene, field.points[node])
                        );
                        return Err(field.fault(what, "write the field on straight triangles"));
                    }
                    numbering.nodes[mesh.points.len() + mesh.triangle_edges[t][i]].get_or_insert(node);
                    value(node)?
                }
                None => mean(u[j], u[k]),
            };
            put(&mut middle[mesh.triangle_edges[t][i]], between, halfway)?;
        }
    }
    for (t, parent) in parents.into_iter().enumerate() {
        let Some(nodes) = parent.map(|number| &field.triangles[number]) else { continue };
        if nodes.len() == 6 {
            degree = 2;
        }
        let values: Vec<[f64; 2]> = nodes.iter().map(|node| value(*node)).collect::<Result<_, _>>()?;
        let corners = [0, 1, 2].map(|i| field.points[nodes[i]]);
        let own = mesh.corners(t);
        let within = |p: [f64; 2]| interpolated(&values, barycentric(&corners, p));
        for i in 0..3 {
            let v = mesh.triangles[t][i];
            put(&mut vertex[v], within(own[i]), own[i])?;
            let weights = barycentric(&corners, own[i]);
            if let Some(corner) = (0..3).find(|c| weights[*c] > 1.0 - INSIDE) {
                numbering.nodes[v].get_or_insert(nodes[corner]);
            }
            let [a, b] = [own[(i + 1) % 3], own[(i + 2) % 3]];
            let halfway = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
            put(&mut middle[mesh.triangle_edges[t][i]], within(halfway), halfway)?;
        }
    }
    let inserted = numbering.nodes[..mesh.points.len()].iter().filter(|n| n.is_none()).count();
    // Every triangle has a partner or a parent, and every vertex and edge a triangle.
    let all = |values: Vec<Option<[f64; 2]>>| values.into_iter().map(Option::unwrap_or_default).collect();
    Ok(Matched { degree, vertex: all(vertex), middle: all(middle), numbering, inserted, off })
}

/// Place, among the nodes of a triangle, of the one between two corners.
fn middle_node(a: usize, b: usize) -> usize {
    match a + b {
        1 => 3,
        3 => 4,
        _ => 5,
    }
}

/// Per triangle of a mesh, the triangle of a field that is the same, with the corners that are its corners, in order.
type Partners = Vec<Option<(usize, [usize; 3])>>;
/// Per triangle of a mesh that has no partner, the triangle of a field that it is a part of.
type Parents = Vec<Option<usize>>;

/// Barycentric coordinates this far below zero are inside.
const INSIDE: f64 = 1e-6;
/// Part of a triangle that its parts may leave open or fill twice, by rounding.
const UNFILLED: f64 = 1e-3;
/// Pairs of triangles that are tried when parents are looked for.
const MOST_PAIRS: usize = 4_000_000;

/// How near points of a triangle are that are one.
type Nearness = fn(&ForeignField, &[[f64; 2]; 3]) -> f64;

/// Where every triangle of `mesh` is in `field`: by points that are equal but for round-off, for contacts may have put a vertex
/// close beside another; where that finds no place for every triangle, by points that a writer has rounded.
fn partners(field: &ForeignField, mesh: &Triangulation, scene: &Scene) -> Result<(Partners, Parents), FieldError> {
    partners_within(field, mesh, scene, round_off).or_else(|_| partners_within(field, mesh, scene, tolerance))
}

fn partners_within(
    field: &ForeignField,
    mesh: &Triangulation,
    scene: &Scene,
    nearness: Nearness,
) -> Result<(Partners, Parents), FieldError> {
    let along = |p: [f64; 2]| DIRECTION[0] * p[0] + DIRECTION[1] * p[1];
    let mut order: Vec<(f64, usize)> =
        (0..mesh.triangles.len()).map(|t| (along(centroid(&mesh.corners(t))), t)).collect();
    order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let mut found: Partners = vec![None; mesh.triangles.len()];
    let mut strays = Vec::new();
    for (number, nodes) in field.triangles.iter().enumerate() {
        let corners = [0, 1, 2].map(|i| field.points[nodes[i]]);
        let close = nearness(field, &corners);
        let place = along(centroid(&corners));
        let start = order.partition_point(|(key, _)| *key < place - close);
        let near = order[start..].iter().take_while(|(key, _)| *key <= place + close);
        let partner = near.filter_map(|(_, t)| Some((*t, same_corners(&mesh.corners(*t), &corners, close)?)));
        // Of two that overlap within the tolerance, one that is still free.
        let Some((t, permutation)) = partner.min_by_key(|(t, _)| found[*t].is_some()) else {
            strays.push(number);
            continue;
        };
        if let Some((other, _)) = found[t] {
            let what = format!("{} is there twice, as triangle {} too", describe(scene, number, corners), other + 1);
            return Err(field.fault(what, "write every triangle once"));
        }
        found[t] = Some((number, permutation));
    }
    match parents(field, mesh, &found, &strays, nearness) {
        Ok(parents) => Ok((found, parents)),
        Err(Lost::Field(number)) => {
            let corners = [0, 1, 2].map(|i| field.points[field.triangles[number][i]]);
            Err(field.fault(format!("{} is not in the mesh of the scene", describe(scene, number, corners)), REMEDY))
        }
        Err(Lost::Mesh(t)) => {
            let corners = mesh.corners(t).map(|p| at(scene, p)).join(", ");
            Err(field.fault(format!("the triangle {corners} of the scene's mesh is not in it"), REMEDY))
        }
    }
}

/// A triangle of a field, or of a mesh, without counterpart.
enum Lost {
    Field(usize),
    Mesh(usize),
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
    let corners = |number: usize| [0, 1, 2].map(|i| field.points[field.triangles[number][i]]);
    let mut filled = vec![0.0; strays.len()];
    for t in alone {
        let own = mesh.corners(t);
        let parent = strays.iter().position(|number| {
            let outer = corners(*number);
            // A field may be rounded where the mesh is not.
            let slack = INSIDE.max(nearness(field, &outer) / longest(&outer));
            own.iter().all(|p| barycentric(&outer, *p).iter().all(|l| *l > -slack))
        });
        let place = parent.ok_or_else(|| first_lost(t))?;
        filled[place] += mesh.area(t) / area(&corners(strays[place])).abs();
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
fn barycentric(corners: &[[f64; 2]; 3], point: [f64; 2]) -> [f64; 3] {
    let [a, b, c] = *corners;
    let whole = area(corners);
    [area(&[point, b, c]) / whole, area(&[a, point, c]) / whole, area(&[a, b, point]) / whole]
}

/// The value of a linear or quadratic field given at the nodes of a triangle: corners, then the middles of (0, 1), (1, 2), (2, 0).
fn interpolated(values: &[[f64; 2]], l: [f64; 3]) -> [f64; 2] {
    let weights = match values.len() {
        6 => {
            let corner = |i: usize| l[i] * (2.0 * l[i] - 1.0);
            let middle = |i: usize, j: usize| 4.0 * l[i] * l[j];
            vec![corner(0), corner(1), corner(2), middle(0, 1), middle(1, 2), middle(2, 0)]
        }
        _ => l.to_vec(),
    };
    values.iter().zip(weights).fold([0.0; 2], |sum, (u, w)| [sum[0] + w * u[0], sum[1] + w * u[1]])
}

/// The corners of `found` that are those of `wanted`, if the two triangles are one.
fn same_corners(wanted: &[[f64; 2]; 3], found: &[[f64; 2]; 3], close: f64) -> Option<[usize; 3]> {
    const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]];
    ORDERS.into_iter().find(|order| (0..3).all(|i| distance(wanted[i], found[order[i]]) <= close))
}

/// Within what distance points of a triangle are one: that of a writer that rounds coordinates to few digits.
fn tolerance(field: &ForeignField, corners: &[[f64; 2]; 3]) -> f64 {
    round_off(field, corners).max((ROUNDED * field.far).min(DISTORTED * longest(corners)))
}

/// Within what distance they are one but for round-off, in single precision where the file is.
fn round_off(field: &ForeignField, corners: &[[f64; 2]; 3]) -> f64 {
    CLOSE * longest(corners) + if field.single { f64::from(f32::EPSILON) * field.far } else { 0.0 }
}

fn longest(corners: &[[f64; 2]; 3]) -> f64 {
    (0..3).map(|i| distance(corners[i], corners[(i + 1) % 3])).fold(0.0, f64::max)
}

fn centroid(corners: &[[f64; 2]; 3]) -> [f64; 2] {
    [0, 1].map(|c| (corners[0][c] + corners[1][c] + corners[2][c]) / 3.0)
}

fn describe(scene: &Scene, number: usize, corners: [[f64; 2]; 3]) -> String {
    format!("triangle {} with the corners {}", number + 1, corners.map(|p| at(scene, p)).join(", "))
}
