//! From cells and named segments to a [`Triangulation`]: edges, names, and vertices of their own wherever two cells
//! are not bonded.

pub(super) mod boxes;
pub(super) mod hanging;
pub(crate) mod labels;
#[cfg(test)]
pub(super) mod topology_tests;
pub(super) mod touching;

use std::collections::HashSet;

use super::cells::overlap;
use super::cells::{self, Cells};
use super::error::{MeshError, at};
use super::refinement::halves::HalfEdges;
use super::sides::polyline::key;
use super::{Edge, FileCells, Map, RawMesh, Triangulation};
use crate::scene::Note;
use crate::scene::Scene;
use crate::sets::DisjointSets;
use labels::{Labels, Pair, pair};

impl Triangulation {
    /// Checks `raw` against `scene` and works out its topology.
    ///
    /// Clockwise triangles are turned, unused vertices dropped. Triangles that share an edge are bonded, except where
    /// a contact of the scene names both sides of the edge: there each body gets its own vertices. Triangles that
    /// share a vertex but are not connected through edges around it get their own vertices too.
    ///
    /// # Errors
    /// [`MeshError`] names the cell, vertex or boundary that does not fit, its place, and the remedy.
    pub fn new(raw: RawMesh, scene: &Scene) -> Result<(Triangulation, Vec<Note>), MeshError> {
        let mut notes = raw.sets.contradictions(scene);
        let raw = raw.resolved(scene);
        let cells = cells::check(&raw, scene, &mut notes)?;
        let halves = HalfEdges::new(&cells.triangles, raw.points.len());
        check_edges(&raw, &cells, &halves, scene)?;
        let labels = labels::assign(&raw, &cells, &halves, scene, &mut notes)?;
        let quadrilaterals = FileCells::find(&raw.quadrilaterals, &cells.triangles);
        let cut = labels.cut.clone();
        let mut mesh = split(&raw, cells, &halves, labels);
        check_cuts(&raw, &mesh, &cut, scene)?;
        mesh.cells = quadrilaterals;
        mesh.drop_parted_cells();
        overlap::check(&mesh, scene)?;
        hanging::check(&mesh, scene, &mut notes)?;
        Ok((mesh, notes))
    }

    /// Edges of given cells, which must be consistent already: counter-clockwise, at most two on an edge.
    ///
    /// `label` gives the name of a boundary edge by its vertices.
    pub(crate) fn connect(
        points: Vec<[f64; 2]>,
        triangles: Vec<[usize; 3]>,
        body: Vec<usize>,
        names: Vec<String>,
        label: &Map<Pair, usize>,
    ) -> Triangulation {
        let halves = HalfEdges::new(&triangles, points.len());
        let mut edges: Vec<Edge> = Vec::with_capacity(triangles.len() * 3 / 2 + 8);
        let mut triangle_edges: Vec<[usize; 3]> = Vec::with_capacity(triangles.len());
        for t in 0..triangles.len() {
            let mut found = [0; 3];
            for (i, found) in found.iter_mut().enumerate() {
                let [a, b] = HalfEdges::ends(&triangles, 3 * t + i);
                match halves.joining(a, b).find(|other| *other < 3 * t + i) {
                    Some(earlier) => {
                        *found = triangle_edges[earlier / 3][earlier % 3];
                        edges[*found].triangles[1] = Some(t);
                    }
                    None => {
                        *found = edges.len();
                        edges.push(Edge { vertices: [a, b], triangles: [Some(t), None], name: None });
                    }
                }
            }
            triangle_edges.push(found);
        }
        for edge in edges.iter_mut().filter(|edge| edge.is_boundary()) {
            edge.name = label.get(&pair(edge.vertices[0], edge.vertices[1])).copied();
        }
        Triangulation { points, triangles, body, edges, triangle_edges, names, cells: FileCells::default() }
    }

    /// The names of the boundary edges, in the form that [`Triangulation::connect`] takes.
    pub(crate) fn label(&self) -> Map<Pair, usize> {
        self.edges.iter().filter_map(|e| Some((pair(e.vertices[0], e.vertices[1]), e.name?))).collect()
    }

    /// Indices of the boundary edges called `name`.
    pub fn boundary(&self, name: &str) -> Vec<usize> {
        let Some(index) = self.names.iter().position(|n| n == name) else { return Vec::new() };
        (0..self.edges.len()).filter(|&e| self.edges[e].name == Some(index)).collect()
    }

    /// Area of triangle `t`.
    pub fn area(&self, t: usize) -> f64 {
        let [a, b, c] = self.corners(t);
        0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
    }

    /// The connected piece of every triangle, and how many pieces there are. Triangles that share an edge belong together.
    pub(crate) fn pieces(&self) -> (Vec<usize>, usize) {
        let mut sets = DisjointSets::new(self.triangles.len());
        for edge in &self.edges {
            if let [Some(left), Some(right)] = edge.triangles {
                sets.join(left, right);
            }
        }
        sets.labels()
    }
}

/// No edge has more than two triangles, and two lie on opposite sides of it.
fn check_edges(raw: &RawMesh, cells: &Cells, halves: &HalfEdges, scene: &Scene) -> Result<(), MeshError> {
    for side in 0..3 * cells.triangles.len() {
        let [a, b] = HalfEdges::ends(&cells.triangles, side);
        let place = || format!("{} to {}", at(scene, raw.points[a]), at(scene, raw.points[b]));
        let mut others = halves.joining(a, b).filter(|other| *other != side);
        let (other, third) = (others.next(), others.next());
        if third.is_some() {
            let what = format!("the edge {} belongs to three triangles", place());
            let remedy = "in a plane at most two triangles share an edge: remove the cells that overlap";
            return Err(MeshError::cells(scene, what, remedy));
        }
        if other.is_some_and(|other| HalfEdges::ends(&cells.triangles, other)[0] == a) {
            let what = format!("two triangles overlap: both lie on the same side of the edge {}", place());
            let remedy = "remove one of them, or give the two bodies their own vertices";
            return Err(MeshError::cells(scene, what, remedy));
        }
    }
    Ok(())
}

/// Every cut parts its two sides: one of a single edge inside a body does not, both of its ends belong to both.
fn check_cuts(raw: &RawMesh, mesh: &Triangulation, cut: &HashSet<Pair>, scene: &Scene) -> Result<(), MeshError> {
    let mut whole: Vec<[[u64; 2]; 2]> = cut.iter().map(|ends| ends.map(|v| key(raw.points[v]))).collect();
    // What is glued again need not part.
    if whole.is_empty() || !scene.bonds.is_empty() {
        return Ok(());
    }
    whole.iter_mut().for_each(|ends| ends.sort_unstable());
    whole.sort_unstable();
    for edge in mesh.edges.iter().filter(|edge| !edge.is_boundary()) {
        let mut ends = edge.vertices.map(|v| key(mesh.points[v]));
        ends.sort_unstable();
        if whole.binary_search(&ends).is_ok() {
            let [a, b] = edge.vertices.map(|v| at(scene, mesh.points[v]));
            let what = format!(
                "the cut {a} to {b} inside a body is one edge long, and parts nothing: both sides share both of its ends"
            );
            return Err(MeshError::cells(scene, what, "divide this edge at least once"));
        }
    }
    Ok(())
}

/// Gives every fan of triangles around a vertex, connected through edges that are not cut, its own vertex.
fn split(raw: &RawMesh, cells: Cells, halves: &HalfEdges, labels: Labels) -> Triangulation {
    let corner = |t: usize, i: usize| 3 * t + i;
    let mut parent: Vec<usize> = (0..3 * cells.triangles.len()).collect();
    for side in 0..parent.len() {
        let [a, b] = HalfEdges::ends(&cells.triangles, side);
        let Some(other) = halves.joining(a, b).find(|other| *other > side) else { continue };
        if labels.cut.is_empty() || !labels.cut.contains(&pair(a, b)) {
            let (t, i, u, j) = (side / 3, side % 3, other / 3, other % 3);
            join(&mut parent, corner(t, (i + 1) % 3), corner(u, (j + 2) % 3));
            join(&mut parent, corner(t, (i + 2) % 3), corner(u, (j + 1) % 3));
        }
    }
    // The first fan of a vertex keeps its place among the vertices, further ones are appended.
    let mut vertex_of_fan: Vec<Option<usize>> = vec![None; parent.len()];
    let mut owner: Vec<Option<usize>> = vec![None; raw.points.len()];
    for (t, corners) in cells.triangles.iter().enumerate() {
        for i in 0..3 {
            owner[corners[i]].get_or_insert(root(&mut parent, corner(t, i)));
        }
    }
    let mut points = Vec::with_capacity(raw.points.len());
    for (v, fan) in owner.iter().enumerate() {
        if let Some(fan) = fan {
            vertex_of_fan[*fan] = Some(points.len());
            points.push(raw.points[v].map(|x| x + 0.0));
        }
    }
    let mut triangles = Vec::with_capacity(cells.triangles.len());
    for (t, corners) in cells.triangles.iter().enumerate() {
        triangles.push([0, 1, 2].map(|i| {
            let fan = root(&mut parent, corner(t, i));
            *vertex_of_fan[fan].get_or_insert_with(|| {
                points.push(raw.points[corners[i]].map(|x| x + 0.0));
                points.len() - 1
            })
        }));
    }
    let label = labels
        .of
        .iter()
        .map(|(&(t, i), &name)| (pair(triangles[t][(i + 1) % 3], triangles[t][(i + 2) % 3]), name))
        .collect();
    Triangulation::connect(points, triangles, cells.body, labels.names, &label)
}

/// The representative of a set; path halving.
fn root(parent: &mut [usize], mut x: usize) -> usize {
    while parent[x] != x {
        parent[x] = parent[parent[x]];
        x = parent[x];
    }
    x
}

/// Unites two sets; the smaller representative stays, so that the result does not depend on the order of joins.
fn join(parent: &mut [usize], x: usize, y: usize) {
    let (x, y) = (root(parent, x), root(parent, y));
    parent[x.max(y)] = x.min(y);
}
