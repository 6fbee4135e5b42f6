//! Numbers and names in the sentences of a diagnosis.

use super::Finding;

/// Numbers this close are one: factors are right to two digits.
const NEAR: f64 = 5e-3;

/// True if two numbers read as one in a sentence.
pub fn near(a: f64, b: f64) -> bool {
    (a - b).abs() <= NEAR * a.abs().max(b.abs())
}

/// A number with four digits.
pub fn number(x: f64) -> String {
    if x != 0.0 && !(1e-3..1e5).contains(&x.abs()) {
        return format!("{x:.3e}");
    }
    let x = format!("{x:.3e}").parse().unwrap_or(x);
    let digits = (3 - x.abs().max(f64::MIN_POSITIVE).log10().floor() as i32).clamp(0, 6);
    format!("{x:.*}", digits as usize)
}

/// A part of a whole in per cent.
pub fn share(x: f64) -> String {
    // Never a whole hundred where something is left.
    if x >= 0.99995 { "more than 99.99 %".to_string() } else { format!("{:.1} %", 100.0 * x.max(0.0)) }
}

/// Describes the factor `s` of `what`: missing, of the wrong sign, of another unit, or larger.
pub fn factor(what: &str, s: f64) -> String {
    let thousands = s.abs().log10() / 3.0;
    let unit = thousands.round() != 0.0 && (thousands - thousands.round()).abs() < 1e-3;
    if s.abs() < NEAR {
        format!("{what} is missing")
    } else if near(s, -1.0) {
        format!("{what} has the opposite sign")
    } else if unit {
        format!("{what} is {} times what the scene says, which is another unit", number(s))
    } else {
        format!("{what} is {} times what the scene says", number(s))
    }
}

/// Sentences one after the other.
pub fn list(findings: &[Finding]) -> String {
    findings.iter().map(|f| f.sentence.as_str()).collect::<Vec<_>>().join(" and ")
}
