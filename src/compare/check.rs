//! A check: one number held against another, with the tolerance and the reason for it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// One comparison that could have failed.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Check {
    /// Stable name, for `--allow NAME=VALUE` and junit.
    pub name: String,
    /// What was found; `null` where it could not be made.
    pub value: Option<f64>,
    /// What it is held against.
    pub reference: Option<f64>,
    /// |value − reference|, or the excess of an inequality.
    pub difference: Option<f64>,
    /// Largest difference that passes.
    pub allowed: f64,
    /// allowed − difference.
    pub margin: Option<f64>,
    /// Whether it passed; a check that could not be made has not. One whose tolerance was chosen by nobody but this
    /// program is a remark and no part of the verdict, see [`Check::decides`].
    pub passed: bool,
    /// One sentence: what is compared and where `allowed` comes from.
    pub why: String,
    /// Where the tolerance comes from.
    pub basis: Basis,
    /// Whether it passed by an allowance alone.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub excused: bool,
}

/// Where an allowed value comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Basis {
    /// From the guaranteed bound: no correct pair of solutions can differ by more.
    Guaranteed,
    /// Round-off of an identity that holds exactly.
    RoundOff,
    /// Claimed of a field that somebody hands in: that it is admissible or, with `--solution`, the discrete solution of its
    /// mesh, to the accuracy of a solver.
    Claimed,
    /// Chosen by this program: theory leaves it open, and what exceeds it is worth a look, no more.
    Chosen,
    /// Asked for by the user: a tolerance, an allowance, a stored result to be reproduced.
    Asked,
}

impl Check {
    /// True if the check takes part in the verdict: tolerances from theory or the user count, those this program chose do not.
    pub fn decides(&self) -> bool {
        self.basis != Basis::Chosen
    }

    /// This check with the tolerance replaced by `allowed`, as the user asks.
    pub fn asked(mut self, allowed: f64) -> Self {
        let failed = self.decides() && !self.passed;
        self.allowed = allowed;
        self.margin = self.difference.map(|difference| allowed - difference);
        self.passed =
            self.value.is_some() && self.reference.is_some() && self.margin.is_some_and(|margin| margin >= 0.0);
        self.basis = Basis::Asked;
        self.excused = failed && self.passed;
        self
    }

    /// A check of `|value − reference| ≤ allowed`.
    pub fn equal(name: &str, value: f64, reference: f64, allowed: f64, basis: Basis, why: impl Into<String>) -> Self {
        Self::with_difference(name, value, reference, (value - reference).abs(), allowed, basis, why)
    }

    /// A check of `value ≤ reference`, by at most `allowed` above it.
    pub fn at_most(name: &str, value: f64, reference: f64, allowed: f64, basis: Basis, why: impl Into<String>) -> Self {
        Self::with_difference(name, value, reference, (value - reference).max(0.0), allowed, basis, why)
    }

    /// A check with a difference measured elsewhere.
    pub fn with_difference(
        name: &str,
        value: f64,
        reference: f64,
        difference: f64,
        allowed: f64,
        basis: Basis,
        why: impl Into<String>,
    ) -> Self {
        let finite = |x: f64| x.is_finite().then_some(x);
        Check {
            name: name.to_string(),
            value: finite(value),
            reference: finite(reference),
            difference: finite(difference),
            allowed,
            margin: finite(allowed - difference),
            // A comparison with NaN is false, so a number that is none does not pass.
            passed: difference <= allowed && value.is_finite() && reference.is_finite(),
            why: why.into(),
            basis,
            excused: false,
        }
    }

    /// A check that could not be made, and therefore has not passed.
    pub fn not_made(name: &str, allowed: f64, basis: Basis, why: impl Into<String>) -> Self {
        Check {
            name: name.to_string(),
            value: None,
            reference: None,
            difference: None,
            allowed,
            margin: None,
            passed: false,
            why: why.into(),
            basis,
            excused: false,
        }
    }
}
