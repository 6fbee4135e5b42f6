//! Displacements of degree k in each coordinate of a square that is mapped onto quadrilaterals, as finite element programs have
//! them: Q1 and Q2.
//!
//! Their nodes are those of degree k on the triangles, with the node in the middle of a quadrilateral in the place of that in the
//! middle of its diagonal. On a parallelogram such a displacement is a polynomial of degree 2k on both halves; on others it is
//! one along each side and none inside.

use super::bilinear::{self, Bilinear};
use super::plain::{PlainDisplacement, inner_len};
use crate::element::polynomial::triangle;
use crate::mesh::{Quadrilateral, Triangulation};

/// The highest degree k.
pub const HIGHEST: usize = 2;

/// A continuous displacement of degree 1 or 2 in each coordinate.
#[derive(Debug, Clone, PartialEq)]
pub struct OnQuadrilaterals {
    degree: usize,
    values: Vec<[f64; 2]>,
    is_polynomial: bool,
}

/// The nodes of a quadrilateral, row by row: vertices and, of degree 2, edges after them.
pub fn nodes(mesh: &Triangulation, k: usize, cell: &Quadrilateral) -> Vec<usize> {
    let [a, b, c, d] = cell.corners;
    match k {
        2 => {
            let [bottom, right, top, left] = cell.sides.map(|e| mesh.points.len() + e);
            vec![a, bottom, b, left, mesh.points.len() + cell.diagonal, right, d, top, c]
        }
        _ => vec![a, b, d, c],
    }
}

impl OnQuadrilaterals {
    /// The displacement with these values at vertices and, of degree 2, in the middle of sides and quadrilaterals (in the place of
    /// the edges that are their diagonals).
    ///
    /// `None` for other degrees, where the mesh has other cells than convex quadrilaterals, or where the number of values is
    /// another.
    pub fn new(mesh: &Triangulation, degree: usize, values: Vec<[f64; 2]>) -> Option<Self> {
        let count = mesh.points.len() + if degree == 2 { mesh.edges.len() } else { 0 };
        let fits = (1..=HIGHEST).contains(&degree) && values.len() == count && can_carry(mesh);
        let is_polynomial = mesh.quadrilaterals().all(|cell| cell.is_parallelogram(mesh));
        fits.then_some(OnQuadrilaterals { degree, values, is_polynomial })
    }

    /// k.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// The values at the nodes.
    pub fn values(&self) -> &[[f64; 2]] {
        &self.values
    }

    /// True if all quadrilaterals are parallelograms, so that [`Self::on_triangles`] represents the displacement exactly.
    pub fn is_polynomial(&self) -> bool {
        self.is_polynomial
    }

    /// The displacement of degree 2k on the triangles that has the same values at equal steps. On sides of quadrilaterals they
    /// agree; inside only on parallelograms.
    pub fn on_triangles(&self, mesh: &Triangulation) -> Option<PlainDisplacement> {
        let (k, vertices) = (self.degree, mesh.points.len());
        let m = 2 * k;
        let mut along = vec![[0.0; 2]; (m - 1) * mesh.edges.len()];
        for (e, edge) in mesh.edges.iter().enumerate() {
            let [a, b] = edge.vertices.map(|v| self.values[v]);
            let middle = (k == 2).then(|| self.values[vertices + e]);
            for j in 1..m {
                let weights = bilinear::line(k, j as f64 / m as f64).0;
                let nodes = std::iter::once(a).chain(middle).chain([b]);
                along[(m - 1) * e + j - 1] = weighed(&weights, nodes);
            }
        }
        let mut inside = vec![[0.0; 2]; inner_len(m) * mesh.triangles.len()];
        for cell in mesh.quadrilaterals() {
            let map = Bilinear::new(cell.points(mesh));
            let own: Vec<[f64; 2]> = nodes(mesh, k, &cell).into_iter().map(|n| self.values[n]).collect();
            let at = |p: [f64; 2]| weighed(&bilinear::values(k, map.inverse(p)), own.iter().copied());
            let [a, b] = mesh.edges[cell.diagonal].vertices.map(|v| mesh.points[v]);
            for j in 1..m {
                let s = j as f64 / m as f64;
                along[(m - 1) * cell.diagonal + j - 1] = at([0, 1].map(|c| (1.0 - s) * a[c] + s * b[c]));
            }
            for t in cell.triangles {
                let corners = mesh.corners(t);
                let inner = triangle::indices(m).filter(|alpha| !alpha.contains(&0));
                for (i, alpha) in inner.enumerate() {
                    let weights = alpha.map(|n| n as f64 / m as f64);
                    inside[inner_len(m) * t + i] = at(weighed(&weights, corners.into_iter()));
                }
            }
        }
        PlainDisplacement::from_values(mesh, m, &self.values[..vertices], &along, &inside)
    }
}

/// True if all cells of the file are quadrilaterals onto which a square can be mapped.
pub fn can_carry(mesh: &Triangulation) -> bool {
    mesh.is_quadrilateral() && mesh.quadrilaterals().all(|cell| cell.is_convex(mesh))
}

fn weighed(weights: &[f64], values: impl Iterator<Item = [f64; 2]>) -> [f64; 2] {
    weights.iter().zip(values).fold([0.0; 2], |sum, (w, v)| [sum[0] + w * v[0], sum[1] + w * v[1]])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::testing::{grid, of_quadrilaterals, scene};

    fn sheared(bend: f64) -> Triangulation {
        let mut raw = of_quadrilaterals(grid("a", [0.0; 2], [1.0; 2], [2, 3]));
        for p in &mut raw.points {
            *p = [2.0 * p[0] + 0.5 * p[1] + bend * p[0] * p[1], p[1] + 0.3 * p[0]];
        }
        Triangulation::new(raw, &scene(&["a"])).expect("a good mesh").0
    }

    fn sampled(mesh: &Triangulation, k: usize, f: impl Fn([f64; 2]) -> [f64; 2]) -> OnQuadrilaterals {
        let mut values: Vec<[f64; 2]> = mesh.points.iter().map(|p| f(*p)).collect();
        if k == 2 {
            let middle = |vertices: &[usize]| {
                [0, 1].map(|c| vertices.iter().map(|v| mesh.points[*v][c]).sum::<f64>() / vertices.len() as f64)
            };
            values.extend(mesh.edges.iter().map(|e| f(middle(&e.vertices))));
            for cell in mesh.quadrilaterals() {
                values[mesh.points.len() + cell.diagonal] = f(middle(&cell.corners));
            }
        }
        OnQuadrilaterals::new(mesh, k, values).expect("quadrilaterals alone")
    }

    #[test]
    fn on_parallelograms_it_is_a_polynomial_of_twice_the_degree() {
        let mesh = sheared(0.0);
        let back = Bilinear::new([[0.0, 0.0], [2.0, 0.3], [2.5, 1.3], [0.5, 1.0]]);
        for k in 1..=HIGHEST {
            // Of degree k in each coordinate of the parallelograms, and 2k in the plane.
            let exact = |p: [f64; 2]| {
                let [x, y] = back.inverse(p);
                [(x - 0.3).powi(k as i32) * (y + 0.2).powi(k as i32), x - y * (1.0 - x)]
            };
            let field = sampled(&mesh, k, exact);
            assert!(field.is_polynomial());
            let split = field.on_triangles(&mesh).expect("as many values as nodes").split(&mesh);
            for t in 0..mesh.triangles.len() {
                for l in [[0.2, 0.3, 0.5], [0.7, 0.05, 0.25], [0.0, 0.6, 0.4]] {
                    let (found, exact) = (split.at(t, l), exact(weighed(&l, mesh.corners(t).into_iter())));
                    assert!((found[0] - exact[0]).hypot(found[1] - exact[1]) < 1e-12, "Q{k}");
                }
            }
        }
    }

    #[test]
    fn elsewhere_it_agrees_at_the_nodes_and_along_the_sides() {
        let mesh = sheared(0.6);
        let f = |[x, y]: [f64; 2]| [1.0 + 2.0 * x - y, 0.5 * x + 3.0 * y];
        for k in 1..=HIGHEST {
            let field = sampled(&mesh, k, f);
            assert!(!field.is_polynomial());
            // What is linear in the plane is so everywhere.
            let split = field.on_triangles(&mesh).expect("as many values as nodes").split(&mesh);
            for t in 0..mesh.triangles.len() {
                let l = [0.2, 0.3, 0.5];
                let (found, exact) = (split.at(t, l), f(weighed(&l, mesh.corners(t).into_iter())));
                assert!((found[0] - exact[0]).hypot(found[1] - exact[1]) < 1e-12);
            }
        }
    }

    #[test]
    fn other_meshes_carry_none() {
        let mesh = sheared(0.0);
        assert!(OnQuadrilaterals::new(&mesh, 3, vec![[0.0; 2]; mesh.points.len()]).is_none());
        assert!(OnQuadrilaterals::new(&mesh, 2, vec![[0.0; 2]; mesh.points.len()]).is_none());
        let mut raw = of_quadrilaterals(grid("a", [0.0; 2], [1.0; 2], [2, 2]));
        raw.quadrilaterals.pop();
        let mixed = Triangulation::new(raw, &scene(&["a"])).expect("a good mesh").0;
        assert!(!can_carry(&mixed));
        let mut dented = of_quadrilaterals(grid("a", [0.0; 2], [1.0; 2], [1, 1]));
        dented.points[1] = [0.4, 0.45];
        dented.triangles = vec![([0, 1, 3], "a".into()), ([0, 3, 2], "a".into())];
        dented.segments.clear();
        let dented = Triangulation::new(dented, &scene(&["a"])).map(|(mesh, _)| can_carry(&mesh));
        assert!(!matches!(dented, Ok(true)));
    }
}
