//! What every method on the hybrid form shares: ordering, held motions, stresses from moments, residuals on stresses.

use rayon::prelude::*;

use super::DualError;
use super::factor::minimum_degree;
use super::system::System;
use crate::element::StressField;
use crate::problem::Problem;

/// A displacement of every vertex that no support and no closed contact resists.
pub type Motion = Vec<[f64; 2]>;

/// Fill-reducing ordering of the unknowns that are not jumps, found on the graph of blocks.
pub fn ordering(system: &System) -> Result<Vec<usize>, DualError> {
    let unknowns = &system.unknowns;
    let blocks = unknowns.blocks.iter().take_while(|b| b.start < unknowns.first_jump).count();
    let mut block_of = vec![0; unknowns.first_jump];
    for (b, block) in unknowns.blocks[..blocks].iter().enumerate() {
        block_of[block.start..block.start + block.len].fill(b);
    }
    let matrix = system.matrix.symbolic();
    let (mut columns, mut rows) = (vec![0], Vec::new());
    for block in &unknowns.blocks[..blocks] {
        // The first column of a block lists its neighbours in order, unknown by unknown.
        let list = &matrix.row_idx()[matrix.col_ptr()[block.start]..matrix.col_ptr()[block.start + 1]];
        let mut last = usize::MAX;
        for &row in list.iter().filter(|&&row| row < unknowns.first_jump) {
            if block_of[row] != last {
                last = block_of[row];
                rows.push(last);
            }
        }
        columns.push(rows.len());
    }
    let order = minimum_degree(&columns, &rows)?;
    Ok(order
        .into_iter()
        .flat_map(|b| {
            let block = unknowns.blocks[b];
            block.start..block.start + block.len
        })
        .collect())
}

/// Unknowns to hold at zero so that exactly the given motions are removed: as many as there are motions.
///
/// Loads that admit an equilibrium do no work on these motions, so holding them changes no stress.
pub fn held_unknowns(problem: &Problem, system: &System, motions: &[Motion]) -> Vec<usize> {
    let mesh = &problem.mesh;
    let mut basis: Vec<Vec<f64>> = motions
        .iter()
        .map(|u| {
            system.unknowns.project(problem, |e, end| {
                let (length, _) = mesh.edge_frame(e);
                let [a, b] = mesh.edges[e].vertices;
                let (near, far) = if end == 0 { (u[a], u[b]) } else { (u[b], u[a]) };
                [0, 1].map(|c| length * (2.0 * near[c] + far[c]) / 6.0)
            })
        })
        .collect();
    let mut held = Vec::with_capacity(basis.len());
    // Gaussian elimination with complete pivoting over motions and unknowns.
    while !basis.is_empty() {
        let mut best = (0, 0, 0.0_f64);
        for (k, z) in basis.iter().enumerate() {
            let norm = z.iter().fold(0.0_f64, |m, v| m.max(v.abs())).max(f64::MIN_POSITIVE);
            for (i, value) in z[..system.unknowns.first_jump].iter().enumerate() {
                if value.abs() / norm > best.2 {
                    best = (k, i, value.abs() / norm);
                }
            }
        }
        let (k, i, size) = best;
        let pivot = basis.swap_remove(k);
        if size == 0.0 {
            continue;
        }
        held.push(i);
        for z in &mut basis {
            let factor = z[i] / pivot[i];
            for (value, p) in z.iter_mut().zip(&pivot) {
                *value -= factor * p;
            }
            z[i] = 0.0;
        }
    }
    held
}

/// Mode parameters S = Tᵀm of every triangle. `given` counts the moments of u0 in; without them the result is the
/// answer to a correction of the unknowns alone.
pub fn parameters(problem: &Problem, system: &System, x: &[f64], given: bool) -> Vec<f64> {
    let mesh = &problem.mesh;
    let mut moments = system.unknowns.moments(problem, x);
    if !given {
        let zero = system.unknowns.moments(problem, &vec![0.0; x.len()]);
        for (m, z) in moments.as_flattened_mut().as_flattened_mut().iter_mut().zip(zero.as_flattened().as_flattened()) {
            *m -= z;
        }
    }
    let n = system.modes.of(0).parameters();
    let mut out = vec![0.0; n * mesh.triangles.len()];
    out.par_chunks_exact_mut(n).enumerate().with_min_len(256).for_each(|(t, s)| {
        let mut m = [0.0; 12];
        for side in 0..3 {
            let e = mesh.triangle_edges[t][side];
            let flipped = mesh.edges[e].triangles[0] != Some(t);
            for node in 0..2 {
                let end = if flipped { 1 - node } else { node };
                m[4 * side + 2 * node..][..2].copy_from_slice(&moments[e][end]);
            }
        }
        system.modes.of(t).parameters_from_moments(&m, s);
    });
    out
}

/// What the stresses with mode parameters `s` leave of the loads: f − Σ(T S + T̄) for every unknown.
///
/// On free unknowns this is the jump of traction across the edge, on closed jumps minus the normal traction.
pub fn residual(problem: &Problem, system: &System, s: &[f64]) -> Vec<f64> {
    let mesh = &problem.mesh;
    let n = system.modes.of(0).parameters();
    let tractions: Vec<[f64; 12]> = (0..mesh.triangles.len())
        .into_par_iter()
        .with_min_len(256)
        .map(|t| {
            let modes = system.modes.of(t);
            let mut values = [0.0; 12];
            values.copy_from_slice(modes.particular_traction());
            for (value, row) in values.iter_mut().zip(modes.traction().chunks_exact(n)) {
                *value += row.iter().zip(&s[t * n..(t + 1) * n]).map(|(a, b)| a * b).sum::<f64>();
            }
            values
        })
        .collect();
    let mut r = system.external.clone();
    for (t, values) in tractions.iter().enumerate() {
        for side in 0..3 {
            let e = mesh.triangle_edges[t][side];
            let flipped = mesh.edges[e].triangles[0] != Some(t);
            let (_, normal) = mesh.edge_frame(e);
            for node in 0..2 {
                let end = if flipped { 1 - node } else { node };
                let (tx, ty) = (values[4 * side + 2 * node], values[4 * side + 2 * node + 1]);
                for component in system.unknowns.components(e, end, normal) {
                    let value = component.direction[0] * tx + component.direction[1] * ty;
                    for &(dof, c) in component.terms() {
                        r[dof] -= c * value;
                    }
                }
            }
        }
    }
    r
}

/// The stress field with mode parameters `s`.
pub fn stresses(problem: &Problem, system: &System, s: &[f64]) -> StressField {
    let mut field = StressField::zeros(system.modes.degree(), problem.mesh.triangles.len());
    let n = system.modes.of(0).parameters();
    let stride = field.stride();
    field
        .values_mut()
        .par_chunks_exact_mut(stride)
        .zip(s.par_chunks_exact(n))
        .enumerate()
        .with_min_len(256)
        .for_each(|(t, (block, s))| system.modes.of(t).stress_from_parameters(s, 1.0, block));
    field
}
