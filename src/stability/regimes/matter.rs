//! Bodies that are not isotropic, and bodies that are warm.

use super::super::known::Known;
use super::super::scenes::{Lift, Sketch, steps};
use super::material::lift_known;
use super::{PLAIN, Regime};
use crate::elasticity::{Elasticity, Initial, Orthotropic};
use crate::load::BodyForce;

const STIFF: &[f64] = &[1.0, 1e2, 1e4, 1e6];
const SOFT: &[f64] = &[0.1, 1e-2, 1e-4, 1e-6, 1e-8];
const LEFT: &[f64] = &[1.0, 1e-3, 1e-6, 1e-9];

/// Both blocks of [`Lift`] of one material.
fn lift(law: Orthotropic) -> Sketch {
    let mut model = Lift::new(8).model();
    model.scene.bodies.iter_mut().for_each(|body| body.elasticity = Elasticity::Orthotropic(law));
    model
}

/// Fibres at 45°.
fn fibres(ratio: f64) -> Sketch {
    lift(Orthotropic { young: [ratio, 1.0, 1.0], poisson: [0.3; 3], shear: 0.4, angle: 45.0 })
}

/// Compliances of the normal strains whose rows add up to `soft` times the first: zero would be a body without change of volume.
fn nearly_incompressible(soft: f64) -> Sketch {
    let s: [f64; 3] = [1.0, 0.8, 1.1];
    let off = |i: usize, j: usize, k: usize| 0.5 * (s[i] + s[j] - s[k]) * (1.0 - soft);
    let poisson = [off(0, 1, 2) / s[0], off(0, 2, 1) / s[0], off(1, 2, 0) / s[1]];
    lift(Orthotropic { young: s.map(|s| 1.0 / s), poisson, shear: 0.3, angle: 30.0 })
}

/// A warm bar between a wall and a rigid obstacle, pulled from the obstacle by a body force that leaves `left` of the thermal pressure one.
fn balanced(left: f64) -> Sketch {
    let mut model = Sketch::new()
        .block("bar", [1.0, 0.0], &steps(0.0, 2.0, 8), &steps(0.0, 1.0, 4))
        .roller("bar_left")
        .roller("bar_bottom")
        .rigid("bar_right");
    // p = EαT − FL/2.
    let body = &mut model.scene.bodies[0];
    body.initial = Initial { expansion: [1e-3; 3], temperature: 1e3, ..Initial::default() };
    body.body_force = BodyForce::constant([-(1.0 - left), 0.0]);
    model
}

pub(super) const REGIMES: &[Regime] = &[
    Regime {
        id: "fibres",
        title: "Stiff fibres at 45°, part of the contact open",
        parameter: "E1 over E2",
        values: STIFF,
        reduced: &[0, 3],
        build: |ratio| fibres(ratio).problem(),
        known: |_| lift_known(),
        degrees: true,
        ..PLAIN
    },
    Regime {
        id: "orthotropic-soft",
        title: "Nearly incompressible and orthotropic, part of the contact open",
        parameter: "what is left of the change of volume",
        values: SOFT,
        reduced: &[0, 4],
        build: |soft| nearly_incompressible(soft).one_way().problem(),
        known: |_| lift_known(),
        flat: Some(3.0),
        degrees: true,
        ..PLAIN
    },
    Regime {
        id: "balanced",
        title: "A temperature that all but balances the load",
        parameter: "pressure over that of the temperature alone",
        values: LEFT,
        reduced: &[0, 3],
        build: |left| balanced(left).problem(),
        known: |left| Known::forces(vec![[-left, 0.0]], 1.0).indeterminate(),
        ..PLAIN
    },
];
