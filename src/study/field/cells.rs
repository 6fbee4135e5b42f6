//! The quadrilaterals of a field on the mesh of a scene: the triangles that make each of them up, and the field on it.

use super::curved::Curved;
use super::matching::mean;
use super::places::Place;
use super::{FieldError, ForeignField, Part};
use crate::bounds::Cell;
use crate::element::displacement::quadrilateral as shape;
use crate::element::polynomial::triangle;
use crate::element::{PlainDisplacement, Quadrilateral};
use crate::mesh::cells::quadrilateral;
use crate::problem::Problem;
use crate::vector::distance;

pub(super) const REMEDY: &str = "write its corners in order around it, without crossing sides, each once";
/// The degree of what stands for a field on triangles of a quadrilateral that is no parallelogram, above that on one that is.
const RAISED: [usize; 2] = [3, 4];

/// The cells cut into triangles. A quadrilateral of four nodes with two that are one is a triangle.
///
/// # Errors
/// A description of the fault of a quadrilateral.
pub(super) fn parts(cells: &mut [Vec<usize>], points: &[[f64; 2]]) -> Result<Vec<Part>, String> {
    let mut parts = Vec::with_capacity(2 * cells.len());
    for (cell, nodes) in cells.iter_mut().enumerate() {
        let (&[a, b, c, d], false) = (nodes.first_chunk().unwrap_or(&[0; 4]), [3, 6].contains(&nodes.len())) else {
            parts.push(Part { cell, nodes: nodes.clone() });
            continue;
        };
        match quadrilateral::cut([a, b, c, d], points).as_deref() {
            Some([one, other]) => {
                parts.extend([one, other].map(|corners| Part { cell, nodes: corners.to_vec() }));
            }
            Some([one]) if nodes.len() == 4 => {
                *nodes = one.to_vec();
                parts.push(Part { cell, nodes: nodes.clone() });
            }
            Some(_) => {
                return Err(format!("cell {} is a quadrilateral of {} nodes without a side", cell + 1, nodes.len()));
            }
            None => return Err(format!("cell {} is a quadrilateral that folds over", cell + 1)),
        }
    }
    Ok(parts)
}

/// A quadrilateral of the file in the mesh.
struct Found {
    cell: usize,
    triangles: Vec<usize>,
    /// The vertices that are its corners, in the order of the file.
    corners: [Option<usize>; 4],
}

/// All of them, and by triangle of the mesh which it belongs to.
pub(super) struct Quadrilaterals {
    /// The fields.
    pub list: Vec<Cell>,
    /// The numbers of their cells in the file.
    pub numbers: Vec<usize>,
    /// Of every triangle its place in `list`.
    pub of: Vec<Option<usize>>,
    /// Mid-nodes and centres that are not where straight sides have them.
    pub curved: Curved,
}

/// The quadrilaterals among the `places` of all triangles.
///
/// # Errors
/// A value is missing, or the map of a quadrilateral folds over.
pub(super) fn quadrilaterals(
    field: &ForeignField,
    problem: &Problem,
    places: &[Place],
    value: impl Fn(usize) -> Result<[f64; 2], FieldError>,
) -> Result<Quadrilaterals, FieldError> {
    let mesh = &problem.mesh;
    let mut slot = vec![usize::MAX; field.cells.len()];
    let mut all: Vec<Found> = Vec::new();
    let mut of = vec![None; places.len()];
    for (t, place) in places.iter().enumerate() {
        let number = place.number();
        let cell = field.triangles[number].cell;
        if [3, 6].contains(&field.cells[cell].len()) {
            continue;
        }
        if slot[cell] == usize::MAX {
            slot[cell] = all.len();
            all.push(Found { cell, triangles: Vec::new(), corners: [None; 4] });
        }
        of[t] = Some(slot[cell]);
        let found = &mut all[slot[cell]];
        found.triangles.push(t);
        for (node, vertex) in place.known(field, problem, t) {
            if let Some(corner) = field.cells[cell][..4].iter().position(|n| *n == node) {
                found.corners[corner] = Some(vertex);
            }
        }
    }
    let mut curved = Curved::default();
    let mut list = Vec::with_capacity(all.len());
    for found in &all {
        let nodes = &field.cells[found.cell];
        let at = |i: usize| found.corners[i].map_or(field.points[nodes[i]], |v| mesh.points[v]);
        let corners = [0, 1, 2, 3].map(at);
        for (i, &node) in nodes.iter().enumerate().skip(4) {
            let ends = [i % 4, (i + 1) % 4].map(|i| field.points[nodes[i]]);
            let straight = if i < 8 {
                mean(ends[0], ends[1])
            } else {
                mean(
                    mean(field.points[nodes[0]], field.points[nodes[1]]),
                    mean(field.points[nodes[2]], field.points[nodes[3]]),
                )
            };
            curved.note(field, field.points[node], straight, distance(ends[0], ends[1]))?;
        }
        // Counter-clockwise, as the triangles are.
        let around: f64 = (0..4).map(|i| cross(corners[i], corners[(i + 1) % 4], corners[0])).sum();
        let order: [usize; 9] = if around > 0.0 { [0, 1, 2, 3, 4, 5, 6, 7, 8] } else { [0, 3, 2, 1, 7, 6, 5, 4, 8] };
        let nodal = order.iter().take(nodes.len()).map(|i| value(nodes[*i])).collect::<Result<Vec<_>, _>>()?;
        let turned = [0, 1, 2, 3].map(|i| corners[order[i]]);
        let Some(own) = Quadrilateral::new(turned, &nodal).filter(|_| shape::is_convex(&turned)) else {
            let what = format!(
                "cell {} is a quadrilateral with an angle of 180 degrees or more, where its map folds over",
                found.cell + 1
            );
            return Err(field.fault(what, "move the corner, or write the field on triangles there"));
        };
        let vertices = order.map(|i| found.corners.get(i).copied().flatten());
        let nodes =
            own_nodes(problem, &found.triangles, [vertices[0], vertices[1], vertices[2], vertices[3]], nodes.len());
        list.push(Cell { field: own, triangles: found.triangles.clone(), nodes: nodes.unwrap_or_default() });
    }
    Ok(Quadrilaterals { numbers: all.iter().map(|found| found.cell).collect(), list, of, curved })
}

fn cross(a: [f64; 2], b: [f64; 2], from: [f64; 2]) -> f64 {
    (a[0] - from[0]) * (b[1] - from[1]) - (a[1] - from[1]) * (b[0] - from[0])
}

/// The nodes of a quadrilateral in the mesh, where its sides are whole.
fn own_nodes(problem: &Problem, triangles: &[usize], corners: [Option<usize>; 4], count: usize) -> Option<Vec<usize>> {
    let mesh = &problem.mesh;
    let &[one, other] = triangles else { return None };
    let edges: Vec<usize> = [one, other].iter().flat_map(|t| mesh.triangle_edges[*t]).collect();
    let between = |a: usize, b: usize| {
        let joins = |e: &&usize| mesh.edges[**e].vertices == [a, b] || mesh.edges[**e].vertices == [b, a];
        edges.iter().find(joins).map(|e| mesh.points.len() + e)
    };
    let [a, b, c, d] = corners;
    let corners = [a?, b?, c?, d?];
    let sides: Option<Vec<usize>> = (0..4).map(|i| between(corners[i], corners[(i + 1) % 4])).collect();
    let centre = between(corners[0], corners[2]).or_else(|| between(corners[1], corners[3]))?;
    let mut nodes = [&corners[..], &sides?[..], &[centre]].concat();
    nodes.truncate(count);
    Some(nodes)
}

/// The polynomials on triangles that stand for the field of `cells`, and are it wherever it is one: `value` is it at a point of
/// triangle t, and `vertex` at the vertices.
pub(super) fn polynomials(
    problem: &Problem,
    cells: &[Cell],
    quadratic: bool,
    vertex: &[[f64; 2]],
    value: impl Fn(usize, [f64; 2]) -> [f64; 2],
) -> Option<PlainDisplacement> {
    let mesh = &problem.mesh;
    let of = |cell: &Cell| match cell.field.is_parallelogram() {
        true => cell.field.degree(),
        false => RAISED[usize::from(cell.field.nodes() > 4)],
    };
    let k = cells.iter().map(of).max()?.max(if quadratic { 2 } else { 1 });
    let between = |points: &[[f64; 2]], parts: &[usize]| {
        [0, 1].map(|c| points.iter().zip(parts).map(|(p, part)| *part as f64 / k as f64 * p[c]).sum::<f64>())
    };
    let along = |edge: &crate::mesh::Edge| {
        let ends = edge.vertices.map(|v| mesh.points[v]);
        let t = edge.triangles[0].unwrap_or_default();
        (1..k).map(|j| value(t, between(&ends, &[k - j, j]))).collect::<Vec<_>>()
    };
    let edges: Vec<[f64; 2]> = mesh.edges.iter().flat_map(along).collect();
    let inner: Vec<triangle::Index> = triangle::indices(k).filter(|alpha| !alpha.contains(&0)).collect();
    let within = |t: usize| inner.iter().map(|alpha| value(t, between(&mesh.corners(t), alpha))).collect::<Vec<_>>();
    let inside: Vec<[f64; 2]> = (0..mesh.triangles.len()).flat_map(within).collect();
    PlainDisplacement::from_values(mesh, k, vertex, &edges, &inside)
}
