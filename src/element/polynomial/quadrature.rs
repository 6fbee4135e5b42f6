//! Quadrature of every degree: on a segment in s from 0 to 1, on triangles in barycentric coordinates. Weights sum to one, so
//! that a rule gives a mean value.
//!
//! The points of Gauss rules are the eigenvalues of the matrix of the three-term recurrence of the orthogonal polynomials,
//! the weights the squares of the first components of its eigenvectors (Golub & Welsch, Math. Comp. 23 (1969)).

use std::sync::OnceLock;

use nalgebra::DMatrix;

/// Points s in [0, 1] with weights.
type SegmentRule = [(f64, f64)];
/// Points in barycentric coordinates with weights.
type TriangleRule = [([f64; 3], f64)];

/// The three edge midpoints, exact to degree 2.
const MIDPOINTS: &TriangleRule =
    &[([0.0, 0.5, 0.5], 1.0 / 3.0), ([0.5, 0.0, 0.5], 1.0 / 3.0), ([0.5, 0.5, 0.0], 1.0 / 3.0)];

/// Six points, exact to degree 4 (Dunavant, Int. J. Numer. Meth. Eng. 21 (1985), rule of degree 4).
const DEGREE_4: &TriangleRule = &[
    ([0.108103018168070, 0.445948490915965, 0.445948490915965], 0.223381589678011),
    ([0.445948490915965, 0.108103018168070, 0.445948490915965], 0.223381589678011),
    ([0.445948490915965, 0.445948490915965, 0.108103018168070], 0.223381589678011),
    ([0.816847572980459, 0.091576213509771, 0.091576213509771], 0.109951743655322),
    ([0.091576213509771, 0.816847572980459, 0.091576213509771], 0.109951743655322),
    ([0.091576213509771, 0.091576213509771, 0.816847572980459], 0.109951743655322),
];

/// A rule that integrates polynomials of degree at most `degree` along a segment.
pub fn segment_rule(degree: usize) -> &'static SegmentRule {
    &Gauss::of(degree / 2 + 1).segment
}

/// A rule that integrates polynomials of degree at most `degree` over a triangle.
pub fn triangle_rule(degree: usize) -> &'static TriangleRule {
    match degree {
        0..=2 => MIDPOINTS,
        3..=4 => DEGREE_4,
        _ => &Gauss::of(degree / 2 + 1).triangle,
    }
}

/// The rule for displacement models of bodies of revolution, whose integrals are rational: the same from all corners, so that programs that
/// order them differently integrate alike; exact to degree 11.
pub fn even_rule() -> Vec<([f64; 3], f64)> {
    let turned =
        |i: usize| triangle_rule(11).iter().map(move |(l, weight)| ([0, 1, 2].map(|j| l[(i + j) % 3]), weight / 3.0));
    (0..3).flat_map(turned).collect()
}

/// The rules with n points in each direction, exact to degree 2n − 1, and those with more behind them.
struct Gauss {
    segment: Vec<(f64, f64)>,
    triangle: Vec<([f64; 3], f64)>,
    next: OnceLock<Box<Gauss>>,
}

impl Gauss {
    /// The rules with `n` points, which are computed once.
    fn of(n: usize) -> &'static Gauss {
        static FIRST: OnceLock<Gauss> = OnceLock::new();
        (2..=n).fold(FIRST.get_or_init(|| Gauss::new(1)), |rules, n| rules.next.get_or_init(|| Box::new(Gauss::new(n))))
    }

    /// On the triangle, the square is collapsed into the first corner: (1 − s, s(1 − t), st), with a weight s.
    fn new(n: usize) -> Gauss {
        let segment = gauss(n, 0.0);
        let away = gauss(n, 1.0);
        let at = |s: f64, t: f64| [1.0 - s, s * (1.0 - t), s * t];
        let triangle = away.iter().flat_map(|&(s, v)| segment.iter().map(move |&(t, w)| (at(s, t), v * w))).collect();
        Gauss { segment, triangle, next: OnceLock::new() }
    }
}

/// `n` points of the Gauss rule on [0, 1] for the weight (1 + b) s^b.
fn gauss(n: usize, b: f64) -> Vec<(f64, f64)> {
    // Jacobi polynomials with α = 0, β = b on [−1, 1].
    let recurrence = DMatrix::from_fn(n, n, |i, j| {
        let k = i.max(j) as f64;
        let m = 2.0 * k + b;
        match i.abs_diff(j) {
            0 if b == 0.0 => 0.0,
            0 => b * b / (m * (m + 2.0)),
            1 => 2.0 * k * (k + b) / (m * (m * m - 1.0).sqrt()),
            _ => 0.0,
        }
    });
    let eigen = recurrence.symmetric_eigen();
    let mut rule: Vec<(f64, f64)> =
        (0..n).map(|i| (0.5 * (1.0 + eigen.eigenvalues[i]), eigen.eigenvectors[(0, i)].powi(2))).collect();
    rule.sort_by(|a, b| a.0.total_cmp(&b.0));
    rule
}

#[cfg(test)]
mod tests {
    use super::*;

    fn factorial(n: usize) -> f64 {
        (1..=n).map(|k| k as f64).product()
    }

    #[test]
    fn segment_rules_are_exact_to_their_degree() {
        for degree in 0..=40 {
            let rule = segment_rule(degree);
            for k in 0..=degree {
                let sum: f64 = rule.iter().map(|&(s, w)| w * s.powi(k as i32)).sum();
                assert!((sum * (k + 1) as f64 - 1.0).abs() < 1e-13, "degree {degree}: s^{k}");
            }
            assert_eq!(rule.len(), degree / 2 + 1);
        }
    }

    #[test]
    fn triangle_rules_are_exact_to_their_degree() {
        for degree in 0..=24 {
            let rule = triangle_rule(degree);
            // The constants of Dunavant have fifteen digits.
            let tolerance = if degree <= 4 { 1e-12 } else { 1e-13 };
            for d in 0..=degree {
                for i in 0..=d {
                    for j in 0..=d - i {
                        let k = d - i - j;
                        let exact = 2.0 * factorial(i) * factorial(j) * factorial(k) / factorial(d + 2);
                        let of = |l: &[f64; 3]| l[0].powi(i as i32) * l[1].powi(j as i32) * l[2].powi(k as i32);
                        let sum: f64 = rule.iter().map(|(l, w)| w * of(l)).sum();
                        assert!((sum / exact - 1.0).abs() < tolerance, "degree {degree}: {i} {j} {k}: {sum} {exact}");
                    }
                }
            }
        }
    }

    #[test]
    fn rules_of_two_degrees_agree() {
        let of = |l: [f64; 3]| (l[0] - 0.3 * l[1] + 0.1).powi(3) * (0.7 * l[2] - l[0] + 0.2).powi(3);
        let mean = |degree: usize| triangle_rule(degree).iter().map(|&(l, w)| w * of(l)).sum::<f64>();
        for degree in 7..=30 {
            assert!((mean(degree) - mean(6)).abs() < 1e-15, "degree {degree}");
        }
        assert!((mean(4) - mean(6)).abs() > 1e-6, "a rule of too low a degree is seen");
    }

    #[test]
    fn points_are_inside_and_weights_positive() {
        for degree in 5..=30 {
            assert!(segment_rule(degree).iter().all(|&(s, w)| s > 0.0 && s < 1.0 && w > 0.0));
            assert!(triangle_rule(degree).iter().all(|(l, w)| l.iter().all(|l| *l > 0.0) && *w > 0.0));
        }
    }
}
