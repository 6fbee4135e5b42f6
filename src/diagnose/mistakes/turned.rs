//! Mistakes in models of bodies of revolution: those of the axis, and constants that are off by a number.

use super::{initial, material, shift};
use crate::bounds::Sum;
use crate::compare::forces::cells;
use crate::compare::forces::functions::Functions;
use crate::compare::forces::tractions;
use crate::compare::forces::turned;
use crate::compare::forces::turned::Rule;
use crate::diagnose::Finding;
use crate::diagnose::Trial;
use crate::diagnose::fit::Terms;
use crate::diagnose::physical::is_mistyped;
use crate::diagnose::space::{Moduli, Space};
use crate::diagnose::words::factor;
use crate::element::Material;
use crate::problem::Problem;

/// How a model counts points and the hoop.
#[derive(Clone, Copy)]
struct Model {
    /// True if integrals carry the weight r; else its mean.
    weighted: bool,
    /// True if there is a hoop strain.
    hoop: bool,
}

const RIGHT: Model = Model { weighted: true, hoop: true };

/// Stress (rr, zz, tt, rz) of a strain, of the material of a body; `None` where it has no part.
type Law<'a> = dyn Fn(usize, [f64; 4]) -> Option<[f64; 4]> + 'a;

/// Makes columns of a body of revolution.
struct Columns<'a> {
    space: &'a Space<'a>,
    rule: Rule,
    /// ∫ r over ∫ 1, of all bodies.
    mean: f64,
}

/// The mistakes that are linear in nothing: the weight and the hoop.
pub fn trials(space: &Space<'_>) -> Vec<Trial> {
    let Some(columns) = Columns::new(space) else { return Vec::new() };
    let materials = space.problem().materials();
    let own = |body: usize, e: [f64; 4]| Some(materials[body].revolved().stress(e));
    let loads = [true, false].map(|weighted| space.column(columns.loads(weighted)));
    let trial = |name: &str, model: Model, weighted: bool, sentence: &str| {
        let stiffness = space.column(columns.stresses(&own, model));
        let load = &loads[usize::from(!weighted)];
        let left = columns.left(&stiffness, load, weighted);
        Trial { rank: 0, left, findings: vec![Finding::new(name, None, None, sentence)] }
    };
    let mut trials = vec![
        trial("revolution/hoop", Model { hoop: false, ..RIGHT }, true, "the hoop strain u_r/r is left out"),
        trial(
            "revolution/plane-strain",
            Model { hoop: false, weighted: false },
            false,
            "plane strain stands in place of a body of revolution",
        ),
        trial(
            "revolution/weight",
            Model { weighted: false, ..RIGHT },
            false,
            "the radius (the r of 2πr) is left out of all integrals",
        ),
        trial(
            "revolution/weight-of-stiffness",
            Model { weighted: false, ..RIGHT },
            true,
            "the radius is left out of the integrals of the stiffness",
        ),
        trial("revolution/weight-of-loads", RIGHT, false, "the radius is left out of the integrals of the loads"),
    ];
    let bodies = &space.problem().scene.bodies;
    let pulled = bodies.iter().any(|body| !body.body_force.is_none());
    let pressed = space.problem().pressed_edges().iter().any(|(_, load)| load.iter().flatten().any(|t| *t != 0.0));
    if pulled && pressed {
        trials.push(columns.light_body_forces(&own, &loads[0]));
    }
    trials.extend(columns.reduced(&own, pulled));
    trials.extend(shift::trial(space, |u| columns.hoop(u[0])));
    trials
}

/// Constants that are off by a number.
pub fn terms<'a>(space: &'a Space<'a>, terms: &mut Terms<'a>) {
    let Some(columns) = Columns::new(space) else { return };
    let bodies = &space.problem().scene.bodies;
    let part = |at: usize, law: &dyn Fn([f64; 4]) -> [f64; 4]| {
        space.column(columns.stresses(&|body, e| (body == at).then(|| law(e)), RIGHT))
    };
    initial::terms_of(space, terms, |of| columns.held(of));
    let shear =
        |body: usize, e: [f64; 4]| Some([0.0, 0.0, 0.0, space.problem().material(body).revolved().stress(e)[3]]);
    terms.push(1, vec![space.column(columns.stresses(&shear, RIGHT))], |x| {
        let sentence = factor("the shear stiffness of every body", 1.0 + x[0]);
        vec![Finding::new("stiffness/shear", Some(1.0 + x[0]), Some(1.0), sentence)]
    });
    for (b, body) in bodies.iter().enumerate().take(material::MOST_BODIES) {
        let law = space.problem().material(b).revolved();
        let own = move |e: [f64; 4]| law.stress(e);
        if bodies.len() > 1 {
            terms.push(1, vec![part(b, &own)], move |x| {
                let s = 1.0 + x[0];
                let (name, what, given) = match body.elasticity.isotropic() {
                    Some([young, _]) => ("young", "Young's modulus", young),
                    None => ("stiffness", "the stiffness", 1.0),
                };
                let sentence = factor(&format!("{what} of {}", body.name), s);
                vec![Finding::new(format!("body/{}/{name}", body.name), Some(s * given), Some(given), sentence)]
            });
        }
        let Some(given) = body.elasticity.isotropic() else { continue };
        let Moduli { lambda, mu, .. } = Moduli::of_body(space.problem(), body);
        let of_lambda = part(b, &|e| [1.0, 1.0, 1.0, 0.0].map(|i| i * (e[0] + e[1] + e[2])));
        let of_mu = part(b, &|e| e.map(|e| 2.0 * e));
        let kinematics = space.problem().scene.kinematics;
        terms.push(2, vec![of_lambda, of_mu], move |x| {
            let [young, found] = Moduli::engineering(kinematics, lambda + x[0], mu + x[1]);
            material::told(body, [young, found], given)
        });
    }
}

impl<'a> Columns<'a> {
    fn new(space: &'a Space<'a>) -> Option<Self> {
        let (problem, rule) = (space.problem(), space.solution.rule?);
        let mesh = &problem.mesh;
        let over = |of: &dyn Fn(usize) -> f64| (0..mesh.triangles.len()).map(of).collect::<Sum>().value();
        let volume = over(&|t| problem.section().volume(mesh.corners(t)));
        Some(Columns { space, rule, mean: volume / over(&|t| mesh.area(t)) })
    }

    fn problem(&self) -> &'a Problem {
        self.space.problem()
    }

    /// Part of the squared residual that is left where `stiffness` and `load` of another model should balance. In which unit of length or
    /// angle loads without their weight are counted is another question; but a model that carries none explains nothing, nor does one
    /// that leaves as much as its loads are.
    fn left(&self, stiffness: &[f64], load: &[f64], weighted: bool) -> f64 {
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let square = dot(load, load);
        let fitted = !weighted && square > 0.0;
        let scale = if fitted { dot(stiffness, load) / square } else { 1.0 };
        if fitted && !is_mistyped(scale) && !is_mistyped(scale * self.mean) {
            return 1.0;
        }
        let rest: f64 = stiffness.iter().zip(load).map(|(k, f)| (k - scale * f).powi(2)).sum();
        rest / self.space.whole()
    }

    /// Body forces without the radius, beside tractions with it.
    fn light_body_forces(&self, own: &Law<'_>, loads: &[f64]) -> Trial {
        let [weighted, light] = [true, false].map(|weighted| self.space.column(self.body_forces(weighted)));
        let stiffness = self.space.column(self.stresses(own, RIGHT));
        let others: Vec<f64> =
            stiffness.iter().zip(loads.iter().zip(&weighted)).map(|(k, (all, body))| k - (all - body)).collect();
        let sentence = "the radius is left out of the integrals of the body forces";
        let findings = vec![Finding::new("revolution/weight-of-body-forces", None, None, sentence)];
        Trial { rank: 0, left: self.left(&others, &light, false), findings }
    }

    /// Quadrilaterals with fewer points than they need, body forces with the same ones or as they are.
    fn reduced(&self, own: &Law<'_>, pulled: bool) -> Vec<Trial> {
        let cells = &self.space.solution.candidate.cells;
        let Some(points) = cells.iter().map(|cell| cells::full(&cell.field)).max() else { return Vec::new() };
        let fewer = points - 1;
        let other = Columns { rule: Rule { points: fewer, exact_loads: false, ..self.rule }, ..*self };
        let [full, reduced] = [self, &other].map(|columns| self.space.column(columns.stresses(own, RIGHT)));
        let [of_full, of_reduced] = [self, &other].map(|columns| self.space.column(columns.body_forces(true)));
        let sentence =
            format!("the quadrilaterals are integrated with {fewer} × {fewer} points in place of {points} × {points}");
        let trial = |loads: f64| {
            let change: Vec<f64> =
                (0..full.len()).map(|i| reduced[i] - full[i] - loads * (of_reduced[i] - of_full[i])).collect();
            let findings = vec![Finding::new("integration/reduced", None, None, sentence.clone())];
            Trial { rank: 0, left: self.space.left_with(&change), findings }
        };
        if pulled { vec![trial(1.0), trial(0.0)] } else { vec![trial(0.0)] }
    }

    /// Body forces, with the weight r or its mean.
    fn body_forces(&self, weighted: bool) -> Vec<[f64; 2]> {
        let (problem, candidate) = (self.problem(), self.space.solution.candidate);
        if weighted {
            return turned::body_forces(problem, candidate, self.rule, |b| &problem.scene.bodies[b].body_force);
        }
        let mut loads = vec![[0.0; 2]; self.space.count()];
        turned::points(problem, candidate, self.rule, |at| {
            let force = problem.section().force(problem.body_force(at.triangle), at.place);
            for (&node, (value, _)) in at.nodes.iter().zip(at.shapes) {
                (0..2).for_each(|c| loads[node][c] += at.weight * self.mean * value * force[c]);
            }
        });
        loads
    }

    /// Nodal forces ∫ s:e(φ) of the stress s that initial strains ask for, of bodies that have a material in `of`.
    fn held(&self, of: impl Fn(usize) -> Option<Material>) -> Vec<[f64; 2]> {
        let known: Vec<Option<Material>> = (0..self.problem().scene.bodies.len()).map(of).collect();
        self.summed(|at| {
            let material = known[at.body].as_ref().filter(|material| !material.initial().is_none())?;
            Some(material.revolved().stress(material.initial().around(at.place)))
        })
    }

    /// ∫ s:e(φ) of the nodes.
    fn stresses(&self, law: &Law<'_>, model: Model) -> Vec<[f64; 2]> {
        let candidate = self.space.solution.candidate;
        let mut forces = vec![[0.0; 2]; self.space.count()];
        let materials = self.problem().materials();
        turned::points(self.problem(), candidate, self.rule, |at| {
            let mut e = at.elastic(&materials[at.body]).0;
            if !model.hoop {
                e[2] = 0.0;
            }
            let Some(mut s) = law(at.body, e) else { return };
            if !model.hoop {
                s[2] = 0.0;
            }
            let weight = at.weight * if model.weighted { at.radius } else { self.mean };
            for (i, &node) in at.nodes.iter().enumerate() {
                let own = at.force(i, s);
                (0..2).for_each(|c| forces[node][c] += weight * own[c]);
            }
        });
        forces
    }

    /// ∫ s:e(φ) of the stress s of the hoop strain of the radial displacement `u` of all points.
    fn hoop(&self, u: f64) -> Vec<[f64; 2]> {
        let materials = self.problem().materials();
        self.summed(|at| Some(materials[at.body].revolved().stress([0.0, 0.0, u / at.radius, 0.0])))
    }

    /// ∫ s:e(φ) of the nodes for a stress at every point.
    fn summed(&self, stress: impl Fn(&turned::At<'_>) -> Option<[f64; 4]>) -> Vec<[f64; 2]> {
        turned::stress_forces(self.problem(), self.space.solution.candidate, self.rule, |_| true, stress)
    }

    /// All loads, with the weight r or its mean.
    fn loads(&self, weighted: bool) -> Vec<[f64; 2]> {
        let (problem, solution) = (self.problem(), self.space.solution);
        if weighted {
            return solution.forces.applied();
        }
        let mut loads = self.body_forces(false);
        for (e, traction) in problem.pressed_edges() {
            let own: Vec<[f64; 2]> = traction.iter().map(|t| t.map(|t| self.mean * t)).collect();
            tractions::add(problem, (e, &own), solution.candidate.degree, Functions::Values, &mut loads);
        }
        loads
    }
}
