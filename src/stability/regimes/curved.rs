//! Contact along curves, as polygons: convex, hollow, all round, and against a side of another shape.
//!
//! The truth of these rows comes from finer meshes, so that refinement has to keep the polygon: the curves are no circles, or
//! the contact has a gap along its length.

use std::f64::consts::{PI, TAU};

use super::super::known::Known;
use super::super::scenes::{Lift, Sketch, steps};
use super::{PLAIN, Regime};
use crate::problem::Problem;
use crate::scene::{Affine, Gap, Load, Normals, Traction};

/// Two blocks whose common side is a half-wave of height `rise`: the left one is convex, and hollow below zero.
fn wave(rise: f64, normals: Normals) -> Result<Problem, String> {
    let to = |[x, y]: [f64; 2]| [x + rise * (PI * y).sin() * x * (2.0 - x), y];
    let mut model = Lift { load: [1.5, -1.8], ..Lift::new(8) }.model().moved(to);
    model.scene.contacts[0].normals = normals;
    model.problem()
}

/// The roller takes up what the curve leaves of the vertical force.
fn wave_known(_: f64) -> Known {
    Known::forces(vec![[-0.6, f64::NAN]], 1.5)
}

/// A round end of height `rise` on a straight side with fewer edges, matched along the axis.
fn along(rise: f64) -> Result<Problem, String> {
    let lines = steps(0.0, 1.0, 8);
    let to = |[x, y]: [f64; 2]| [x - rise * x * (1.0 - (PI * y).sin()), y];
    let mut model = Sketch::new()
        .block("left", [1.0, 0.3], &lines, &lines)
        .moved(to)
        .block("right", [1.0, 0.3], &steps(1.0, 2.0, 5), &steps(0.0, 1.0, 5))
        .clamp("right_right")
        .roller("left_bottom")
        .push("left_left", 1.5, -1.8)
        .contact("left_right", "right_left", Gap::Constant(0.0));
    model.scene.contacts[0].direction = Some([1.0, 0.0]);
    model.problem()
}

/// Facets of the disc and its bore.
const FACETS: usize = 24;
/// Weight of the disc.
const WEIGHT: f64 = 1.0;

/// A disc (radii ½ and 1) in the bore of a plate that is clamped at radius 2, pressed down by its weight and turned by
/// tractions of size `couple` on its inner boundary.
fn bore(couple: f64, normals: Normals) -> Result<Problem, String> {
    let mut model = Sketch::new().body("disc", 1.0, 0.3).body("plate", 1.0, 0.3);
    ring(&mut model, "disc", [0.5, 1.0], ["hub", "rim"]);
    ring(&mut model, "plate", [1.0, 2.0], ["bore", "wall"]);
    let area = 0.375 * FACETS as f64 * (TAU / FACETS as f64).sin();
    model.scene.bodies[0].body_force = [0.0, -WEIGHT / area].into();
    let turning = Load::Affine(Affine { value: [0.0; 2], gradient: [[0.0, -couple], [couple, 0.0]] });
    model.scene.tractions.push(Traction { on: "hub".into(), load: turning, terms: Vec::new() });
    let mut model = model.clamp("wall").contact("rim", "bore", Gap::Table(vec![[0.0, 0.0]]));
    model.scene.contacts[0].normals = normals;
    model.problem()
}

/// A ring of [`FACETS`] by four cells.
fn ring(model: &mut Sketch, body: &str, [inner, outer]: [f64; 2], names: [&str; 2]) {
    const LAYERS: usize = 4;
    let base = model.raw.points.len();
    for layer in 0..=LAYERS {
        let radius = inner + (outer - inner) * layer as f64 / LAYERS as f64;
        let on = |i: usize| TAU * i as f64 / FACETS as f64;
        model.raw.points.extend((0..FACETS).map(|i| [radius * on(i).cos(), radius * on(i).sin()]));
    }
    let at = |layer: usize, i: usize| base + layer * FACETS + i % FACETS;
    for layer in 0..LAYERS {
        for i in 0..FACETS {
            let (a, b) = (at(layer, i), at(layer + 1, i));
            let (c, d) = (at(layer + 1, i + 1), at(layer, i + 1));
            let cut = if (i + layer) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
            model.raw.triangles.extend(cut.map(|t| (t, body.to_string())));
        }
    }
    for i in 0..FACETS {
        model.raw.segments.push(([at(0, i), at(0, i + 1)], names[0].to_string()));
        model.raw.segments.push(([at(LAYERS, i), at(LAYERS, i + 1)], names[1].to_string()));
    }
}

const RISES: &[f64] = &[0.0, 0.01, 0.05, 0.1, 0.2, 0.3];

const WAVE: Regime = Regime {
    parameter: "rise of the curve over its chord",
    values: RISES,
    reduced: &[0, 3],
    reported: "MOOSE #23802",
    known: wave_known,
    ..PLAIN
};

const BORE: Regime = Regime {
    parameter: "couple over weight and radius",
    values: &[0.0, 1e-6, 1e-3, 1.0],
    reduced: &[0, 2],
    reported: "MOOSE #33657, PR #33283",
    ..PLAIN
};

pub(super) const REGIMES: &[Regime] = &[
    Regime { id: "curved", title: "A curved contact, convex", build: |rise| wave(rise, Normals::Smooth), ..WAVE },
    Regime {
        id: "curved-hollow",
        title: "A curved contact, hollow",
        build: |rise| wave(-rise, Normals::Smooth),
        ..WAVE
    },
    Regime {
        id: "curved-facets",
        title: "A curved contact, every facet with its own normal",
        build: |rise| wave(rise, Normals::Facets),
        ..WAVE
    },
    Regime {
        id: "along",
        title: "Sides of different shape and edges, matched along a direction",
        parameter: "height of the round end over the straight one",
        values: RISES,
        reduced: &[0, 3],
        reported: "MOOSE #23802",
        build: along,
        known: |_| Known::forces(vec![[-0.6, 0.0]], 1.5),
        ..PLAIN
    },
    Regime {
        id: "bore",
        title: "A disc in its bore: it turns freely",
        build: |couple| bore(couple, Normals::Smooth),
        known: |couple| if couple == 0.0 { Known::forces(vec![[0.0, WEIGHT]], WEIGHT) } else { Known::none() },
        ..BORE
    },
    Regime {
        id: "bore-facets",
        title: "A disc in its bore, held by its facets",
        build: |couple| bore(couple, Normals::Facets),
        known: |_| Known::forces(vec![[0.0, WEIGHT]], WEIGHT),
        ..BORE
    },
];
