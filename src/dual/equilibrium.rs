//! Equilibrium, measured on the stresses themselves.

use crate::element::StressField;
use crate::problem::{Condition, Problem};

/// How well a stress field balances the loads.
///
/// Remainders of traction are relative to the applied load, or to the largest stress in the triangles at the edge where that is
/// larger: a body that rests on a millionth of its side has a million times its load there, and its rounding errors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Equilibrium {
    /// Largest jump of traction across an interior edge or a closed pair, and largest shear on rollers and contacts.
    pub jump: f64,
    /// Largest difference between traction and applied traction.
    pub applied: f64,
    /// Largest resultant of boundary tractions and body force on any body, relative to the sum of their sizes.
    pub resultant: f64,
    /// Largest tension on a contact.
    pub tension: f64,
    /// The size of the applied load, as a traction.
    pub scale: f64,
    /// ∫ |what is left of equilibrium · displacement|: by how much the lower bound can be off, per unit thickness.
    pub work: f64,
}

impl Equilibrium {
    /// The largest of the four.
    pub fn residual(&self) -> f64 {
        self.jump.max(self.applied).max(self.resultant).max(self.tension)
    }

    /// Measures `stress` on `problem`; `moments` are those of the displacement that the remainders are weighed with.
    pub fn measure(problem: &Problem, stress: &StressField, moments: &[[[f64; 2]; 2]]) -> Self {
        let mesh = &problem.mesh;
        let bodies = problem.scene.bodies.len();
        let scale = load_scale(problem, || stress.clone());
        let stressed: Vec<f64> = (0..stress.len()).map(|t| largest(stress.block(t).as_flattened())).collect();
        let relative = |left: f64, e: usize| {
            let near = mesh.edges[e].triangles.iter().flatten().fold(scale, |m, &t| m.max(stressed[t]));
            if near > 0.0 { left / near } else { left }
        };
        let (mut jump, mut applied) = (0.0_f64, 0.0_f64);
        let mut force = vec![[0.0; 2]; bodies];
        let mut gross = vec![0.0; bodies];
        let (mut tension, mut work) = (0.0_f64, 0.0);
        for (e, edge) in mesh.edges.iter().enumerate() {
            let own = edge_traction(problem, stress, e, 0);
            let (length, normal) = mesh.edge_frame(e);
            let along = |t: [f64; 2]| {
                let shear = t[1] * normal[0] - t[0] * normal[1];
                [-shear * normal[1], shear * normal[0]]
            };
            let other = edge_traction(problem, stress, e, 1);
            for end in 0..2 {
                let left = match problem.conditions[e] {
                    Condition::Interior => [own[end][0] + other[end][0], own[end][1] + other[end][1]],
                    Condition::Traction(p) => [own[end][0] - p[end][0], own[end][1] - p[end][1]],
                    Condition::Clamped(_) => [0.0; 2],
                    Condition::Roller | Condition::Contact { .. } => along(own[end]),
                };
                match problem.conditions[e] {
                    Condition::Traction(_) => applied = applied.max(relative(norm(left), e)),
                    _ => jump = jump.max(relative(norm(left), e)),
                }
                work += norm(left) * norm(moments[e][end]);
            }
            let sides = usize::from(!edge.is_boundary()) + 1;
            for (side, triangle) in edge.triangles.iter().take(sides).enumerate() {
                // Interior edges between two bonded bodies count for both.
                let Some(t) = *triangle else { continue };
                let body = mesh.body[t];
                let between =
                    edge.triangles[1].is_some_and(|o| mesh.body[o] != mesh.body[edge.triangles[0].unwrap_or(o)]);
                if edge.is_boundary() || between {
                    let t = edge_traction(problem, stress, e, side);
                    for c in 0..2 {
                        force[body][c] += 0.5 * length * (t[0][c] + t[1][c]);
                    }
                    gross[body] += 0.5 * length * (norm(t[0]) + norm(t[1]));
                }
            }
        }
        for pair in problem.interfaces.iter().flat_map(|i| &i.pairs) {
            let Some(a) = pair.edges[0] else { continue };
            let at = |e: usize, v: usize| usize::from(mesh.edges[e].vertices[0] != v);
            let ta = edge_traction(problem, stress, a, 0);
            for end in 0..2 {
                let own = at(a, pair.first[end]);
                let normal = ta[own][0] * pair.normal[0] + ta[own][1] * pair.normal[1];
                let mut opening = moments[a][own];
                if let (Some(b), Some(second)) = (pair.edges[1], pair.second) {
                    let tb = edge_traction(problem, stress, b, 0);
                    let other = at(b, second[end]);
                    let left = norm([ta[own][0] + tb[other][0], ta[own][1] + tb[other][1]]);
                    jump = jump.max(relative(left, a));
                    work += left * norm(moments[b][other]);
                    opening = [opening[0] - moments[b][other][0], opening[1] - moments[b][other][1]];
                }
                tension = tension.max(relative(normal, a));
                let g = 0.5 * pair.length * pair.gap[end];
                work += normal.max(0.0) * (norm(opening) + g);
            }
        }
        for t in 0..mesh.triangles.len() {
            let body = mesh.body[t];
            let f = problem.scene.bodies[body].body_force;
            let area = mesh.area(t);
            for c in 0..2 {
                force[body][c] += f[c] * area;
            }
            gross[body] += norm(f) * area;
        }
        // A body without load carries nothing but rounding errors, which are not to be compared with each other.
        let least = 1e-3 * gross.iter().copied().fold(0.0, f64::max);
        let resultant = (0..bodies)
            .map(|b| if gross[b] > 0.0 { norm(force[b]) / f64::max(gross[b], least) } else { 0.0 })
            .fold(0.0, f64::max);
        Equilibrium { jump, applied, resultant, tension, scale, work }
    }
}

/// Traction of the stress on edge `e` at its two ends, as seen from its first or second triangle (outward normal of
/// that triangle).
pub fn edge_traction(problem: &Problem, stress: &StressField, e: usize, side: usize) -> [[f64; 2]; 2] {
    let mesh = &problem.mesh;
    let edge = &mesh.edges[e];
    let Some(t) = edge.triangles[side] else { return [[0.0; 2]; 2] };
    let sub = mesh.triangle_edges[t].iter().position(|&x| x == e).unwrap_or(0);
    let (_, n) = mesh.edge_frame(e);
    let sign = if side == 0 { 1.0 } else { -1.0 };
    let start = mesh.triangles[t][(sub + 1) % 3];
    [0, 1].map(|end| {
        let first = edge.vertices[end] == start;
        let tau = stress.at(t, sub, if first { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] });
        [sign * (tau[0] * n[0] + tau[2] * n[1]), sign * (tau[2] * n[0] + tau[1] * n[1])]
    })
}

/// The largest applied traction: P on Γ_τ, or what a body force adds up to across its body; where nothing is applied
/// (prescribed displacements alone), the largest of the stresses that `stress` gives.
pub fn load_scale(problem: &Problem, stress: impl FnOnce() -> StressField) -> f64 {
    let mut scale = 0.0_f64;
    for condition in &problem.conditions {
        if let Condition::Traction(p) = condition {
            scale = scale.max(norm(p[0])).max(norm(p[1]));
        }
    }
    let mut bounds =
        vec![[f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY]; problem.scene.bodies.len()];
    for t in 0..problem.mesh.triangles.len() {
        let b = &mut bounds[problem.mesh.body[t]];
        for p in problem.mesh.corners(t) {
            *b = [b[0].min(p[0]), b[1].min(p[1]), b[2].max(p[0]), b[3].max(p[1])];
        }
    }
    for (body, b) in problem.scene.bodies.iter().zip(&bounds) {
        if b[0].is_finite() {
            scale = scale.max(norm(body.body_force) * (b[2] - b[0]).min(b[3] - b[1]));
        }
    }
    if scale == 0.0 {
        let stress = stress();
        scale = (0..stress.len()).fold(0.0, |m, t| m.max(largest(stress.block(t).as_flattened())));
    }
    scale
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, v| m.max(v.abs()))
}

fn norm(v: [f64; 2]) -> f64 {
    v[0].hypot(v[1])
}
