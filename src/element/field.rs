//! Stresses on the split triangulation.
//!
//! Every triangle a_0 a_1 a_2 is split at its centroid 0 into three subtriangles; subtriangle i is opposite vertex i
//! and has the corners (a_{i+1}, a_{i+2}, 0). Barycentric coordinates on a subtriangle follow that order.

/// A stress or traction-like field of degree p on every subtriangle.
#[derive(Debug, Clone, PartialEq)]
pub struct StressField {
    degree: usize,
    values: Vec<[f64; 3]>,
}

impl StressField {
    /// A zero field of the given degree on `triangles` triangles.
    pub fn zeros(degree: usize, triangles: usize) -> Self {
        StressField { degree, values: vec![[0.0; 3]; triangles * 3 * lattice_len(degree)] }
    }

    /// Polynomial degree p on each subtriangle.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// Number of triangles.
    pub fn len(&self) -> usize {
        self.values.len() / self.stride()
    }

    /// Whether there are no triangles.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// Values (xx, yy, xy) at the lattice nodes of triangle `t`, subtriangle by subtriangle; for degree 1 the nodes
    /// are the corners (a_{i+1}, a_{i+2}, 0).
    pub fn block(&self, t: usize) -> &[[f64; 3]] {
        &self.values[t * self.stride()..(t + 1) * self.stride()]
    }

    /// Mutable access to [`Self::block`].
    pub fn block_mut(&mut self, t: usize) -> &mut [[f64; 3]] {
        let stride = self.stride();
        &mut self.values[t * stride..(t + 1) * stride]
    }

    /// All blocks, for filling in parallel: chunks of [`Self::stride`].
    pub fn values_mut(&mut self) -> &mut [[f64; 3]] {
        &mut self.values
    }

    /// Values per triangle.
    pub fn stride(&self) -> usize {
        3 * lattice_len(self.degree)
    }

    /// Stress (xx, yy, xy) at barycentric coordinates `bary` of subtriangle `sub` of triangle `t`.
    pub fn at(&self, t: usize, sub: usize, bary: [f64; 3]) -> [f64; 3] {
        let nodes = lattice_len(self.degree);
        let block = &self.block(t)[sub * nodes..(sub + 1) * nodes];
        let mut stress = [0.0; 3];
        for (value, (k, weight)) in block.iter().zip(lattice_shape(self.degree, bary)) {
            debug_assert!(k < nodes);
            for c in 0..3 {
                stress[c] += weight * value[c];
            }
        }
        stress
    }

    /// Mean of the stress over triangle `t`, weighted by area (subtriangles are equal).
    pub fn mean(&self, t: usize) -> [f64; 3] {
        // Exact for degree 1; for higher degree the centroid rule of the lattice would not be, so integrate.
        let mut mean = [0.0; 3];
        for sub in 0..3 {
            for (bary, weight) in crate::element::quadrature::triangle_rule(self.degree) {
                let value = self.at(t, sub, *bary);
                for c in 0..3 {
                    mean[c] += weight * value[c] / 3.0;
                }
            }
        }
        mean
    }
}

/// Number of nodes of the principal lattice of degree p on a triangle.
pub fn lattice_len(degree: usize) -> usize {
    (degree + 1) * (degree + 2) / 2
}

/// Lagrange shape functions of the principal lattice, as (node, value); for degree 1 node k is corner k.
///
/// Nodes are ordered by corners first for degree 1, and lexicographically by (i, j) of p·bary = (i, j, k) otherwise.
fn lattice_shape(degree: usize, bary: [f64; 3]) -> impl Iterator<Item = (usize, f64)> {
    let p = degree;
    let factor = move |n: usize, x: f64| (0..n).map(|m| (p as f64 * x - m as f64) / (n - m) as f64).product::<f64>();
    let mut node = 0;
    (0..=p).rev().flat_map(move |i| (0..=p - i).rev().map(move |j| (i, j))).map(move |(i, j)| {
        let value = factor(i, bary[0]) * factor(j, bary[1]) * factor(p - i - j, bary[2]);
        node += 1;
        (node - 1, value)
    })
}
