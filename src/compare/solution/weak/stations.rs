//! Quadrature points along a contact: the jump less the gap there, and the normal stresses of the field.

use super::super::Solution;
use crate::element::geometry::gradients;
use crate::element::polynomial::quadrature::segment_rule;

/// One quadrature point.
pub struct Station {
    /// ds times the thickness.
    pub weight: f64,
    /// Part of the way from the first end of its pair to the second.
    pub at: f64,
    /// Its edge, an index into [`super::super::Sites::edges`].
    pub edge: usize,
    /// Shape functions of the jump: places of contact, as indices into [`super::super::Sites::list`], with their values.
    pub sites: Vec<(usize, f64)>,
    /// (v' − v'')·n̂ − g.
    pub excess: f64,
}

/// The shape of the gap that another program may have used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// Linear between the vertices of the mesh.
    Chords,
    /// The curve of the scene at every quadrature point.
    Curve,
}

/// A linear form in the displacements of nodes: each node with the coefficients of its two components.
pub type Rows = Vec<(usize, [f64; 2])>;

/// Shape functions of an edge at `s`: its ends and, of degree 2, its middle.
pub fn shapes(degree: usize, s: f64) -> [f64; 3] {
    match degree {
        1 => [1.0 - s, s, 0.0],
        _ => [(1.0 - s) * (1.0 - 2.0 * s), s * (2.0 * s - 1.0), 4.0 * s * (1.0 - s)],
    }
}

impl Solution<'_> {
    /// True if the gap of contact `interface` is a curve between the vertices.
    pub fn is_curved(&self, interface: usize) -> bool {
        self.stations(interface, 4, Shape::Curve)
            .iter()
            .zip(self.stations(interface, 4, Shape::Chords))
            .any(|(a, b)| a.excess != b.excess)
    }

    /// The points of a rule of degree `degree` along contact `interface`.
    pub fn stations(&self, interface: usize, degree: usize, shape: Shape) -> Vec<Station> {
        let scene = &self.problem.scene;
        let gap = scene.contacts.get(interface).map(|contact| &contact.gap).filter(|_| shape == Shape::Curve);
        let pairs = &self.problem.interfaces[interface].pairs;
        let mut stations = Vec::new();
        for (edge, span) in self.sites.edges.iter().enumerate().filter(|(_, span)| span.interface == interface) {
            let pair = &pairs[span.pair];
            let [first, last] = pair.arc;
            let places: Vec<usize> = span.ends.into_iter().chain(span.middle).collect();
            for (at, part) in segment_rule(degree) {
                let values = shapes(if span.middle.is_some() { 2 } else { 1 }, *at);
                let sites: Vec<(usize, f64)> = places.iter().copied().zip(values).collect();
                let bulge = gap.map_or(0.0, |gap| {
                    let chord = gap.at(first) * (1.0 - at) + gap.at(last) * at;
                    chord - gap.at(first + at * (last - first))
                });
                let jump: f64 = sites.iter().map(|(site, value)| value * self.excess[*site]).sum();
                stations.push(Station {
                    weight: scene.thickness * span.length * part,
                    at: *at,
                    edge,
                    sites,
                    excess: jump + bulge,
                });
            }
        }
        stations
    }

    /// The normal stress n̂·σ(φ)n̂ at a point, from the triangle of either side.
    pub fn traces(&self, station: &Station) -> [Rows; 2] {
        let span = &self.sites.edges[station.edge];
        let pair = &self.problem.interfaces[span.interface].pairs[span.pair];
        let (mesh, n) = (&self.problem.mesh, pair.direction.at(station.at));
        let side = |edge: Option<usize>, ends: Option<[usize; 2]>| {
            let t = mesh.edges[edge?].triangles[0]?;
            let mut l = [0.0; 3];
            for (vertex, part) in ends?.into_iter().zip([1.0 - station.at, station.at]) {
                if let Some(corner) = mesh.triangles[t].iter().position(|v| *v == vertex) {
                    l[corner] = part;
                }
            }
            Some(self.normal_stress(t, l, n))
        };
        [side(pair.edges[0], Some(pair.first)), side(pair.edges[1], pair.second)].map(Option::unwrap_or_default)
    }

    /// n·σ(φ)n of the shape functions of triangle `t` at barycentric coordinates `l`.
    pub fn normal_stress(&self, t: usize, l: [f64; 3], n: [f64; 2]) -> Rows {
        let body = &self.materials[self.problem.mesh.body[t]];
        let row = |d: [f64; 2]| {
            [0, 1].map(|c| {
                let e = if c == 0 { [d[0], 0.0, 0.5 * d[1]] } else { [0.0, d[1], 0.5 * d[0]] };
                let s = body.stress(e);
                n[0] * (s[0] * n[0] + s[2] * n[1]) + n[1] * (s[2] * n[0] + s[1] * n[1])
            })
        };
        self.gradients(t, l).into_iter().map(|(node, d)| (node, row(d))).collect()
    }

    /// The gradients of the shape functions of triangle `t` at barycentric coordinates `l`.
    pub fn gradients(&self, t: usize, l: [f64; 3]) -> Vec<(usize, [f64; 2])> {
        let mesh = &self.problem.mesh;
        let g = gradients(mesh.corners(t));
        let vertices = mesh.points.len();
        if self.candidate.degree == 1 {
            return mesh.triangles[t].into_iter().zip(g).collect();
        }
        let corner = |i: usize| (mesh.triangles[t][i], g[i].map(|x| (4.0 * l[i] - 1.0) * x));
        let middle = |i: usize| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let d = [0, 1].map(|c| 4.0 * (l[j] * g[k][c] + l[k] * g[j][c]));
            (vertices + mesh.triangle_edges[t][i], d)
        };
        (0..3).map(corner).chain((0..3).map(middle)).collect()
    }
}
