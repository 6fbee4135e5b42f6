//! The inside of each triangle: four nodes that minimise the local energy with the boundary values fixed.

use rayon::prelude::*;

use super::cholesky;
use super::split::{BOUNDARY, INSIDE, Split};
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
    let split = Split::new(corners, material, force);
    let mut load = [0.0; INSIDE];
    for (i, value) in load.iter_mut().enumerate() {
        let forces = split.matrix[BOUNDARY + i].iter().zip(values.as_flattened()).map(|(k, u)| k * u);
        *value = split.load[BOUNDARY + i] - forces.sum::<f64>();
    }
    let mut stiffness = split.inside();
    if cholesky::factorise(&mut stiffness, INSIDE, 0.0) {
        cholesky::solve(&stiffness, &mut load);
        for (value, step) in values.as_flattened_mut()[BOUNDARY..].iter_mut().zip(load) {
            *value += step;
        }
    }
    values.map(|v| [v[0] + base[0], v[1] + base[1]])
}
