//! Numbers and names in the sentences of a diagnosis.

use super::Finding;

/// Numbers this close are one: factors are right to two digits.
const NEAR: f64 = 5e-3;
/// Factors below this one are rounding, and no unit.
pub const LEAST_UNIT: f64 = 1e-10;
/// Decimals of a number in a sentence, and the most that it takes to tell it from another.
const FEWEST: usize = 3;
const MOST: usize = 12;

/// True if two numbers read as one in a sentence.
pub fn near(a: f64, b: f64) -> bool {
    (a - b).abs() <= NEAR * a.abs().max(b.abs())
}

/// A number with four digits.
pub fn number(x: f64) -> String {
    with_decimals(x, FEWEST)
}

/// A number with four digits, or with as many as show that it is not `other`.
pub fn number_beside(x: f64, other: f64) -> String {
    let differ = |decimals: &usize| format!("{x:.decimals$e}") != format!("{other:.decimals$e}");
    with_decimals(x, (FEWEST..=MOST).find(differ).unwrap_or(FEWEST))
}

/// A number with one digit before and `decimals` behind the point, were it written with an exponent.
fn with_decimals(x: f64, decimals: usize) -> String {
    if x != 0.0 && !(1e-3..1e5).contains(&x.abs()) {
        return format!("{x:.decimals$e}");
    }
    let x: f64 = format!("{x:.decimals$e}").parse().unwrap_or(x);
    let decimals = decimals as i32;
    let places = (decimals - x.abs().max(f64::MIN_POSITIVE).log10().floor() as i32).clamp(0, decimals + 3);
    format!("{x:.*}", places as usize)
}

/// A factor, with as many digits as show that it is not one.
pub fn times(s: f64) -> String {
    number_beside(s, 1.0)
}

/// A part of a whole in per cent.
pub fn share(x: f64) -> String {
    let cents = 100.0 * x.max(0.0);
    // Never a whole hundred where something is left.
    match x {
        0.99995.. => "more than 99.99 %".to_string(),
        0.9995.. => format!("{cents:.2} %"),
        _ => format!("{cents:.1} %"),
    }
}

/// Describes the factor `s` of `what`: missing, of the wrong sign, of another unit, or larger.
pub fn factor(what: &str, s: f64) -> String {
    let thousands = s.abs().log10() / 3.0;
    let unit = thousands.round() != 0.0 && (thousands - thousands.round()).abs() < 1e-3 && s.abs() > LEAST_UNIT;
    if s.abs() < NEAR && !unit {
        format!("{what} is missing")
    } else if near(s, -1.0) {
        format!("{what} has the opposite sign")
    } else if unit {
        format!("{what} is {} times what the scene says, which is another unit", times(s))
    } else {
        format!("{what} is {} times what the scene says", times(s))
    }
}

/// Sentences one after the other.
pub fn list(findings: &[Finding]) -> String {
    findings.iter().map(|f| f.sentence.as_str()).collect::<Vec<_>>().join(" and ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_have_as_many_digits_as_show_that_they_are_not_one() {
        let cases =
            [(1.0001, "1.0001"), (0.99996, "0.99996"), (1.000_000_2, "1.0000002"), (1.05, "1.050"), (2.0, "2.000")];
        for (s, words) in cases {
            assert_eq!(times(s), words);
        }
        assert_eq!(number_beside(0.30004, 0.3), "0.30004");
        assert_eq!(number_beside(1e-7, 2e-7), "1.000e-7");
        assert!(factor("every load", 1.0001).contains(" 1.0001 times"));
        assert!(factor("every load", 1e-3).ends_with("which is another unit"));
        assert!([2e-3, 1e-15].iter().all(|s| factor("every load", *s) == "every load is missing"));
    }

    #[test]
    fn no_part_reads_as_the_whole() {
        let cases = [
            (0.5, "50.0 %"),
            (0.9994, "99.9 %"),
            (0.9997, "99.97 %"),
            (0.99994, "99.99 %"),
            (1.0, "more than 99.99 %"),
        ];
        for (part, words) in cases {
            assert_eq!(share(part), words);
        }
    }
}
