//! Contact: almost lost, at one point, at its limits, with and without other supports.

use super::super::known::Known;
use super::super::scenes::{Lift, Sketch, steps};
use super::super::strips::Strips;
use super::material::lift_known;
use super::{CLOSED, PLAIN, Regime};
use crate::load::{Affine, BodyForce};
use crate::problem::Problem;
use crate::scene::{Contact, ContactSides, Gap};

/// Resultant ε of the load: contact is lost at ε = 0.
fn almost_lost(epsilon: f64) -> Result<Problem, String> {
    Lift { load: [3.5 + epsilon, -7.0], ..Lift::new(8) }.model().problem()
}

fn almost_lost_known(epsilon: f64) -> Known {
    if epsilon < 0.0 { Known::none() } else { Known::forces(vec![[-((3.5 + epsilon) - 3.5), 0.0]], 4.0) }
}

/// A gap that opens from the middle of the side to both ends.
fn wedge(slope: f64) -> Result<Problem, String> {
    let gap = Gap::Table(vec![[0.0, 0.5 * slope], [0.5, 0.0], [1.0, 0.5 * slope]]);
    Lift { load: [1.0, 0.0], gap, ..Lift::new(8) }.model().problem()
}

fn rotating(b: f64) -> Result<Problem, String> {
    Lift { load: [4.0, -b], ..Lift::new(8) }.model().problem()
}

/// A free block pressed with force one, its line of action off the middle by `offset`.
fn free_block(offset: f64) -> Result<Problem, String> {
    let lines = steps(0.0, 1.0, 8);
    let b = 12.0 * offset;
    let right: Vec<f64> = lines.iter().map(|x| 1.0 + x).collect();
    Sketch::new()
        .block("left", [1.0, 0.3], &lines, &lines)
        .block("right", [1.0, 0.3], &right, &lines)
        .clamp("right_right")
        .push("left_left", 1.0 - 0.5 * b, b)
        .contact("left_right", "right_left", Gap::Constant(0.0))
        .problem()
}

fn free_block_known(offset: f64) -> Known {
    if offset >= 0.5 { Known::none() } else { Known::forces(vec![[-1.0, 0.0]], 1.0) }
}

fn long_row(k: f64) -> Strips {
    let k = k as usize;
    let mut row = Strips::new(2);
    row.materials = vec![[1.0, 0.3]; k];
    row.cells = (2, vec![2; k]);
    row
}

fn grazing(t: f64) -> Strips {
    Strips { load: [1.0, -t], ..Strips::new(4) }
}

/// A gap that is zero at every other vertex of the contact and `height` between them.
fn waves(height: f64) -> Result<Problem, String> {
    let at = |i: usize| [i as f64 / 8.0, if i.is_multiple_of(2) { 0.0 } else { height }];
    Lift { gap: Gap::Table((0..=8).map(at).collect()), ..Lift::new(8) }.model().problem()
}

/// A unit bar without lateral strain, held at its left end and pulled to the right by its weight 1. Without an obstacle
/// its right end would move by ½; the obstacle stands `closing` short of that.
fn hair(closing: f64) -> Result<Problem, String> {
    let lines = steps(0.0, 1.0, 4);
    let mut model = Sketch::new().block("bar", [1.0, 0.0], &lines, &lines).roller("bar_left").roller("bar_bottom");
    model.scene.bodies[0].body_force = [1.0, 0.0].into();
    let sides = ContactSides::Rigid("bar_right".into());
    model.scene.contacts.push(Contact::new(sides, Gap::Constant(0.5 - closing)));
    model.problem()
}

/// σ = 1 − x − p with the pressure p, and E = −1/6 + ½p². Statics alone does not give p.
fn hair_known(closing: f64) -> Known {
    let p = closing.max(0.0);
    let energy = -1.0 / 6.0 + 0.5 * p * p;
    let strain = 0.5 * (1.0 / 3.0 - p + p * p);
    Known { energy: Some([energy, strain]), ..Known::forces(vec![[f64::NAN, 0.0]], 1.0) }
}

/// The bar in a centrifuge, between its left end and an obstacle that it touches: the axis lies `radius` to the left, and its weight is one
/// in all. Far away the force is as good as constant.
fn centrifuge(radius: f64) -> Result<Problem, String> {
    let lines = steps(0.0, 1.0, 4);
    let mut model = Sketch::new().block("bar", [1.0, 0.0], &lines, &lines).roller("bar_left").roller("bar_bottom");
    let slope = 1.0 / (radius + 0.5);
    let force = Affine { value: [radius * slope, 0.0], gradient: [[slope, 0.0], [0.0; 2]] };
    model.scene.bodies[0].body_force = BodyForce::affine(force);
    model.rigid("bar_right").problem()
}

/// σ = (R(1 − x) + ½(1 − x²))/(R + ½) − p, whose mean is zero.
fn centrifuge_known(radius: f64) -> Known {
    let p = (0.5 * radius + 1.0 / 3.0) / (radius + 0.5);
    // ∫ σ² of the two parts of σ + p, and what p takes of it.
    let square = (radius * radius / 3.0 + 5.0 / 12.0 * radius + 2.0 / 15.0) / (radius + 0.5).powi(2);
    let strain = 0.5 * (square - p * p);
    Known { energy: Some([-strain, strain]), ..Known::forces(vec![[f64::NAN, 0.0]], 1.0) }
}

/// Contacts that meet supports and each other.
fn meeting(variant: f64) -> Result<Problem, String> {
    let model = Lift::new(8).model();
    let model = match variant as usize {
        0 => model,
        1 => model.clamp("right_bottom"),
        2 => model.roller("left_top").roller("right_bottom"),
        3 => {
            let upper = |m: [f64; 2]| m[1] > 0.5;
            model.renamed("left_right", "left_upper", upper).renamed("right_left", "right_upper", upper).contact(
                "left_upper",
                "right_upper",
                Gap::Constant(0.0),
            )
        }
        4 => model.renamed("left_bottom", "left_foot", |m| m[0] > 0.5).rigid("left_foot"),
        _ => model.rigid("left_top"),
    };
    model.problem()
}

fn meeting_known(variant: f64) -> Known {
    match variant as usize {
        // A second contact or support shares the force, or adds one that statics does not know.
        2 => Known::forces(vec![[-0.5, 0.0]], 4.0),
        3 => Known::forces(vec![[f64::NAN, 0.0]; 2], 4.0),
        4 | 5 => Known::forces(vec![[-0.5, 0.0], [0.0, f64::NAN]], 4.0),
        _ => lift_known(),
    }
}

pub(super) const REGIMES: &[Regime] = &[
    Regime {
        id: "loss",
        title: "Towards loss of contact, and beyond",
        parameter: "resultant of the load; below 0 there is no equilibrium",
        reported: "cane PR #8, MOOSE PR #14188",
        values: &[0.5, 0.1, 1e-3, 1e-6, 1e-9, 1e-12, 0.0, -1e-6, -1e-3, -1.0],
        reduced: &[0, 4, 8],
        build: almost_lost,
        known: almost_lost_known,
        ..PLAIN
    },
    Regime {
        id: "one-point",
        title: "Contact that shrinks to one point",
        parameter: "slope of the gap on both sides of the point",
        reported: "cane PR #8, MOOSE PR #14188",
        values: &[0.0, 1e-3, 1e-2, 0.1, 1.0, 1e2, 1e4],
        reduced: &[0, 5],
        build: wedge,
        known: |_| Known::forces(vec![[-1.0, 0.0]], 1.0),
        ..PLAIN
    },
    Regime {
        id: "moving-end",
        title: "End of contact crossing vertices",
        parameter: "slope of the load",
        reported: "MOOSE #10950, #14241; Kratos PR #14685",
        values: &[4.0, 4.5, 5.0, 5.5, 6.0, 6.25, 6.5, 6.75, 7.0, 7.25, 7.5, 7.75, 7.9],
        reduced: &[0, 10],
        build: rotating,
        known: |b| Known::forces(vec![[-(4.0 - 0.5 * b), 0.0]], 4.0),
        degrees: true,
        ..PLAIN
    },
    Regime {
        id: "grazing",
        title: "Pressure that touches zero at the end of a closed contact",
        parameter: "drop of the pressure along the contact; 1 reaches zero",
        reported: "MOOSE #10950, #14241; Kratos PR #14685",
        truth: CLOSED,
        values: &[0.5, 0.9, 0.999, 0.999999, 0.999999999, 1.0],
        reduced: &[0, 5],
        build: |t| grazing(t).model().problem(),
        known: |t| grazing(t).known(),
        ..PLAIN
    },
    Regime {
        id: "contact-alone",
        title: "A body held by contact alone, off-centre load",
        parameter: "offset of the force from the middle; from 0.5 on there is no equilibrium",
        reported: "4C #1585",
        values: &[0.0, 0.1, 0.166, 0.3, 0.4, 0.45, 0.49, 0.499, 0.51, 0.6],
        reduced: &[0, 6, 9],
        build: free_block,
        known: free_block_known,
        ..PLAIN
    },
    Regime {
        id: "many-contacts",
        title: "Bodies in a row, each held by contact, pure bending",
        parameter: "bodies",
        reported: "4C #1585",
        truth: CLOSED,
        values: &[2.0, 4.0, 8.0, 16.0, 32.0],
        reduced: &[0, 2],
        build: |k| long_row(k).model().problem(),
        known: |k| long_row(k).known(),
        ..PLAIN
    },
    Regime {
        id: "redundant",
        title: "Contacts that end on supports, meet each other, or hold twice",
        parameter: "variant",
        reported: "MOOSE #31836, #33493",
        values: &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0],
        labels: &["ends on Γ_0", "ends on Γ_u", "Γ_0 on all sides", "in two parts", "floor half contact", "held above"],
        reduced: &[0, 3, 4],
        build: meeting,
        known: meeting_known,
        ..PLAIN
    },
    Regime {
        id: "gap",
        title: "A gap between zero and wide",
        parameter: "initial gap",
        reported: "MOOSE #10950",
        values: &[0.0, 1e-12, 1e-9, 1e-6, 1e-3, 0.1, 1.0, 1e3],
        reduced: &[0, 4],
        build: |gap| Lift { gap: Gap::Constant(gap), ..Lift::new(8) }.model().problem(),
        known: |_| lift_known(),
        ..PLAIN
    },
    Regime {
        id: "centrifuge",
        title: "A bar in a centrifuge, pressed against its wall",
        parameter: "distance of the axis, in lengths of the bar",
        reported: "the digits of a force that is nearly constant",
        truth: CLOSED,
        values: &[0.0, 1.0, 1e3, 1e6, 1e9, 1e12],
        reduced: &[0, 3, 5],
        build: centrifuge,
        known: centrifuge_known,
        ..PLAIN
    },
    Regime {
        id: "hair",
        title: "A gap that just closes, or just stays open",
        parameter: "closing beyond the gap; below 0 it stays open",
        reported: "MOOSE #10950",
        truth: CLOSED,
        values: &[0.1, 1e-3, 1e-6, 1e-9, 1e-12, 0.0, -1e-12, -1e-9, -1e-6, -1e-3, -0.1],
        reduced: &[0, 4, 6],
        build: hair,
        known: hair_known,
        ..PLAIN
    },
    Regime {
        id: "between-nodes",
        title: "Two bodies that may not penetrate at nodes nor between them",
        parameter: "height of the waves of the gap, one every two edges",
        reported: "MOOSE #14454, #30098",
        values: &[0.0, 1e-4, 1e-3, 1e-2, 0.1, 1.0],
        reduced: &[0, 3],
        build: waves,
        known: |_| lift_known(),
        ..PLAIN
    },
];
