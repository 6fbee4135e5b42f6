//! Meshes: slivers, fans, distortion, numbering, sides that do not match, coarse and fine.

use super::super::known::Known;
use super::super::scenes::{Lift, Random, Sketch, polygon, steps};
use super::super::strips::Strips;
use super::material::lift_known;
use super::{CLOSED, PLAIN, Regime};
use crate::problem::Problem;

const ASPECT: &[f64] = &[2.0, 10.0, 1e2, 1e3, 1e4, 1e5, 1e6];

/// Lines x of a block whose last column, at the contact, is thinner than high by the factor `aspect`.
fn layered(aspect: f64) -> [f64; 6] {
    [0.0, 0.25, 0.5, 0.75, 1.0 - 0.25 / aspect, 1.0]
}

/// A vertex at the contact's side moved to δ of a cell from it: flat triangles with an obtuse angle near 180°.
fn fan(delta: f64) -> Result<Problem, String> {
    let h = 0.125;
    let to = |p: [f64; 2]| {
        let near = |q: [f64; 2]| (p[0] - q[0]).abs() < 1e-9 && (p[1] - q[1]).abs() < 1e-9;
        if near([1.0 - h, 0.5 + h]) { [1.0 - delta * h, 0.5 + 0.5 * h] } else { p }
    };
    Lift::new(8).model().moved(to).problem()
}

fn distorted(amount: f64) -> Result<Problem, String> {
    let mut random = Random(7);
    let mut shifts = std::iter::repeat_with(move || [random.signed(), random.signed()]);
    let mut model = Lift::new(8).model();
    for p in &mut model.raw.points {
        let shift = shifts.next().unwrap_or_default();
        let inside = |x: f64| x % 1.0 > 1e-9 && x % 1.0 < 1.0 - 1e-9;
        if inside(p[0]) && inside(p[1]) {
            *p = [p[0] + amount * 0.125 * shift[0], p[1] + amount * 0.125 * shift[1]];
        }
    }
    model.problem()
}

/// Cells along the two sides for each step.
const SIDES: [[usize; 2]; 8] = [[10, 10], [100, 101], [10, 11], [10, 15], [10, 20], [10, 30], [10, 50], [10, 100]];
const SIDE_LABELS: &[&str] = &["1:1", "1:1.01", "1:1.1", "1:1.5", "1:2", "1:3", "1:5", "1:10"];
const SIDE_STEPS: &[f64] = &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];

fn sides(step: f64) -> [usize; 2] {
    SIDES[(step as usize).min(SIDES.len() - 1)]
}

fn unmatched(step: f64) -> Result<Problem, String> {
    let [a, b] = sides(step);
    Lift::new(4).on(&steps(0.0, 1.0, 4), [&steps(0.0, 1.0, a), &steps(0.0, 1.0, b)]).problem()
}

fn unmatched_row(step: f64) -> Strips {
    let [a, b] = sides(step);
    Strips { cells: (4, vec![a, b]), ..Strips::new(4) }
}

/// The right block stands out above the left one by δ: its side ends inside an edge.
fn overlapping(delta: f64) -> Result<Problem, String> {
    let lines = steps(0.0, 1.0, 4);
    Lift::new(4).on(&lines, [&lines, &steps(0.0, 1.0 + delta, 4)]).problem()
}

fn beam(length: f64) -> Strips {
    Strips { length, cells: (length as usize, vec![1; 2]), ..Strips::new(1) }
}

fn corner(size: f64) -> Result<Problem, String> {
    Sketch::new().body("angle", 1.0, 0.3).roller("side").pressure("top", 1.0).rigid("foot").polygons(
        vec![polygon(
            "angle",
            &[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]],
            &["foot", "", "", "", "top", "side"],
        )],
        size,
    )
}

/// A square, cut from its left side to the middle.
fn slit(shear: f64) -> Result<Problem, String> {
    let (xs, left) = (steps(0.0, 1.0, 8), |m: [f64; 2]| m[0] < 0.5);
    let mut model = Sketch::new()
        .block("lower", [1.0, 0.3], &xs, &steps(0.0, 0.5, 4))
        .block("upper", [1.0, 0.3], &xs, &steps(0.5, 1.0, 4))
        .bonded(|p| p[1] == 0.5 && p[0] >= 0.5)
        .renamed("lower_top", "slit_lower", left)
        .renamed("upper_bottom", "slit_upper", left)
        .clamp("lower_bottom")
        .contact("slit_lower", "slit_upper", crate::scene::Gap::Constant(0.0));
    model.scene.tractions.push(crate::scene::Traction {
        on: "upper_top".into(),
        load: crate::scene::Load::Affine(crate::scene::Affine { value: [shear, -1.0], gradient: [[0.0; 2]; 2] }),
        terms: Vec::new(),
    });
    // Names that bonded edges no longer need would only be remarked on.
    model.raw.segments.retain(|(_, name)| name != "lower_top" && name != "upper_bottom");
    model.problem()
}

fn unequal_row(n: f64) -> Strips {
    let n = n as usize;
    let mut row = Strips::new(n);
    row.materials = vec![[1.0, 0.3], [100.0, 0.3]];
    row
}

pub(super) const REGIMES: &[Regime] = &[
    Regime {
        id: "slivers",
        title: "Slivers along the contact, part of it open",
        parameter: "aspect ratio of the triangles at the contact",
        reported: "cfsem-py PR #37, MOOSE PR #33268",
        values: ASPECT,
        reduced: &[0, 5],
        promised: 6,
        build: |aspect| Lift::new(4).on(&layered(aspect), [&steps(0.0, 1.0, 4); 2]).problem(),
        known: |_| lift_known(),
        flat: Some(3.0),
        degrees: true,
        ..PLAIN
    },
    Regime {
        id: "slivers-exact",
        title: "Slivers along the contact, pure bending",
        parameter: "aspect ratio of the triangles at the contact",
        reported: "cfsem-py PR #37, MOOSE PR #33268",
        truth: CLOSED,
        values: ASPECT,
        reduced: &[0, 5, 6],
        promised: 6,
        build: |aspect| Strips::new(4).on(&layered(aspect)).problem(),
        known: |_| Strips::new(4).known(),
        ..PLAIN
    },
    Regime {
        id: "fan",
        title: "A fan of flat triangles around one vertex near the contact",
        parameter: "height of the flattest triangle over its base",
        values: &[0.5, 0.1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6],
        reduced: &[0, 3],
        promised: 6,
        build: fan,
        known: |_| lift_known(),
        flat: Some(3.0),
        ..PLAIN
    },
    Regime {
        id: "distortion",
        title: "Inner vertices moved at random",
        parameter: "largest shift over the mesh size",
        reported: "firedrake #4971",
        values: &[0.0, 0.05, 0.1, 0.15, 0.2, 0.24],
        reduced: &[0, 4],
        build: distorted,
        known: |_| lift_known(),
        flat: Some(3.0),
        ..PLAIN
    },
    Regime {
        id: "numbering",
        title: "Vertices, triangles and corners in random order",
        parameter: "seed of the order",
        truth: "the answer in the first order; energy: bracket on a finer mesh; forces: statics",
        values: &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0],
        reduced: &[0, 1],
        promised: 6,
        build: |seed| Lift::new(8).model().shuffled(seed as u64).problem(),
        known: |_| lift_known().scaled(1.0, 1.0),
        ..PLAIN
    },
    Regime {
        id: "unmatched",
        title: "Sides that do not match, part of the contact open",
        parameter: "cells on one side to cells on the other",
        reported: "MOOSE PR #33572",
        values: SIDE_STEPS,
        labels: SIDE_LABELS,
        reduced: &[0, 7],
        build: unmatched,
        known: |_| lift_known(),
        flat: Some(3.0),
        ..PLAIN
    },
    Regime {
        id: "unmatched-exact",
        title: "Sides that do not match, pure bending",
        parameter: "cells on one side to cells on the other",
        reported: "MOOSE PR #33572",
        truth: CLOSED,
        values: SIDE_STEPS,
        labels: SIDE_LABELS,
        reduced: &[0, 2],
        build: |step| unmatched_row(step).model().problem(),
        known: |step| unmatched_row(step).known(),
        ..PLAIN
    },
    Regime {
        id: "overlap",
        title: "A contact side that ends inside an edge of the other",
        parameter: "length that stands out",
        reported: "MOOSE PR #33572",
        values: &[0.0, 1e-6, 0.05, 0.3],
        reduced: &[0, 2],
        build: overlapping,
        known: |_| lift_known(),
        ..PLAIN
    },
    Regime {
        id: "thin-beam",
        title: "Thin beams, one square across, pure bending",
        parameter: "length over height",
        truth: CLOSED,
        values: &[2.0, 8.0, 32.0, 128.0, 512.0],
        reduced: &[0, 2],
        build: |length| beam(length).model().problem(),
        known: |length| beam(length).known(),
        ..PLAIN
    },
    Regime {
        id: "refinement",
        title: "From many triangles a body to two",
        parameter: "squares per side of a block",
        reported: "README of Kratos' Hertz example",
        values: &[8.0, 16.0, 32.0, 64.0, 4.0, 2.0, 1.0],
        reduced: &[0, 1, 6],
        build: |n| Lift::new(n as usize).model().problem(),
        known: |_| lift_known(),
        ..PLAIN
    },
    Regime {
        id: "oscillation",
        title: "Contact pressure between unequal blocks under refinement",
        parameter: "squares per side of a block",
        reported: "MOOSE #17279, #6488; README of Kratos' Hertz example",
        truth: CLOSED,
        values: &[8.0, 16.0, 32.0, 4.0, 2.0, 1.0],
        reduced: &[0, 1],
        build: |n| unequal_row(n).model().problem(),
        known: |n| unequal_row(n).known(),
        ..PLAIN
    },
    Regime {
        id: "corner",
        title: "Re-entrant corner on a rigid plane",
        parameter: "mesh size",
        values: &[0.25, 0.125, 0.0625, 0.5, 1.0],
        reduced: &[0, 1],
        build: corner,
        known: |_| Known::forces(vec![[0.0, 1.0]], 1.0),
        ..PLAIN
    },
    Regime {
        id: "slit",
        title: "A crack-like slit that closes under load",
        parameter: "shear over pressure",
        values: &[0.0, 0.3, 1.0, 3.0, 10.0],
        reduced: &[0, 2],
        build: slit,
        known: |_| Known::forces(Vec::new(), 1.0),
        ..PLAIN
    },
];
