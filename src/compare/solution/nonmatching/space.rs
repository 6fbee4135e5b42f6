//! The shape functions of a file at places of the mesh that was made of it.

use std::collections::BTreeMap;

use super::forces::Row;
use crate::compare::solution::Solution;
use crate::compare::solution::weak::{Point, Rows, longest};
use crate::element::polynomial::quadrature::segment_rule;
use crate::problem::{ContactPair, Problem};
use crate::vector::{distance, dot};

/// Weights of shape functions below this are zero: a vertex that lies on an edge lies there to round-off.
const BESIDE: f64 = 1e-6;
/// Parts of shape functions of the file: (node, weight).
type Weights = Vec<(usize, f64)>;

/// The shape functions of a file at places of the mesh that was made of it.
pub struct Space<'a> {
    own: &'a Problem,
    glued: &'a Problem,
    degree: usize,
    /// Vertices of the file.
    pub vertices: usize,
    /// For every vertex of the mesh, a triangle that has it.
    at: Vec<usize>,
}

impl<'a> Space<'a> {
    pub fn new(own: &'a Problem, glued: &'a Problem, degree: usize) -> Self {
        let mut at = vec![0; glued.mesh.points.len()];
        for (t, corners) in glued.mesh.triangles.iter().enumerate() {
            corners.iter().for_each(|v| at[*v] = t);
        }
        Space { own, glued, degree, vertices: own.mesh.points.len(), at }
    }

    /// The rows of a contact: values of the jump at the ends of pairs, and of quadratic fields the coefficient between them.
    pub fn rows(&self, pairs: &[ContactPair]) -> Vec<Row> {
        let mut ends: BTreeMap<(usize, Option<usize>), Vec<[f64; 2]>> = BTreeMap::new();
        let mut rows = Vec::new();
        for pair in pairs {
            let of_ends = [0.0, 1.0].map(|at| self.row(pair, at));
            if self.degree > 1 {
                rows.push(self.row(pair, 0.5).bernstein([&of_ends[0], &of_ends[1]]));
            }
            for (end, row) in of_ends.into_iter().enumerate() {
                let normal = pair.direction.ends[end];
                let known = ends.entry((pair.first[end], pair.second.map(|second| second[end]))).or_default();
                if !known.contains(&normal) {
                    known.push(normal);
                    rows.push(row);
                }
            }
        }
        rows
    }

    /// The jumps at the nodes between vertices of the file, at which methods of degree 2 may ask for contact.
    pub fn between(&self, pairs: &[ContactPair]) -> Vec<Row> {
        if self.degree == 1 {
            return Vec::new();
        }
        let place = |ends: [usize; 2]| {
            let [p, q] = ends.map(|v| self.glued.mesh.points[v]);
            let along = [q[0] - p[0], q[1] - p[1]];
            let corners = self.barycentric(self.beside(ends), [0, 1].map(|c| p[c] + 0.5 * along[c])).1;
            let [(a, _), (b, _)] = corners[..] else { return None };
            let [a, b] = [a, b].map(|v| self.glued.mesh.points[v]);
            let from = [0, 1].map(|c| 0.5 * (a[c] + b[c]) - p[c]);
            let at = dot(from, along) / dot(along, along);
            (BESIDE..1.0 - BESIDE).contains(&at).then_some(at)
        };
        let of = |pair: &ContactPair| {
            let places = [Some(pair.first), pair.second].map(|ends| place(ends?));
            let same = matches!(places, [Some(a), Some(b)] if (a - b).abs() < BESIDE);
            places.into_iter().take(if same { 1 } else { 2 }).flatten().map(|at| self.row(pair, at)).collect::<Vec<_>>()
        };
        pairs.iter().flat_map(of).collect()
    }

    /// The jump at a part `at` of a pair.
    pub fn row(&self, pair: &ContactPair, at: f64) -> Row {
        let direction = pair.direction.at(at);
        let side = |ends: [usize; 2]| match at {
            0.0 => self.nodes(self.at[ends[0]], self.glued.mesh.points[ends[0]]),
            1.0 => self.nodes(self.at[ends[1]], self.glued.mesh.points[ends[1]]),
            _ => {
                let [p, q] = ends.map(|v| self.glued.mesh.points[v]);
                let t = self.beside(ends);
                self.nodes(t, [p[0] + at * (q[0] - p[0]), p[1] + at * (q[1] - p[1])])
            }
        };
        let term = |sign: f64| move |(node, w): (usize, f64)| (node, direction.map(|d| sign * w * d));
        let mut terms: Vec<(usize, [f64; 2])> = side(pair.first).into_iter().map(term(1.0)).collect();
        terms.extend(pair.second.map(side).into_iter().flatten().map(term(-1.0)));
        Row { terms, gap: (1.0 - at) * pair.gap[0] + at * pair.gap[1], overlap: 0.0 }
    }

    /// The points of a rule on every pair, with the jump and the normal stresses in the nodes of the file.
    pub fn points(&self, solution: &Solution<'_>, pairs: &[ContactPair], rule: usize) -> Vec<Point> {
        let mut points = Vec::new();
        for pair in pairs {
            let sides = [Some(pair.first), pair.second].map(|ends| ends.map(|ends| (ends, self.beside(ends))));
            for (at, part) in segment_rule(rule) {
                let row = self.row(pair, *at);
                let mut lengths = [pair.length; 4];
                let mut stress: [Rows; 2] = Default::default();
                for (side, (ends, t)) in sides.into_iter().enumerate().filter_map(|(i, side)| Some((i, side?))) {
                    let [p, q] = ends.map(|v| self.glued.mesh.points[v]);
                    let point = [0, 1].map(|c| p[c] + at * (q[c] - p[c]));
                    let (parent, corners) = self.barycentric(t, point);
                    let vertices = self.own.mesh.triangles[parent];
                    let weight = |v: usize| corners.iter().find(|(w, _)| *w == v).map_or(0.0, |(_, weight)| *weight);
                    let l = vertices.map(weight);
                    stress[side] = solution.normal_stress(parent, l, pair.direction.at(*at));
                    let [a, b] = match corners[..] {
                        [(a, _), (b, _)] => [a, b].map(|v| self.own.mesh.points[v]),
                        _ => [p, q],
                    };
                    lengths[2 * side] = distance(a, b);
                    lengths[2 * side + 1] = longest(self.own.mesh.corners(parent));
                }
                if pair.second.is_none() {
                    lengths = [lengths[0], lengths[1], lengths[0], lengths[1]];
                }
                points.push(Point {
                    weight: self.own.scene.thickness * pair.length * part,
                    excess: row.excess(solution.candidate),
                    lengths,
                    carries: true,
                    jump: row.terms,
                    stress,
                });
            }
        }
        points
    }

    /// The triangle of the edge between two vertices.
    fn beside(&self, ends: [usize; 2]) -> usize {
        let has = |t: usize| ends.iter().all(|v| self.glued.mesh.triangles[t].contains(v));
        let edges = self.glued.pairs().flat_map(|pair| pair.edges).flatten();
        let mut triangles = edges.filter_map(|e| self.glued.mesh.edges[e].triangles[0]);
        triangles.find(|t| has(*t)).unwrap_or(self.at[ends[0]])
    }

    /// The corners of the file at a vertex of the mesh.
    pub fn corners(&self, vertex: usize) -> Weights {
        self.barycentric(self.at[vertex], self.glued.mesh.points[vertex]).1
    }

    /// The nodes of the file at a point of triangle `t` of the mesh.
    fn nodes(&self, t: usize, point: [f64; 2]) -> Weights {
        let (parent, corners) = self.barycentric(t, point);
        if self.degree == 1 {
            return corners;
        }
        let mesh = &self.own.mesh;
        let weight = |v: usize| corners.iter().find(|(w, _)| *w == v).map_or(0.0, |(_, weight)| *weight);
        let l = mesh.triangles[parent].map(weight);
        let corner = (0..3).map(|i| (mesh.triangles[parent][i], l[i] * (2.0 * l[i] - 1.0)));
        let middle =
            (0..3).map(|i| (self.vertices + mesh.triangle_edges[parent][i], 4.0 * l[(i + 1) % 3] * l[(i + 2) % 3]));
        corner.chain(middle).filter(|(_, weight)| *weight != 0.0).collect()
    }

    /// The triangle of the file that triangle `t` of the mesh is a part of, and its corners with their barycentric coordinates.
    fn barycentric(&self, t: usize, point: [f64; 2]) -> (usize, Weights) {
        let parent = self.glued.uncut.as_ref().map_or(t, |uncut| uncut.parent[t]);
        let corners = self.own.mesh.triangles[parent];
        // Vertices that contact moved are where it moved them.
        let [a, b, c] = corners.map(|v| self.glued.mesh.points[v]);
        let area =
            |a: [f64; 2], b: [f64; 2], c: [f64; 2]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        let whole = area(a, b, c);
        let l = [area(point, b, c), area(a, point, c), area(a, b, point)].map(|part| part / whole);
        let l = l.map(|x| if x.abs() < BESIDE { 0.0 } else { x });
        let sum: f64 = l.iter().sum();
        (parent, corners.into_iter().zip(l).filter(|(_, x)| *x != 0.0).map(|(v, x)| (v, x / sum)).collect())
    }
}
