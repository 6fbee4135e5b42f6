//! Allowances for the digits of a file: the allowance for rounding has a ceiling that comes from the problem.
//!
//! A value that is kept to d digits is off by up to half a unit of the last one, and a displacement far larger than the strains
//! loses them all. The residual that this may leave is known, and a correct field leaves no more. But the same digits could
//! hide a mistake worth finding in a wrong field: the check is then not made, and has not passed.

use super::{SOLVER, Solution};
use crate::compare::Check;
use crate::compare::ceiling::{Allowance, Extent, MISTAKE, PART, Sizes};

impl Solution<'_> {
    /// Limits the scales to the size of a solution given by `extent`, if the field is larger.
    pub fn within(mut self, extent: Extent) -> Self {
        self.reference = extent.reference(self.largest);
        self.larger = extent.of_forces(self.strain);
        let supported = self.forces.energy_size(|i| self.forces.left[i][0].hypot(self.forces.left[i][1]));
        let sizes = Sizes { data: self.forces.energy_sizes(), supported };
        self.ceiling = sizes.ceiling(self.larger) / self.scale;
        self
    }

    /// Allowance of checks of forces, relative to the scale of the residual.
    pub(super) fn of_forces(&self) -> Allowance {
        Allowance { exact: SOLVER, digits: self.rounding / self.scale, ceiling: self.ceiling }
    }

    /// Allowance of checks of displacements, relative to [`Self::reference`], if each is computed from `values` rounded values.
    pub(super) fn of_displacements(&self, values: f64) -> Allowance {
        let larger = if self.reference > 0.0 { self.largest / self.reference } else { 1.0 };
        Allowance { exact: SOLVER, digits: values * self.candidate.precision * larger, ceiling: PART * MISTAKE }
    }

    /// The check `made` with `allowance`. It is not made if the field may pass owing to rounding of its digits alone, and they are
    /// too few to detect a mistake.
    pub(super) fn with_digits(&self, allowance: Allowance, made: impl Fn(f64) -> Check) -> Check {
        allowance.check(made, || self.too_few(allowance))
    }

    /// A sentence on the number of digits that the check would need.
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
        let remedy = match self.candidate.name.ends_with(".frd") {
            true => {
                "Ask CalculiX for `*NODE PRINT` of all nodes with U, and hand in the .dat, which has one digit more."
            }
            false => "Write the displacements with more digits.",
        };
        format!(
            "This could not be decided: {needed} {digits} needed to tell {part} % of E; this file has {has}. {remedy}"
        )
    }
}
