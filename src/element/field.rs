//! Stresses on the split triangulation.
//!
//! Every triangle a_0 a_1 a_2 is split at its centroid 0 into three subtriangles; subtriangle i is opposite vertex i
//! and has the corners (a_{i+1}, a_{i+2}, 0). Barycentric coordinates on a subtriangle follow that order.

use std::borrow::Cow;
use std::sync::OnceLock;

use nalgebra::DMatrix;

use super::polynomial::samples::Samples;
use super::polynomial::side;
use super::polynomial::side_values::{parts, starts};
use super::polynomial::triangle;

/// A stress, on each triangle of a degree of its own on every subtriangle.
#[derive(Debug, Clone, PartialEq)]
pub struct StressField {
    degree: Vec<u8>,
    /// First value of each triangle, and the end.
    start: Vec<usize>,
    values: Vec<[f64; 3]>,
}

impl StressField {
    /// A zero field of the given degree on `triangles` triangles.
    pub fn zeros(degree: usize, triangles: usize) -> Self {
        Self::of_degrees(std::iter::repeat_n(degree, triangles))
    }

    /// A zero field with a degree for each triangle.
    pub fn of_degrees(degrees: impl IntoIterator<Item = usize>) -> Self {
        let degree: Vec<u8> = degrees.into_iter().map(|p| p as u8).collect();
        let start = starts(degree.iter().map(|&p| 3 * lattice_len(p.into())));
        let values = vec![[0.0; 3]; start[degree.len()]];
        StressField { degree, start, values }
    }

    /// Polynomial degree p on each subtriangle of triangle `t`.
    pub fn degree(&self, t: usize) -> usize {
        self.degree[t].into()
    }

    /// The largest degree; zero where there are no triangles.
    pub fn largest_degree(&self) -> usize {
        self.degree.iter().copied().max().unwrap_or(0).into()
    }

    /// Number of triangles.
    pub fn len(&self) -> usize {
        self.degree.len()
    }

    /// True if there are no triangles.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// Values (xx, yy, xy) at the lattice nodes of triangle `t`, subtriangle by subtriangle; for degree 1 the nodes
    /// are the corners (a_{i+1}, a_{i+2}, 0).
    pub fn block(&self, t: usize) -> &[[f64; 3]] {
        &self.values[self.start[t]..self.start[t + 1]]
    }

    /// Mutable access to [`Self::block`].
    pub fn block_mut(&mut self, t: usize) -> &mut [[f64; 3]] {
        &mut self.values[self.start[t]..self.start[t + 1]]
    }

    /// The blocks of all triangles, for filling in parallel.
    pub fn blocks_mut(&mut self) -> Vec<&mut [[f64; 3]]> {
        parts(&mut self.values, &self.start)
    }

    /// All values, triangle by triangle.
    pub fn values(&self) -> &[[f64; 3]] {
        &self.values
    }

    /// The first value of each triangle, and the number of all.
    pub fn starts(&self) -> &[usize] {
        &self.start
    }

    /// All values, triangle by triangle, to change.
    pub fn values_mut(&mut self) -> &mut [[f64; 3]] {
        &mut self.values
    }

    /// Stress (xx, yy, xy) at barycentric coordinates `bary` of subtriangle `sub` of triangle `t`.
    pub fn at(&self, t: usize, sub: usize, bary: [f64; 3]) -> [f64; 3] {
        let degree = self.degree(t);
        let nodes = lattice_len(degree);
        let block = &self.block(t)[sub * nodes..(sub + 1) * nodes];
        match degree {
            // The shape functions of degree 1 are the coordinates themselves.
            1 => weighed(block, bary),
            _ => weighed(block, lattice_shape(degree, bary)),
        }
    }

    /// The functions that nodal values of one subtriangle are multiplied with, at barycentric coordinates `bary` of it.
    pub fn shapes(degree: usize, bary: [f64; 3]) -> Vec<f64> {
        match degree {
            1 => bary.to_vec(),
            _ => lattice_shape(degree, bary).collect(),
        }
    }

    /// The values of [`Self::block`] for a degree that is no lower.
    pub fn in_degree(&self, t: usize, degree: usize) -> Cow<'_, [[f64; 3]]> {
        if degree == self.degree(t) {
            return Cow::Borrowed(self.block(t));
        }
        let points = || triangle::indices(degree).map(|i| i.map(|i| i as f64 / degree as f64));
        Cow::Owned((0..3).flat_map(|sub| points().map(move |l| self.at(t, sub, l))).collect())
    }

    /// Stress at point `q` of `shapes`, those of the degree on triangle `t` ([`Samples::of_stress`]), in subtriangle `sub`.
    pub fn sample(&self, t: usize, sub: usize, shapes: &Samples, q: usize) -> [f64; 3] {
        let weights = shapes.basis(q);
        weighed(&self.block(t)[sub * weights.len()..], weights.iter().copied())
    }

    /// Mean of the stress over triangle `t`, weighted by area (subtriangles are equal).
    pub fn mean(&self, t: usize) -> [f64; 3] {
        // Exact for degree 1; for higher degree the centroid rule of the lattice would not be, so integrate.
        let mut mean = [0.0; 3];
        for sub in 0..3 {
            for (bary, weight) in super::polynomial::quadrature::triangle_rule(self.degree(t)) {
                let value = self.at(t, sub, *bary);
                for c in 0..3 {
                    mean[c] += weight * value[c] / 3.0;
                }
            }
        }
        mean
    }

    /// Values (xx, yy, xy) on side `side` of triangle `t` as Bernstein coefficients of the degree there, from corner
    /// side + 1 to corner side + 2.
    pub fn on_side(&self, t: usize, side: usize) -> impl Iterator<Item = [f64; 3]> + use<'_> {
        let degree = self.degree(t);
        let nodes = &self.block(t)[side * lattice_len(degree)..][..lattice_len(degree)];
        to_bernstein(degree, move |j| nodes[triangle::number([degree - j, j, 0])])
    }

    /// By how much the values (xx, yy, xy) on the two subtriangles beside the segment from corner `corner` of triangle `t` to its centroid
    /// differ, as Bernstein coefficients of the degree there.
    pub fn jump_inside(&self, t: usize, corner: usize) -> impl Iterator<Item = [f64; 3]> + use<'_> {
        let degree = self.degree(t);
        let nodes = |sub: usize| &self.block(t)[sub * lattice_len(degree)..][..lattice_len(degree)];
        // The second side of one, and the third of the other.
        let (one, other) = (nodes((corner + 1) % 3), nodes((corner + 2) % 3));
        to_bernstein(degree, move |j| {
            let a = one[triangle::number([0, degree - j, j])];
            let b = other[triangle::number([degree - j, 0, j])];
            [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
        })
    }
}

/// Bernstein coefficients of the polynomial that has these values at equally spaced points.
pub(super) fn to_bernstein<'a>(
    degree: usize,
    at: impl Fn(usize) -> [f64; 3] + 'a,
) -> impl Iterator<Item = [f64; 3]> + 'a {
    let matrix = from_equispaced(degree);
    (0..=degree).map(move |k| {
        let mut value = [0.0; 3];
        for j in 0..=degree {
            let weight = matrix[k * (degree + 1) + j];
            let own = at(j);
            (0..3).for_each(|c| value[c] += weight * own[c]);
        }
        value
    })
}

/// The matrix that gives Bernstein coefficients of degree p, row by row, from values at p + 1 equally spaced points.
pub(super) fn from_equispaced(p: usize) -> &'static [f64] {
    static MATRICES: [OnceLock<Vec<f64>>; 16] = [const { OnceLock::new() }; 16];
    MATRICES[p].get_or_init(|| {
        let at = |j: usize| if p == 0 { 0.5 } else { j as f64 / p as f64 };
        let values = DMatrix::from_fn(p + 1, p + 1, |j, k| side::bernstein(p, k, at(j)));
        // Regular, the points being different.
        let inverse = values.try_inverse().unwrap_or_else(|| DMatrix::identity(p + 1, p + 1));
        inverse.transpose().as_slice().to_vec()
    })
}

/// Number of nodes of the principal lattice of degree p on a triangle.
pub fn lattice_len(degree: usize) -> usize {
    (degree + 1) * (degree + 2) / 2
}

/// Barycentric coordinates of the nodes of the principal lattice of degree p, in the order of [`StressField`]: row by row away
/// from the first corner.
pub fn lattice(p: usize) -> impl Iterator<Item = [f64; 3]> {
    let node = move |i: usize, j: usize| [i, j, p - i - j].map(|n| n as f64 / p as f64);
    (0..=p).rev().flat_map(move |i| (0..=p - i).rev().map(move |j| node(i, j)))
}

/// Lagrange shape functions of the principal lattice, node by node; for degree 1 node k is corner k.
///
/// Nodes are ordered by corners first for degree 1, and lexicographically by (i, j) of p·bary = (i, j, k) otherwise.
pub(super) fn lattice_shape(degree: usize, bary: [f64; 3]) -> impl Iterator<Item = f64> {
    let p = degree;
    let factor = move |n: usize, x: f64| (0..n).map(|m| (p as f64 * x - m as f64) / (n - m) as f64).product::<f64>();
    (0..=p)
        .rev()
        .flat_map(move |i| (0..=p - i).rev().map(move |j| (i, j)))
        .map(move |(i, j)| factor(i, bary[0]) * factor(j, bary[1]) * factor(p - i - j, bary[2]))
}

/// a : b of symmetric tensors (xx, yy, xy).
pub fn contraction(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + 2.0 * a[2] * b[2]
}

/// The sum of values times weights.
pub fn weighed(values: &[[f64; 3]], weights: impl IntoIterator<Item = f64>) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for (value, weight) in values.iter().zip(weights) {
        (0..3).for_each(|c| sum[c] += weight * value[c]);
    }
    sum
}
