//! The boundary of a triangle in terms of unknowns.
//!
//! A triangle has on each side the coefficients of its traction (see [`crate::element::Modes`]), x and y of one after the
//! other, raised to the degree of the edge where its neighbour has a larger one. An edge has an order and a normal of its
//! own, and its second triangle runs along it the other way round.

use super::unknowns::{Component, EdgeMoments, Unknowns};
use crate::element::polynomial::side;
use crate::mesh::Triangulation;

/// The sides of a triangle with the degrees of their edges.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sides {
    /// Degree of the triangle.
    pub degree: usize,
    /// The edges.
    pub edges: [usize; 3],
    /// Their degrees.
    pub degrees: [usize; 3],
    /// True if the triangle runs along them the other way round.
    flipped: [bool; 3],
    /// Where the coefficients of each side begin, and the end of them all.
    pub start: [usize; 4],
}

impl Sides {
    /// The sides of triangle `t`, itself of the given degree.
    pub fn new(mesh: &Triangulation, unknowns: &Unknowns, t: usize, degree: usize) -> Self {
        let edges = mesh.triangle_edges[t];
        let degrees = edges.map(|e| unknowns.degree(e));
        let flipped = edges.map(|e| mesh.edges[e].triangles[0] != Some(t));
        let mut start = [0; 4];
        (0..3).for_each(|i| start[i + 1] = start[i] + 2 * (degrees[i] + 1));
        Sides { degree, edges, degrees, flipped, start }
    }

    /// Number of coefficients, x and y counted.
    pub fn len(&self) -> usize {
        self.start[3]
    }

    /// True if all sides have the degree of the triangle.
    pub fn are_even(&self) -> bool {
        self.degrees == [self.degree; 3]
    }

    /// Place of the x value of coefficient `k`, in the order of the edge, on side `side`; y follows.
    pub fn at(&self, side: usize, k: usize) -> usize {
        let k = if self.flipped[side] { self.degrees[side] - k } else { k };
        self.start[side] + 2 * k
    }

    /// The coefficients `own` of the degree of the triangle, raised to the degrees of its edges.
    pub fn raise(&self, own: &[f64], out: &mut [f64]) {
        let p = self.degree;
        for (i, own) in own.chunks_exact(2 * (p + 1)).enumerate() {
            let q = self.degrees[i];
            let out = &mut out[self.start[i]..self.start[i + 1]];
            if p == q {
                out.copy_from_slice(own);
                continue;
            }
            let rows = side::elevation_matrix(p, q).chunks_exact(p + 1);
            for (out, row) in out.chunks_exact_mut(2).zip(rows) {
                for c in 0..2 {
                    out[c] = row.iter().zip(own.chunks_exact(2)).map(|(e, t)| e * t[c]).sum();
                }
            }
        }
    }

    /// Moments `own` of the degrees of the edges, lowered to those of the triangle: the transpose of [`Self::raise`].
    pub fn lower(&self, own: &[f64], out: &mut [f64]) {
        let p = self.degree;
        for (i, out) in out.chunks_exact_mut(2 * (p + 1)).enumerate() {
            let q = self.degrees[i];
            let own = &own[self.start[i]..self.start[i + 1]];
            if p == q {
                out.copy_from_slice(own);
                continue;
            }
            out.fill(0.0);
            for (own, row) in own.chunks_exact(2).zip(side::elevation_matrix(p, q).chunks_exact(p + 1)) {
                for (out, e) in out.chunks_exact_mut(2).zip(row) {
                    (0..2).for_each(|c| out[c] += e * own[c]);
                }
            }
        }
    }

    /// The coefficients of all sides with the components that their moments, and so their tractions, are taken in.
    pub fn rows<'a>(&self, unknowns: &'a Unknowns) -> impl Iterator<Item = (usize, [Component; 2])> + use<'a> {
        let sides = *self;
        (0..3).flat_map(move |i| {
            let e = sides.edges[i];
            (0..=sides.degrees[i]).map(move |k| (sides.at(i, k), unknowns.components(e, k)))
        })
    }

    /// The first unknown of each side, if all moments of all sides are unknowns, as they are for most triangles.
    pub fn free(&self, unknowns: &Unknowns) -> Option<[usize; 3]> {
        let mut first = [0; 3];
        for (first, e) in first.iter_mut().zip(self.edges) {
            let EdgeMoments::Free(own) = &unknowns.edges[e] else { return None };
            *first = *own;
        }
        Some(first)
    }
}
