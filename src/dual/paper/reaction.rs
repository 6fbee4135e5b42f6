//! The simplest distribution of reaction forces on Γ_K: Examples 1, 2 and 3 of Section 2.

use crate::problem::{Condition, Problem};
use crate::vector::cross;

/// Choice of λ̄ on Γ_K.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Reaction {
    /// Example 1, (2.2) and (2.3): T_n = g, T_t = 0 where rollers leave Ω'' a translation that Γ_K stops.
    Normal {
        /// g.
        value: f64,
    },
    /// Example 2, (2.5): T_n = 0, T_t = g_1 where Γ_K runs along that translation.
    Shear {
        /// g_1.
        value: f64,
    },
    /// Example 3, (2.6): T_n = g, T_t = 0 where Γ_K alone holds Ω''.
    Held {
        /// g.
        value: f64,
    },
    /// None of these configurations: T_t = 0 and whatever T_n makes the field least.
    Free,
}

/// Two directions are parallel up to this sine.
const PARALLEL: f64 = 1e-9;

impl Reaction {
    /// Recognises the configuration. Ω'' is the body without Γ_u, Ω' the one with it; x_1 is the direction of Γ_0.
    pub fn of(problem: &Problem) -> Self {
        let mesh = &problem.mesh;
        let [interface] = problem.interfaces.as_slice() else { return Reaction::Free };
        let Some(pair) = interface.pairs.first() else { return Reaction::Free };
        let [Some(a), Some(b)] = pair.edges else { return Reaction::Free };
        let bodies = [a, b].map(|e| mesh.edges[e].triangles[0].map_or(0, |t| mesh.body[t]));
        if problem.scene.bodies.len() != 2 || bodies[0] == bodies[1] || bonded(problem) {
            return Reaction::Free;
        }
        let straight = interface.pairs.iter().all(|p| cross(p.normal, pair.normal).abs() < PARALLEL);
        let clamped = bodies.map(|body| has(problem, body, |c| matches!(c, Condition::Clamped(_))));
        let second = match clamped {
            [true, false] => 1,
            [false, true] => 0,
            _ => return Reaction::Free,
        };
        if !straight {
            return Reaction::Free;
        }
        // n'' points out of Ω''.
        let sign = if second == 0 { 1.0 } else { -1.0 };
        let normal = pair.normal.map(|n| sign * n);
        let length: f64 = interface.pairs.iter().map(|p| p.length).sum();
        let v = applied(problem, bodies[second]);
        let mut direction: Option<[f64; 2]> = None;
        for (e, condition) in problem.conditions.iter().enumerate() {
            let Condition::Roller { direction: n, .. } = *condition else { continue };
            if mesh.edges[e].triangles[0].map(|t| mesh.body[t]) != Some(bodies[second]) {
                continue;
            }
            let along = [-n[1], n[0]];
            if direction.is_some_and(|d| cross(d, along).abs() > PARALLEL) {
                return Reaction::Free;
            }
            direction = Some(along);
        }
        let dot = |p: [f64; 2], q: [f64; 2]| p[0] * q[0] + p[1] * q[1];
        match direction {
            None => Reaction::Held { value: -dot(v, normal) / length },
            Some(d) if dot(normal, d).abs() > PARALLEL => {
                Reaction::Normal { value: -dot(v, d) / (dot(normal, d) * length) }
            }
            Some(d) => Reaction::Shear { value: -dot(v, d) / (dot([-normal[1], normal[0]], d) * length) },
        }
    }

    /// The example of the paper that this is.
    pub fn example(&self) -> Option<u8> {
        match self {
            Reaction::Normal { .. } => Some(1),
            Reaction::Shear { .. } => Some(2),
            Reaction::Held { .. } => Some(3),
            Reaction::Free => None,
        }
    }

    /// T_n of λ̄ on Γ_K where it is prescribed.
    pub fn normal(&self) -> Option<f64> {
        match *self {
            Reaction::Normal { value } | Reaction::Held { value } => Some(value),
            Reaction::Shear { .. } => Some(0.0),
            Reaction::Free => None,
        }
    }

    /// T_t of λ̄ on Γ_K, along the tangent that turns counter-clockwise from each side's outward normal.
    pub fn shear(&self) -> f64 {
        if let Reaction::Shear { value } = *self { value } else { 0.0 }
    }
}

/// V = ∫_{Ω''} F dx + ∫_{Γτ''} P ds of one body, per unit thickness.
pub fn applied(problem: &Problem, body: usize) -> [f64; 2] {
    let mesh = &problem.mesh;
    let mut v = [0.0; 2];
    for t in (0..mesh.triangles.len()).filter(|&t| mesh.body[t] == body) {
        let force = problem.force_on(t).of_area(mesh.area(t)).resultant();
        v = [v[0] + force[0], v[1] + force[1]];
    }
    for (e, condition) in problem.conditions.iter().enumerate() {
        let Condition::Traction(p) = condition else { continue };
        if mesh.edges[e].triangles[0].map(|t| mesh.body[t]) == Some(body) {
            let half = 0.5 * mesh.edge_frame(e).0;
            for (c, total) in v.iter_mut().enumerate() {
                *total += half * (p[0][c] + p[1][c]);
            }
        }
    }
    v
}

fn has(problem: &Problem, body: usize, is: impl Fn(&Condition) -> bool) -> bool {
    let of = |e: usize| problem.mesh.edges[e].triangles[0].map(|t| problem.mesh.body[t]);
    problem.conditions.iter().enumerate().any(|(e, c)| is(c) && of(e) == Some(body))
}

/// True if an edge joins triangles of different bodies.
fn bonded(problem: &Problem) -> bool {
    let mesh = &problem.mesh;
    mesh.edges.iter().any(|edge| matches!(edge.triangles, [Some(a), Some(b)] if mesh.body[a] != mesh.body[b]))
}
