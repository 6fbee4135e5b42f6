//! What pulls at a displacement.

use super::split::{self, load};
use crate::element::StressField;
use crate::problem::{Condition, Problem};

/// What pulls at a displacement: the energy is ½‖σ(v)‖²_a less the work of these.
#[derive(Debug, Clone, Copy)]
pub struct Pull<'a> {
    /// Body forces and tractions of the scene, times this.
    pub scene: f64,
    /// Forces ∫ σ : e(v) of a stress on every triangle.
    pub stress: Option<&'a StressField>,
}

impl Pull<'_> {
    /// The scene alone: the energy is 𝓛.
    pub const SCENE: Pull<'static> = Pull { scene: 1.0, stress: None };

    /// The forces on all coefficients of triangle `t` in degree `k`, but for tractions.
    pub(super) fn forces(&self, problem: &Problem, t: usize, k: usize) -> Vec<f64> {
        let corners = problem.mesh.corners(t);
        let force = problem.scene.bodies[problem.mesh.body[t]].body_force;
        let mut forces = load(problem.section(), k, corners, force.map(|f| self.scene * f));
        if let Some(stress) = self.stress {
            split::pull(k, corners, stress, t, &mut forces);
        }
        forces
    }

    /// The traction of the scene at the ends of edge `e`, where it pulls.
    pub(super) fn traction(&self, problem: &Problem, e: usize) -> Option<[[f64; 2]; 2]> {
        match problem.conditions[e] {
            Condition::Traction(ends) if self.scene != 0.0 => Some(ends.map(|p| p.map(|p| self.scene * p))),
            _ => None,
        }
    }
}
