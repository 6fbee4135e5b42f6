//! From cells and named segments to a [`Triangulation`]: edges, names, and vertices of their own wherever two cells
//! are not bonded.

use std::collections::HashMap;

use super::cells::{self, Cells};
use super::error::{MeshError, at};
use super::labels::{self, Labels, Pair, Side, pair};
use super::{Edge, RawMesh, Triangulation, hanging, overlap};
use crate::problem::Note;
use crate::scene::Scene;

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
        let mut notes = Vec::new();
        let cells = cells::check(&raw, scene, &mut notes)?;
        let sides = match_sides(&raw, &cells, scene)?;
        let labels = labels::assign(&raw, &cells, &sides, scene, &mut notes)?;
        let mesh = split(&raw, cells, &sides, labels);
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
        label: &HashMap<Pair, usize>,
    ) -> Triangulation {
        let mut edges: Vec<Edge> = Vec::with_capacity(triangles.len() * 3 / 2 + 8);
        let mut index: HashMap<Pair, usize> = HashMap::with_capacity(edges.capacity());
        let mut triangle_edges = Vec::with_capacity(triangles.len());
        for (t, corners) in triangles.iter().enumerate() {
            triangle_edges.push([0, 1, 2].map(|i| {
                let (a, b) = (corners[(i + 1) % 3], corners[(i + 2) % 3]);
                let e = *index.entry(pair(a, b)).or_insert(edges.len());
                if e == edges.len() {
                    let name = label.get(&pair(a, b)).copied();
                    edges.push(Edge { vertices: [a, b], triangles: [Some(t), None], name });
                } else {
                    edges[e].triangles[1] = Some(t);
                    edges[e].name = None;
                }
                e
            }));
        }
        Triangulation { points, triangles, body, edges, triangle_edges, names }
    }

    /// The names of the boundary edges, in the form that [`Triangulation::connect`] takes.
    pub(crate) fn label(&self) -> HashMap<Pair, usize> {
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
}

/// For every edge the (triangle, local edge) on its sides, two at most and on opposite sides.
fn match_sides(raw: &RawMesh, cells: &Cells, scene: &Scene) -> Result<HashMap<Pair, Vec<Side>>, MeshError> {
    let mut sides: HashMap<Pair, Vec<Side>> = HashMap::with_capacity(cells.triangles.len() * 3 / 2);
    for (t, corners) in cells.triangles.iter().enumerate() {
        for i in 0..3 {
            let (a, b) = (corners[(i + 1) % 3], corners[(i + 2) % 3]);
            let found = sides.entry(pair(a, b)).or_default();
            found.push((t, i));
            let place = format!("{} to {}", at(raw.points[a]), at(raw.points[b]));
            if found.len() > 2 {
                return Err(MeshError::cells(
                    scene,
                    format!("the edge {place} belongs to three triangles"),
                    "in a plane at most two triangles share an edge: remove the cells that overlap",
                ));
            }
            if let [(other, j), _] = found[..]
                && cells.triangles[other][(j + 1) % 3] == a
            {
                return Err(MeshError::cells(
                    scene,
                    format!("two triangles overlap: both lie on the same side of the edge {place}"),
                    "remove one of them, or give the two bodies their own vertices",
                ));
            }
        }
    }
    Ok(sides)
}

/// Gives every fan of triangles around a vertex, connected through edges that are not cut, its own vertex.
fn split(raw: &RawMesh, cells: Cells, sides: &HashMap<Pair, Vec<Side>>, labels: Labels) -> Triangulation {
    let corner = |t: usize, i: usize| 3 * t + i;
    let mut parent: Vec<usize> = (0..3 * cells.triangles.len()).collect();
    for (key, both) in sides {
        let [(t, i), (u, j)] = both[..] else { continue };
        if !labels.cut.contains(key) {
            join(&mut parent, corner(t, (i + 1) % 3), corner(u, (j + 2) % 3));
            join(&mut parent, corner(t, (i + 2) % 3), corner(u, (j + 1) % 3));
        }
    }
    // The first fan of a vertex keeps its place among the vertices, further ones are appended.
    let mut vertex_of_fan: HashMap<usize, usize> = HashMap::new();
    let mut owner: Vec<Option<usize>> = vec![None; raw.points.len()];
    for (t, corners) in cells.triangles.iter().enumerate() {
        for i in 0..3 {
            owner[corners[i]].get_or_insert(root(&mut parent, corner(t, i)));
        }
    }
    let mut points = Vec::with_capacity(raw.points.len());
    for (v, fan) in owner.iter().enumerate() {
        if let Some(fan) = fan {
            vertex_of_fan.insert(*fan, points.len());
            points.push(raw.points[v].map(|x| x + 0.0));
        }
    }
    let mut triangles = Vec::with_capacity(cells.triangles.len());
    for (t, corners) in cells.triangles.iter().enumerate() {
        triangles.push([0, 1, 2].map(|i| {
            let fan = root(&mut parent, corner(t, i));
            *vertex_of_fan.entry(fan).or_insert_with(|| {
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
