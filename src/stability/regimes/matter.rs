//! Bodies that are not isotropic, bodies that are warm, bodies on springs, and bodies with a crack.

use super::super::known::Known;
use super::super::scenes::{Lift, Sketch, steps};
use super::material::lift_known;
use super::{CLOSED, PLAIN, Regime};
use crate::elasticity::{Elasticity, Initial, Orthotropic};
use crate::load::BodyForce;
use crate::problem::Problem;
use crate::scene::{Gap, Load};

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

const SPRINGS: &[f64] = &[1.0, 1e3, 1e6, 1e9, 1e12, 1e-3, 1e-6, 1e-9, 1e-12];
const SLOPES: &[f64] = &[0.0, 1e-3, 1e-2, 0.1, 1.0, 1e2];

/// Two blocks pressed onto a wall of springs, with bending.
fn on_springs(stiffness: f64) -> Sketch {
    let lines = steps(0.0, 1.0, 8);
    let right: Vec<f64> = lines.iter().map(|x| 1.0 + x).collect();
    Sketch::new()
        .block("left", [1.0, 0.3], &lines, &lines)
        .block("right", [1.0, 0.3], &right, &lines)
        .springs("right_right", stiffness)
        .push("left_left", 1.0, -0.75)
        .contact("left_right", "right_left", Gap::Constant(0.0))
}

/// σ_xx = −(1 − ¾ y) everywhere: what bodies and springs store.
fn on_springs_known(stiffness: f64) -> Known {
    let strain = 0.5 * (2.0 * 0.91 + 1.0 / stiffness) * (1.0 - 0.75 + 0.75 * 0.25);
    Known {
        energy: Some([-strain, strain]),
        variation: vec![0.75],
        ..Known::forces(vec![[-(1.0 - 0.375), 0.0]], 1.0 - 0.375)
    }
}

/// A block that is pressed onto its crack, whose faces, two boundaries of one body, touch in the middle and part from there with this slope.
fn crack(slope: f64) -> Result<Problem, String> {
    let (xs, cracked) = (steps(0.0, 2.0, 16), |m: [f64; 2]| (m[0] - 1.0).abs() < 0.5);
    let mut model = Sketch::new()
        .block("low", [1.0, 0.3], &xs, &steps(0.0, 1.0, 8))
        .block("high", [1.0, 0.3], &xs, &steps(1.0, 2.0, 8))
        .bonded(|p| p[1] == 1.0 && (p[0] - 1.0).abs() >= 0.5)
        .renamed("low_top", "face", cracked)
        .renamed("high_bottom", "other_face", cracked)
        .clamp("low_bottom")
        .contact("face", "other_face", Gap::Table(vec![[0.0, 0.5 * slope], [0.5, 0.0], [1.0, 0.5 * slope]]));
    model.scene.bodies.truncate(1);
    model.raw.triangles.iter_mut().for_each(|(_, body)| *body = "low".into());
    model.raw.segments.retain(|(_, name)| name != "low_top" && name != "high_bottom");
    model.scene.tractions.push(crate::scene::Traction {
        on: "high_top".into(),
        load: Load::Pressure(1.0),
        terms: Vec::new(),
    });
    model.problem()
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
    Regime {
        id: "springs",
        title: "Springs from soft to stiff, pure bending",
        parameter: "stiffness times length over the modulus",
        truth: CLOSED,
        values: SPRINGS,
        reduced: &[0, 4, 8],
        build: |stiffness| on_springs(stiffness).problem(),
        known: on_springs_known,
        degrees: true,
        ..PLAIN
    },
    Regime {
        id: "crack-one-point",
        title: "Faces of a crack that close at one point",
        parameter: "slope of the gap on both sides of the point",
        values: SLOPES,
        reduced: &[0, 5],
        build: crack,
        known: |_| Known::forces(vec![[0.0, f64::NAN]], 2.0),
        degrees: true,
        ..PLAIN
    },
];
