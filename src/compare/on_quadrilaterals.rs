//! Displacement solutions on the quadrilaterals of the mesh file.
//!
//! On parallelograms they are polynomials on the triangles, and everything that is asked of one on triangles is asked of them.
//! On other quadrilaterals they are not: checks of the discrete solution use its own Gauss rule, and results that need a
//! field on triangles use the polynomial with the same values, which is an admissible displacement itself but another one.

use super::forces::NodalForces;
use crate::bounds::Potential;
use crate::element::OnQuadrilaterals;
use crate::element::displacement::bilinear::Bilinear;
use crate::element::polynomial::quadrature::segment_rule;
use crate::mesh::Quadrilateral;
use crate::problem::Problem;

/// A displacement on quadrilaterals with the Gauss rule of the program that found it.
#[derive(Debug, Clone, PartialEq)]
pub struct QuadrilateralSolution {
    /// The displacement.
    pub field: OnQuadrilaterals,
    /// Points of the rule in each direction.
    pub gauss_points: usize,
}

impl QuadrilateralSolution {
    /// Its forces and energy in its own rule.
    pub(super) fn forces(&self, problem: &Problem) -> (NodalForces, Potential) {
        NodalForces::on_quadrilaterals(problem, &self.field, self.gauss_points)
    }
}

/// Points in each direction for products of strains of degree 1, exact on parallelograms.
const POINTS: usize = 3;

/// ‖e(w)‖², per thickness, of the displacement of degree 1 on quadrilaterals with the values `w` at the vertices; all
/// quadrilaterals are parallelograms.
pub(super) fn strain_norm_squared(problem: &Problem, w: &[[f64; 2]]) -> f64 {
    let mesh = &problem.mesh;
    let materials = problem.materials();
    let of_cell = |cell: Quadrilateral| {
        let map = Bilinear::new(cell.points(mesh));
        let [a, b, c, d] = cell.corners.map(|v| w[v]);
        let rule = segment_rule(2 * POINTS - 1);
        let points = rule.iter().flat_map(|(x, v)| rule.iter().map(move |(y, w)| ([*x, *y], v * w)));
        let term = |(at, weight): ([f64; 2], f64)| {
            let mut e = [0.0; 3];
            for (g, u) in map.gradients(1, at).iter().zip([a, b, d, c]) {
                e[0] += g[0] * u[0];
                e[1] += g[1] * u[1];
                e[2] += 0.5 * (g[1] * u[0] + g[0] * u[1]);
            }
            weight * map.determinant(at) * materials[mesh.body[cell.triangles[0]]].strain_product(e, e)
        };
        points.map(term).sum::<f64>()
    };
    mesh.quadrilaterals().map(of_cell).sum()
}

/// The gradient, in the plane, of the function of degree 1 that is one at corner `i` of a parallelogram, at the point `p` of it.
pub(super) fn hat_gradient(cell: &Bilinear, i: usize, p: [f64; 2]) -> [f64; 2] {
    cell.gradients(1, cell.inverse(p))[[0, 1, 3, 2][i]]
}
