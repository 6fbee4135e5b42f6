//! The values of a field, found again at the vertices and edges of the mesh of a scene.
//!
//! Points are not enough to match by: bodies that meet at a contact have two vertices at equal coordinates, and which point belongs
//! to which body only the triangles say. A file that has merged such points gives both vertices the same displacement; one that has
//! a point of its own for every triangle is read as the continuous field it must be.
//!
//! Contacts put vertices of one side and kinks of the gap into the edges of a mesh, and cut the triangles there. A triangle that is
//! not in the file is then a part of one that is, whose polynomial it has.

use super::places::{Place, Places, barycentric, places, round_off, tolerance};
use super::{FieldError, ForeignField};
use crate::compare::Numbering;
use crate::mesh::error::at;
use crate::problem::Problem;
use crate::scene::Scene;
use crate::vector::distance;

/// Difference between two values of one point, in parts of the largest displacement, that counts as round-off.
const JUMP: f64 = 1e-6;
/// A barycentric coordinate this close to one is at the corner.
const AT_CORNER: f64 = 1e-6;

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
    let moved = field.about(problem.scene.origin);
    let field = moved.as_ref().unwrap_or(field);
    let Places { triangles, uncut } = places(field, problem)?;
    let mesh = &problem.mesh;
    let number = |place: &Place| match place {
        Place::Same(number, _) | Place::Part { number, .. } => Some(*number),
    };
    let quadratic = triangles.iter().filter_map(number).any(|number| field.triangles[number].len() == 6);
    let numbering = Numbering {
        nodes: vec![None; mesh.points.len() + mesh.edges.len()],
        triangles: triangles.iter().map(number).collect(),
        files: field.files.clone(),
        uncut,
    };
    let mut carried = Carried {
        field,
        problem,
        size: field.values.iter().flatten().flatten().fold(0.0_f64, |m, v| m.max(v.abs())),
        vertex: vec![None; mesh.points.len()],
        middle: vec![None; mesh.edges.len()],
        numbering,
        off: None,
    };
    for (t, place) in triangles.iter().enumerate() {
        if let Place::Same(number, order) = place {
            carried.whole(t, *number, order)?;
        }
    }
    for (t, place) in triangles.iter().enumerate() {
        if let Place::Part { number, corners, vertices } = place {
            carried.part(t, *number, corners, vertices.as_ref())?;
        }
    }
    let Carried { vertex, middle, numbering, off, .. } = carried;
    let inserted = numbering.nodes[..mesh.points.len()].iter().filter(|n| n.is_none()).count();
    // Every triangle has a place, and every vertex and edge a triangle.
    let all = |values: Vec<Option<[f64; 2]>>| values.into_iter().map(Option::unwrap_or_default).collect();
    let degree = if quadratic { 2 } else { 1 };
    Ok(Matched { degree, vertex: all(vertex), middle: all(middle), numbering, inserted, off })
}

/// What has been found so far.
struct Carried<'a> {
    field: &'a ForeignField,
    problem: &'a Problem,
    /// The largest displacement.
    size: f64,
    vertex: Vec<Option<[f64; 2]>>,
    middle: Vec<Option<[f64; 2]>>,
    numbering: Numbering,
    off: Option<f64>,
}

impl Carried<'_> {
    /// Triangle `t` of the mesh is triangle `number` of the file.
    fn whole(&mut self, t: usize, number: usize, order: &[usize; 3]) -> Result<(), FieldError> {
        let (field, problem) = (self.field, self.problem);
        let mesh = &problem.mesh;
        // Contact has not moved these.
        let points = problem.uncut.as_ref().map_or(&mesh.points, |uncut| &uncut.mesh.points);
        let place = |v: usize| points.get(v).copied().unwrap_or(mesh.points[v]);
        let (nodes, corners) = (&field.triangles[number], mesh.triangles[t].map(place));
        for i in 0..3 {
            let (v, node) = (mesh.triangles[t][i], nodes[order[i]]);
            self.put_vertex(v, self.value(node)?)?;
            self.numbering.nodes[v].get_or_insert(node);
            let away = distance(field.points[node], corners[i]);
            if away > round_off(field, &corners) && self.off.is_none_or(|most| most < away) {
                self.off = Some(away);
            }
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let edge = mesh.triangle_edges[t][i];
            let between = match nodes.get(middle_node(order[j], order[k])) {
                Some(&node) => {
                    if distance(field.points[node], mean(corners[j], corners[k])) > tolerance(field, &corners) {
                        let place = at(&problem.scene, field.points[node]);
                        let what = format!("triangle {} is curved: its mid-node {place} is not halfway", number + 1);
                        return Err(field.fault(what, "write the field on straight triangles"));
                    }
                    self.numbering.nodes[mesh.points.len() + edge].get_or_insert(node);
                    self.value(node)?
                }
                None => mean(self.value(nodes[order[j]])?, self.value(nodes[order[k]])?),
            };
            self.put_middle(edge, between)?;
        }
        Ok(())
    }

    /// Triangle `t` of the mesh is a part of triangle `number` of the file, with these corners, which are these vertices.
    fn part(
        &mut self,
        t: usize,
        number: usize,
        corners: &[[f64; 2]; 3],
        vertices: Option<&[usize; 3]>,
    ) -> Result<(), FieldError> {
        let (nodes, mesh) = (&self.field.triangles[number], &self.problem.mesh);
        let values: Vec<[f64; 2]> = nodes.iter().map(|node| self.value(*node)).collect::<Result<_, _>>()?;
        let own = mesh.corners(t);
        let within = |p: [f64; 2]| interpolated(&values, barycentric(corners, p));
        for i in 0..3 {
            let v = mesh.triangles[t][i];
            let corner = match vertices {
                Some(vertices) => vertices.iter().position(|w| *w == v),
                None => barycentric(corners, own[i]).iter().position(|weight| *weight > 1.0 - AT_CORNER),
            };
            let known = corner.filter(|_| vertices.is_some());
            self.put_vertex(v, known.map_or_else(|| within(own[i]), |corner| values[corner]))?;
            if let Some(corner) = corner {
                self.numbering.nodes[v].get_or_insert(nodes[corner]);
            }
            let halfway = mean(own[(i + 1) % 3], own[(i + 2) % 3]);
            self.put_middle(mesh.triangle_edges[t][i], within(halfway))?;
        }
        Ok(())
    }

    /// The displacement of a point of the file.
    fn value(&self, node: usize) -> Result<[f64; 2], FieldError> {
        let field = self.field;
        field.values[node].ok_or_else(|| {
            let place = at(&self.problem.scene, field.points[node]);
            let what = format!("there is no finite displacement at point {} {place}", node + 1);
            field.fault(what, "write a finite value at every point of a triangle")
        })
    }

    fn put_vertex(&mut self, v: usize, u: [f64; 2]) -> Result<(), FieldError> {
        let point = self.problem.mesh.points[v];
        put(&mut self.vertex[v], u, self.size).ok_or_else(|| jump(self.field, &self.problem.scene, point))
    }

    fn put_middle(&mut self, edge: usize, u: [f64; 2]) -> Result<(), FieldError> {
        let [a, b] = self.problem.mesh.edges[edge].vertices.map(|v| self.problem.mesh.points[v]);
        put(&mut self.middle[edge], u, self.size).ok_or_else(|| jump(self.field, &self.problem.scene, mean(a, b)))
    }
}

/// Keeps the first of several values of one point; `None` where they differ.
fn put(slot: &mut Option<[f64; 2]>, u: [f64; 2], size: f64) -> Option<()> {
    let kept = slot.get_or_insert(u);
    ((kept[0] - u[0]).abs().max((kept[1] - u[1]).abs()) <= JUMP * size).then_some(())
}

fn jump(field: &ForeignField, scene: &Scene, point: [f64; 2]) -> FieldError {
    let what = format!("the displacement jumps inside a body, at {}", at(scene, point));
    field.fault(what, "only a continuous field has an energy: write it in a continuous space")
}

fn mean(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]
}

/// Place, among the nodes of a triangle, of the one between two corners.
fn middle_node(a: usize, b: usize) -> usize {
    match a + b {
        1 => 3,
        3 => 4,
        _ => 5,
    }
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
