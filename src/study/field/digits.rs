//! How many digits the numbers of a file keep.

use std::path::Path;

/// Fewer numbers than this say nothing about the digits of a file.
const ENOUGH: usize = 24;
/// So many different last digits among the longest numbers of a file are the work of a writer that cuts them. Multiples of a half, a
/// quarter, an eighth end with a 5, whatever their length.
const LAST: usize = 3;
/// Numbers of a file that keeps more digits than this are as good as those of the machine.
const MOST: usize = 12;

/// The part of numbers in single precision that use its last bits.
const FULL: f64 = 0.8;

/// Rounding relative to their size that a format leaves in its numbers, however few there are: results of CalculiX have six or
/// seven digits.
pub(super) fn of_format(file: &Path) -> f64 {
    match ending(file).as_str() {
        "frd" => 0.5e-5,
        "dat" => 0.5e-6,
        _ => 0.0,
    }
}

/// What tells the format of a file: the end of its name, without that of gzip.
pub(super) fn ending(file: &Path) -> String {
    let name = file.to_string_lossy().to_ascii_lowercase();
    name.strip_suffix(".gz").unwrap_or(&name).rsplit('.').next().unwrap_or_default().to_string()
}

/// Rounding relative to their size that `values` carry, where a file keeps a few decimal digits of them, or single precision.
pub(super) fn precision(values: impl Iterator<Item = f64>, single: bool) -> f64 {
    let values: Vec<f64> = values.filter(|x| *x != 0.0).collect();
    let machine = if single || are_single(&values) { f64::from(f32::EPSILON) } else { f64::EPSILON };
    let mut ends = [[false; 10]; MOST + 1];
    let mut all = 0;
    for x in values {
        let written = (1..=MOST).map(|d| format!("{x:.*e}", d - 1)).enumerate().find(|(_, text)| text.parse() == Ok(x));
        let Some((before, text)) = written else { return machine };
        let last = text.split('e').next().and_then(|digits| digits.chars().last()?.to_digit(10)).unwrap_or(0);
        ends[before + 1][last as usize] = true;
        all += 1;
    }
    let most = (1..=MOST).rev().find(|d| ends[*d] != [false; 10]).unwrap_or(MOST);
    let cut = ends[most].iter().filter(|there| **there).count() >= LAST;
    if all >= ENOUGH && cut { (0.5 * 10f64.powi(1 - most as i32)).max(machine) } else { machine }
}

/// True if numbers in double precision are those of single precision, most of which use all their digits.
fn are_single(values: &[f64]) -> bool {
    // Sixteen of its bits in 23, and simple numbers do without the last seven.
    let full = |x: &&f64| (**x as f32).to_bits() & 0x7f != 0;
    let used = values.iter().filter(full).count();
    values.len() >= ENOUGH
        && used as f64 >= FULL * values.len() as f64
        && values.iter().all(|x| f64::from(*x as f32) == *x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_of_calculix_have_the_digits_of_their_format() {
        assert_eq!(of_format(Path::new("out/job.FRD")), 0.5e-5);
        assert_eq!(of_format(Path::new("job.dat")), 0.5e-6);
        assert_eq!(of_format(Path::new("job.frd.gz")), 0.5e-5);
        assert_eq!(of_format(Path::new("frd.vtu")), 0.0);
    }

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
