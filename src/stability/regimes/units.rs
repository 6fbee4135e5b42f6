//! Units and scales: the same problem in other numbers.

use super::super::known::Known;
use super::super::scenes::Lift;
use super::material::lift_known;
use super::{PLAIN, Regime};
use crate::problem::Problem;

const POWERS: &[f64] = &[0.0, -3.0, 3.0, -6.0, 6.0, -9.0, 9.0];
const SCALED: &str = "scaling relation to the first value; energy there: bracket on a finer mesh; forces: statics";

/// [`Lift`] with lengths, moduli and loads multiplied.
fn scaled(length: f64, modulus: f64, load: f64) -> Result<Problem, String> {
    let [a, b] = Lift::LOAD;
    let blocks = Lift { materials: [[modulus, 0.3]; 2], load: [a * load, b * load / length], ..Lift::new(8) };
    blocks.model().moved(|[x, y]| [x * length, y * length]).problem()
}

/// Its answer: force goes with load and length, energy with load² length² over modulus.
fn known(length: f64, modulus: f64, load: f64) -> Known {
    let force = load * length;
    Known::forces(vec![[-0.5 * force, 0.0]], 4.0 * force).scaled(force * force / modulus, force)
}

fn ten(power: f64) -> f64 {
    10.0_f64.powi(power as i32)
}

/// Length, modulus and pressure of steel blocks of one metre under 100 MPa in different units.
const UNITS: [[f64; 3]; 5] = [[1.0, 2e11, 1e8], [1e3, 2e5, 1e2], [1e3, 2e2, 0.1], [1e6, 2e5, 1e2], [1e2, 2e7, 1e4]];

fn unit(step: f64) -> [f64; 3] {
    UNITS[(step as usize).min(UNITS.len() - 1)]
}

/// Factors against the first of the units.
fn units_known(step: f64) -> Known {
    let ([l0, e0, p0], [l, e, p]) = (UNITS[0], unit(step));
    let (force, force0) = (p * l, p0 * l0);
    Known::forces(vec![[-0.5 * force, 0.0]], 4.0 * force)
        .scaled((force * force / e) / (force0 * force0 / e0), force / force0)
}

pub(super) const REGIMES: &[Regime] = &[
    Regime {
        id: "scale-length",
        title: "All lengths multiplied",
        parameter: "power of ten",
        reported: "CalculiX #162, GEOS #896, MOOSE #22256",
        truth: SCALED,
        values: POWERS,
        reduced: &[0, 5, 6],
        promised: POWERS.len(),
        build: |k| scaled(ten(k), 1.0, 1.0),
        known: |k| known(ten(k), 1.0, 1.0),
        ..PLAIN
    },
    Regime {
        id: "scale-force",
        title: "All loads and moduli multiplied",
        parameter: "power of ten",
        reported: "CalculiX #162, GEOS #896, MOOSE #22256",
        truth: SCALED,
        values: POWERS,
        reduced: &[0, 6],
        promised: POWERS.len(),
        build: |k| scaled(1.0, ten(k), ten(k)),
        known: |k| known(1.0, ten(k), ten(k)),
        ..PLAIN
    },
    Regime {
        id: "scale-both",
        title: "All lengths, loads and moduli multiplied",
        parameter: "power of ten",
        reported: "CalculiX #162, GEOS #896, MOOSE #22256",
        truth: SCALED,
        values: POWERS,
        reduced: &[0, 6],
        promised: POWERS.len(),
        build: |k| scaled(ten(k), ten(k), ten(k)),
        known: |k| known(ten(k), ten(k), ten(k)),
        ..PLAIN
    },
    Regime {
        id: "units",
        title: "Steel in the units of different trades",
        parameter: "units",
        reported: "CalculiX #162, GEOS #896, MOOSE #22256",
        truth: SCALED,
        values: &[0.0, 1.0, 2.0, 3.0, 4.0],
        labels: &["N m", "N mm", "kN mm", "µN µm", "N cm"],
        reduced: &[0, 3],
        promised: UNITS.len(),
        build: |step| {
            let [length, modulus, load] = unit(step);
            scaled(length, modulus, load)
        },
        known: units_known,
        ..PLAIN
    },
    Regime {
        id: "vanishing-load",
        title: "Loads that vanish while the moduli stay",
        parameter: "factor of the loads",
        reported: "4C #1585",
        truth: SCALED,
        values: &[1.0, 1e-3, 1e-6, 1e-9, 1e-12, 1e-100, 0.0],
        reduced: &[0, 4, 6],
        build: |factor| scaled(1.0, 1.0, factor),
        known: |factor| known(1.0, 1.0, factor),
        ..PLAIN
    },
    Regime {
        id: "step-length",
        title: "Step length of the paper's iteration",
        parameter: "ϱ over the largest that converges",
        reported: "underworld3 #625",
        values: &[0.5, 0.25, 0.1, 0.01, 0.75, 0.9, 0.99, 0.999, 1.01, 1.1, 1.5, 3.0],
        reduced: &[0, 6, 8, 10],
        build: |_| Lift::new(2).model().problem(),
        known: |_| lift_known(),
        is_step_length: true,
        ..PLAIN
    },
];
