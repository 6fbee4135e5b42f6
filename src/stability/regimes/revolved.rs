//! Bodies of revolution: near the axis and far from it, flat, nearly incompressible, and a contact that ends on the axis.

use std::f64::consts::PI;

use super::super::known::Known;
use super::super::scenes::{Sketch, steps};
use super::{CLOSED, PLAIN, Regime};
use crate::problem::Problem;
use crate::scene::Gap;

/// A tube on a rigid plate, pressed from outside and from above.
#[derive(Debug, Clone, Copy)]
struct Tube {
    inside: f64,
    outside: f64,
    height: f64,
    poisson: f64,
    /// Pressure from outside; `None` where rollers hold both walls.
    around: Option<f64>,
}

impl Tube {
    /// Pressure from above.
    const ABOVE: f64 = 0.5;

    fn problem(self) -> Result<Problem, String> {
        let (xs, ys) = (steps(self.inside, self.outside, 8), steps(0.0, self.height, 4));
        let tube = Sketch::new().block("tube", [1.0, self.poisson], &xs, &ys).revolved().rigid("tube_bottom");
        let tube = tube.pressure("tube_top", Tube::ABOVE);
        match self.around {
            Some(pressure) => tube.pressure("tube_right", pressure),
            None => tube.roller("tube_left").roller("tube_right"),
        }
        .problem()
    }

    /// Lamé's tube with a uniform stress along the axis; between rollers no strain across it.
    fn known(self) -> Known {
        let (a, b, nu, q) = (self.inside, self.outside, self.poisson, Tube::ABOVE);
        let face = PI * (b - a) * (b + a);
        let strain = match self.around {
            None => 0.5 * q * q * face * self.height * (1.0 + nu) * (1.0 - 2.0 * nu) / (1.0 - nu),
            Some(p) => {
                let k = -p * b * b / ((b - a) * (b + a));
                let sunk = self.height * (q + 2.0 * nu * k);
                let closed = -b * (2.0 * k + p + nu * (p + q));
                0.5 * (q * face * sunk + p * 2.0 * PI * b * self.height * closed)
            }
        };
        Known {
            energy: Some([-strain, strain]),
            variation: vec![0.0],
            ..Known::forces(vec![[0.0, q * face]], q * face)
        }
    }
}

const TUBE: Tube = Tube { inside: 0.5, outside: 1.0, height: 0.5, poisson: 0.3, around: Some(1.0) };

fn hole(inside: f64) -> Tube {
    Tube { inside, ..TUBE }
}

fn far(inside: f64) -> Tube {
    Tube { inside, outside: inside + 1.0, around: None, ..TUBE }
}

fn flat(height: f64) -> Tube {
    Tube { height, ..TUBE }
}

fn nearly_incompressible(poisson: f64) -> Tube {
    Tube { poisson, ..TUBE }
}

/// A round block pressed on a plate that is a little of a cone, or of a dish below zero: contact ends on the axis, or begins there.
fn cone(slope: f64) -> Result<Problem, String> {
    let gap = if slope < 0.0 { [[0.0, -slope], [1.0, 0.0]] } else { [[0.0, 0.0], [1.0, slope]] };
    let mut model = Sketch::new()
        .block("block", [1.0, 0.3], &steps(0.0, 1.0, 8), &steps(0.0, 1.0, 8))
        .revolved()
        .rigid("block_bottom")
        .pressure("block_top", Tube::ABOVE);
    model.scene.contacts[0].gap = Gap::Table(gap.to_vec());
    model.raw.segments.retain(|(_, name)| name != "block_left");
    model.problem()
}

fn cone_known(_: f64) -> Known {
    Known::forces(vec![[0.0, PI * Tube::ABOVE]], PI * Tube::ABOVE)
}

pub(super) const REGIMES: &[Regime] = &[
    Regime {
        id: "revolved-hole",
        title: "A body of revolution with a hole that is ever narrower",
        parameter: "radius of the hole over that of the body",
        truth: CLOSED,
        values: &[0.5, 0.1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8],
        reduced: &[0, 5],
        build: |inside| hole(inside).problem(),
        known: |inside| hole(inside).known(),
        degrees: true,
        ..PLAIN
    },
    Regime {
        id: "revolved-far",
        title: "A ring far from its axis",
        parameter: "radius over width",
        truth: CLOSED,
        values: &[1.0, 1e2, 1e4, 1e6, 1e8],
        reduced: &[0, 3],
        build: |inside| far(inside).problem(),
        known: |inside| far(inside).known(),
        degrees: true,
        ..PLAIN
    },
    Regime {
        id: "revolved-flat",
        title: "A flat ring",
        parameter: "height",
        truth: CLOSED,
        values: &[0.5, 0.1, 1e-2, 1e-3, 1e-4],
        reduced: &[0, 3],
        build: |height| flat(height).problem(),
        known: |height| flat(height).known(),
        degrees: true,
        ..PLAIN
    },
    Regime {
        id: "revolved-poisson",
        title: "A nearly incompressible tube",
        parameter: "Poisson's ratio",
        truth: CLOSED,
        values: &[0.3, 0.49, 0.4999, 0.499999, 0.49999999],
        reduced: &[0, 3],
        build: |nu| nearly_incompressible(nu).problem(),
        known: |nu| nearly_incompressible(nu).known(),
        flat: Some(3.0),
        degrees: true,
        ..PLAIN
    },
    Regime {
        id: "revolved-tip",
        title: "A contact that ends on the axis, or begins there",
        parameter: "slope of a cone, or below zero of a dish",
        values: &[0.0, 0.1, 1.0, 10.0, 100.0, -0.1, -1.0, -10.0],
        reduced: &[0, 6],
        build: cone,
        known: cone_known,
        degrees: true,
        ..PLAIN
    },
];
