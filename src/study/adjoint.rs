//! The problem whose load is what a quantity weighs displacements with, for the proof of its interval.

use super::{Certified, certify};
use crate::dual::{Condensed, Options};
use crate::elasticity::Initial;
use crate::element::Elements;
use crate::load::BodyForce;
use crate::problem::{Condition, Problem};
use crate::scene::{Extent, Quantity, Scene, Target};

/// Part of the energies that stands for their error where it is none but rounding.
const ROUNDING: f64 = 1e-12;

/// An adjoint problem that was solved on the mesh of another one.
#[derive(Debug)]
pub struct Adjoint {
    /// Problem, stress and displacement.
    pub certified: Certified,
    /// The multiple of the adjoint load at which the energies of both signs tell most of the quantity.
    pub step: f64,
}

/// Solves the problem with a unit load along a quantity that is a mean displacement, in the degrees of `known`; `None` of other quantities,
/// and where contact makes the energy no quadratic function of the loads.
pub fn adjoint(known: &Certified, quantity: &Quantity, options: &Options) -> Option<Adjoint> {
    let Certified { problem, dual, bracket, .. } = known;
    let Target::Displacement { of, direction } = &quantity.target else { return None };
    let is_body = |name: &str| problem.scene.bodies.iter().any(|body| body.name == name);
    let ambiguous = match of {
        Extent::Boundary(name) => is_body(name),
        Extent::Body(body) => problem.mesh.names.contains(&problem.scene.bodies[*body].name),
    };
    if ambiguous
        || !problem.scene.contacts.is_empty()
        || problem.section().is_revolved()
        || problem.has_polynomial_tractions()
    {
        return None;
    }
    let on = match of {
        Extent::Boundary(name) => problem.mesh.boundary(name),
        Extent::Body(_) => Vec::new(),
    };
    let is_free = |e: &usize| matches!(problem.conditions[*e], Condition::Traction(_));
    if !on.iter().all(is_free) {
        return None;
    }
    let mut draft = (*problem.scene).clone();
    for (b, body) in draft.bodies.iter_mut().enumerate() {
        let own = matches!(of, Extent::Body(of) if *of == b);
        body.body_force = if own { BodyForce::constant(*direction) } else { BodyForce::NONE };
        body.initial = Initial::default();
    }
    draft.tractions.clear();
    draft.quantities.clear();
    let at_rest = |(e, condition): (usize, &Condition)| match condition {
        Condition::Traction(_) => Condition::Traction([if on.contains(&e) { *direction } else { [0.0; 2] }; 2]),
        Condition::Clamped(_) => Condition::Clamped([[0.0; 2]; 2]),
        Condition::Roller { direction, .. } => Condition::Roller { direction: *direction, displacement: 0.0 },
        other => *other,
    };
    let conditions = problem.conditions.iter().enumerate().map(at_rest).collect();
    let own = Problem { scene: Scene::unchecked(draft), conditions, notes: Vec::new(), ..problem.clone() };
    let degrees = (0..dual.stress.len()).map(|t| dual.stress.degree(t) as u8).collect();
    let options = Options { elements: Elements::Blocks(degrees), ..options.clone() };
    let certified = certify(own, &Condensed::default(), &options).ok()?;
    let width = |of: &Certified| Some(of.bracket.free.as_ref().ok()?.upper() - of.bracket.lower());
    let weighed = |width: f64, of: &Certified| width.max(0.0) + ROUNDING * of.bracket.complementary.stored();
    let step = (weighed(width(known)?, known) / weighed(width(&certified)?, &certified)).sqrt();
    let [v, z] = [bracket, &certified.bracket].map(|bracket| bracket.free.as_ref().map(|free| &free.displacement));
    let (v, z) = (v.ok()?, z.ok()?);
    let alike =
        (0..v.len()).all(|t| v.degree(t) == z.degree(t) && dual.stress.degree(t) == certified.dual.stress.degree(t));
    (alike && step.is_finite() && step > 0.0).then_some(Adjoint { certified, step })
}
