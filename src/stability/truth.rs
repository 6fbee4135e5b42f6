//! The interval that surely contains the exact energy.

use super::known::Known;
use crate::measure::{Answer, Ended, Measured, Method};

/// The exact energy lies between `lower` and `upper`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Truth {
    /// Not above the exact energy.
    pub lower: f64,
    /// Not below it.
    pub upper: f64,
    /// 𝒮, to which errors are relative.
    pub strain: f64,
}

impl Truth {
    /// From a closed solution, or from runs on finer meshes: the largest lower and the smallest upper bound. `None` where
    /// there is neither, or where the runs contradict each other.
    pub fn new(known: &Known, finer: &[Ended]) -> Option<Truth> {
        if let Some([energy, strain]) = known.energy {
            return Some(Truth { lower: energy, upper: energy, strain });
        }
        let answers = || {
            finer.iter().flat_map(|e| match e {
                Ended::Told(results) => results.as_slice(),
                _ => &[],
            })
        };
        let of = |value: fn(&Answer) -> Option<f64>| {
            answers().filter_map(move |m: &Measured| value(m.answer.as_ref()?)).filter(|v: &f64| v.is_finite())
        };
        let strain = answers()
            .filter(|m| Method::of_name(&m.method).is_some_and(Method::has_bracket))
            .find_map(|m| m.answer.as_ref()?.strain)?;
        let truth =
            Truth { lower: of(|a| a.lower).reduce(f64::max)?, upper: of(|a| a.upper).reduce(f64::min)?, strain };
        (truth.lower <= truth.upper).then_some(truth)
    }

    /// With energies multiplied.
    pub fn scaled(self, factor: f64) -> Truth {
        Truth { lower: self.lower * factor, upper: self.upper * factor, strain: self.strain * factor }
    }

    /// √(|E − energy| / 𝒮) for E in the middle.
    pub fn error(&self, energy: f64) -> f64 {
        ((0.5 * (self.lower + self.upper) - energy).abs() / self.strain).sqrt()
    }
}
