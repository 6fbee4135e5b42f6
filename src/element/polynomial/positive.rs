//! The positive part of a polynomial on a side, by its Bernstein coefficients.
//!
//! A polynomial whose coefficients have one sign has that sign. Where they have both, the side is halved until rounding is all
//! that is left around a zero; what is kept there lies nowhere below the positive part.

use super::quadrature::segment_rule;
use super::side;

/// Halvings around a zero.
const MOST: usize = 60;
/// Values below this part of the largest are rounding around a zero.
const NOTHING: f64 = 1e-15;

/// A part of a side.
pub struct Part {
    /// The parameter at its beginning.
    pub from: f64,
    /// That at its end.
    pub to: f64,
    /// Coefficients there, none of them negative; `None` where the polynomial is not positive.
    positive: Option<Vec<f64>>,
}

impl Part {
    /// f₊ at a parameter of the side.
    pub fn value(&self, at: f64) -> f64 {
        let own = || ((at - self.from) / (self.to - self.from)).clamp(0.0, 1.0);
        self.positive.as_ref().map_or(0.0, |c| side::value(c, own()))
    }
}

/// The parts where `f` is positive, and the others.
pub fn parts(f: &[f64]) -> Vec<Part> {
    let mut out = Vec::new();
    let small = NOTHING * f.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
    let mut left = vec![(0.0, 1.0, f.to_vec(), 0)];
    while let Some((from, to, c, depth)) = left.pop() {
        let largest = c.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if largest <= 0.0 {
            out.push(Part { from, to, positive: None });
        } else if depth == MOST || largest <= small || c.iter().all(|c| *c >= 0.0) {
            out.push(Part { from, to, positive: Some(c.iter().map(|c| c.max(0.0)).collect()) });
        } else {
            let middle = 0.5 * (from + to);
            let [first, second] = halves(c);
            left.push((middle, to, second, depth + 1));
            left.push((from, middle, first, depth + 1));
        }
    }
    out
}

/// Gives `add` the points of a rule on every part, f₊ there and the weight: exact for polynomials of degree `degree` on each.
pub fn points(f: &[f64], degree: usize, mut add: impl FnMut(f64, f64, f64)) {
    for Part { from, to, positive } in parts(f) {
        for &(s, weight) in segment_rule(degree) {
            let value = positive.as_ref().map_or(0.0, |c| side::value(c, s));
            add(from + s * (to - from), value, (to - from) * weight);
        }
    }
}

/// The coefficients on both halves (de Casteljau).
fn halves(mut c: Vec<f64>) -> [Vec<f64>; 2] {
    let degree = c.len() - 1;
    let mut first = vec![c[0]];
    for order in 1..=degree {
        (0..=degree - order).for_each(|i| c[i] = 0.5 * (c[i] + c[i + 1]));
        first.push(c[0]);
    }
    [first, c]
}

/// ∫₀¹ w f₊², with a linear w by its values at the ends.
pub fn square(f: &[f64], [a, b]: [f64; 2]) -> f64 {
    let mut sum = 0.0;
    points(f, 2 * f.len() - 1, |at, positive, weight| sum += weight * (a + at * (b - a)) * positive * positive);
    sum
}

/// ∫₀¹ w f₊ B_i of degree p, i = 0 … p, with a linear w by its values at the ends.
pub fn moments(f: &[f64], p: usize, [a, b]: [f64; 2]) -> Vec<f64> {
    let mut out = vec![0.0; p + 1];
    points(f, f.len() + p, |at, positive, weight| {
        let weight = weight * (a + at * (b - a));
        (0..=p).for_each(|i| out[i] += weight * positive * side::bernstein(p, i, at));
    });
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integrals_are_those_of_where_it_is_positive() {
        // 1 − 3 t on (0, 1/3).
        let line = [1.0, -2.0];
        assert!((square(&line, [1.0; 2]) - 1.0 / 9.0).abs() < 1e-15);
        let [a, b] = <[f64; 2]>::try_from(moments(&line, 1, [1.0; 2])).expect("two");
        // ∫ (1 − 3t)(1 − t) and ∫ (1 − 3t) t over it.
        assert!((a - 4.0 / 27.0).abs() < 1e-15 && (b - 1.0 / 54.0).abs() < 1e-15, "{a} {b}");
        // ∫ (1 + t)(1 − 3t)² over it.
        assert!((square(&line, [1.0, 2.0]) - (1.0 / 9.0 + 1.0 / 108.0)).abs() < 1e-15);
        // What is positive all along is integrated as it is, and what is nowhere is nothing.
        let curve = [0.5, 2.0, 0.1, 0.7];
        assert!((square(&curve, [1.0; 2]) - side::integral(&curve, &curve)).abs() < 1e-15);
        assert_eq!(square(&curve.map(|c| -c), [1.0; 2]), 0.0);
        // Two zeros inside: f² = f₊² + f₋².
        let both = [1.0, -3.0, 2.0];
        let whole = square(&both, [1.0; 2]) + square(&both.map(|c| -c), [1.0; 2]);
        assert!((whole - side::integral(&both, &both)).abs() < 1e-14);
    }
}
