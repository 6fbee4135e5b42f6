//! Upper limits of tolerances: the ceiling comes from the problem and never from the answer.
//!
//! The error left by rounding, or by a solver that works relative to the size of its displacements, is known, and a correct field
//! has no larger one. But the same tolerance could hide a mistake worth finding in a wrong field: a displacement far
//! larger than its strains loses every digit of them. The check is then not made, and has not passed.

use super::Check;
use super::contact::pressure::{Piece, dual_pressure};
use super::contact::resultant::forces;
use crate::bounds::Bracket;
use crate::bounds::energy::initial_energy;
use crate::dual::DualSolution;
use crate::problem::{Problem, Scales};

/// The mistake that a check has to detect: this fraction of the modulus, the loads or the displacement.
pub(super) const MISTAKE: f64 = 0.05;
/// Rounding may leave this fraction of the residual that the mistake leaves.
pub(super) const PART: f64 = 0.5;
/// The largest displacement of a correct field is at most this multiple of that of the stress side, except for motions that
/// nothing restrains.
const LARGER: f64 = 2.0;
/// Loads below this fraction of the forces at supports and contacts do not determine the size of the solution.
const BESIDE: f64 = 0.1;
/// Forces below this fraction of all others are smaller than what a solver may leave.
const UNSEEN: f64 = 1e-6;
/// Error that rounding may leave in any case, relative to the scales of the data of a problem: where these cause no strain at all,
/// everything is rounding.
const OF_DATA: f64 = 1e-9;

/// Limits on the size of the solution that do not depend on the field: from λ_h and the displacement that belongs to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extent {
    /// Energy of the strains of λ_h, including initial strains.
    pub strain: f64,
    /// Largest displacement of the admissible field made from λ_h; infinite if there is none.
    pub displacement: f64,
}

impl Extent {
    /// The extent from the two bounds of the stress side.
    pub fn of(problem: &Problem, bracket: &Bracket) -> Self {
        let displacement = bracket.free.as_ref().map_or(f64::INFINITY, |free| {
            let field = &free.displacement;
            (0..field.len()).map(|t| field.largest(t)).fold(0.0, f64::max)
        });
        // Strains are those of the stress and the initial ones.
        let held = initial_energy(problem);
        let strain = match held > 0.0 {
            true => (bracket.complementary.stored().max(0.0).sqrt() + held.sqrt()).powi(2),
            false => bracket.complementary.stored(),
        };
        Extent { strain, displacement }
    }

    /// The smaller of the displacement `largest` and the largest that a correct field can have.
    pub fn reference(&self, largest: f64) -> f64 {
        if self.displacement > 0.0 { largest.min(LARGER * self.displacement) } else { largest }
    }

    /// Ratio of a field with the displacement `largest` to the largest correct field; 1 if it is not larger.
    pub fn larger(&self, largest: f64) -> f64 {
        let reference = self.reference(largest);
        if reference > 0.0 { largest / reference } else { 1.0 }
    }

    /// Factor that reduces the forces of a field of strain energy `strain` to at most those of a solution.
    pub fn of_forces(&self, strain: f64) -> f64 {
        if strain > self.strain { (self.strain.max(0.0) / strain).sqrt() } else { 1.0 }
    }

    /// Residual of nodal forces that rounding may leave: `load` is the size of the load forces, `supported` that of the support
    /// and contact forces on a field of strain energy `strain`.
    pub fn rounding_of_forces(&self, load: f64, supported: f64, strain: f64) -> f64 {
        let supported = self.of_forces(strain) * supported;
        PART * MISTAKE * if load > BESIDE * supported { load } else { supported }
    }
}

/// The sizes of the nodal forces of a field, each as the root of an energy.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sizes {
    /// Of the loads, and of initial strains.
    pub data: [f64; 2],
    /// Of supports and contacts.
    pub supported: f64,
}

impl Sizes {
    /// Residual of nodal forces that the digits of a file may leave, on a field whose forces are those of a solution times `larger`: part of
    /// what the smallest of its causes leaves when it is 5 % off, loads or initial strains, and where there is neither, the forces at supports
    /// and contacts.
    pub(super) fn ceiling(self, larger: f64) -> f64 {
        let Sizes { data, supported } = self;
        let supported = larger * supported;
        let all = data.into_iter().fold(supported, f64::max);
        let seen = data.into_iter().filter(|size| *size > UNSEEN * all).reduce(f64::min);
        PART * MISTAKE * seen.unwrap_or(supported)
    }
}

/// The ceilings of all tolerances of a comparison.
#[derive(Debug, Clone, Copy)]
pub struct Ceilings {
    /// Limits on the size of a solution.
    pub extent: Extent,
    /// Ceiling for an energy.
    pub energy: f64,
    /// Ceiling for a force.
    pub force: f64,
    /// Ceiling for nodal forces as the root of an energy, where data cause no stress.
    pub of_data: f64,
}

impl Ceilings {
    /// The ceilings of `problem`, from its data and λ_h.
    pub fn new(problem: &Problem, scales: &Scales, (dual, bracket): (&DualSolution, &Bracket)) -> Self {
        let contact = problem.interfaces.iter().enumerate().map(|(index, interface)| {
            // Forces around a pin and radial ones cancel, and are there all the same.
            let size =
                |piece: &Piece| piece.coefficients().map(f64::abs).sum::<f64>() / piece.coefficients().count() as f64;
            let own = dual_pressure(dual, index);
            let pairs = interface.pairs.iter().zip(&own);
            problem.scene.thickness * pairs.map(|(pair, piece)| pair.length * size(piece)).sum::<f64>()
        });
        let part = PART * MISTAKE;
        let of_data = OF_DATA * scales.data.energy;
        Ceilings {
            extent: Extent::of(problem, bracket),
            energy: part * bracket.complementary.stored().max(0.0) + of_data,
            force: part * (forces(problem) + contact.sum::<f64>()) + OF_DATA * scales.data.force,
            of_data: (2.0 * of_data).sqrt(),
        }
    }
}

/// A tolerance in two parts, in the units of a check.
#[derive(Debug, Clone, Copy)]
pub struct Allowance {
    /// Residual that a solver may leave in a field of the size that the problem allows.
    pub exact: f64,
    /// Addition for the actual size of the field: rounding of its values, and the error of its solver.
    pub digits: f64,
    /// Largest addition with which the check still detects a mistake.
    pub ceiling: f64,
}

impl Allowance {
    /// The check `made` with this tolerance. It is not made, for the reason given by `told`, if the field may pass owing to
    /// [`Self::digits`] alone and these could hide a mistake.
    pub fn check(&self, made: impl Fn(f64) -> Check, told: impl FnOnce() -> String) -> Check {
        let exact = made(self.exact);
        if exact.passed {
            return if self.digits <= self.ceiling { made(self.exact + self.digits) } else { exact };
        }
        let check = made(self.exact + self.digits);
        if !check.passed || self.digits <= self.ceiling {
            return check;
        }
        let allowed = made(self.exact + self.ceiling).allowed;
        Check::not_made(&check.name, allowed, check.basis, format!("{} {}", told(), check.why))
    }

    /// As [`Self::check`], with displacements that are too large as the reason.
    pub fn check_of_large(&self, made: impl Fn(f64) -> Check) -> Check {
        self.check(made, || TOO_LARGE.to_string())
    }
}

/// The reason why a check could not be made of a field whose displacements are large compared with its strains.
pub(super) const TOO_LARGE: &str = "This could not be decided: the displacements are so large beside those that the loads and supports \
     ask for that rounding of them could hide 5 % of E; hold the motion that nothing holds, and solve again.";

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::Basis;

    #[test]
    fn rounding_beyond_its_ceiling_makes_no_check_pass() {
        let check = |value: f64, digits: f64| {
            Allowance { exact: 1e-6, digits, ceiling: 0.025 }
                .check_of_large(|allowed| Check::at_most("x", value, 0.0, allowed, Basis::RoundOff, "Why."))
        };
        let outcomes = [check(1e-7, 1e9), check(1e-4, 1e-3), check(1e-4, 1e-5), check(0.5, 0.7), check(0.9, 0.7)];
        assert_eq!(outcomes.each_ref().map(|c| c.passed), [true, true, false, false, false]);
        assert_eq!(outcomes.each_ref().map(|c| c.value.is_none()), [false, false, false, true, false]);
    }
}
