//! The gap along a contact edge as a polynomial: its chord less a bow.
//!
//! With t from 0 at the first end of a pair to 1 at the second,
//!
//! g(t) = (1 − t) g₀ + t g₁ − t (1 − t) b(t), b(t) = l² g[s₀, s₁, s(t)],
//!
//! with the second divided difference of the curve, which is l²/2R for a parabola, and positive for everything convex. What is kept
//! of a circle is a polynomial that is no less than its b, so that the polynomial gap P has the values of the curve at the
//! ends and lies nowhere above it: whatever is admissible for P is so for the curve. By how much the curve lies above P is
//! bounded ([`Bow::excess`]), and the lower bound loses ∫ (−t) times that.
//!
//! b is interpolated at Chebyshev points. Its n-th derivative is l^{n + 2} n! g^{(n + 2)}/(n + 2)! somewhere between, and
//! those of g = R − √(R² − x²) are largest at the largest x, since all coefficients of its power series about 0 are
//! positive: the remainder has a bound from the coefficients of the series about that x.

use crate::element::polynomial::side;
use crate::problem::ContactPair;
use crate::scene::{Gap, Touching};

/// The largest degree of b.
const MOST: usize = 8;
/// A remainder of b below this part of it is rounding.
const ENOUGH: f64 = 1e-13;

/// How far a gap lies below its chord along an edge: b by its Bernstein coefficients, none for a gap that is linear.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Bow {
    coefficients: [f64; MOST + 1],
    count: usize,
    excess: f64,
}

impl Bow {
    /// The number of [`Bow::numbers`].
    pub const NUMBERS: usize = MOST + 3;

    /// That of `gap` between two arc lengths; of a table or a number, none.
    pub fn of(gap: &Gap, [from, to]: [f64; 2]) -> Bow {
        match gap {
            Gap::Constant(_) | Gap::Table(_) => Bow::default(),
            Gap::Parabola(Touching { radius, .. }) => Bow::constant((to - from).powi(2) / (2.0 * radius), 0.0),
            Gap::Circle(circle) => Bow::of_circle(circle, [from, to]),
        }
    }

    fn constant(b: f64, excess: f64) -> Bow {
        let mut coefficients = [0.0; MOST + 1];
        coefficients[0] = b;
        Bow { coefficients, count: usize::from(b != 0.0), excess }
    }

    fn of_circle(circle: &Touching, arc: [f64; 2]) -> Bow {
        let ends = arc.map(|s| s - circle.at);
        let length = ends[1] - ends[0];
        // The tangents at the two ends lie below a convex curve: chord − g ≤ l · min(t (c − g₀'), (1 − t) (g₁' − c)), c the
        // slope of the chord, so that g₁' − g₀' bounds b/l.
        let [a, b] = ends.map(|x| circle.slope(x));
        let by_tangents = Bow::constant(length * (b - a), 0.25 * length * (b - a));
        let farthest = ends[0].abs().max(ends[1].abs());
        if farthest > circle.round() {
            return by_tangents;
        }
        let by_series = (0..=MOST).map(|degree| (degree, remainder(circle.radius, farthest, length, degree)));
        let size = length * length / circle.radius;
        let better =
            |(d, r): (usize, f64), (e, s): (usize, f64)| if r <= ENOUGH * size || r <= s { (d, r) } else { (e, s) };
        let Some((degree, remainder)) = by_series.reduce(better) else { return by_tangents };
        let b = interpolated(circle.radius, ends, degree);
        let rounding = ENOUGH * b.iter().fold(0.0_f64, |m, b| m.max(b.abs()));
        let excess = 0.5 * (remainder + rounding);
        if excess > by_tangents.excess {
            return by_tangents;
        }
        let mut bow = Bow { count: b.len(), excess, ..Bow::default() };
        bow.coefficients.iter_mut().zip(b).for_each(|(kept, b)| *kept = b + remainder + rounding);
        bow
    }

    /// Coefficients of b, none where the gap is linear.
    pub fn coefficients(&self) -> &[f64] {
        &self.coefficients[..self.count]
    }

    /// True if the gap is linear.
    pub fn is_none(&self) -> bool {
        self.count == 0
    }

    /// By how much the curve lies above its polynomial at most; zero for a parabola.
    pub fn excess(&self) -> f64 {
        self.excess
    }

    /// Coefficients of a polynomial of degree `degree` that is no less than b: itself where it has no larger degree. In no
    /// degree are coefficients of the difference below zero.
    fn above(&self, degree: usize) -> Vec<f64> {
        let b = self.coefficients();
        if b.len() <= degree + 1 {
            return side::elevate(b, degree);
        }
        let nearest = side::from_moments(&side::moments(b, degree));
        let raised = side::elevate(&nearest, b.len() - 1);
        let short = b.iter().zip(raised).map(|(b, own)| b - own).fold(0.0, f64::max);
        nearest.into_iter().map(|own| own + short).collect()
    }

    /// All of it as numbers.
    pub fn numbers(&self) -> [f64; Self::NUMBERS] {
        let mut out = [0.0; Self::NUMBERS];
        out[..=MOST].copy_from_slice(&self.coefficients);
        out[MOST + 1..].copy_from_slice(&[self.count as f64, self.excess]);
        out
    }

    /// The one that these are the numbers of; `None` where they are those of none.
    pub fn from_numbers(numbers: [f64; Self::NUMBERS]) -> Option<Bow> {
        let mut coefficients = [0.0; MOST + 1];
        coefficients.copy_from_slice(&numbers[..=MOST]);
        let count = (0..=MOST + 1).find(|count| *count as f64 == numbers[MOST + 1])?;
        Some(Bow { coefficients, count, excess: numbers[MOST + 2] })
    }
}

impl ContactPair {
    /// Bernstein coefficients of the gap P along the pair.
    pub fn gap_polynomial(&self) -> Vec<f64> {
        match self.bow.count {
            0 => self.gap.to_vec(),
            count => self.gap_below(count + 1),
        }
    }

    /// P at t.
    pub fn gap_at(&self, t: f64) -> f64 {
        let chord = self.gap[0] + t * (self.gap[1] - self.gap[0]);
        match self.bow.coefficients() {
            [] => chord,
            b => chord - t * (1.0 - t) * side::value(b, t),
        }
    }

    /// The mean of P.
    pub fn mean_gap(&self) -> f64 {
        let chord = 0.5 * (self.gap[0] + self.gap[1]);
        chord - side::integral(self.bow.coefficients(), &[0.0, 0.5, 0.0])
    }

    /// ∫₀¹ P B_k of degree p, k = 0 … p.
    pub fn gap_moments(&self, p: usize) -> Vec<f64> {
        side::moments(&self.gap_polynomial(), p)
    }

    /// Coefficients of degree `degree` of a polynomial that lies nowhere above the gap: P where the degree allows. From degree 2
    /// on it has the values of the gap at the ends.
    pub fn gap_below(&self, degree: usize) -> Vec<f64> {
        let chord = side::linear(self.gap, degree);
        if self.bow.is_none() {
            return chord.collect();
        }
        if degree < 2 {
            let deepest = 0.25 * self.bow.above(0)[0];
            return chord.map(|g| g - deepest).collect();
        }
        // t (1 − t) B_{j − 1} of degree q − 2 is j (q − j)/(q (q − 1)) times B_j of degree q.
        let b = self.bow.above(degree - 2);
        let part = |j: usize| (j * (degree - j)) as f64 / (degree * (degree - 1)) as f64;
        let below = |(j, g): (usize, f64)| if j == 0 || j == degree { g } else { g - part(j) * b[j - 1] };
        chord.enumerate().map(below).collect()
    }
}

/// b of a circle of radius `r` between two distances from where it touches, at t.
///
/// g[x₀, x₁, x] without differences of numbers that are nearly equal, y = √(r² − x²).
fn bow_of_circle(r: f64, [x0, x1]: [f64; 2], t: f64) -> f64 {
    let x = x0 + t * (x1 - x0);
    let [y0, y1, y] = [x0, x1, x].map(|x| ((r - x) * (r + x)).sqrt());
    let second = ((y0 + y1) + (x0 + x1) * (x + x0) / (y0 + y)) / ((y + y1) * (y0 + y1));
    (x1 - x0).powi(2) * second
}

/// Coefficients of the polynomial of degree `degree` that has the values of b at Chebyshev points.
fn interpolated(r: f64, ends: [f64; 2], degree: usize) -> Vec<f64> {
    let point = |i: usize| {
        let angle = (2 * i + 1) as f64 / (2 * degree + 2) as f64 * std::f64::consts::PI;
        0.5 * (1.0 - angle.cos())
    };
    let points: Vec<f64> = (0..=degree).map(point).collect();
    // Newton's divided differences, then Horner's scheme in Bernstein coefficients.
    let mut newton: Vec<f64> = points.iter().map(|t| bow_of_circle(r, ends, *t)).collect();
    for order in 1..=degree {
        for i in (order..=degree).rev() {
            newton[i] = (newton[i] - newton[i - 1]) / (points[i] - points[i - order]);
        }
    }
    let mut out = vec![newton[degree]];
    for i in (0..degree).rev() {
        let n = out.len();
        let own = |j: usize| if j < n { (n - j) as f64 * out[j] * -points[i] } else { 0.0 };
        let before = |j: usize| if j > 0 { j as f64 * out[j - 1] * (1.0 - points[i]) } else { 0.0 };
        out = (0..=n).map(|j| (own(j) + before(j)) / n as f64 + newton[i]).collect();
    }
    out
}

/// By how much b and its interpolation of degree `degree` differ at most on an edge of the given length that reaches to
/// `farthest` from where the circle touches.
fn remainder(r: f64, farthest: f64, length: f64, degree: usize) -> f64 {
    // Coefficients of the series of g about `farthest`, n-th derivatives over n!, from y² = r² − x².
    let y = ((r - farthest) * (r + farthest)).sqrt();
    let mut series = vec![0.0, farthest / y];
    series.push((1.0 + series[1] * series[1]) / (2.0 * y));
    for n in 3..=degree + 3 {
        let sum: f64 = (1..n).map(|k| series[k] * series[n - k]).sum();
        series.push(sum / (2.0 * y));
    }
    let order = degree as i32 + 1;
    // |∏ (t − t_i)| ≤ 2/4^{d + 1}.
    length.powi(order + 2) * series[degree + 3] * 2.0 * 0.25_f64.powi(order)
}

#[cfg(test)]
#[path = "bow_tests.rs"]
mod tests;
