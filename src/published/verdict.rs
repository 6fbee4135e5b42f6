//! Verdict of a guaranteed interval on a published number.

use super::Value;
use crate::quantity::outside;
use crate::report::text::number::significant;

/// How a published number lies to the interval of its quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Verdict {
    /// Inside the interval.
    Inside,
    /// Outside, by no more than its accuracy.
    Accurate,
    /// Beyond its accuracy, by so much.
    Outside(f64),
    /// The interval is wider than was asked for, so that nothing follows from it.
    Undecided,
    /// The number belongs to another place.
    Elsewhere,
}

impl Verdict {
    /// Judges `value` by `ends`, which are to be no further apart than twice `wanted`.
    pub fn of(value: &Value, ends: [f64; 2], wanted: f64) -> Self {
        let width = ends[1] - ends[0];
        if value.elsewhere.is_some() {
            return Verdict::Elsewhere;
        }
        let is_narrow = width <= 2.0 * wanted;
        if !is_narrow || !value.number().is_finite() {
            return Verdict::Undecided;
        }
        let distance = outside(ends, 0.0, value.number());
        match () {
            _ if distance == 0.0 => Verdict::Inside,
            _ if distance <= value.accuracy => Verdict::Accurate,
            _ => Verdict::Outside(distance - value.accuracy),
        }
    }

    /// True if the published number may be right; one that is not judged is no reason to doubt it.
    pub fn agrees(self) -> bool {
        matches!(self, Verdict::Inside | Verdict::Accurate | Verdict::Elsewhere)
    }

    /// The verdict in words.
    pub fn words(self) -> String {
        match self {
            Verdict::Inside => "inside".to_string(),
            Verdict::Accurate => "inside within its accuracy".to_string(),
            Verdict::Outside(by) => format!("outside by {} beyond its accuracy", significant(by, 2)),
            Verdict::Undecided => "not decided: the interval is wider than was asked for".to_string(),
            Verdict::Elsewhere => "not judged".to_string(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_is_judged_by_its_accuracy_and_by_a_narrow_interval_only() {
        let value = |printed: &str, elsewhere: Option<&str>| Value {
            quantity: "q".into(),
            printed: printed.into(),
            formula: None,
            accuracy: 0.05,
            because: String::new(),
            source: String::new(),
            checked: String::new(),
            finding: None,
            elsewhere: elsewhere.map(str::to_string),
        };
        let of = |printed: &str, ends| Verdict::of(&value(printed, None), ends, 0.1);
        assert_eq!(of("92.7", [92.68, 92.73]), Verdict::Inside);
        assert_eq!(of("92.7", [92.74, 92.79]), Verdict::Accurate);
        assert!(matches!(of("92.7", [92.9, 92.95]), Verdict::Outside(by) if (by - 0.15).abs() < 1e-9));
        assert_eq!(of("92.7", [92.5, 92.9]), Verdict::Undecided);
        for ends in [[f64::NEG_INFINITY, f64::INFINITY], [f64::NAN, 1.0], [92.7, f64::INFINITY]] {
            assert_eq!(of("92.7", ends), Verdict::Undecided);
        }
        assert_eq!(of("none", [92.68, 92.73]), Verdict::Undecided);
        assert_eq!(Verdict::of(&value("92.7", Some("there")), [0.0, 1.0], 0.1), Verdict::Elsewhere);
        assert!(!Verdict::Undecided.agrees() && !Verdict::Outside(1.0).agrees() && Verdict::Elsewhere.agrees());
    }
}
