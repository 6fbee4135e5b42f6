//! Loads that pull at a displacement.

use super::split::{self, load};
use crate::bounds::springs::OnSprings;
use crate::element::StressField;
use crate::element::geometry::sub_corners;
use crate::element::revolved::{Held, Tensor};
use crate::load::{Affine, BodyForce};
use crate::problem::{Condition, Problem};

/// Loads that pull at a displacement: the energy is ½‖σ(v)‖²_a less their work.
#[derive(Debug, Clone, Copy)]
pub struct Pull<'a> {
    /// Body forces and tractions of the scene, times this.
    pub scene: f64,
    /// True if the initial strains of the scene pull too: forces ∫ cε0 : e(v).
    pub initial: bool,
    /// Forces ∫ σ : e(v) of a stress on every triangle. In a body of revolution it is one that balances minus the body forces of the
    /// scene times [`Self::scene`].
    pub stress: Option<&'a StressField>,
    /// Work ∫ f j(v) of forces on the jumps of springs.
    pub springs: Option<&'a OnSprings>,
    /// In a body of revolution the terms of a stress that its weighted form leaves out.
    pub beside: Option<Beside<'a>>,
}

/// Terms of a stress in a body of revolution that its weighted form leaves out, times a factor.
#[derive(Debug, Clone, Copy)]
pub struct Beside<'a> {
    /// The factor.
    pub factor: f64,
    /// Body forces of which the radial part is in the hoop stress, by body.
    pub forces: &'a [BodyForce],
    /// Constant stresses (rr, zz, tt, rz) of triangles, in their order.
    pub stresses: &'a [(usize, Tensor)],
}

impl Beside<'_> {
    fn add(&self, problem: &Problem, t: usize, k: usize, forces: &mut [f64]) {
        let (section, corners, factor) = (problem.section(), problem.mesh.corners(t), self.factor);
        let [value, slope] = section.radial(&self.forces[problem.mesh.body[t]]);
        if [value, slope] != [0.0; 2] {
            let axis = section.axis().unwrap_or(0.0);
            let value = [factor * (value - slope * axis), 0.0];
            let radial = BodyForce::affine(Affine { value, gradient: [[factor * slope, 0.0], [0.0; 2]] });
            forces.iter_mut().zip(load(section, k, corners, &radial)).for_each(|(f, own)| *f += own);
        }
        if let Ok(at) = self.stresses.binary_search_by_key(&t, |(t, _)| *t) {
            let stress = self.stresses[at].1.map(|s| factor * s);
            split::pull_linear(section, k, corners, |_, _| stress, forces);
        }
    }
}

impl Pull<'_> {
    /// The scene alone: the energy is 𝓛.
    pub const SCENE: Pull<'static> = Pull { scene: 1.0, initial: true, stress: None, springs: None, beside: None };

    /// The forces on all coefficients of triangle `t` in degree `k`, but for tractions.
    pub(in crate::bounds::upper) fn forces(&self, problem: &Problem, t: usize, k: usize) -> Vec<f64> {
        let corners = problem.mesh.corners(t);
        if let (Some(revolved), Some(stress)) = (problem.section().revolved(), self.stress) {
            // The hoop stress takes up the radial body force: what is left of that is none.
            let [_, axial] = problem.section().forces(problem.body_force(t));
            let axial = BodyForce::constant([0.0, self.scene * axial]);
            let mut forces = load(problem.section(), k, corners, &axial);
            split::pull_revolved(k, corners, &revolved.stresses_on(stress, t, corners, &BodyForce::NONE), &mut forces);
            if let Some(beside) = &self.beside {
                beside.add(problem, t, k, &mut forces);
            }
            return forces;
        }
        let mut forces = load(problem.section(), k, corners, &problem.body_force(t).times(self.scene));
        let body = problem.mesh.body[t];
        if self.initial && !problem.scene.bodies[body].initial.is_none() {
            let material = problem.material(body);
            if problem.section().is_revolved() {
                let law = material.revolved();
                if let Some(held) = Held::on(&material, corners) {
                    let stress = |sub: usize, l: [f64; 3]| law.stress(held.at(sub, l));
                    split::pull_linear(problem.section(), k, corners, stress, &mut forces);
                }
                return forces;
            }
            let mut held = StressField::zeros(1, 1);
            let places = (0..3).flat_map(|sub| sub_corners(corners, sub));
            held.block_mut(0).iter_mut().zip(places).for_each(|(s, x)| *s = material.stress(material.initial().at(x)));
            split::pull(k, corners, &held, 0, &mut forces);
        }
        if let Some(stress) = self.stress {
            split::pull(k, corners, stress, t, &mut forces);
        }
        forces
    }

    /// The traction of the scene at the ends of edge `e`, where it pulls.
    pub(in crate::bounds::upper) fn traction(&self, problem: &Problem, e: usize) -> Option<[[f64; 2]; 2]> {
        match problem.conditions[e] {
            Condition::Traction(ends) if self.scene != 0.0 => Some(ends.map(|p| p.map(|p| self.scene * p))),
            _ => None,
        }
    }
}
