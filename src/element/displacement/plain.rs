//! Displacements that are one polynomial on each triangle, as displacement models have them.

use std::sync::OnceLock;

use nalgebra::DMatrix;

use super::{MOST, SplitNodes};
use crate::element::Displacement;
use crate::element::displacement;
use crate::element::polynomial::triangle;
use crate::mesh::Triangulation;

/// A continuous displacement of degree k by its Bernstein coefficients.
#[derive(Debug, Clone, PartialEq)]
pub struct PlainDisplacement {
    degree: usize,
    /// At the vertices, then the k − 1 inside each edge from its first vertex to its second, then the (k − 1)(k − 2)/2
    /// inside each triangle in the order of [`triangle::indices`].
    values: Vec<[f64; 2]>,
    /// One past the last of the vertices, and of the edges.
    ends: [usize; 2],
}

/// Number of coefficients inside a triangle.
pub const fn inner_len(k: usize) -> usize {
    if k < 3 { 0 } else { (k - 1) * (k - 2) / 2 }
}

/// The numbers of the coefficients of triangle `t`, in the order of [`triangle::indices`].
pub fn nodes(mesh: &Triangulation, k: usize, t: usize) -> Vec<usize> {
    let (corners, edges) = (mesh.triangles[t], mesh.triangle_edges[t]);
    let start = mesh.points.len();
    let mut inside = start + (k - 1) * mesh.edges.len() + inner_len(k) * t;
    let mut number = |alpha: triangle::Index| {
        if let Some(i) = (0..3).find(|&i| alpha[i] == k) {
            return corners[i];
        }
        let Some(i) = (0..3).find(|&i| alpha[i] == 0) else {
            inside += 1;
            return inside - 1;
        };
        // On the side opposite corner i, so many steps from corner i + 1.
        let steps = alpha[(i + 2) % 3];
        let forward = mesh.edges[edges[i]].vertices[0] == corners[(i + 1) % 3];
        start + (k - 1) * edges[i] + if forward { steps } else { k - steps } - 1
    };
    triangle::indices(k).map(&mut number).collect()
}

impl PlainDisplacement {
    /// The displacement of degree `k`, from 1 to [`MOST`], with the given values at equal steps: at vertices, inside edges and
    /// inside triangles, numbered as the coefficients are.
    ///
    /// `None` where their numbers are not those of the mesh.
    pub fn from_values(
        mesh: &Triangulation,
        k: usize,
        vertex: &[[f64; 2]],
        edge: &[[f64; 2]],
        inside: &[[f64; 2]],
    ) -> Option<Self> {
        let wanted = [mesh.points.len(), (k - 1) * mesh.edges.len(), inner_len(k) * mesh.triangles.len()];
        if [vertex.len(), edge.len(), inside.len()] != wanted {
            return None;
        }
        let given = [vertex, edge, inside].concat();
        let mut values = given.clone();
        let ends = [wanted[0], wanted[0] + wanted[1]];
        for (e, inner) in mesh.edges.iter().zip(values[ends[0]..ends[1]].chunks_mut((k - 1).max(1))) {
            let [a, b] = e.vertices.map(|v| vertex[v]);
            let along: Vec<[f64; 2]> = [&[a], &*inner, &[b]].concat();
            inner.copy_from_slice(&displacement::through(&along)[1..k]);
        }
        if k > 2 {
            let inverse = from_lattice(k);
            for t in 0..mesh.triangles.len() {
                let own = nodes(mesh, k, t);
                // About the value at the first corner: what all have in common costs no digits.
                let base = given[own[0]];
                for (i, alpha) in triangle::indices(k).enumerate().filter(|(_, alpha)| !alpha.contains(&0)) {
                    debug_assert_eq!(triangle::number(alpha), i);
                    values[own[i]] = [0, 1].map(|c| {
                        let parts = own.iter().enumerate().map(|(j, &n)| inverse[(i, j)] * (given[n][c] - base[c]));
                        base[c] + parts.sum::<f64>()
                    });
                }
            }
        }
        Some(PlainDisplacement { degree: k, values, ends })
    }

    /// This displacement with other boundary values: those at vertices, then the coefficients inside edges.
    pub fn with_boundary(mut self, boundary: &[[f64; 2]]) -> Self {
        self.values[..boundary.len()].copy_from_slice(boundary);
        self
    }

    /// k.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// All coefficients.
    pub fn values(&self) -> &[[f64; 2]] {
        &self.values
    }

    /// Those at vertices and inside edges.
    pub fn boundary(&self) -> &[[f64; 2]] {
        &self.values[..self.ends[1]]
    }

    /// The coefficients of triangle `t`, in the order of [`triangle::indices`].
    pub fn triangle(&self, mesh: &Triangulation, t: usize) -> Vec<[f64; 2]> {
        nodes(mesh, self.degree, t).into_iter().map(|n| self.values[n]).collect()
    }

    /// The values at the midpoints of the edges.
    pub fn middles(&self, mesh: &Triangulation) -> Vec<[f64; 2]> {
        let k = self.degree;
        let weights: Vec<f64> = (0..=k).map(|j| crate::element::polynomial::side::bernstein(k, j, 0.5)).collect();
        let middle = |(e, edge): (usize, &crate::mesh::Edge)| {
            let [a, b] = edge.vertices.map(|v| self.values[v]);
            let from = self.ends[0] + e * (k - 1);
            let along = std::iter::once(&a).chain(&self.values[from..from + k - 1]).chain(std::iter::once(&b));
            along.zip(&weights).fold([0.0; 2], |sum, (u, w)| [sum[0] + w * u[0], sum[1] + w * u[1]])
        };
        mesh.edges.iter().enumerate().map(middle).collect()
    }

    /// This displacement on the split triangulation, by de Casteljau's steps to the centroids.
    pub fn split(&self, mesh: &Triangulation) -> Displacement {
        let k = self.degree;
        let mut field = Displacement::zeros(std::iter::repeat_n(k, mesh.triangles.len()));
        for (t, block) in field.blocks_mut().into_iter().enumerate() {
            // steps[l]: the coefficients of degree k − l after l steps.
            let mut steps = vec![self.triangle(mesh, t)];
            for l in 0..k {
                let last = &steps[l];
                let mean = |alpha: triangle::Index| {
                    let parts = [0, 1, 2].map(|i| last[triangle::number(triangle::raised(alpha, i))]);
                    [0, 1].map(|c| (parts[0][c] + parts[1][c] + parts[2][c]) / 3.0)
                };
                let next = triangle::indices(k - l - 1).map(mean).collect();
                steps.push(next);
            }
            for (sub, nodes) in SplitNodes::of(k).subs.iter().enumerate() {
                for (&node, [i, j, l]) in nodes.iter().zip(triangle::indices(k)) {
                    let mut alpha = [0; 3];
                    (alpha[(sub + 1) % 3], alpha[(sub + 2) % 3]) = (i, j);
                    block[node] = steps[l][triangle::number(alpha)];
                }
            }
        }
        field
    }
}

/// From values at equal steps on a triangle to coefficients.
fn from_lattice(k: usize) -> &'static DMatrix<f64> {
    static KNOWN: [OnceLock<DMatrix<f64>>; MOST + 1] = [const { OnceLock::new() }; MOST + 1];
    KNOWN[k].get_or_init(|| {
        let rows: Vec<f64> = triangle::indices(k)
            .flat_map(|at| triangle::basis(k, at.map(|i| i as f64 / k as f64)).collect::<Vec<_>>())
            .collect();
        let size = triangle::len(k);
        DMatrix::from_row_slice(size, size, &rows).try_inverse().unwrap_or_else(|| DMatrix::identity(size, size))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::primal::fixture::pressed_square;

    /// A polynomial of degree k in no special position.
    fn exact(k: usize, [x, y]: [f64; 2]) -> [f64; 2] {
        let n = k as i32;
        [(0.3 + x - 0.7 * y).powi(n) + 2.0, (x + 0.4 * y).powi(n) - (0.2 - y).powi(n - 1)]
    }

    fn sampled(mesh: &Triangulation, k: usize) -> PlainDisplacement {
        let between = |points: &[[f64; 2]], weights: &[usize]| {
            let at = |c: usize| points.iter().zip(weights).map(|(p, w)| *w as f64 / k as f64 * p[c]).sum();
            exact(k, [at(0), at(1)])
        };
        let vertex: Vec<_> = mesh.points.iter().map(|p| exact(k, *p)).collect();
        let along = |e: &crate::mesh::Edge| {
            let ends = e.vertices.map(|v| mesh.points[v]);
            (1..k).map(move |i| between(&ends, &[k - i, i])).collect::<Vec<_>>()
        };
        let edge: Vec<_> = mesh.edges.iter().flat_map(along).collect();
        let within = |t: usize| {
            let inner = triangle::indices(k).filter(|alpha| !alpha.contains(&0));
            inner.map(move |alpha| between(&mesh.corners(t), &alpha)).collect::<Vec<_>>()
        };
        let inside: Vec<_> = (0..mesh.triangles.len()).flat_map(within).collect();
        PlainDisplacement::from_values(mesh, k, &vertex, &edge, &inside).expect("as many values as nodes")
    }

    #[test]
    fn a_polynomial_is_the_same_everywhere() {
        let mesh = pressed_square().mesh;
        for k in 1..=MOST {
            let plain = sampled(&mesh, k);
            let split = plain.split(&mesh);
            for t in 0..mesh.triangles.len() {
                for l in [[0.2, 0.3, 0.5], [0.7, 0.05, 0.25], [0.0, 0.6, 0.4], [1.0, 0.0, 0.0]] {
                    let corners = mesh.corners(t);
                    let at = [0, 1].map(|c| (0..3).map(|i| l[i] * corners[i][c]).sum());
                    let (found, exact) = (split.at(t, l), exact(k, at));
                    let off = (found[0] - exact[0]).hypot(found[1] - exact[1]);
                    assert!(off < 1e-12, "degree {k}: {found:?} is not {exact:?}");
                }
            }
            for (edge, middle) in mesh.edges.iter().zip(plain.middles(&mesh)) {
                let [a, b] = edge.vertices.map(|v| mesh.points[v]);
                let exact = exact(k, [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]);
                assert!((middle[0] - exact[0]).hypot(middle[1] - exact[1]) < 1e-12);
            }
        }
    }

    #[test]
    fn values_of_another_mesh_are_refused() {
        let mesh = pressed_square().mesh;
        let [vertex, edge] = [mesh.points.len(), 2 * mesh.edges.len()].map(|n| vec![[0.0; 2]; n]);
        assert!(PlainDisplacement::from_values(&mesh, 3, &vertex, &edge, &[[0.0; 2]; 2]).is_some());
        assert!(PlainDisplacement::from_values(&mesh, 3, &vertex, &edge, &[[0.0; 2]; 1]).is_none());
        assert!(PlainDisplacement::from_values(&mesh, 2, &vertex, &edge, &[]).is_none());
    }
}
