//! What every method on the hybrid form shares: ordering, held motions, stresses from moments, residuals on stresses.

use rayon::prelude::*;

use super::dissection::nested_dissection;
use super::factor::{Breakdown, SymbolicFactor};
use super::rows::{FreeEdge, SideEnd, free_edges, rows, side_ends};
use super::system::System;
use super::unknowns::EdgeMoments;
use super::{DualError, Options};
use crate::problem::Problem;

/// A displacement of every vertex that no support and no closed contact resists.
pub type Motion = Vec<[f64; 2]>;

/// Fill-reducing ordering of the unknowns that are not jumps.
pub fn ordering(problem: &Problem, system: &System) -> Vec<usize> {
    let unknowns = &system.unknowns;
    let blocks = nested_dissection(problem, unknowns).into_iter().map(|b| unknowns.blocks[b]);
    blocks.flat_map(|block| block.start..block.start + block.len).collect()
}

/// Structure of the factor of K with its jumps last, when its values fit into memory.
///
/// # Errors
/// [`DualError::TooLarge`].
pub fn structure(problem: &Problem, system: &System, options: &Options) -> Result<SymbolicFactor, DualError> {
    let pattern = system.matrix.symbolic();
    let symbolic = SymbolicFactor::new(pattern, system.unknowns.first_jump, ordering(problem, system))
        .map_err(|breakdown| explain(problem, system, breakdown))?;
    match options.budget.admit_more(symbolic.memory(options.par())) {
        Ok(()) => Ok(symbolic),
        Err(excess) => Err(explain(problem, system, Breakdown::TooLarge(excess.to_string()))),
    }
}

/// What a breakdown of the factorisation means on the mesh.
pub fn explain(problem: &Problem, system: &System, breakdown: Breakdown) -> DualError {
    let reason = match breakdown {
        Breakdown::TooLarge(reason) => {
            let (unknowns, jumps) = (system.unknowns.count, system.jump_bound.len());
            let contact = if jumps > 0 { format!(", {jumps} of them at contact,") } else { String::new() };
            let reason = format!("the factorisation for {unknowns} unknowns{contact} does not fit: {reason}");
            return DualError::TooLarge { reason };
        }
        Breakdown::NotPositive(unknown) => {
            let block_of = system.unknowns.block_of();
            let has = |e: &usize| {
                let (blocks, len) = system.unknowns.blocks_of_edge(*e, &block_of);
                blocks[..len].contains(&(block_of[unknown] as usize))
            };
            let mesh = &problem.mesh;
            match (0..mesh.edges.len()).find(has) {
                Some(e) => {
                    let [a, b] = mesh.edges[e].vertices.map(|v| mesh.points[v]);
                    let [x, y] = problem.scene.as_written([0, 1].map(|c| 0.5 * (a[c] + b[c])));
                    let t = mesh.edges[e].triangles[0].unwrap_or(0);
                    let body = &problem.scene.bodies[mesh.body[t]].name;
                    format!("nothing resists a motion of the edge at ({x}, {y}) of {body}")
                }
                None => format!("the pivot of unknown {unknown} is not positive"),
            }
        }
    };
    DualError::Factorisation { reason }
}

/// What the unknowns held so far leave of a motion, and the unknown that is held for it.
struct Pivot {
    unknown: usize,
    value: f64,
    /// Unknown and value, where it is not zero.
    entries: Vec<(usize, f64)>,
}

/// Unknowns to hold at zero so that exactly the given motions are removed: as many as there are motions.
///
/// Loads that admit an equilibrium do no work on these motions, so holding them changes no stress.
pub fn held_unknowns(problem: &Problem, system: &System, motions: &[Motion]) -> Vec<usize> {
    let mesh = &problem.mesh;
    let mut pivots: Vec<Pivot> = Vec::with_capacity(motions.len());
    for u in motions {
        let mut z = system.unknowns.project(problem, |e, end| {
            let (length, _) = mesh.edge_frame(e);
            let [a, b] = mesh.edges[e].vertices;
            let (near, far) = if end == 0 { (u[a], u[b]) } else { (u[b], u[a]) };
            [0, 1].map(|c| length * (2.0 * near[c] + far[c]) / 6.0)
        });
        // Gaussian elimination: what the unknowns held so far leave of the motion, and where it is largest. Motions of few
        // bodies have few entries, and meet few of the others.
        for Pivot { unknown, value, entries } in &pivots {
            let factor = z[*unknown] / value;
            if factor != 0.0 {
                entries.iter().for_each(|(i, p)| z[*i] -= factor * p);
                z[*unknown] = 0.0;
            }
        }
        let free = z[..system.unknowns.first_jump].iter().enumerate();
        let largest =
            free.clone().fold((0, 0.0_f64), |best, (i, v)| if v.abs() > best.1.abs() { (i, *v) } else { best });
        if largest.1 != 0.0 {
            let entries = free.filter(|(_, v)| **v != 0.0).map(|(i, v)| (i, *v)).collect();
            pivots.push(Pivot { unknown: largest.0, value: largest.1, entries });
        }
    }
    pivots.into_iter().map(|pivot| pivot.unknown).collect()
}

/// Mode parameters S = Tᵀm of every triangle. `given` counts the moments of u0 in; without them the result is the
/// answer to a correction of the unknowns alone.
pub fn parameters(problem: &Problem, system: &System, x: &[f64], given: bool) -> Vec<f64> {
    let mesh = &problem.mesh;
    let mut moments = system.unknowns.moments(problem, x);
    if !given {
        for (m, edge) in moments.iter_mut().zip(&system.unknowns.edges) {
            if let EdgeMoments::Given(_) = edge {
                *m = [[0.0; 2]; 2];
            }
        }
    }
    let n = system.modes.of(0).parameters();
    let mut out = vec![0.0; n * mesh.triangles.len()];
    out.par_chunks_exact_mut(n).enumerate().with_min_len(256).for_each(|(t, s)| {
        let mut m = [0.0; 12];
        for SideEnd { at, edge, end } in side_ends(mesh, t) {
            m[at..at + 2].copy_from_slice(&moments[edge][end]);
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
            let mut values = [0.0; 12];
            system.modes.of(t).tractions_from_parameters(&s[t * n..(t + 1) * n], 1.0, &mut values);
            values
        })
        .collect();
    let mut r = system.external.clone();
    for (t, values) in tractions.iter().enumerate() {
        if let Some(edges) = free_edges(mesh, &system.unknowns, t) {
            for (unknown, at) in edges.iter().flat_map(FreeEdge::unknowns) {
                r[unknown] -= values[at];
            }
            continue;
        }
        for (SideEnd { at, .. }, components) in rows(mesh, &system.unknowns, t) {
            for component in components {
                let value = component.direction[0] * values[at] + component.direction[1] * values[at + 1];
                for &(dof, c) in component.terms() {
                    r[dof] -= c * value;
                }
            }
        }
    }
    r
}
