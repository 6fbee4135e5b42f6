//! The energy of a triangle as a function of the six nodes on its boundary, the inside minimised away.

use rayon::prelude::*;

use super::cholesky;
use super::split::{BOUNDARY, INSIDE, Split};
use crate::dual::modes::materials;
use crate::problem::{Condition, Problem};

/// ½ uᵀKu − fᵀu of one triangle, u being x and y of three corners and of the midpoints opposite them.
#[derive(Debug, Clone)]
pub struct Condensed {
    /// K.
    pub matrix: [[f64; BOUNDARY]; BOUNDARY],
    /// f: body force and traction.
    pub load: [f64; BOUNDARY],
}

impl Condensed {
    /// Ku.
    pub fn times(&self, u: &[f64; BOUNDARY]) -> [f64; BOUNDARY] {
        let mut out = [0.0; BOUNDARY];
        for (row, u) in self.matrix.iter().zip(u) {
            out.iter_mut().zip(row).for_each(|(o, k)| *o += k * u);
        }
        out
    }

    /// f − Ku.
    pub fn residual(&self, u: &[f64; BOUNDARY]) -> [f64; BOUNDARY] {
        let mut out = self.load;
        out.iter_mut().zip(self.times(u)).for_each(|(o, k)| *o -= k);
        out
    }
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
            let mut element = element(&Split::new(mesh.corners(t), &materials[body], force))?;
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

/// Eliminates the inside: with K_ii = L Lᵀ and Y = L⁻¹ K_ib, what is left is K_bb − YᵀY.
fn element(split: &Split) -> Option<Condensed> {
    let mut inside = split.inside();
    if !cholesky::factorise(&mut inside, INSIDE, 0.0) {
        return None;
    }
    // The load is one more column.
    let mut y = [[0.0; BOUNDARY + 1]; INSIDE];
    for (i, row) in y.iter_mut().enumerate() {
        row[..BOUNDARY].copy_from_slice(&split.matrix[BOUNDARY + i][..BOUNDARY]);
        row[BOUNDARY] = split.load[BOUNDARY + i];
    }
    cholesky::forward(&inside, &mut y);
    let mut out = Condensed { matrix: [[0.0; BOUNDARY]; BOUNDARY], load: [0.0; BOUNDARY] };
    out.load.copy_from_slice(&split.load[..BOUNDARY]);
    for (i, row) in out.matrix.iter_mut().enumerate() {
        row.copy_from_slice(&split.matrix[i][..BOUNDARY]);
        for y in &y {
            row.iter_mut().zip(y).for_each(|(k, v)| *k -= y[i] * v);
            out.load[i] -= y[i] * y[BOUNDARY];
        }
    }
    Some(out)
}
