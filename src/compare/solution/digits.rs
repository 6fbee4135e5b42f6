//! What the digits of a file can tell: an allowance for rounding has a ceiling that comes from the problem.
//!
//! A value that is kept to d digits is off by up to half a unit of the last one, and a displacement far larger than the strains
//! loses them all. How much that may leave of a residual is known, and a correct field leaves no more. It says nothing about a
//! wrong one where the same digits would hide a mistake worth finding: the check is then not made, and has not passed.

use super::{SOLVER, Solution};
use crate::compare::{Basis, Check};

/// The mistake that a check has to be able to tell: this part of the modulus, the loads or the displacement.
const MISTAKE: f64 = 0.05;
/// Rounding may leave this part of what the mistake leaves.
const PART: f64 = 0.5;
/// Of the largest displacement of the stress side, that of a correct field is at most so many times as large, but for motions that
/// nothing holds.
const LARGER: f64 = 2.0;
/// Loads below this part of the forces at supports and contacts are not what the solution consists of.
const BESIDE: f64 = 0.1;

/// What the problem says of the size of its solution, whatever the field: from λ_h and the displacement that belongs to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extent {
    /// Strain energy of λ_h.
    pub strain: f64,
    /// Largest displacement of the admissible field made from λ_h; infinite where there is none.
    pub displacement: f64,
}

/// An allowance in two parts, in the units of a check.
#[derive(Debug, Clone, Copy)]
pub(super) struct Allowance {
    /// What a solver may leave.
    pub exact: f64,
    /// What the rounding of a correct field can leave at most.
    pub digits: f64,
    /// What it may leave where the check is to tell a mistake.
    pub ceiling: f64,
}

impl Solution<'_> {
    /// Takes the size of the solution from `extent` where the field is larger.
    pub fn within(mut self, extent: Extent) -> Self {
        if extent.displacement > 0.0 {
            self.reference = self.largest.min(LARGER * extent.displacement);
        }
        let supported = self.forces.energy_size(|i| self.forces.left[i][0].hypot(self.forces.left[i][1]));
        let larger = if self.strain > extent.strain { (extent.strain.max(0.0) / self.strain).sqrt() } else { 1.0 };
        let supported = larger * supported;
        let load = self.forces.energy_size(|i| self.forces.load[i][0].hypot(self.forces.load[i][1]));
        let carried = if load > BESIDE * supported { load } else { supported };
        self.ceiling = PART * MISTAKE * carried / self.scale;
        self
    }

    /// What checks of forces allow, relative to the scale of the residual.
    pub(super) fn of_forces(&self) -> Allowance {
        Allowance { exact: SOLVER, digits: self.rounding / self.scale, ceiling: self.ceiling }
    }

    /// What checks of displacements allow, relative to [`Self::reference`], where `values` rounded values make one.
    pub(super) fn of_displacements(&self, values: f64) -> Allowance {
        let larger = if self.reference > 0.0 { self.largest / self.reference } else { 1.0 };
        Allowance { exact: SOLVER, digits: values * self.candidate.precision * larger, ceiling: PART * MISTAKE }
    }

    /// The check `made` with `allowance`: it is not made where the field may owe to its digits alone that it passes, and they are
    /// too few to tell a mistake.
    pub(super) fn with_digits(&self, allowance: Allowance, made: impl Fn(f64) -> Check) -> Check {
        let exact = made(allowance.exact);
        if exact.passed {
            return exact;
        }
        let check = made(allowance.exact + allowance.digits);
        if !check.passed || allowance.digits <= allowance.ceiling {
            return check;
        }
        let told = made(allowance.exact + allowance.ceiling).allowed;
        let why = format!("{} {}", check.why, self.too_few(allowance));
        Check::not_made(&check.name, told, Basis::Claimed, why)
    }

    /// How many digits the check would need.
    fn too_few(&self, allowance: Allowance) -> String {
        let has = self.candidate.precision;
        let digits = |precision: f64| (1.0 - (2.0 * precision).log10()).clamp(1.0, 99.0);
        let needed = digits(has * allowance.ceiling / allowance.digits).ceil();
        let part = 100.0 * MISTAKE;
        if needed > 15.0 || !needed.is_finite() {
            return format!(
                "This could not be decided: the displacements are so large beside the strains that no file of numbers in double \
                 precision tells {part} % of E; fix the motion that nothing holds, and write the field again."
            );
        }
        let has = digits(has).round();
        let digits = if needed == 1.0 { "digit is" } else { "digits are" };
        format!(
            "This could not be decided: {needed} {digits} needed to tell {part} % of E; this file has {has}. Write the \
             displacements with more digits."
        )
    }
}
