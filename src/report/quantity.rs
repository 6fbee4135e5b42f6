//! Quantities of a scene in the report: the interval that holds each, and the values that are held against it.

use schemars::JsonSchema;
use serde::Serialize;

use super::Report;
use super::text::number::{digits_to_tell, outward, significant};
use crate::compare::name::{GIVEN, of_quantity};
use crate::quantity::outside;

/// Ends that are closer than this, relative to their size, differ by rounding.
const A_POINT: f64 = 1e-9;
/// Digits of a value that is known but for rounding.
const DIGITS_OF_A_POINT: usize = 9;
/// Symbols for ends that are missing.
const MISSING: [&str; 2] = ["−∞", "∞"];

/// A quantity of the scene, with an interval that holds its exact value.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct QuantitySummary {
    /// Its name.
    pub name: String,
    /// `displacement`, `force`, `moment` or `stress`.
    pub kind: String,
    /// The value of the dual solution, for displacements that of the upper bound: nearer to the truth than the middle of
    /// the interval. `null` where it is not known.
    pub value: f64,
    /// The exact value is no less; `null` where nothing is guaranteed.
    pub lower: f64,
    /// The exact value is no more; `null` where nothing is guaranteed.
    pub upper: f64,
    /// The interval of first order, to compare with; `null` for an end that it does not have.
    pub first_order: [f64; 2],
    /// Whether equilibrium alone determines the value.
    pub exact_by_statics: bool,
    /// How far outside rounding may put a correct value that was computed.
    #[serde(skip)]
    pub rounding: f64,
    /// The values of the displacement models.
    pub primal: Vec<QuantityOfModel>,
    /// Why there is no interval, or only one end of it; `null` where there is one.
    pub reason: Option<String>,
}

/// The value of a quantity in a displacement model.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct QuantityOfModel {
    /// The model.
    pub solver: String,
    /// Polynomial degree.
    pub degree: usize,
    /// Its value; `null` where its displacement does not tell.
    pub value: Option<f64>,
    /// Why there is no value, or what that of its reactions is worth; `null` where its displacement tells.
    pub reason: Option<String>,
    /// Whether it lies in the interval; `null` where there is no value or no interval.
    pub inside: Option<bool>,
}

/// A value that is held against an interval.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Held {
    /// Whose it is.
    pub of: String,
    /// Polynomial degree, where it is that of a field.
    pub degree: Option<usize>,
    /// The value; `None` where the field does not tell.
    pub value: Option<f64>,
    /// Why the field does not tell, or what its value is worth.
    pub reason: Option<String>,
    /// True if its distance from the interval is within the allowance for its own error, where that was checked.
    pub allowed: Option<bool>,
}

impl QuantitySummary {
    /// True if both ends are there.
    pub fn is_enclosed(&self) -> bool {
        self.lower.is_finite() && self.upper.is_finite()
    }

    /// True if anything is guaranteed.
    pub fn has_an_end(&self) -> bool {
        self.lower.is_finite() || self.upper.is_finite()
    }

    /// True if the ends differ by no more than rounding.
    pub fn is_point(&self) -> bool {
        self.is_enclosed() && self.upper - self.lower <= A_POINT * self.lower.abs().max(self.upper.abs())
    }

    /// Half of the width; infinite where an end is missing.
    pub fn half_width(&self) -> f64 {
        if self.is_enclosed() { 0.5 * (self.upper - self.lower) } else { f64::INFINITY }
    }

    /// Half of the width relative to the value.
    pub fn relative_half_width(&self) -> f64 {
        self.half_width() / self.value.abs()
    }

    /// By how much `x` lies outside; zero inside.
    pub fn outside(&self, x: f64) -> f64 {
        outside([self.lower, self.upper], self.rounding, x)
    }

    /// The digits that tell the ends of the interval apart.
    pub fn digits(&self) -> usize {
        match () {
            _ if self.is_point() => DIGITS_OF_A_POINT,
            _ if self.is_enclosed() => digits_to_tell(self.lower, self.upper),
            _ => 6,
        }
    }

    /// The lower and the upper end, rounded away from the interval, with a sign of infinity for one that is missing.
    pub fn ends(&self) -> [String; 2] {
        let end = |k: usize, x: f64| {
            if x.is_finite() { outward(x, self.digits(), k == 1) } else { MISSING[k].to_string() }
        };
        [end(0, self.lower), end(1, self.upper)]
    }

    /// The interval: `−0.57 … −0.56`.
    pub fn interval(&self) -> String {
        self.ends().join(" … ")
    }

    /// One sentence, with the [firmness](Report::firmness) of the interval.
    pub fn in_words(&self, firmness: &str) -> String {
        let value = if self.value.is_finite() { significant(self.value, self.digits()) } else { "unknown".to_string() };
        let how = if self.exact_by_statics { ", exact by statics" } else { "" };
        let reason = self.reason.as_ref().map_or(String::new(), |reason| format!(" ({reason})"));
        format!("{} ({}): {value}, {firmness} within {}{how}{reason}", self.name, self.kind, self.interval())
    }

    /// The values that are held against the interval: those of the displacement models, then those that came without a
    /// field.
    pub(crate) fn held(&self, report: &Report) -> Vec<Held> {
        let checks = |last: &str| {
            let name = of_quantity(&self.name, last);
            report.checks.iter().filter(move |check| check.name == name)
        };
        let of_model = |model: &QuantityOfModel| Held {
            of: model.solver.clone(),
            degree: Some(model.degree),
            value: model.value,
            reason: model.reason.clone(),
            allowed: checks(&model.solver).next().map(|check| check.passed),
        };
        let given = checks(GIVEN).map(|check| Held {
            of: GIVEN.to_string(),
            degree: None,
            value: check.value,
            reason: None,
            allowed: Some(check.passed),
        });
        self.primal.iter().map(of_model).chain(given).collect()
    }

    /// How a value that is held against the interval lies to it, in words; empty inside.
    pub(crate) fn verdict_on(&self, held: &Held) -> String {
        let Some(value) = held.value else {
            let why = held.reason.as_ref().map_or(String::new(), |reason| format!(": {reason}"));
            return format!("its displacement does not tell{why}");
        };
        let outside = self.outside(value);
        if outside == 0.0 {
            return String::new();
        }
        let own = match &held.reason {
            _ if held.allowed == Some(true) && held.of == GIVEN => ", which its last digit explains".to_string(),
            _ if held.allowed == Some(true) => ", which its own error may explain".to_string(),
            Some(reason) => format!("; {reason}"),
            None => String::new(),
        };
        format!("outside by {}{own}", significant(outside, 3))
    }
}

impl Report {
    /// How firmly intervals hold, before "within".
    pub fn firmness(&self) -> &'static str {
        firmness(self.is_guaranteed(), Data::of(self.coulomb.is_some(), self.data_range.is_some()))
    }
}

/// The data that intervals are for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Data {
    /// Those of the scene.
    Whole,
    /// Those with the friction bound that was found.
    OfBound,
    /// One end of each range of the scene.
    OfEnds,
}

impl Data {
    /// Those of a scene with Coulomb friction, or with ranges, or with neither.
    pub fn of(coulomb: bool, ranges: bool) -> Self {
        match (coulomb, ranges) {
            (true, _) => Data::OfBound,
            (false, true) => Data::OfEnds,
            (false, false) => Data::Whole,
        }
    }
}

/// As [`Report::firmness`], of a problem whose notes leave the guarantee or not.
pub fn firmness(guaranteed: bool, data: Data) -> &'static str {
    match (guaranteed, data) {
        (false, _) => "indicated",
        (true, Data::OfBound) => "for the friction bound that was found guaranteed",
        (true, Data::OfEnds) => "for the ends of the ranges with the lowest energy guaranteed",
        (true, Data::Whole) => "guaranteed",
    }
}

#[cfg(test)]
mod tests {
    use crate::report::sample::{Sample, Verdict};

    #[test]
    fn a_sentence_says_what_is_known_and_why_not_more() {
        let mut quantities = Sample::new(1, Verdict::Agree).dossier().report.quantities;
        assert_eq!(
            quantities[0].in_words("guaranteed"),
            "tip <a&b> (displacement): 0.801, guaranteed within 0.79 … 0.81"
        );
        assert_eq!(
            quantities[1].in_words("guaranteed"),
            "seat (force): 0.25, guaranteed within 0.2 … ∞ (nothing holds <it>)"
        );
        assert!(quantities[2].in_words("guaranteed").ends_with("0.5 … 0.5, exact by statics"));
        assert!(quantities[0].in_words("indicated").contains("indicated within"));
        quantities[0].lower = 0.790_000_9;
        quantities[0].upper = 0.810_000_1;
        assert_eq!(quantities[0].interval(), "0.79 … 0.81001", "rounded away from what it holds");
    }

    #[test]
    fn widths_and_distances_are_those_of_the_interval() {
        let quantities = Sample::new(1, Verdict::Agree).dossier().report.quantities;
        let [tip, seat, whole] = [0, 1, 2].map(|k| &quantities[k]);
        assert!((tip.half_width() - 0.01).abs() < 1e-15 && (tip.relative_half_width() - 0.01 / 0.801).abs() < 1e-15);
        assert!((tip.outside(0.85) - 0.04).abs() < 1e-15 && tip.outside(0.8) == 0.0);
        assert!(!seat.is_enclosed() && seat.half_width().is_infinite() && seat.outside(1e9) == 0.0);
        assert!(whole.is_point() && !tip.is_point());
    }
}
