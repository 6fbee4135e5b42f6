//! Equilibrium, measured on the stresses themselves.

use crate::element::StressField;
use crate::problem::{Condition, ContactPair, Problem, Scales};

/// How well a stress field balances the loads.
///
/// Remainders of traction are relative to the applied load, or to the largest stress in the triangles at the edge where that is
/// larger: a body that rests on a millionth of its side has a million times its load there, and its rounding errors.
/// What rounding of prescribed displacements leaves there ([`Scales::stress_round_off`]) is taken off first: where they
/// cause no stress, remainders and stresses are both nothing else.
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
        let scales = Scales::new(problem);
        let scale = load_scale(&scales, || stress.clone());
        let stressed: Vec<f64> = (0..stress.len()).map(|t| largest(stress.block(t).as_flattened())).collect();
        let relative = |left: f64, e: usize| {
            let at = mesh.edges[e].triangles.iter().flatten();
            let near = at.clone().fold(scale, |m, &t| m.max(stressed[t]));
            let rounding = at.fold(0.0_f64, |m, &t| m.max(scales.stress_round_off(problem, t)));
            let left = left - rounding;
            if left <= 0.0 {
                0.0
            } else if near > 0.0 {
                left / near
            } else {
                left
            }
        };
        let (mut jump, mut applied) = (0.0_f64, 0.0_f64);
        let mut force = vec![[0.0; 2]; bodies];
        let mut gross = vec![0.0; bodies];
        let mut rounding = vec![0.0; bodies];
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
                    Condition::Roller => along(own[end]),
                    Condition::Contact { interface, pair, side } => {
                        let pair = &problem.interfaces[interface].pairs[pair];
                        let vertices = if side == 0 { pair.first } else { pair.second.unwrap_or(pair.first) };
                        let at = usize::from(vertices[0] != edge.vertices[end]);
                        sideways(pair, at, own[end])
                    }
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
                let Some(at) = *triangle else { continue };
                let body = mesh.body[at];
                let between =
                    edge.triangles[1].is_some_and(|o| mesh.body[o] != mesh.body[edge.triangles[0].unwrap_or(o)]);
                if edge.is_boundary() || between {
                    let t = edge_traction(problem, stress, e, side);
                    for c in 0..2 {
                        force[body][c] += 0.5 * length * (t[0][c] + t[1][c]);
                    }
                    gross[body] += 0.5 * length * (norm(t[0]) + norm(t[1]));
                    rounding[body] += length * scales.stress_round_off(problem, at);
                }
            }
        }
        for pair in problem.interfaces.iter().flat_map(|i| &i.pairs) {
            let Some(a) = pair.edges[0] else { continue };
            let at = |e: usize, v: usize| usize::from(mesh.edges[e].vertices[0] != v);
            let ta = edge_traction(problem, stress, a, 0);
            for end in 0..2 {
                let own = at(a, pair.first[end]);
                let direction = &pair.direction;
                let normal = direction.multiplier(end, ta[own]);
                if !direction.is_constant() {
                    // A single t holds all along the pair; the other end is known by another value of it.
                    let other = direction.multiplier(1 - end, ta[1 - own]);
                    let left = 0.5 * (normal - other).abs();
                    jump = jump.max(relative(left, a));
                    work += left * norm(moments[a][own]);
                }
                let mut opening = moments[a][own];
                if let (Some(b), Some(second)) = (pair.edges[1], pair.second) {
                    let tb = edge_traction(problem, stress, b, 0);
                    let other = at(b, second[end]);
                    let [c, d] = direction.shares;
                    let left = norm([0, 1].map(|k| ta[own][k] / c + tb[other][k] / d)) * d;
                    jump = jump.max(relative(left, a).min(relative(left, b)));
                    work += left * norm(moments[b][other]);
                    opening = [0, 1].map(|k| c * opening[k] - d * moments[b][other][k]);
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
            .map(|b| match norm(force[b]) - rounding[b] {
                left if left > 0.0 => left / f64::max(gross[b], least),
                _ => 0.0,
            })
            .fold(0.0, f64::max);
        Equilibrium { jump, applied, resultant, tension, scale, work }
    }
}

/// The part of a traction across the direction of contact at an end of `pair`.
fn sideways(pair: &ContactPair, end: usize, t: [f64; 2]) -> [f64; 2] {
    let n = pair.direction.unit(end);
    let shear = t[1] * n[0] - t[0] * n[1];
    [-shear * n[1], shear * n[0]]
}

/// t at the two ends of `pair`, from the traction t n̂ of its first side.
pub fn contact_traction(problem: &Problem, stress: &StressField, pair: &ContactPair) -> [f64; 2] {
    let Some(e) = pair.edges[0] else { return [0.0; 2] };
    let t = edge_traction(problem, stress, e, 0);
    [0, 1].map(|end| {
        let at = usize::from(problem.mesh.edges[e].vertices[0] != pair.first[end]);
        pair.direction.multiplier(end, t[at])
    })
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

/// Stresses, relative to what prescribed displacements and gaps could cause, that are as good as none.
pub const LEAST_STRESS: f64 = 1e-3;

/// The largest applied traction: P on Γ_τ, or what a body force adds up to across its body; where nothing is applied
/// (prescribed displacements alone), the largest of the stresses that `stress` gives, or [`LEAST_STRESS`] where they
/// vanish.
pub fn load_scale(scales: &Scales, stress: impl FnOnce() -> StressField) -> f64 {
    if scales.traction > 0.0 {
        return scales.traction;
    }
    let stress = stress();
    let least = LEAST_STRESS * scales.data.stress;
    (0..stress.len()).fold(least, |m, t| m.max(largest(stress.block(t).as_flattened())))
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, v| m.max(v.abs()))
}

fn norm(v: [f64; 2]) -> f64 {
    v[0].hypot(v[1])
}
