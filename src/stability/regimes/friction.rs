//! Contact with a given friction bound.

use super::super::known::Known;
use super::super::scenes::{Sketch, steps};
use super::{PLAIN, Regime};
use crate::problem::Problem;
use crate::scene::Gap;

/// Pressure that holds the blocks together, per length.
const PRESSURE: f64 = 0.3;
/// Push and bound where they are not swept: a half of the contact slides, about.
const PUSH: f64 = 0.1;
const BOUND: f64 = 0.1;

/// A block on a block of the same length 2, pressed down and pushed at its left end.
fn pushed(push: f64, bound: f64) -> Sketch {
    let (along, across) = (steps(0.0, 2.0, 16), [steps(0.0, 1.0, 8), steps(1.0, 2.0, 8)]);
    Sketch::new()
        .block("low", [2.0, 0.3], &along, &across[0])
        .block("high", [1.0, 0.3], &along, &across[1])
        .clamp("low_bottom")
        .pressure("high_top", PRESSURE)
        .push("high_left", push, 0.0)
        .contact("high_bottom", "low_top", Gap::Constant(0.0))
        .rubbing(bound)
}

/// The force across the contact; that of friction is not judged.
fn held() -> Known {
    Known::forces(vec![[f64::NAN, 2.0 * PRESSURE]], 2.0 * PRESSURE)
}

/// The blocks of [`pushed`], pushed to the right, or mirrored.
fn mirrored(sign: f64) -> Result<Problem, String> {
    let sketch = pushed(sign * PUSH, BOUND);
    if sign > 0.0 { sketch.problem() } else { sketch.moved(|[x, y]| [2.0 - x, y]).problem() }
}

pub(super) const REGIMES: &[Regime] = &[
    Regime {
        id: "friction-bound",
        title: "Friction bound from nothing to sticking, against a spring",
        parameter: "bound of the tangential traction",
        reported: "stick and slip that alternate",
        values: &[0.1, 0.03, 1e-2, 1e-4, 1e-8, 1e-12, 1.0, 1e2, 1e4, 1e8, 1e12],
        reduced: &[0, 5, 10],
        build: |bound| pushed(PUSH, bound).springs("high_right", 0.5).problem(),
        known: |_| held(),
        ..PLAIN
    },
    Regime {
        id: "slip-end",
        title: "End of slip crossing vertices",
        parameter: "push; from 0.2 on nothing holds it",
        reported: "stick and slip that alternate",
        values: &[0.05, 0.06, 0.07, 0.08, 0.09, 0.1, 0.11, 0.12, 0.13, 0.14, 0.15, 0.16, 0.17, 0.18, 0.19, 0.21],
        reduced: &[0, 8, 15],
        build: |push| pushed(push, BOUND).problem(),
        known: |push| if push < 2.0 * BOUND { held() } else { Known::none() },
        ..PLAIN
    },
    Regime {
        id: "slip-mirror",
        title: "Friction against either direction of a push",
        parameter: "direction; the second is the first in a mirror",
        reported: "signs of slip",
        values: &[1.0, -1.0],
        labels: &["to the right", "to the left"],
        reduced: &[0, 1],
        build: mirrored,
        known: |_| held().scaled(1.0, 1.0).mirrored(),
        ..PLAIN
    },
];
