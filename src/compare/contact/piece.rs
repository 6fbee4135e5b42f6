//! Pressure on one contact pair.

use crate::element::polynomial::side;
use crate::element::polynomial::subdivision;
use crate::element::polynomial::subdivision::part;

/// Pressure on one pair: polynomials on equal parts of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Piece {
    /// The Bernstein coefficients on each part, from the first end of the pair to the second.
    parts: Vec<Vec<f64>>,
}

impl Piece {
    /// One polynomial on the whole pair, by its Bernstein coefficients ([`side`]).
    pub fn polynomial(coefficients: Vec<f64>) -> Self {
        Piece { parts: vec![coefficients] }
    }

    /// Linear between the given values, at equal steps from the first end to the second; at least two.
    pub fn broken(values: Vec<f64>) -> Self {
        Piece { parts: values.windows(2).map(<[f64]>::to_vec).collect() }
    }

    /// All coefficients: none of the values is outside them.
    pub fn coefficients(&self) -> impl Iterator<Item = f64> {
        self.parts.iter().flatten().copied()
    }

    /// The values at the two ends.
    pub fn ends(&self) -> [f64; 2] {
        let mut all = self.coefficients();
        let first = all.next().unwrap_or(0.0);
        [first, all.last().unwrap_or(first)]
    }

    /// The largest value, and which part of the way from the first end to the second it is at.
    pub fn largest(&self) -> (f64, f64) {
        let of = |(own, [from, to]): (&[f64], [f64; 2])| {
            let (value, s) = subdivision::largest(own);
            (value, from + s * (to - from))
        };
        self.placed().map(of).fold((f64::NEG_INFINITY, 0.0), |best, own| if own.0 > best.0 { own } else { best })
    }

    /// ∫ |dp| from end to end.
    pub fn variation(&self) -> f64 {
        self.parts.iter().map(|own| subdivision::variation(own)).sum()
    }

    /// ∫₀¹ p w ds with the polynomial w of the given coefficients.
    pub fn integral(&self, weight: &[f64]) -> f64 {
        self.placed().map(|(own, [from, to])| (to - from) * product(own, &part(weight, [from, to]))).sum()
    }

    /// ∫₀¹ p² ds.
    pub fn square(&self) -> f64 {
        self.parts.iter().map(|own| product(own, own)).sum::<f64>() / self.parts.len() as f64
    }

    /// ∫₀¹ (p − q)² ds.
    pub fn squared_difference(&self, other: &Piece) -> f64 {
        let count = self.parts.len().max(other.parts.len());
        let square = |i: usize| {
            let [mut p, mut q] = [self, other].map(|piece| piece.within([i, i + 1].map(|k| k as f64 / count as f64)));
            let degree = p.len().max(q.len()) - 1;
            p = side::elevate(&p, degree);
            q = side::elevate(&q, degree);
            let apart: Vec<f64> = p.iter().zip(&q).map(|(p, q)| p - q).collect();
            product(&apart, &apart)
        };
        (0..count).map(square).sum::<f64>() / count as f64
    }

    /// Points (s, p(s)) to draw straight lines between: what is linear exactly, what is of degree p at 2p + 1 points.
    pub fn points(&self) -> Vec<[f64; 2]> {
        let mut points = Vec::new();
        for (own, [from, to]) in self.placed() {
            let degree = own.len() - 1;
            let steps = if degree > 1 { 2 * degree } else { 1 };
            for k in usize::from(!points.is_empty())..=steps {
                let s = k as f64 / steps as f64;
                points.push([from + s * (to - from), side::value(own, s)]);
            }
        }
        points
    }

    /// The value at `s`.
    pub fn at(&self, s: f64) -> f64 {
        let count = self.parts.len();
        let which = ((s * count as f64) as usize).min(count - 1);
        side::value(&self.parts[which], s * count as f64 - which as f64)
    }

    /// The coefficients on [from, to], which lies in one part.
    fn within(&self, [from, to]: [f64; 2]) -> Vec<f64> {
        let count = self.parts.len() as f64;
        let which = ((0.5 * (from + to) * count) as usize).min(self.parts.len() - 1);
        part(&self.parts[which], [from, to].map(|s| s * count - which as f64))
    }

    /// The coefficients on each part, and where it begins and ends.
    fn placed(&self) -> impl Iterator<Item = (&[f64], [f64; 2])> {
        let count = self.parts.len() as f64;
        self.parts.iter().enumerate().map(move |(i, own)| (own.as_slice(), [i, i + 1].map(|k| k as f64 / count)))
    }
}

/// ∫₀¹ f g ds.
fn product(f: &[f64], g: &[f64]) -> f64 {
    side::moments(f, g.len() - 1).iter().zip(g).map(|(m, g)| m * g).sum()
}

/// ∫ |dp| along a contact, jumps between edges included.
pub fn variation(pieces: &[Piece]) -> f64 {
    let jumps = pieces.windows(2).map(|w| (w[1].ends()[0] - w[0].ends()[1]).abs());
    pieces.iter().map(Piece::variation).chain(jumps).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ∫₀¹ f ds by Simpson's rule on a thousand intervals, of which one ends at s = ½.
    fn by_simpson(f: impl Fn(f64) -> f64) -> f64 {
        let n = 2000;
        let weight = |i: usize| if i == 0 || i == n { 1.0 } else { (2 + 2 * (i % 2)) as f64 };
        (0..=n).map(|i| weight(i) * f(i as f64 / n as f64)).sum::<f64>() / (3 * n) as f64
    }

    /// p(s).
    type Curve = fn(f64) -> f64;

    /// Pressures, and the same from nothing but powers of s.
    fn samples() -> Vec<(Piece, Curve)> {
        vec![
            (Piece::polynomial(vec![1.5]), |_| 1.5),
            (Piece::polynomial(vec![1.0, 3.0]), |s| 1.0 + 2.0 * s),
            (Piece::polynomial(vec![0.0, 0.0, 1.0]), |s| s * s),
            (Piece::polynomial(vec![0.0, 0.0, 1.0, 0.0]), |s| 3.0 * s * s * (1.0 - s)),
            (Piece::broken(vec![1.0, 2.0, 0.0]), |s| if s < 0.5 { 1.0 + 2.0 * s } else { 4.0 - 4.0 * s }),
        ]
    }

    #[test]
    fn integrals_are_those_of_the_values() {
        for (p, of_p) in samples() {
            let weighed = by_simpson(|s| of_p(s) * (2.0 - 5.0 * s + s * s));
            assert!((p.integral(&[2.0, -0.5, -2.0]) - weighed).abs() < 1e-12, "{p:?}");
            assert!((p.square() - by_simpson(|s| of_p(s).powi(2))).abs() < 1e-12);
            for (q, of_q) in samples() {
                let apart = by_simpson(|s| (of_p(s) - of_q(s)).powi(2));
                assert!((p.squared_difference(&q) - apart).abs() < 1e-12, "{p:?} {q:?}");
            }
        }
    }

    #[test]
    fn largest_values_ends_and_points_are_on_the_curve() {
        for (p, of) in samples() {
            let (value, at) = p.largest();
            assert!((of(at) - value).abs() < 1e-14);
            assert!((0..=300).all(|i| of(f64::from(i) / 300.0) <= value + 1e-14), "{p:?}");
            assert_eq!(p.ends(), [of(0.0), of(1.0)]);
            assert!(p.points().iter().all(|[s, v]| (of(*s) - v).abs() < 1e-15));
        }
        // 3 s² (1 − s) is largest at 2/3.
        let (value, at) = Piece::polynomial(vec![0.0, 0.0, 1.0, 0.0]).largest();
        assert!((value - 4.0 / 9.0).abs() < 1e-15 && (at - 2.0 / 3.0).abs() < 1e-7);
    }

    #[test]
    fn straight_lines_have_no_points_to_spare() {
        let counts: Vec<usize> = samples().iter().map(|(p, _)| p.points().len()).collect();
        assert_eq!(counts, [2, 2, 5, 7, 3]);
    }

    #[test]
    fn variation_goes_through_the_middle() {
        assert_eq!(Piece::broken(vec![1.0, 2.0, 0.0]).variation(), 3.0);
        assert!((Piece::polynomial(vec![0.0, 0.0, 1.0, 0.0]).variation() - 8.0 / 9.0).abs() < 1e-14);
    }

    #[test]
    fn variation_counts_every_way_up_and_down() {
        let up_and_down = [[0.0, 1.0, 2.0], [2.0, 1.0, 0.0]].map(|p| Piece::broken(p.to_vec()));
        assert_eq!(variation(&up_and_down), 4.0);
        let with_a_jump = [Piece::polynomial(vec![0.0, 1.0]), Piece::polynomial(vec![3.0])];
        assert_eq!(variation(&with_a_jump), 3.0);
        assert_eq!(variation(&[]), 0.0);
    }
}
