//! How many digits the numbers of a file keep.

/// Fewer numbers than this say nothing about the digits of a file.
const ENOUGH: usize = 24;
/// Of the numbers of a file with so many digits, this part needs all of them; nine tenths of arbitrary ones do.
const USED: f64 = 0.8;
/// Numbers of a file that keeps more digits than this are as good as those of the machine.
const MOST: usize = 12;

/// Rounding relative to their size that `values` carry, where a file keeps a few decimal digits of them, or single precision.
pub(super) fn precision(values: impl Iterator<Item = f64>, single: bool) -> f64 {
    let values: Vec<f64> = values.filter(|x| *x != 0.0).collect();
    let machine = if single || are_single(&values) { f64::from(f32::EPSILON) } else { f64::EPSILON };
    let mut counts = [0; MOST + 1];
    let mut all = 0;
    for x in values {
        let Some(digits) = (1..=MOST).find(|d| format!("{x:.*e}", d - 1).parse() == Ok(x)) else { return machine };
        counts[digits] += 1;
        all += 1;
    }
    let most = (1..=MOST).rev().find(|d| counts[*d] > 0).unwrap_or(MOST);
    let used = counts[most] as f64 >= USED * all as f64;
    if all >= ENOUGH && used { (0.5 * 10f64.powi(1 - most as i32)).max(machine) } else { machine }
}

/// Whether numbers in double precision are those of single precision, of which most use all digits.
fn are_single(values: &[f64]) -> bool {
    // Sixteen of its bits in 23, and simple numbers do without the last seven.
    let full = |x: &&f64| (**x as f32).to_bits() & 0x7f != 0;
    let used = values.iter().filter(full).count();
    values.len() >= ENOUGH
        && used as f64 >= USED * values.len() as f64
        && values.iter().all(|x| f64::from(*x as f32) == *x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_those_that_the_numbers_need() {
        let values = || (1..200).map(|k| f64::from(k).sin());
        let rounded = |digits: usize| values().map(move |x| format!("{x:.*e}", digits - 1).parse().unwrap_or(x));
        assert_eq!(precision(values(), false), f64::EPSILON);
        assert_eq!(precision(rounded(6), false), 0.5e-5);
        assert_eq!(precision(rounded(9), true), f64::from(f32::EPSILON));
        assert_eq!(precision(values().map(|x| f64::from(x as f32)), false), f64::from(f32::EPSILON));
        // Short because they are simple, not because they were cut.
        assert_eq!(precision((1..200).map(|k| f64::from(k) / 8.0), false), f64::EPSILON);
        assert_eq!(precision([0.123, 0.456].into_iter(), false), f64::EPSILON);
    }
}
