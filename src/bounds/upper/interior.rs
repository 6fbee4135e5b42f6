//! The inside of each triangle: four nodes that minimise the local energy with the boundary values fixed.

use nalgebra::{SMatrix, SVector};
use rayon::prelude::*;

use crate::bounds::strain::{gradients, shape_gradients, sub_area, sub_corners};
use crate::dual::modes::materials;
use crate::element::{Compliance, Displacement};
use crate::problem::Problem;

/// Completes vertex and edge values to a displacement on the split triangles.
pub fn fill(problem: &Problem, vertex: &[[f64; 2]], middle: &[[f64; 2]]) -> Displacement {
    let mesh = &problem.mesh;
    let materials = materials(problem);
    let values = (0..mesh.triangles.len())
        .into_par_iter()
        .with_min_len(128)
        .map(|t| {
            let body = mesh.body[t];
            let u = mesh.triangles[t].map(|v| vertex[v]);
            let m = mesh.triangle_edges[t].map(|e| middle[e]);
            inside(mesh.corners(t), &materials[body], problem.scene.bodies[body].body_force, u, m)
        })
        .collect();
    Displacement { values }
}

/// Nodes of the six that each subtriangle has, as indices into the ten of the triangle.
fn nodes(sub: usize) -> [usize; 6] {
    let (j, k) = ((sub + 1) % 3, (sub + 2) % 3);
    [j, k, 6, 7 + k, 7 + j, 3 + sub]
}

/// Ten nodal values from the six on the boundary.
fn inside(
    corners: [[f64; 2]; 3],
    material: &Compliance,
    force: [f64; 2],
    u: [[f64; 2]; 3],
    m: [[f64; 2]; 3],
) -> [[f64; 2]; 10] {
    // Start from the plain quadratic, about the value at the first corner: the correction is small and rigid
    // translations cost no digits.
    let base = u[0];
    let off = |v: [f64; 2]| [v[0] - base[0], v[1] - base[1]];
    let mut values = [[0.0; 2]; 10];
    for i in 0..3 {
        values[i] = off(u[i]);
        values[3 + i] = off(m[i]);
    }
    let plain = |l: [f64; 3], values: &[[f64; 2]; 10]| {
        let mut w = [0.0; 2];
        for i in 0..3 {
            let (a, b) = (l[i] * (2.0 * l[i] - 1.0), 4.0 * l[(i + 1) % 3] * l[(i + 2) % 3]);
            for c in 0..2 {
                w[c] += a * values[i][c] + b * values[3 + i][c];
            }
        }
        w
    };
    values[6] = plain([1.0 / 3.0; 3], &values);
    for i in 0..3 {
        let mut l = [1.0 / 6.0; 3];
        l[i] = 2.0 / 3.0;
        values[7 + i] = plain(l, &values);
    }
    // Newton's step from there: exact, the energy being quadratic.
    let mut stiffness = SMatrix::<f64, 8, 8>::zeros();
    let mut load = SVector::<f64, 8>::zeros();
    let area = sub_area(corners);
    let weight = area / 3.0;
    for sub in 0..3 {
        let g = gradients(sub_corners(corners, sub));
        let index = nodes(sub);
        for at in 0..3 {
            let shape = shape_gradients(&g, at);
            let mut e = [0.0; 3];
            for (d, &node) in shape.iter().zip(&index) {
                e[0] += d[0] * values[node][0];
                e[1] += d[1] * values[node][1];
                e[2] += 0.5 * (d[1] * values[node][0] + d[0] * values[node][1]);
            }
            let stress = material.stress(e);
            for (a, &node) in index.iter().enumerate() {
                let Some(i) = node.checked_sub(6) else { continue };
                load[2 * i] -= weight * (stress[0] * shape[a][0] + stress[2] * shape[a][1]);
                load[2 * i + 1] -= weight * (stress[2] * shape[a][0] + stress[1] * shape[a][1]);
                let columns = [[shape[a][0], 0.0, 0.5 * shape[a][1]], [0.0, shape[a][1], 0.5 * shape[a][0]]];
                for (b, &other) in index.iter().enumerate() {
                    let Some(j) = other.checked_sub(6).filter(|&j| j <= i) else { continue };
                    let rows = [[shape[b][0], 0.0, 0.5 * shape[b][1]], [0.0, shape[b][1], 0.5 * shape[b][0]]];
                    for (c, column) in columns.iter().enumerate() {
                        for (d, row) in rows.iter().enumerate() {
                            stiffness[(2 * i + c, 2 * j + d)] += weight * material.strain_product(*column, *row);
                        }
                    }
                }
            }
        }
        // ∫F·v: the midpoint rule, on the midpoints that lie inside.
        for (a, &node) in index.iter().enumerate() {
            if let Some(i) = node.checked_sub(6).filter(|_| a >= 3) {
                load[2 * i] += weight * force[0];
                load[2 * i + 1] += weight * force[1];
            }
        }
    }
    if let Some(factor) = nalgebra::Cholesky::new(symmetric(stiffness)) {
        let step = factor.solve(&load);
        for i in 0..4 {
            values[6 + i][0] += step[2 * i];
            values[6 + i][1] += step[2 * i + 1];
        }
    }
    values.map(|v| [v[0] + base[0], v[1] + base[1]])
}

/// Completes the upper triangle from the lower.
fn symmetric(mut m: SMatrix<f64, 8, 8>) -> SMatrix<f64, 8, 8> {
    for i in 0..8 {
        for j in i + 1..8 {
            m[(i, j)] = m[(j, i)];
        }
    }
    m
}
