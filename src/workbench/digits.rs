//! How many digits the entries of a matrix were printed with.

use nalgebra::DMatrix;

/// The digits of numbers that are not rounded: more than this say nothing.
const MOST: usize = 8;
/// Fewer are too few to tell a mistake from rounding.
const LEAST: usize = 3;

/// Rounding of the entries of a matrix, where it shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Rounded {
    /// So many significant decimal digits.
    Digits(usize),
    /// Single precision.
    Single,
}

impl Rounded {
    /// How the entries look; `None` where they have more digits than were printed by choice.
    pub fn of(k: &DMatrix<f64>) -> Option<Self> {
        let digits = k.iter().map(|x| digits_of(*x)).max().unwrap_or(0);
        if (LEAST..=MOST).contains(&digits) {
            return Some(Rounded::Digits(digits));
        }
        let is_single = |x: &f64| f64::from(*x as f32) == *x;
        (digits > MOST && k.iter().all(is_single)).then_some(Rounded::Single)
    }

    /// How exact the entries are, relative to the largest.
    pub fn precision(self) -> f64 {
        match self {
            Rounded::Digits(digits) => 10.0_f64.powi(1 - digits as i32),
            Rounded::Single => 1e-5,
        }
    }

    /// The digits of the entries, in words.
    pub fn words(self) -> String {
        match self {
            Rounded::Digits(digits) => format!("at most {digits} digits"),
            Rounded::Single => "the digits of single precision".into(),
        }
    }
}

/// The least number of significant digits that give a number back.
fn digits_of(x: f64) -> usize {
    let is_same = |digits: &usize| format!("{x:.*e}", digits - 1).parse() == Ok(x);
    if x == 0.0 { 0 } else { (1..17).find(is_same).unwrap_or(17) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn printed_digits_are_counted() {
        let of = |entries: &[f64]| Rounded::of(&DMatrix::from_row_slice(1, entries.len(), entries));
        assert_eq!(of(&[0.1234, -12.0, 0.0, 1.3e-9]), Some(Rounded::Digits(4)));
        assert_eq!(of(&[1.0 / 3.0, 0.5]), None);
        assert_eq!(of(&[0.5, 0.25]), None, "two digits are those of an exact number");
        assert_eq!(of(&[f64::from(0.1_f32), 2.0]), Some(Rounded::Single));
        assert_eq!(Rounded::Digits(4).precision(), 1e-3);
    }
}
