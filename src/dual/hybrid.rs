//! The parts that all methods on the hybrid form share: ordering, held motions, stresses from moments, residuals on stresses.

use faer::sparse::SymbolicSparseColMatRef;
use rayon::prelude::*;

use super::contact::interface::Interface;
use super::factor::{Breakdown, SymbolicFactor};
use super::system::System;
use super::system::dissection::nested_dissection;
use super::system::rows::Sides;
use super::system::unknowns::Unknowns;
use super::{DualError, Options};
use crate::element::SideValues;
use crate::element::polynomial::side;
use crate::problem::Problem;

/// A displacement of every vertex that no support and no closed contact resists.
pub type Motion = Vec<[f64; 2]>;

/// Fill-reducing ordering of the unknowns that are not jumps.
pub fn ordering(problem: &Problem, unknowns: &Unknowns) -> Vec<usize> {
    let blocks = nested_dissection(problem, unknowns).into_iter().map(|b| unknowns.blocks[b]);
    blocks.flat_map(|block| block.start..block.start + block.len).collect()
}

/// Structure of the factor of K with its jumps, or all unknowns of interfaces, last, when its values fit into memory.
///
/// # Errors
/// [`DualError::TooLarge`].
pub fn structure(
    problem: &Problem,
    unknowns: &Unknowns,
    pattern: SymbolicSparseColMatRef<'_, usize>,
    options: &Options,
) -> Result<SymbolicFactor, DualError> {
    let interface = Interface::new(problem, unknowns);
    let mut order = ordering(problem, unknowns);
    let last: Vec<usize> = match &interface {
        Some(interface) => interface.eliminated().collect(),
        None => (unknowns.first_jump..unknowns.count).collect(),
    };
    let mut is_last = vec![false; unknowns.count];
    last.iter().for_each(|&i| is_last[i] = true);
    order.retain(|&i| !is_last[i]);
    let leading = order.len();
    order.extend(last);
    let symbolic = SymbolicFactor::new(pattern, leading, order, interface)
        .map_err(|breakdown| explain(problem, unknowns, breakdown))?;
    match options.budget.admit_more(symbolic.memory(options.par(symbolic.numbers()))) {
        Ok(()) => Ok(symbolic),
        Err(excess) => Err(explain(problem, unknowns, Breakdown::TooLarge(excess.to_string()))),
    }
}

/// Explains a breakdown of the factorisation in terms of the mesh.
pub fn explain(problem: &Problem, unknowns: &Unknowns, breakdown: Breakdown) -> DualError {
    let reason = match breakdown {
        Breakdown::TooLarge(reason) => {
            let (count, jumps) = (unknowns.count, unknowns.count - unknowns.first_jump);
            let contact = if jumps > 0 { format!(", {jumps} of them at contact,") } else { String::new() };
            let reason = format!("the factorisation for {count} unknowns{contact} does not fit: {reason}");
            return DualError::TooLarge { reason };
        }
        Breakdown::NotPositive(unknown) => {
            let block_of = unknowns.block_of();
            let has = |e: &usize| {
                let (blocks, len) = unknowns.blocks_of_edge(*e, &block_of);
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

/// Moment `k` of edge `e` of the two functions that are linear along it and one at an end.
pub fn moments_of_ends(problem: &Problem, unknowns: &Unknowns, e: usize, k: usize) -> [f64; 2] {
    let (length, _) = problem.mesh.edge_frame(e);
    [0, 1].map(|end| length * side::product(unknowns.degree(e), k, 1, end))
}

/// The part of a motion that the unknowns held so far leave free, and the unknown that is held for it.
struct Pivot {
    unknown: usize,
    value: f64,
    /// Unknown and value, where it is not zero.
    entries: Vec<(usize, f64)>,
}

/// Unknowns to hold at zero so that exactly the given motions are removed: as many as there are motions.
///
/// Loads that admit an equilibrium do no work on these motions, so holding them changes no stress.
pub fn held_unknowns(problem: &Problem, unknowns: &Unknowns, motions: &[Motion]) -> Vec<usize> {
    let mesh = &problem.mesh;
    let mut pivots: Vec<Pivot> = Vec::with_capacity(motions.len());
    for u in motions {
        let mut z = unknowns.project(|e, k| {
            let [a, b] = mesh.edges[e].vertices;
            let [near, far] = moments_of_ends(problem, unknowns, e, k);
            // What nothing resists holds nothing.
            let idle = problem.vanishes(e, k, unknowns.degree(e));
            [0, 1].map(|c| if idle { 0.0 } else { near * u[a][c] + far * u[b][c] })
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
        let free = z[..unknowns.first_jump].iter().enumerate();
        let largest =
            free.clone().fold((0, 0.0_f64), |best, (i, v)| if v.abs() > best.1.abs() { (i, *v) } else { best });
        if largest.1 != 0.0 {
            let entries = free.filter(|(_, v)| **v != 0.0).map(|(i, v)| (i, *v)).collect();
            pivots.push(Pivot { unknown: largest.0, value: largest.1, entries });
        }
    }
    pivots.into_iter().map(|pivot| pivot.unknown).collect()
}

/// Mode parameters S = Tᵀm of every triangle, then of all springs. `given` counts the moments of u0 and initial strains in; without them the result is the
/// answer to a correction of the unknowns alone.
pub fn parameters(problem: &Problem, system: &System, x: &[f64], given: bool) -> Vec<f64> {
    let mesh = &problem.mesh;
    let unknowns = &system.unknowns;
    let moments = if given { unknowns.moments(x) } else { unknowns.moments_of_change(x) };
    let mut out = vec![0.0; system.parameters()];
    system.springs.parameters_from(x, &mut out[system.modes.parameters()..]);
    let parts = system.modes.split_parameters(&mut out);
    parts.into_par_iter().enumerate().with_min_len(256).for_each(|(t, s)| {
        let sides = Sides::new(mesh, &system.unknowns, t, system.modes.degree(t));
        let (mut small, mut large) = ([0.0; SMALL], Vec::new());
        let m = room(&mut small, &mut large, 2 * sides.len());
        let (own, lowered) = m.split_at_mut(sides.len());
        for (i, e) in sides.edges.into_iter().enumerate() {
            for (k, m) in moments.of(e).iter().enumerate() {
                own[sides.at(i, k)..][..2].copy_from_slice(m);
            }
        }
        let modes = system.modes.of(t);
        if sides.are_even() {
            return modes.parameters_from_moments(own, s);
        }
        let lowered = &mut lowered[..6 * (sides.degree + 1)];
        sides.lower(own, lowered);
        modes.parameters_from_moments(lowered, s);
    });
    if given {
        out.iter_mut().zip(system.initial.iter()).for_each(|(s, initial)| *s += initial);
    }
    out
}

/// Numbers on the boundary of a triangle, twice, up to degree 4: as many as fit without an allocation.
const SMALL: usize = 60;

/// `len` zeros, in `small` where they fit.
fn room<'a>(small: &'a mut [f64; SMALL], large: &'a mut Vec<f64>, len: usize) -> &'a mut [f64] {
    if len <= SMALL {
        return &mut small[..len];
    }
    large.resize(len, 0.0);
    large
}

/// Residual of the loads for the stresses with mode parameters `s`: f − Σ(T S + T̄) for every unknown.
///
/// On free unknowns this is the jump of traction across the edge, on closed jumps minus the normal traction.
pub fn residual(problem: &Problem, system: &System, s: &[f64]) -> Vec<f64> {
    let mesh = &problem.mesh;
    let sides = |t: usize| Sides::new(mesh, &system.unknowns, t, system.modes.degree(t));
    let mut tractions = SideValues::filled((0..mesh.triangles.len()).map(|t| sides(t).len()), 0.0);
    tractions.parts_mut().into_par_iter().enumerate().with_min_len(256).for_each(|(t, values)| {
        let sides = sides(t);
        let (modes, own) = (system.modes.of(t), &s[system.modes.parameters_of(t)]);
        if sides.are_even() {
            return modes.tractions_from_parameters(own, 1.0, values);
        }
        let (mut small, mut large) = ([0.0; SMALL], Vec::new());
        let lower = room(&mut small, &mut large, 6 * (sides.degree + 1));
        modes.tractions_from_parameters(own, 1.0, lower);
        sides.raise(lower, values);
    });
    let mut r = system.external.clone();
    system.springs.subtract_forces(&s[system.modes.parameters()..], &mut r);
    for (t, values) in tractions.iter().enumerate() {
        let sides = sides(t);
        if let Some(first) = sides.free(&system.unknowns) {
            for (i, first) in first.into_iter().enumerate() {
                for k in 0..=sides.degrees[i] {
                    let at = sides.at(i, k);
                    r[first + 2 * k] -= values[at];
                    r[first + 2 * k + 1] -= values[at + 1];
                }
            }
            continue;
        }
        for (at, components) in sides.rows(&system.unknowns) {
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
