//! The energy of a triangle as a function of the six nodes on its boundary, the inside minimised away.

use nalgebra::{Cholesky, SMatrix};
use rayon::prelude::*;

use crate::bounds::strain::{gradients, shape_gradients, sub_area, sub_corners};
use crate::dual::modes::materials;
use crate::element::Compliance;
use crate::problem::{Condition, Problem};

/// Unknowns on the boundary: three corners, then the midpoints opposite them, x and y each.
pub const BOUNDARY: usize = 12;

/// ½ uᵀKu − fᵀu of one triangle.
#[derive(Debug, Clone)]
pub struct Condensed {
    /// K.
    pub matrix: SMatrix<f64, BOUNDARY, BOUNDARY>,
    /// f: body force and traction.
    pub load: SMatrix<f64, BOUNDARY, 1>,
}

/// Of every triangle, per unit thickness. `None` where the inside has no unique minimum in numbers.
pub fn condensed(problem: &Problem) -> Vec<Option<Condensed>> {
    let materials = materials(problem);
    let mesh = &problem.mesh;
    (0..mesh.triangles.len())
        .into_par_iter()
        .with_min_len(64)
        .map(|t| {
            let body = mesh.body[t];
            let force = problem.scene.bodies[body].body_force;
            let mut element = element(mesh.corners(t), &materials[body], force)?;
            for side in 0..3 {
                let e = mesh.triangle_edges[t][side];
                let Condition::Traction([pa, pb]) = problem.conditions[e] else { continue };
                // A boundary edge runs from corner side + 1 to corner side + 2 of its triangle.
                let (length, _) = mesh.edge_frame(e);
                let nodes = [(side + 1) % 3, 3 + side, (side + 2) % 3];
                for c in 0..2 {
                    let weights = [pa[c], 2.0 * (pa[c] + pb[c]), pb[c]];
                    for (node, weight) in nodes.iter().zip(weights) {
                        element.load[2 * node + c] += length / 6.0 * weight;
                    }
                }
            }
            Some(element)
        })
        .collect()
}

/// Nodes of the six that each subtriangle has, as indices into the ten of the triangle.
fn nodes(sub: usize) -> [usize; 6] {
    let (j, k) = ((sub + 1) % 3, (sub + 2) % 3);
    [j, k, 6, 7 + k, 7 + j, 3 + sub]
}

fn element(corners: [[f64; 2]; 3], material: &Compliance, force: [f64; 2]) -> Option<Condensed> {
    const INSIDE: usize = 8;
    let mut full = SMatrix::<f64, 20, 20>::zeros();
    let mut load = SMatrix::<f64, 20, 1>::zeros();
    let weight = sub_area(corners) / 3.0;
    // c e:e = λ (tr e)² + 2μ e:e.
    let shear = material.young / material.gamma;
    let bulk = 0.25 * material.young / material.kappa - shear;
    for sub in 0..3 {
        let g = gradients(sub_corners(corners, sub));
        let index = nodes(sub);
        for at in 0..3 {
            let d = shape_gradients(&g, at);
            for (a, &i) in index.iter().enumerate() {
                for (b, &j) in index.iter().enumerate().take(a + 1) {
                    let dot = d[a][0] * d[b][0] + d[a][1] * d[b][1];
                    for p in 0..2 {
                        for q in 0..2 {
                            let same = if p == q { dot } else { 0.0 };
                            let value = weight * (bulk * d[a][p] * d[b][q] + shear * (d[a][q] * d[b][p] + same));
                            full[(2 * i + p, 2 * j + q)] += value;
                            if a != b {
                                full[(2 * j + q, 2 * i + p)] += value;
                            }
                        }
                    }
                }
            }
        }
        for &node in &index[3..] {
            load[2 * node] += weight * force[0];
            load[2 * node + 1] += weight * force[1];
        }
    }
    let inside: SMatrix<f64, INSIDE, INSIDE> = full.fixed_view::<INSIDE, INSIDE>(BOUNDARY, BOUNDARY).into();
    let coupling: SMatrix<f64, INSIDE, BOUNDARY> = full.fixed_view::<INSIDE, BOUNDARY>(BOUNDARY, 0).into();
    let factor = Cholesky::new(inside)?;
    let answer = factor.solve(&coupling);
    let boundary: SMatrix<f64, BOUNDARY, BOUNDARY> = full.fixed_view::<BOUNDARY, BOUNDARY>(0, 0).into();
    let inner_load: SMatrix<f64, INSIDE, 1> = load.fixed_rows::<INSIDE>(BOUNDARY).into();
    let outer_load: SMatrix<f64, BOUNDARY, 1> = load.fixed_rows::<BOUNDARY>(0).into();
    Some(Condensed {
        matrix: boundary - coupling.transpose() * answer,
        load: outer_load - answer.transpose() * inner_load,
    })
}
