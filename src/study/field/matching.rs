//! The values of a field, found again at the vertices and edges of the mesh of a scene.
//!
//! Points are not enough to match by: bodies that meet at a contact have two vertices at equal coordinates, and which point belongs
//! to which body only the triangles say. A file that has merged such points gives both vertices the same displacement; one that has
//! a point of its own for every triangle is read as the continuous field it must be.
//!
//! Contacts put vertices of one side and kinks of the gap into the edges of a mesh, and cut the triangles there. A triangle that is
//! not in the file is then a part of one that is, whose polynomial it has.

use super::cells::{Quadrilaterals, polynomials, quadrilaterals};
use super::curved::Curved;
use super::places::{AT_CORNER, Place, Places, barycentric, places, round_off, turned};
use super::{FieldError, ForeignField};
use crate::bounds::Cell;
use crate::compare::solution::place;
use crate::compare::{ADMISSIBLE, Numbering};
use crate::element::{PlainDisplacement, Quadrilateral};
use crate::mesh::error::at;
use crate::problem::Problem;
use crate::scene::Scene;
use crate::vector::distance;

/// Difference between two values of one point, in parts of the largest displacement, that counts as round-off.
const JUMP: f64 = 1e-6;
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
    /// Mid-nodes and centres that are not where straight sides have them.
    pub curved: Option<Curved>,
    /// The quadrilaterals.
    pub cells: Vec<Cell>,
    /// The polynomials on triangles that stand for the field, where there are quadrilaterals.
    pub higher: Option<PlainDisplacement>,
}

/// Brings `field` onto the mesh of `problem`.
pub(super) fn onto(field: &ForeignField, problem: &Problem) -> Result<Matched, FieldError> {
    let moved = field.about(problem.scene.origin);
    let field = moved.as_ref().unwrap_or(field);
    // Whoever made the mesh of the scene may have cut quadrilaterals along their other diagonals.
    let found = places(field, problem).map(|places| (places, None));
    let other = |fault: FieldError| {
        let turned = turned(field, problem).ok_or_else(|| fault.clone())?;
        let places = places(&turned, problem).map_err(|_| fault)?;
        Ok((places, Some(turned)))
    };
    let (Places { triangles, uncut }, turned) = found.or_else(other)?;
    let field = turned.as_ref().unwrap_or(field);
    let mesh = &problem.mesh;
    let cell = |place: &Place| field.triangles[place.number()].cell;
    let quadratic = triangles.iter().any(|place| field.cells[cell(place)].len() > 4);
    let numbering = Numbering {
        nodes: vec![None; mesh.points.len() + mesh.edges.len()],
        triangles: triangles.iter().map(|place| Some(cell(place))).collect(),
        files: field.files.clone(),
        uncut,
        off: 0.0,
    };
    let mut carried = Carried {
        field,
        problem,
        size: field.values.iter().flatten().flatten().fold(0.0_f64, |m, v| m.max(v.abs())),
        vertex: vec![None; mesh.points.len()],
        middle: vec![None; mesh.edges.len()],
        numbering,
        off: None,
        curved: Curved::default(),
    };
    let cells = quadrilaterals(field, problem, &triangles, |node| carried.value(node))?;
    carried.curved = cells.curved;
    let whole = |t: usize| cells.of[t].is_none();
    for (t, place) in triangles.iter().enumerate() {
        match place {
            Place::Same(number, order) if whole(t) => carried.whole(t, *number, order)?,
            _ => {}
        }
    }
    for (t, place) in triangles.iter().enumerate() {
        match place {
            Place::Part { number, corners, vertices } if whole(t) => {
                carried.part(t, *number, corners, vertices.as_ref())?;
            }
            _ => {}
        }
    }
    for (t, place) in triangles.iter().enumerate() {
        if let Some(own) = cells.of[t] {
            carried.in_quadrilateral(t, place, &cells.list[own].field)?;
        }
    }
    carried.number_inside(&cells);
    let Carried { vertex, middle, mut numbering, off, curved, .. } = carried;
    numbering.off = off.unwrap_or(0.0);
    let inserted = numbering.nodes[..mesh.points.len()].iter().filter(|n| n.is_none()).count();
    // Every triangle has a place, and every vertex and edge a triangle.
    let all = |values: Vec<Option<[f64; 2]>>| values.into_iter().map(Option::unwrap_or_default).collect::<Vec<_>>();
    let (vertex, mut middle) = (all(vertex), all(middle));
    let value = |t: usize, point: [f64; 2]| match cells.of[t] {
        Some(own) => cells.list[own].field.value(cells.list[own].field.place(point)),
        None => {
            let [a, b, c] = mesh.triangle_edges[t].map(|e| middle[e]);
            let corners = mesh.triangles[t].map(|v| vertex[v]);
            interpolated(&[&corners[..], &[c, a, b]].concat(), barycentric(&mesh.corners(t), point))
        }
    };
    let higher = polynomials(problem, &cells.list, quadratic, &vertex, value);
    for cell in &cells.list {
        if let (9, Some(centre)) = (cell.field.nodes(), cell.nodes.get(8)) {
            middle[centre - mesh.points.len()] = cell.field.values()[8];
        }
    }
    let degree = if quadratic { 2 } else { 1 };
    let curved = Some(curved).filter(|curved| curved.off > 0.0);
    Ok(Matched { degree, vertex, middle, numbering, inserted, off, curved, cells: cells.list, higher })
}

/// Values and places found so far.
struct Carried<'a> {
    field: &'a ForeignField,
    problem: &'a Problem,
    /// The largest displacement.
    size: f64,
    vertex: Vec<Option<[f64; 2]>>,
    middle: Vec<Option<[f64; 2]>>,
    numbering: Numbering,
    off: Option<f64>,
    curved: Curved,
}

impl Carried<'_> {
    /// Triangle `t` of the mesh is, or is a part of, a quadrilateral with this field.
    fn in_quadrilateral(&mut self, t: usize, place: &Place, own: &Quadrilateral) -> Result<(), FieldError> {
        let (field, mesh) = (self.field, &self.problem.mesh);
        let known = place.known(field, self.problem, t);
        let corners = mesh.corners(t);
        let before = |v: usize| self.problem.uncut.as_ref().and_then(|uncut| uncut.place_before(v));
        for i in 0..3 {
            let v = mesh.triangles[t][i];
            match known.iter().find(|(_, vertex)| *vertex == v) {
                Some(&(node, _)) => {
                    self.put_vertex(v, self.value(node)?)?;
                    self.numbering.nodes[v].get_or_insert(node);
                    let away = distance(field.points[node], before(v).unwrap_or(corners[i]));
                    if away > round_off(field, &corners) && self.off.is_none_or(|most| most < away) {
                        self.off = Some(away);
                    }
                }
                None => self.put_vertex(v, own.value(own.place(corners[i])))?,
            }
            let halfway = mean(corners[(i + 1) % 3], corners[(i + 2) % 3]);
            self.put_middle(mesh.triangle_edges[t][i], own.value(own.place(halfway)))?;
        }
        Ok(())
    }

    /// Numbers the nodes of quadrilaterals that are no vertices.
    fn number_inside(&mut self, cells: &Quadrilaterals) {
        for (cell, number) in cells.list.iter().zip(&cells.numbers) {
            let nodes = &self.field.cells[*number];
            for &node in cell.nodes.iter().skip(4) {
                let [x, y] = place(self.problem, node);
                let near = |n: &&usize| distance(self.field.points[**n], [x, y]);
                // A node between two corners is nearest to its own side, and the centre is the last.
                let own = match cell.nodes.get(8) {
                    Some(centre) if *centre == node => nodes.last(),
                    _ => nodes[4..].iter().take(4).min_by(|a, b| near(a).total_cmp(&near(b))),
                };
                self.numbering.nodes[node] = self.numbering.nodes[node].or(own.copied());
            }
        }
    }

    /// Triangle `t` of the mesh is triangle `number` of the file.
    fn whole(&mut self, t: usize, number: usize, order: &[usize; 3]) -> Result<(), FieldError> {
        let (field, problem) = (self.field, self.problem);
        let mesh = &problem.mesh;
        // Contact has not moved these.
        let before = |v: usize| problem.uncut.as_ref().and_then(|uncut| uncut.place_before(v));
        let place = |v: usize| before(v).unwrap_or(mesh.points[v]);
        let (nodes, corners) = (&field.triangles[number].nodes, mesh.triangles[t].map(place));
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
                    let straight = mean(corners[j], corners[k]);
                    self.curved.note(field, field.points[node], straight, distance(corners[j], corners[k]))?;
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
        let (nodes, mesh) = (&self.field.triangles[number].nodes, &self.problem.mesh);
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

    /// The displacement of a point of the file; none away from the axis of a body of revolution where it is so but for round-off.
    fn value(&self, node: usize) -> Result<[f64; 2], FieldError> {
        let field = self.field;
        let axis = self.problem.section().axis();
        let on_axis = axis.is_some_and(|axis| (field.points[node][0] - axis).abs() <= AT_CORNER * field.far);
        let stays = |u: &[f64; 2]| on_axis && u[0].abs() <= ADMISSIBLE * self.size;
        field.values[node].map(|u| if stays(&u) { [0.0, u[1]] } else { u }).ok_or_else(|| {
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
    if scene.bonds.is_empty() {
        let what = format!("the displacement jumps inside a body, at {}", at(scene, point));
        return field.fault(what, "only a continuous field has an energy: write it in a continuous space");
    }
    let what = format!("the displacement jumps inside a body or across a bond, at {}", at(scene, point));
    field.fault(
        what,
        "only a continuous field has an energy: write it in a continuous space; one of a method that ties unlike meshes in the mean is made continuous by projecting it onto equal vertices of both sides",
    )
}

pub(super) fn mean(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
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
