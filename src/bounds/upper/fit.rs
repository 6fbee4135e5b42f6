//! Vertex values: the average of a local fit over the triangles at each vertex.
//!
//! On each triangle the quadratic displacement whose (linear) strain is nearest to aλ_h in the plain L² norm; its rigid
//! part from the mean displacements of the three edges. The norm knows no material, so ν plays no part.

use rayon::prelude::*;

use crate::dual::DualSolution;
use crate::dual::modes::materials;
use crate::element::Compliance;
use crate::problem::Problem;

/// Averages of the local fits.
pub fn vertex_values(problem: &Problem, dual: &DualSolution) -> Vec<[f64; 2]> {
    let mesh = &problem.mesh;
    let materials = materials(problem);
    let local: Vec<[[f64; 2]; 3]> = (0..mesh.triangles.len())
        .into_par_iter()
        .with_min_len(256)
        .map(|t| corner_values(problem, dual, &materials[mesh.body[t]], t))
        .collect();
    let mut sum = vec![[0.0; 2]; mesh.points.len()];
    let mut count = vec![0.0; mesh.points.len()];
    for (triangle, values) in mesh.triangles.iter().zip(&local) {
        for (&v, value) in triangle.iter().zip(values) {
            sum[v][0] += value[0];
            sum[v][1] += value[1];
            count[v] += 1.0;
        }
    }
    sum.into_iter().zip(count).map(|([x, y], n): ([f64; 2], f64)| [x / n.max(1.0), y / n.max(1.0)]).collect()
}

/// Values of the fit on triangle `t` at its corners.
fn corner_values(problem: &Problem, dual: &DualSolution, material: &Compliance, t: usize) -> [[f64; 2]; 3] {
    let mesh = &problem.mesh;
    let corners = mesh.corners(t);
    let origin = corners[0];
    let centre = [0, 1].map(|c| ((corners[1][c] - origin[c]) + (corners[2][c] - origin[c])) / 3.0);
    let p = corners.map(|q| [q[0] - origin[0] - centre[0], q[1] - origin[1] - centre[1]]);
    let u = Quadratic::with_strain(p, linear_strain(dual, material, t));
    // Rigid part: least squares between the edge means of the fit and those of the dual solution.
    let (mut shift, mut turn, mut inertia) = ([0.0; 2], 0.0, 0.0);
    for side in 0..3 {
        let (a, b) = (p[(side + 1) % 3], p[(side + 2) % 3]);
        let middle = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
        let e = mesh.triangle_edges[t][side];
        let (length, _) = mesh.edge_frame(e);
        let (m0, m1) = (dual.moments.of(e)[0], dual.moments.of(e)[1]);
        let (ua, um, ub) = (u.at(a), u.at(middle), u.at(b));
        let off = [0, 1].map(|c| (m0[c] + m1[c]) / length - (ua[c] + 4.0 * um[c] + ub[c]) / 6.0);
        shift[0] += off[0] / 3.0;
        shift[1] += off[1] / 3.0;
        // The three midpoints have the centroid as their mean, so shift and turn decouple.
        turn += middle[0] * off[1] - middle[1] * off[0];
        inertia += middle[0] * middle[0] + middle[1] * middle[1];
    }
    let turn = turn / inertia;
    p.map(|q| {
        let v = u.at(q);
        [v[0] + shift[0] - turn * q[1], v[1] + shift[1] + turn * q[0]]
    })
}

/// L² projection of aλ_h onto linear strains: values at the three corners, (xx, yy, xy) each.
fn linear_strain(dual: &DualSolution, material: &Compliance, t: usize) -> [[f64; 3]; 3] {
    // Σ over subtriangles of ∫ f μ_j in units of the triangle's area, with f linear on each and μ_j the barycentric
    // coordinates of the triangle.
    let mut b = [[0.0; 3]; 3];
    for sub in 0..3 {
        let (j, k) = ((sub + 1) % 3, (sub + 2) % 3);
        let f = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|l| material.strain(dual.stress.at(t, sub, l)));
        for (corner, row) in b.iter_mut().enumerate() {
            let mu = [f64::from(corner == j), f64::from(corner == k), 1.0 / 3.0];
            for (m, fm) in f.iter().enumerate() {
                for (n, mun) in mu.iter().enumerate() {
                    let weight = if m == n { 1.0 / 18.0 } else { 1.0 / 36.0 };
                    for c in 0..3 {
                        row[c] += weight * fm[c] * mun;
                    }
                }
            }
        }
    }
    let total = [0, 1, 2].map(|c| b[0][c] + b[1][c] + b[2][c]);
    // Inverse of the mass matrix (1 + δ_ij)/12.
    b.map(|row| [0, 1, 2].map(|c| 12.0 * (row[c] - 0.25 * total[c])))
}

/// A quadratic displacement about the centroid, without a rigid part there.
struct Quadratic {
    /// Coefficients of x, y, x², xy, y² for each component.
    coefficients: [[f64; 5]; 2],
}

impl Quadratic {
    /// The displacement with the linear strain that has the given corner values.
    fn with_strain(p: [[f64; 2]; 3], corner: [[f64; 3]; 3]) -> Self {
        let g = crate::bounds::strain::gradients(p);
        let mean = [0, 1, 2].map(|c| (corner[0][c] + corner[1][c] + corner[2][c]) / 3.0);
        let slope = |c: usize, d: usize| (0..3).map(|i| corner[i][c] * g[i][d]).sum::<f64>();
        let (xx_x, xx_y) = (slope(0, 0), slope(0, 1));
        let (yy_x, yy_y) = (slope(1, 0), slope(1, 1));
        let (xy_x, xy_y) = (slope(2, 0), slope(2, 1));
        Quadratic {
            coefficients: [
                [mean[0], mean[2], 0.5 * xx_x, xx_y, xy_y - 0.5 * yy_x],
                [mean[2], mean[1], xy_x - 0.5 * xx_y, yy_x, 0.5 * yy_y],
            ],
        }
    }

    fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        self.coefficients.map(|c| c[0] * x + c[1] * y + c[2] * x * x + c[3] * x * y + c[4] * y * y)
    }
}
