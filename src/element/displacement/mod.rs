//! Displacements on the split triangulation, continuous and of any degree.
pub mod bilinear;
pub mod on_quadrilaterals;
pub mod plain;
pub mod quadrilateral;
pub mod strain;

use std::sync::OnceLock;

use super::polynomial::{side, triangle};
use super::{MAX_DEGREE, parts, starts};
use crate::mesh::{Edge, Triangulation};

/// The highest degree of a displacement: one above that of stresses.
pub const MOST: usize = MAX_DEGREE + 1;

/// A displacement, polynomial on every subtriangle, with a degree for each triangle: the space that carries P1, P2 and the
/// free upper bound alike.
///
/// It is stored by its Bernstein coefficients on the three subtriangles of each triangle, those that subtriangles share
/// once ([`SplitNodes`]).
#[derive(Debug, Clone, PartialEq)]
pub struct Displacement {
    degree: Vec<u8>,
    /// Where the coefficients of each triangle begin, and the end of the last.
    start: Vec<usize>,
    values: Vec<[f64; 2]>,
}

impl Displacement {
    /// No displacement, of the given degree on each triangle.
    pub fn zeros(degrees: impl IntoIterator<Item = usize>) -> Self {
        let degree: Vec<u8> = degrees.into_iter().map(|k| k as u8).collect();
        let start = starts(degree.iter().map(|&k| split_len(k.into())));
        let values = vec![[0.0; 2]; start[degree.len()]];
        Displacement { degree, start, values }
    }

    /// From values at vertices, linear on each triangle and stored as a quadratic one.
    pub fn from_p1(mesh: &Triangulation, vertex: &[[f64; 2]]) -> Self {
        let middle = |e: usize| {
            let [a, b] = mesh.edges[e].vertices;
            mean(vertex[a], vertex[b])
        };
        Self::from_p2(mesh, vertex, &(0..mesh.edges.len()).map(middle).collect::<Vec<_>>())
    }

    /// From values at vertices and edge midpoints, quadratic on each triangle.
    pub fn from_p2(mesh: &Triangulation, vertex: &[[f64; 2]], middle: &[[f64; 2]]) -> Self {
        let inner = |(edge, middle): (&Edge, &[f64; 2])| {
            let [a, b] = edge.vertices.map(|v| vertex[v]);
            inner_coefficient(a, *middle, b)
        };
        Self::quadratic(mesh, vertex, &mesh.edges.iter().zip(middle).map(inner).collect::<Vec<_>>())
    }

    /// From values at vertices and the inner Bernstein coefficient of every edge, quadratic on each triangle.
    pub fn quadratic(mesh: &Triangulation, vertex: &[[f64; 2]], inner: &[[f64; 2]]) -> Self {
        let mut field = Self::zeros(std::iter::repeat_n(2, mesh.triangles.len()));
        for t in 0..mesh.triangles.len() {
            let u = mesh.triangles[t].map(|v| vertex[v]);
            let b = mesh.triangle_edges[t].map(|e| inner[e]);
            let (towards, centre) = divided(u, b);
            let [p, q, r] = u;
            let ([a, b, c], [d, e, f]) = (b, towards);
            field.block_mut(t).copy_from_slice(&[p, q, r, a, b, c, centre, d, e, f]);
        }
        field
    }

    /// Number of triangles.
    pub fn len(&self) -> usize {
        self.degree.len()
    }

    /// True if there are no triangles.
    pub fn is_empty(&self) -> bool {
        self.degree.is_empty()
    }

    /// Polynomial degree on triangle `t`.
    pub fn degree(&self, t: usize) -> usize {
        self.degree[t].into()
    }

    /// The coefficients of triangle `t`, in the order of [`SplitNodes`].
    pub fn block(&self, t: usize) -> &[[f64; 2]] {
        &self.values[self.start[t]..self.start[t + 1]]
    }

    /// Mutable access to [`Self::block`].
    pub fn block_mut(&mut self, t: usize) -> &mut [[f64; 2]] {
        &mut self.values[self.start[t]..self.start[t + 1]]
    }

    /// All blocks, to be filled in parallel.
    pub fn blocks_mut(&mut self) -> Vec<&mut [[f64; 2]]> {
        parts(&mut self.values, &self.start)
    }

    /// The Bernstein coefficients of subtriangle `sub` of triangle `t`, in the order of [`triangle::indices`].
    pub fn sub(&self, t: usize, sub: usize) -> impl Iterator<Item = [f64; 2]> {
        let block = self.block(t);
        SplitNodes::of(self.degree(t)).subs[sub].iter().map(|&n| block[n])
    }

    /// The Bernstein coefficients of the side opposite corner `i` of triangle `t`, from corner i + 1 to corner i + 2.
    pub fn side(&self, t: usize, i: usize) -> impl Iterator<Item = [f64; 2]> {
        let block = self.block(t);
        side_nodes(self.degree(t), i).map(|n| block[n])
    }

    /// The value at corner `i` of triangle `t`.
    pub fn corner(&self, t: usize, i: usize) -> [f64; 2] {
        self.block(t)[i]
    }

    /// The value at the centroid of triangle `t`.
    pub fn centre(&self, t: usize) -> [f64; 2] {
        self.block(t)[3 * self.degree(t)]
    }

    /// The value at the point of triangle `t` with barycentric coordinates `l`.
    pub fn at(&self, t: usize, l: [f64; 3]) -> [f64; 2] {
        // The subtriangle opposite the corner that is farthest away.
        let sub = (0..3).fold(0, |least, i| if l[i] < l[least] { i } else { least });
        let (j, k) = ((sub + 1) % 3, (sub + 2) % 3);
        self.in_sub(t, sub, [l[j] - l[sub], l[k] - l[sub], 3.0 * l[sub]])
    }

    /// The value at the point of subtriangle `sub` of triangle `t` with barycentric coordinates `l` in it.
    pub fn in_sub(&self, t: usize, sub: usize, l: [f64; 3]) -> [f64; 2] {
        let mut value = [0.0; 2];
        for (u, weight) in self.sub(t, sub).zip(triangle::basis(self.degree(t), l)) {
            value = [value[0] + weight * u[0], value[1] + weight * u[1]];
        }
        value
    }

    /// No displacement on triangle `t` is larger: √2 times the largest component of its coefficients.
    pub fn largest(&self, t: usize) -> f64 {
        let component = |v: &[f64; 2]| v[0].abs().max(v[1].abs());
        std::f64::consts::SQRT_2 * self.block(t).iter().map(component).fold(0.0, f64::max)
    }
}

/// De Casteljau's steps from a quadratic on a triangle, with the values `u` at the corners and the inner coefficients `b` of
/// the sides opposite them, to the centroid: the inner coefficients of the segments from the corners, and the value there.
pub fn divided(u: [[f64; 2]; 3], b: [[f64; 2]; 3]) -> ([[f64; 2]; 3], [f64; 2]) {
    let third = |p: [f64; 2], q: [f64; 2], r: [f64; 2]| [0, 1].map(|c| (p[c] + q[c] + r[c]) / 3.0);
    let towards = [0, 1, 2].map(|i: usize| third(u[i], b[(i + 1) % 3], b[(i + 2) % 3]));
    (towards, third(towards[0], towards[1], towards[2]))
}

/// The inner Bernstein coefficient of the quadratic with these values at the ends and in the middle.
pub fn inner_coefficient(a: [f64; 2], middle: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [0, 1].map(|c| 2.0 * middle[c] - 0.5 * (a[c] + b[c]))
}

/// Number of coefficients of degree k on a split triangle.
pub const fn split_len(k: usize) -> usize {
    (3 * k * k + 3 * k + 2) / 2
}

/// The nodes of the side opposite corner `i` in degree k, from corner i + 1 to corner i + 2.
pub fn side_nodes(k: usize, i: usize) -> impl Iterator<Item = usize> {
    let inner = 3 + i * (k - 1);
    std::iter::once((i + 1) % 3).chain(inner..inner + k - 1).chain(std::iter::once((i + 2) % 3))
}

/// How the coefficients of degree k on a split triangle are numbered.
///
/// First the boundary: the three corners, then for i = 0, 1, 2 the k − 1 inside the side opposite corner i, from corner
/// i + 1 to corner i + 2. Then the inside: the centroid, for i = 0, 1, 2 the k − 1 inside the segment from corner i to the
/// centroid, and those inside each subtriangle in the order of [`triangle::indices`].
#[derive(Debug)]
pub struct SplitNodes {
    /// The node of every coefficient of each subtriangle.
    pub subs: [Vec<usize>; 3],
}

impl SplitNodes {
    /// The numbering of degree k from 1 to [`MOST`].
    pub fn of(k: usize) -> &'static SplitNodes {
        static KNOWN: [OnceLock<SplitNodes>; MOST + 1] = [const { OnceLock::new() }; MOST + 1];
        KNOWN[k].get_or_init(|| SplitNodes { subs: [0, 1, 2].map(|sub| sub_nodes(k, sub)) })
    }
}

/// The nodes of subtriangle `sub`, whose corners are those after and before corner `sub`, and the centroid.
fn sub_nodes(k: usize, sub: usize) -> Vec<usize> {
    let (first, second) = ((sub + 1) % 3, (sub + 2) % 3);
    let centre = 3 * k;
    let segment = |corner: usize, steps: usize| centre + 1 + corner * (k - 1) + steps - 1;
    let mut inside = centre + 1 + 3 * (k - 1) + sub * ((k - 1) * k / 2 - (k - 1));
    let mut node = |alpha: triangle::Index| match alpha {
        [i, 0, 0] if i == k => first,
        [0, j, 0] if j == k => second,
        [0, 0, l] if l == k => centre,
        [_, j, 0] => 3 + sub * (k - 1) + j - 1,
        [_, 0, l] => segment(first, l),
        [0, _, l] => segment(second, l),
        _ => {
            inside += 1;
            inside - 1
        }
    };
    triangle::indices(k).map(&mut node).collect()
}

/// The Bernstein coefficients of degree k of the polynomial that takes the given k + 1 values at equal steps along a side.
pub fn through(values: &[[f64; 2]]) -> Vec<[f64; 2]> {
    use nalgebra::DMatrix;
    static KNOWN: [OnceLock<DMatrix<f64>>; MOST + 1] = [const { OnceLock::new() }; MOST + 1];
    let k = values.len() - 1;
    let inverse = KNOWN[k].get_or_init(|| {
        let at = |i: usize| if k == 0 { 0.5 } else { i as f64 / k as f64 };
        let matrix = DMatrix::from_fn(k + 1, k + 1, |i, j| side::bernstein(k, j, at(i)));
        matrix.try_inverse().unwrap_or_else(|| DMatrix::identity(k + 1, k + 1))
    });
    // About the first value: what all have in common costs no digits.
    let base = values[0];
    let row =
        |i: usize| [0, 1].map(|c| base[c] + (0..=k).map(|j| inverse[(i, j)] * (values[j][c] - base[c])).sum::<f64>());
    (0..=k).map(row).collect()
}

fn mean(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_node_belongs_to_a_subtriangle_and_shared_ones_to_two() {
        for k in 1..=MOST {
            let mut count = vec![0; split_len(k)];
            SplitNodes::of(k).subs.iter().flatten().for_each(|&n| count[n] += 1);
            assert!(count[..3].iter().all(|c| *c == 2), "corners");
            assert!(count[3..3 * k].iter().all(|c| *c == 1), "sides");
            assert_eq!(count[3 * k], 3, "the centroid");
            assert!(count[3 * k + 1..][..3 * (k - 1)].iter().all(|c| *c == 2), "segments");
            assert!(count[3 * k + 1 + 3 * (k - 1)..].iter().all(|c| *c == 1), "inside");
        }
    }

    #[test]
    fn subtriangles_meet_along_their_segments() {
        for k in 1..=MOST {
            let mut field = Displacement::zeros([k]);
            for (n, value) in field.block_mut(0).iter_mut().enumerate() {
                *value = [(7 * n + 1) as f64 % 5.0, (n * n) as f64 % 7.0];
            }
            // Along the segment from corner 0 to the centroid, from either side.
            for s in [0.2, 0.7] {
                let on = |sub: usize, l: [f64; 3]| {
                    let weights = triangle::basis(k, l);
                    field.sub(0, sub).zip(weights).fold(0.0, |sum, (u, w)| sum + w * u[0])
                };
                assert!((on(1, [0.0, 1.0 - s, s]) - on(2, [1.0 - s, 0.0, s])).abs() < 1e-13);
                let side: f64 = field.side(0, 1).zip(0..).map(|(u, j)| u[0] * side::bernstein(k, j, s)).sum();
                assert!((side - on(1, [1.0 - s, s, 0.0])).abs() < 1e-13);
                assert!((side - field.at(0, [s, 0.0, 1.0 - s])[0]).abs() < 1e-13);
            }
        }
    }

    #[test]
    fn a_polynomial_comes_back_from_its_values() {
        for k in 1..=MOST {
            let c: Vec<f64> = (0..=k).map(|j| ((3 * j + 1) as f64).sin()).collect();
            let values: Vec<[f64; 2]> = (0..=k).map(|i| [side::value(&c, i as f64 / k as f64), 1.0]).collect();
            for (found, c) in through(&values).into_iter().zip(&c) {
                assert!((found[0] - c).abs() < 1e-11 && (found[1] - 1.0).abs() < 1e-11);
            }
        }
    }
}
