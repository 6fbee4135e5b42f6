//! Plausibility of hypotheses: besides fitting closely, each has to be something that a person or a program can have done.

use super::words::near;
use super::{Finding, Trial};

/// Factors between these are those of a number that was read or typed wrongly.
const DECADE: [f64; 2] = [0.1, 10.0];
/// Powers of ten up to this one are units.
const UNITS: i32 = 9;
/// Stiffness up to this one, either way, counts as missing springs, relative to those that should be there.
const NOTHING: f64 = 1e-3;
/// One unknown of a hypothesis for this many numbers of the residual, or fewer: with more, it repeats what it should explain.
const NUMBERS: usize = 4;

/// True if a positive constant can be `s` times its right value: within a decade, or by a power of ten.
pub fn is_mistyped(s: f64) -> bool {
    let power = s.log10().round();
    let in_decade = (DECADE[0]..=DECADE[1]).contains(&s);
    s > 0.0 && (in_decade || (power.abs() <= f64::from(UNITS) && near(s, 10.0_f64.powf(power))))
}

/// True if `unknowns` are few enough beside the `numbers` that they explain.
pub fn is_simple(unknowns: usize, numbers: usize) -> bool {
    NUMBERS * unknowns <= numbers
}

impl Finding {
    /// True if the number found can occur in a model.
    fn is_physical(&self) -> bool {
        let Some(value) = self.value else { return true };
        match self.name.rsplit('/').next().unwrap_or(&self.name) {
            "young" => self.expected.is_none_or(|given| is_mistyped(value / given)),
            "poisson" => self.is_ratio(value),
            "shear" => is_mistyped(value),
            "stiffness" if self.name.starts_with("body/") => is_mistyped(value),
            "pulling" => is_mistyped(value),
            "springs" => value > 0.0,
            // Springs may be missing, or act where there should be none.
            "stiffness" | "normal" | "tangential" => match self.expected {
                Some(given) if given != 0.0 => (value / given).abs() <= NOTHING || is_mistyped(value / given),
                _ => value > 0.0,
            },
            // Its sign is what is mistaken most often: 1 + 2ν in place of 1 − 2ν is no change of it.
            "lambda" => value == 0.0 || is_mistyped(value.abs()),
            _ if self.name == "loads" || self.name.starts_with("load/") => value.abs() <= 10.0_f64.powi(UNITS),
            _ => value.is_finite(),
        }
    }

    /// True if a Poisson's ratio can be `value`: the sign of a positive one may be wrong, but no other ratio below zero is typed in its place.
    fn is_ratio(&self, value: f64) -> bool {
        let turned = self.expected.is_none_or(|given| given <= 0.0 || near(value, -given));
        (if turned { -1.0 < value } else { 0.0 <= value }) && value < 0.5
    }

    /// True if it makes a body softer or stiffer.
    fn is_of_stiffness(&self) -> bool {
        self.name.starts_with("stiffness/")
            || ["/young", "/poisson", "/stiffness"].iter().any(|end| self.name.ends_with(end))
    }

    /// True if it takes a load away.
    fn takes_load(&self) -> bool {
        (self.name == "loads" || self.name.starts_with("load/") || self.name.ends_with("/body_force"))
            && self.value.zip(self.expected).is_some_and(|(found, given)| near(given + found, given))
    }
}

impl Trial {
    /// True if every constant found can occur, and a problem is left: without loads any stiffness is as good as another.
    pub fn is_possible(&self) -> bool {
        let empty = self.findings.iter().any(Finding::takes_load) && self.findings.iter().any(Finding::is_of_stiffness);
        !empty && self.findings.iter().all(Finding::is_physical)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trial(findings: &[(&str, f64, f64)]) -> Trial {
        let findings = findings.iter().map(|(name, value, given)| Finding::new(*name, Some(*value), Some(*given), ""));
        Trial { rank: 1, left: 0.0, findings: findings.collect() }
    }

    #[test]
    fn constants_are_those_that_somebody_can_have_typed() {
        for young in [500.0, 9_500.0, 1e4, 1e5, 1e7, 10.0] {
            assert_eq!(trial(&[("body/b/young", young, 1e4)]).is_possible(), young != 500.0, "{young}");
        }
        for young in [-1e4, 0.0, 4.8e-8, 3.7e7, f64::NAN] {
            assert!(!trial(&[("body/b/young", young, 1e4)]).is_possible(), "{young}");
        }
        for (poisson, possible) in [(0.5, false), (0.0, true), (-0.3, true), (-0.6878, false), (f64::NAN, false)] {
            assert_eq!(trial(&[("body/b/poisson", poisson, 0.3)]).is_possible(), possible, "{poisson}");
        }
        assert!(trial(&[("body/b/poisson", -0.2, -0.1)]).is_possible());
        assert!(trial(&[("stiffness/lambda", -1.0, 1.0)]).is_possible());
        assert!(!trial(&[("stiffness/shear", -1.0, 1.0)]).is_possible());
    }

    #[test]
    fn springs_may_be_missing_and_are_otherwise_within_a_decade_or_a_power_of_ten() {
        for (found, possible) in
            [(0.0, true), (-0.1, true), (0.052, true), (250.0, true), (5e5, true), (6e3, false), (-250.0, false)]
        {
            assert_eq!(trial(&[("support/foot/normal", found, 500.0)]).is_possible(), possible, "{found}");
        }
        assert!(!trial(&[("support/foot/tangential", 0.4919, 200.0)]).is_possible());
        assert!(!trial(&[("support/foot/tangential", -3.0, 0.0)]).is_possible());
        assert!(!trial(&[("body/b/stiffness", -1.0, 1.0)]).is_possible());
    }

    #[test]
    fn loads_are_no_larger_than_units_make_them() {
        for (found, possible) in [(0.0, true), (-1.0, true), (1e6, true), (-4.8e14, false)] {
            assert_eq!(trial(&[("loads", found, 1.0)]).is_possible(), possible, "{found}");
            assert_eq!(trial(&[("load/top/gradient", found, 1.0)]).is_possible(), possible, "{found}");
        }
    }

    #[test]
    fn a_stiffness_without_its_load_is_no_explanation() {
        assert!(trial(&[("load/top", 0.0, 1.0)]).is_possible());
        assert!(!trial(&[("body/b/young", 9e3, 1e4), ("load/top", 1e-9, 1.0)]).is_possible());
        assert!(trial(&[("body/b/young", 9e3, 1e4), ("load/top", 0.5, 1.0)]).is_possible());
    }
}
