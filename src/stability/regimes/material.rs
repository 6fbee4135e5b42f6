//! Materials: incompressibility, stiffness ratios.

use super::super::known::Known;
use super::super::scenes::{Lift, Sketch, polygon};
use super::super::strips::Strips;
use super::{CLOSED, PLAIN, Regime};
use crate::problem::Problem;
use crate::scene::Gap;

const POISSON: &[f64] = &[0.3, 0.4, 0.49, 0.499, 0.4999, 0.49999, 0.499999, 0.4999999];
const RATIO: &[f64] = &[1.0, 1e2, 1e4, 1e6, 1e8, 1e10, 1e12];

/// The force that the left block feels in [`Lift`].
pub(super) fn lift_known() -> Known {
    Known::forces(vec![[-0.5, 0.0]], 4.0)
}

fn lift(nu: f64, ratio: f64) -> Sketch {
    Lift { materials: [[1.0, nu], [ratio, nu]], ..Lift::new(8) }.model()
}

fn row(nu: f64, ratio: f64) -> Strips {
    let mut row = Strips::new(4);
    row.materials = vec![[1.0, nu], [ratio, nu], [1.0, nu]];
    row.cells.1 = vec![4; 3];
    row
}

fn punch(ratio: f64) -> Result<Problem, String> {
    Sketch::new()
        .body("base", 1.0, 0.3)
        .body("punch", ratio, 0.3)
        .clamp("bottom")
        .pressure("load", 1.0)
        .contact("foot", "seat", Gap::Constant(0.0))
        .polygons(
            vec![
                polygon(
                    "base",
                    &[[0.0, 0.0], [1.0, 0.0], [1.0, 0.75], [0.75, 0.75], [0.25, 0.75], [0.0, 0.75]],
                    &["bottom", "", "", "seat", "", ""],
                ),
                polygon("punch", &[[0.25, 0.75], [0.75, 0.75], [0.75, 1.0], [0.25, 1.0]], &["foot", "", "load", ""]),
            ],
            0.125,
        )
}

pub(super) const REGIMES: &[Regime] = &[
    Regime {
        id: "poisson",
        title: "Nearly incompressible, part of the contact open",
        parameter: "Poisson's ratio, plane strain",
        reported: "MOOSE #9505, #21842",
        values: POISSON,
        reduced: &[0, 7],
        promised: POISSON.len(),
        build: |nu| lift(nu, 1.0).one_way().problem(),
        known: |_| lift_known(),
        flat: Some(3.0),
        degrees: true,
        ..PLAIN
    },
    Regime {
        id: "poisson-exact",
        title: "Nearly incompressible, pure bending",
        parameter: "Poisson's ratio, plane strain",
        reported: "MOOSE #9505, #21842",
        truth: CLOSED,
        values: POISSON,
        reduced: &[0, 7],
        promised: POISSON.len(),
        build: |nu| row(nu, 1.0).model().one_way().problem(),
        known: |nu| row(nu, 1.0).known(),
        ..PLAIN
    },
    Regime {
        id: "stiffness",
        title: "A soft block against a stiff one, part of the contact open",
        parameter: "ratio of the moduli",
        reported: "MOOSE #17279",
        values: RATIO,
        reduced: &[0, 5],
        promised: 6,
        build: |ratio| lift(0.3, ratio).problem(),
        known: |_| lift_known(),
        flat: Some(3.0),
        ..PLAIN
    },
    Regime {
        id: "stiffness-exact",
        title: "A stiff block between two soft ones, pure bending",
        parameter: "ratio of the moduli",
        reported: "MOOSE #17279",
        truth: CLOSED,
        values: RATIO,
        reduced: &[0, 5, 6],
        promised: 6,
        build: |ratio| row(0.3, ratio).model().problem(),
        known: |ratio| row(0.3, ratio).known(),
        degrees: true,
        ..PLAIN
    },
    Regime {
        id: "punch",
        title: "Flat punch: infinite pressure at its edges",
        parameter: "modulus of the punch over that of the base",
        reported: "MOOSE #6488",
        values: &[1.0, 10.0, 1e2, 1e4, 1e6, 1e8],
        reduced: &[0, 4],
        build: punch,
        known: |_| Known::forces(vec![[0.0, 0.5]], 0.5),
        ..PLAIN
    },
];
