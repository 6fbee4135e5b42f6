//! De Casteljau's subdivision of a polynomial on a side, and what it finds: parts, the largest value, the total variation.
//!
//! The coefficients of a polynomial on a part of the side enclose its values there, and come nearer to them with the square of
//! the length of the part. Halving where a question is open answers it to the last digits, whatever the degree.

/// Machine epsilons of the largest coefficient within which two values are one.
const SAME: f64 = 4.0 * f64::EPSILON;
/// Halvings after which a polynomial is straight to the last digit.
const MOST_HALVINGS: u32 = 40;

/// The coefficients of the same polynomial on [0, s] and on [s, 1], each as on a side of its own.
pub fn divide(coefficients: &[f64], s: f64) -> [Vec<f64>; 2] {
    let mut row = coefficients.to_vec();
    let (mut left, mut right) = (Vec::with_capacity(row.len()), vec![0.0; row.len()]);
    for last in (0..row.len()).rev() {
        left.push(row[0]);
        right[last] = row[last];
        for k in 0..last {
            row[k] = (1.0 - s) * row[k] + s * row[k + 1];
        }
    }
    [left, right]
}

/// The coefficients of the same polynomial on [a, b], as on a side of its own.
pub fn part(coefficients: &[f64], [a, b]: [f64; 2]) -> Vec<f64> {
    let [before, _] = divide(coefficients, b);
    let [_, inside] = divide(&before, if b > 0.0 { a / b } else { 0.0 });
    inside
}

/// The largest value and where it is taken: the first place, where there are several.
pub fn largest(coefficients: &[f64]) -> (f64, f64) {
    let (first, last) = (coefficients[0], coefficients[coefficients.len() - 1]);
    let mut best = if last > first { (last, 1.0) } else { (first, 0.0) };
    let size = coefficients.iter().fold(0.0_f64, |m, c| m.max(c.abs()));
    let mut open = vec![(coefficients.to_vec(), 0.0, 0)];
    while let Some((own, from, halvings)) = open.pop() {
        let bound = own.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        // Coefficients that are no numbers bound nothing.
        let open_still = bound > best.0 + SAME * size && size.is_finite();
        if !open_still || halvings == MOST_HALVINGS {
            continue;
        }
        let [left, right] = divide(&own, 0.5);
        let middle = from + 0.5_f64.powi(halvings as i32 + 1);
        if right[0] > best.0 {
            best = (right[0], middle);
        }
        open.push((right, middle, halvings + 1));
        open.push((left, from, halvings + 1));
    }
    best
}

/// ∫ |f'| ds of the polynomial f: all its ways up and down.
pub fn variation(coefficients: &[f64]) -> f64 {
    let mut sum = 0.0;
    let size = coefficients.iter().fold(0.0_f64, |m, c| m.max(c.abs()));
    let mut open = vec![(coefficients.to_vec(), 0)];
    while let Some((own, halvings)) = open.pop() {
        let rises = own.windows(2).all(|w| w[1] >= w[0]);
        let falls = own.windows(2).all(|w| w[1] <= w[0]);
        // Ups and downs of rounding are none, and what is no number has no halves worth looking at.
        let spread = own.iter().fold(0.0_f64, |m, c| m.max((c - own[0]).abs()));
        let uneven = spread > SAME * size && spread.is_finite();
        if rises || falls || !uneven || halvings == MOST_HALVINGS {
            sum += (own[own.len() - 1] - own[0]).abs();
        } else {
            open.extend(divide(&own, 0.5).map(|half| (half, halvings + 1)));
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::polynomial::side;

    /// Coefficients that look like nothing in particular.
    fn some(p: usize) -> Vec<f64> {
        (0..=p).map(|k| (2.5 * (k * k) as f64 + 1.3 * (p + k) as f64).sin()).collect()
    }

    const POINTS: usize = 20_000;

    fn sampled(c: &[f64]) -> Vec<f64> {
        (0..=POINTS).map(|i| side::value(c, i as f64 / POINTS as f64)).collect()
    }

    #[test]
    fn rounding_and_what_is_no_number_are_not_looked_into() {
        let e = f64::EPSILON;
        assert!(variation(&[1.0, 1.0 + e, 1.0 - e, 1.0 + e, 1.0]) < 4.0 * e);
        for wild in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let c = [1.0, wild, -wild, 2.0];
            variation(&c);
            largest(&c);
        }
    }

    #[test]
    fn parts_have_the_values_of_the_whole() {
        for p in 0..=8 {
            let c = some(p);
            for [a, b] in [[0.0, 1.0], [0.0, 0.3], [0.25, 0.5], [0.6, 1.0]] {
                let own = part(&c, [a, b]);
                for s in [0.0, 0.2, 0.77, 1.0] {
                    assert!((side::value(&own, s) - side::value(&c, a + s * (b - a))).abs() < 1e-13);
                }
            }
        }
    }

    #[test]
    fn the_largest_value_is_above_all_others_and_is_taken() {
        for p in 0..=8 {
            let c = some(p);
            let (value, at) = largest(&c);
            let most = sampled(&c).into_iter().fold(f64::NEG_INFINITY, f64::max);
            assert!(value > most - 1e-14 && value < most + 1e-6, "degree {p}: {value} and {most}");
            assert!((side::value(&c, at) - value).abs() < 1e-13);
        }
    }

    #[test]
    fn a_maximum_between_coefficients_that_are_all_larger_or_smaller() {
        // 4 s (1 − s), whose middle coefficient is twice its largest value.
        assert_eq!(largest(&[0.0, 2.0, 0.0]), (1.0, 0.5));
        assert_eq!(largest(&[3.0; 9]), (3.0, 0.0));
        assert_eq!(largest(&[-1.0, -2.0]), (-1.0, 0.0));
        assert_eq!(largest(&[0.7]), (0.7, 0.0));
    }

    #[test]
    fn variation_counts_every_way_up_and_down() {
        assert_eq!(variation(&[0.0, 2.0, 0.0]), 2.0);
        assert_eq!(variation(&[5.0]), 0.0);
        for p in 1..=8 {
            let c = some(p);
            let steps: f64 = sampled(&c).windows(2).map(|w| (w[1] - w[0]).abs()).sum();
            assert!((variation(&c) - steps).abs() < 1e-6, "degree {p}");
        }
    }
}
