//! Forces and moments of supports, by a displacement that moves the support alone.

use std::collections::BTreeSet;

use super::{Functional, Kind, NotBounded, RADIAL};
use crate::bounds::{NoUpperBound, holds_at, jumps, work};
use crate::element::Displacement;
use crate::element::geometry::gradients;
use crate::problem::Problem;
use crate::scene::SupportKind;

/// The cosine of a motion with the axis of a spring below which it is across it, but for rounding.
const ACROSS: f64 = 1e-14;

/// Adds ∫ T·j(w) over all springs, whose traction T is −k j(u), for a motion w by edge and vertex, linear between.
fn pull_springs(problem: &Problem, functional: &mut Functional, motion: impl Fn(usize, usize) -> [f64; 2]) {
    let mesh = &problem.mesh;
    for (pair, stiffness) in problem.bed_pairs() {
        let [a, b] = mesh.edges[pair.edge].vertices;
        let facing = |v: usize, end: usize| {
            let other = pair.opposite.map_or([0.0; 2], |e| motion(e, mesh.edges[e].vertices[1 - end]));
            let own = motion(pair.edge, v);
            [own[0] - other[0], own[1] - other[1]]
        };
        let pulled = [facing(a, 0), facing(b, 1)].map(|jump| {
            let mut force = [0.0; 2];
            for (axis, k) in pair.axes.iter().zip(stiffness) {
                let along = jump[0] * axis[0] + jump[1] * axis[1];
                if along.abs() > ACROSS * jump[0].hypot(jump[1]) {
                    (0..2).for_each(|c| force[c] -= k * along * axis[c]);
                }
            }
            force
        });
        if pulled != [[0.0; 2]; 2] {
            functional.load.tractions.push((pair.edge, pulled));
            let [first, last] = pulled.map(|force| force.map(|f| -f));
            functional.load.tractions.extend(pair.opposite.map(|e| (e, [last, first])));
        }
    }
}

/// The force or moment of a support, by the motion w that does unit work on it.
pub fn on_support(
    problem: &Problem,
    support: usize,
    kind: Kind,
    motion: impl Fn([f64; 2]) -> [f64; 2],
) -> Result<Functional, NotBounded> {
    let mesh = &problem.mesh;
    let name = &problem.scene.supports[support].on;
    let own: BTreeSet<usize> = mesh.boundary(name).into_iter().collect();
    if own.is_empty() {
        return Err(NotBounded::Empty { name: name.clone() });
    }
    if let SupportKind::Spring { .. } = problem.scene.supports[support].kind {
        let moved = |e: usize, v: usize| if own.contains(&e) { motion(mesh.points[v]) } else { [0.0; 2] };
        let mut functional = Functional::empty(problem, kind);
        pull_springs(problem, &mut functional, moved);
        return Ok(functional);
    }
    let prescribed = |e: usize, v: usize| {
        if own.contains(&e) { motion(mesh.points[v]).map(|w| -w) } else { [0.0; 2] }
    };
    let holds = holds_at(problem, prescribed).map_err(|error| match error {
        NoUpperBound::SupportsDisagree { x, y }
        | NoUpperBound::ForcedPenetration { x, y, .. }
        | NoUpperBound::PressedInside { x, y, .. } => NotBounded::Shared { x, y },
    })?;
    let mut vertex = vec![[0.0; 2]; mesh.points.len()];
    for v in own.iter().flat_map(|&e| mesh.edges[e].vertices) {
        vertex[v] = holds.vertices[v].impose([0.0; 2]);
    }
    if problem.section().is_revolved() && vertex.iter().any(|u| u[0] != 0.0) {
        return Err(NotBounded::Revolved { what: RADIAL });
    }
    let moved = Displacement::from_p1(mesh, &vertex);
    let mut functional = Functional::empty(problem, kind);
    pull_springs(problem, &mut functional, |_, v| vertex[v]);
    functional.constant = work(problem, &moved).value();
    add_strains(problem, &mut functional, &vertex, -1.0);
    let pairs = problem.pairs();
    for (weights, pair) in functional.load.weights.iter_mut().zip(pairs) {
        let along = jumps(problem, &moved, pair);
        if along.iter().any(|w| *w != 0.0) {
            *weights = along;
        }
    }
    Ok(functional.beside(problem))
}

/// Adds sign · ∫ τ:e(w), w being linear on triangles with the values `vertex`.
pub(super) fn add_strains(problem: &Problem, functional: &mut Functional, vertex: &[[f64; 2]], sign: f64) {
    let mesh = &problem.mesh;
    let young: Vec<f64> = problem.materials().iter().map(|material| material.young()[1]).collect();
    for (t, triangle) in mesh.triangles.iter().enumerate() {
        let u = triangle.map(|v| vertex[v]);
        if u == [[0.0; 2]; 3] {
            continue;
        }
        let g = gradients(mesh.corners(t));
        let d = |c: usize, x: usize| (0..3).map(|i| (u[i][c] - u[0][c]) * g[i][x]).sum::<f64>();
        let e = [d(0, 0), d(1, 1), 0.5 * (d(0, 1) + d(1, 0))];
        if problem.section().is_revolved() {
            let volume = problem.section().volume(mesh.corners(t));
            functional.load.turned.push((t, [0.0, sign * e[1], 0.0, sign * e[2]]));
            functional.natural += young[mesh.body[t]] * volume * (e[1] * e[1] + e[2] * e[2]);
            continue;
        }
        functional.load.strains.push((t, e.map(|e| sign * e)));
        functional.natural += young[mesh.body[t]] * mesh.area(t) * e.iter().map(|e| e * e).sum::<f64>();
    }
}
