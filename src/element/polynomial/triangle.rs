//! Polynomials on a triangle, by their Bernstein coefficients.
//!
//! With barycentric coordinates l, a polynomial of degree k is Σ c_α B_α(l), B_α = k!/(α_0! α_1! α_2!) l^α, over the
//! multi-indices α = (α_0, α_1, α_2) that sum to k. Coefficients of α = k e_i are the values at the corners, those with
//! α_i = 0 are the coefficients of the side opposite corner i ([`super::side`]), and
//!
//! ∇ Σ c_α B_α = k Σ_β B_β Σ_i c_{β + e_i} ∇l_i over |β| = k − 1,
//!
//! so that the coefficients of a gradient are differences of neighbouring coefficients.
//!
//! Coefficients are numbered with α_0 falling and, where it is equal, α_1 falling: (1, 0, 0), (0, 1, 0), (0, 0, 1) for k = 1.

use std::sync::OnceLock;

use super::side::binomial;
use crate::element::displacement::MOST;

/// A multi-index.
pub type Index = [usize; 3];

/// Number of coefficients of degree k.
pub const fn len(k: usize) -> usize {
    (k + 1) * (k + 2) / 2
}

/// The number of a coefficient.
pub const fn number([_, j, l]: Index) -> usize {
    (j + l) * (j + l + 1) / 2 + l
}

/// The multi-indices of degree k in the order of the coefficients.
pub fn indices(k: usize) -> impl Iterator<Item = Index> {
    (0..=k).flat_map(move |rest| (0..=rest).map(move |l| [k - rest, rest - l, l]))
}

/// α + e_i.
pub fn raised(mut alpha: Index, i: usize) -> Index {
    alpha[i] += 1;
    alpha
}

/// α − e_i, where there is such an index.
pub fn lowered(mut alpha: Index, i: usize) -> Option<Index> {
    alpha[i] = alpha[i].checked_sub(1)?;
    Some(alpha)
}

/// B_α(l).
pub fn bernstein(alpha: Index, l: [f64; 3]) -> f64 {
    let [i, j, k] = alpha;
    let powers = l[0].powi(i as i32) * l[1].powi(j as i32) * l[2].powi(k as i32);
    binomial(i + j + k, i) * binomial(j + k, j) * powers
}

/// The mean of B_α B_β over the triangle, of any two degrees.
pub fn product(alpha: Index, beta: Index) -> f64 {
    let [p, q] = [alpha, beta].map(|a| a.iter().sum::<usize>());
    let ways: f64 = (0..3).map(|i| binomial(alpha[i] + beta[i], alpha[i])).product();
    ways / (binomial(p + q, p) * len(p + q) as f64)
}

/// Weight of coefficient `beta` of a polynomial in coefficient `alpha` of the same polynomial in a higher degree.
pub fn elevation(beta: Index, alpha: Index) -> f64 {
    if (0..3).any(|i| beta[i] > alpha[i]) {
        return 0.0;
    }
    let [p, q] = [alpha, beta].map(|a| a.iter().sum::<usize>());
    (0..3).map(|i| binomial(alpha[i], beta[i])).product::<f64>() / binomial(p, q)
}

/// The highest degree that there are tables of.
const HIGHEST: usize = 2 * MOST;

/// The values of all B_α of degree k, at most [`HIGHEST`], at l.
pub fn basis(k: usize, l: [f64; 3]) -> impl Iterator<Item = f64> {
    let powers = l.map(|l| {
        let mut powers = [1.0; HIGHEST + 1];
        (1..=k).for_each(|i| powers[i] = powers[i - 1] * l);
        powers
    });
    let [a, b, c] = powers;
    indices(k).zip(ways(k)).map(move |([i, j, m], ways)| ways * (a[i] * b[j] * c[m]))
}

/// k!/(α_0! α_1! α_2!) of all indices of degree k.
fn ways(k: usize) -> &'static [f64] {
    static TABLES: [OnceLock<Vec<f64>>; HIGHEST + 1] = [const { OnceLock::new() }; HIGHEST + 1];
    TABLES[k].get_or_init(|| indices(k).map(|[i, j, m]| binomial(k, i) * binomial(j + m, j)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::polynomial::side;

    const POINTS: [[f64; 3]; 4] = [[0.2, 0.3, 0.5], [0.7, 0.05, 0.25], [0.0, 0.6, 0.4], [1.0, 0.0, 0.0]];

    #[test]
    fn coefficients_are_numbered_one_after_the_other() {
        for k in 0..=9 {
            assert_eq!(indices(k).count(), len(k));
            assert!(indices(k).enumerate().all(|(n, alpha)| number(alpha) == n && alpha.iter().sum::<usize>() == k));
        }
    }

    #[test]
    fn the_basis_sums_to_one_and_is_that_of_a_side_on_it() {
        for k in 0..=9 {
            for l in POINTS {
                assert!((basis(k, l).sum::<f64>() - 1.0).abs() < 1e-13);
            }
            for j in 0..=k {
                let on_side = bernstein([0, k - j, j], [0.0, 0.4, 0.6]);
                assert!((on_side - side::bernstein(k, j, 0.6)).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn elevation_keeps_the_polynomial() {
        let c: Vec<f64> = (0..len(2)).map(|n| (3 * n + 1) as f64 % 7.0).collect();
        for k in 2..=9 {
            let raised =
                indices(k).map(|alpha| indices(2).zip(&c).map(|(beta, c)| c * elevation(beta, alpha)).sum::<f64>());
            let raised: Vec<f64> = raised.collect();
            for l in POINTS {
                let value = |k: usize, c: &[f64]| basis(k, l).zip(c).map(|(b, c)| b * c).sum::<f64>();
                assert!((value(2, &c) - value(k, &raised)).abs() < 1e-13);
            }
        }
    }

    /// ∫ l^α over a triangle of area ½ is α! / (|α| + 2)!.
    #[test]
    fn means_of_products_are_those_of_monomials() {
        let factorial = |n: usize| (1..=n).map(|i| i as f64).product::<f64>();
        for (p, q) in [(1, 1), (2, 1), (3, 3), (2, 5)] {
            for alpha in indices(p) {
                for beta in indices(q) {
                    let scale = |a: Index| factorial(a.iter().sum()) / a.iter().map(|n| factorial(*n)).product::<f64>();
                    let sum: f64 = (0..3).map(|i| factorial(alpha[i] + beta[i])).product();
                    let mean = 2.0 * scale(alpha) * scale(beta) * sum / factorial(p + q + 2);
                    assert!((product(alpha, beta) - mean).abs() < 1e-14 * mean);
                }
            }
        }
    }
}
