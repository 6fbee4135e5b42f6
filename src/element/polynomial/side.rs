//! Polynomials on a side, by their Bernstein coefficients.
//!
//! With s from 0 at the first end of the side to 1 at the second, a polynomial of degree p is Σ c_k B_k(s),
//! B_k(s) = C(p, k) s^k (1 − s)^{p − k}, k = 0 … p. The first and the last coefficient are the values at the ends, all
//! coefficients together enclose the values between, they sum to p + 1 times the mean, and in reverse order they are those
//! of the same polynomial run through from the other end. For p = 1 they are the two end values.
//!
//! A traction Σ t_k B_k does on a displacement u the work Σ t_k m_k with the moments m_k = ∫ u B_k ds: coefficients and
//! moments of one degree are conjugate. Where two degrees meet, coefficients of the lower one are elevated
//! ([`elevate`]) and moments of the higher one lowered by the transpose of the same matrix ([`lower_moments`]).

use std::sync::OnceLock;

/// C(n, k).
pub fn binomial(n: usize, k: usize) -> f64 {
    (0..k.min(n - k)).fold(1.0, |product, i| product * (n - i) as f64 / (i + 1) as f64)
}

/// B_k(s) of degree p.
pub fn bernstein(p: usize, k: usize, s: f64) -> f64 {
    binomial(p, k) * s.powi(k as i32) * (1.0 - s).powi((p - k) as i32)
}

/// The value at s of the polynomial with the given coefficients.
pub fn value(coefficients: &[f64], s: f64) -> f64 {
    let p = coefficients.len() - 1;
    coefficients.iter().enumerate().map(|(k, c)| c * bernstein(p, k, s)).sum()
}

/// Component `c` of vectors, as coefficients or values.
pub fn component(vectors: &[[f64; 2]], c: usize) -> Vec<f64> {
    vectors.iter().map(|v| v[c]).collect()
}

/// ∫₀¹ B_i B_j ds of degrees p and q.
pub fn product(p: usize, i: usize, q: usize, j: usize) -> f64 {
    binomial(p, i) * binomial(q, j) / (binomial(p + q, i + j) * (p + q + 1) as f64)
}

/// The coefficients of degree p of the linear function with values `ends` at the ends.
pub fn linear(ends: [f64; 2], p: usize) -> impl Iterator<Item = f64> {
    (0..=p).map(move |k| match k {
        0 => ends[0],
        k if k == p => ends[1],
        k => ends[0] + (ends[1] - ends[0]) * (k as f64 / p as f64),
    })
}

/// The entry of the matrix that turns coefficients of degree p into those of the same polynomial in degree q ≥ p: what
/// coefficient k of degree p has in coefficient j of degree q.
pub fn elevation(p: usize, q: usize, j: usize, k: usize) -> f64 {
    if k > j || j - k > q - p {
        return 0.0;
    }
    binomial(p, k) * binomial(q - p, j - k) / binomial(q, j)
}

/// The matrix of [`elevation`], row by row: q + 1 rows of p + 1 entries.
pub fn elevation_matrix(p: usize, q: usize) -> &'static [f64] {
    static MATRICES: [OnceLock<Vec<f64>>; 16 * 16] = [const { OnceLock::new() }; 16 * 16];
    MATRICES[16 * p + q].get_or_init(|| (0..=q).flat_map(|j| (0..=p).map(move |k| elevation(p, q, j, k))).collect())
}

/// Coefficients of degree q of the polynomial with the given ones, q no less than its degree.
pub fn elevate(coefficients: &[f64], q: usize) -> Vec<f64> {
    let p = coefficients.len() - 1;
    (0..=q).map(|j| (0..=p).map(|k| elevation(p, q, j, k) * coefficients[k]).sum()).collect()
}

/// The coefficients of a polynomial times the linear function with these values at the ends.
pub fn times_linear(f: &[f64], [a, b]: [f64; 2]) -> Vec<f64> {
    let n = f.len();
    let of = |i: usize| {
        let low = if i < n { (n - i) as f64 / n as f64 * a * f[i] } else { 0.0 };
        low + if i > 0 { i as f64 / n as f64 * b * f[i - 1] } else { 0.0 }
    };
    (0..=n).map(of).collect()
}

/// Moments of degree p, from those of a degree no less.
pub fn lower_moments(moments: &[f64], p: usize) -> Vec<f64> {
    let q = moments.len() - 1;
    (0..=p).map(|k| (0..=q).map(|j| elevation(p, q, j, k) * moments[j]).sum()).collect()
}

/// ∫₀¹ g B_k ds of degree p, k = 0 … p, for a polynomial g with the given coefficients.
pub fn moments(g: &[f64], p: usize) -> Vec<f64> {
    let q = g.len() - 1;
    (0..=p).map(|k| g.iter().enumerate().map(|(j, c)| c * product(p, k, q, j)).sum()).collect()
}

/// ∫ u B_k ds, k = 0 … p, of the linear u with these values at the ends of an edge of this length.
pub fn linear_moments([a, b]: [[f64; 2]; 2], length: f64, p: usize) -> Vec<[f64; 2]> {
    let of = |k: usize, c: usize| match a[c] == b[c] {
        true => a[c] * (length / (p + 1) as f64),
        false => ((p + 1 - k) as f64 * a[c] + (k + 1) as f64 * b[c]) * length / ((p + 1) * (p + 2)) as f64,
    };
    (0..=p).map(|k| [of(k, 0), of(k, 1)]).collect()
}

/// ∫₀¹ f g ds of the polynomials with the given coefficients; no coefficients stand for zero.
pub fn integral(f: &[f64], g: &[f64]) -> f64 {
    let (Some(p), Some(q)) = (f.len().checked_sub(1), g.len().checked_sub(1)) else { return 0.0 };
    let row = |(i, f): (usize, &f64)| f * g.iter().enumerate().map(|(j, g)| g * product(p, i, q, j)).sum::<f64>();
    f.iter().enumerate().map(row).sum()
}

/// Coefficients of the polynomial of degree p whose moments ∫₀¹ g B_k ds are given: the nearest one in L² to every g that
/// has them.
///
/// With P_n the Legendre polynomials on [0, 1], g = Σ (2n + 1) (∫ g P_n) P_n, and P_n has the coefficients
/// (−1)^{n − k} C(n, k) in degree n.
pub fn from_moments(moments: &[f64]) -> Vec<f64> {
    let p = moments.len() - 1;
    let mut out = vec![0.0; p + 1];
    for n in 0..=p {
        let legendre = elevate(&legendre(n), p);
        let part = (2 * n + 1) as f64 * legendre.iter().zip(moments).map(|(l, m)| l * m).sum::<f64>();
        out.iter_mut().zip(&legendre).for_each(|(o, l)| *o += part * l);
    }
    out
}

/// Coefficients of degree n of the Legendre polynomial P_n on [0, 1], one at s = 1.
pub fn legendre(n: usize) -> Vec<f64> {
    (0..=n).map(|k| if (n - k).is_multiple_of(2) { binomial(n, k) } else { -binomial(n, k) }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Coefficients that look like nothing in particular.
    fn some(p: usize) -> Vec<f64> {
        (0..=p).map(|k| ((k * k + 3 * k + 1) as f64).sin()).collect()
    }

    /// ∫₀¹ f ds by Simpson's rule on a thousand intervals.
    fn by_simpson(f: impl Fn(f64) -> f64) -> f64 {
        let n = 1000;
        let weight = |i: usize| if i == 0 || i == n { 1.0 } else { (2 + 2 * (i % 2)) as f64 };
        (0..=n).map(|i| weight(i) * f(i as f64 / n as f64)).sum::<f64>() / (3 * n) as f64
    }

    #[test]
    fn elevation_keeps_the_polynomial() {
        for p in 0..=8 {
            let c = some(p);
            for q in p..=9 {
                let raised = elevate(&c, q);
                for s in [0.0, 0.13, 0.5, 0.94, 1.0] {
                    assert!((value(&c, s) - value(&raised, s)).abs() < 1e-13);
                }
            }
        }
    }

    #[test]
    fn reversed_coefficients_run_from_the_other_end() {
        let c = some(5);
        let reversed: Vec<f64> = c.iter().rev().copied().collect();
        assert!((value(&c, 0.3) - value(&reversed, 0.7)).abs() < 1e-14);
    }

    #[test]
    fn a_linear_function_in_any_degree() {
        for p in 1..=8 {
            let c: Vec<f64> = linear([2.0, -1.0], p).collect();
            assert!((value(&c, 0.3) - 1.1).abs() < 1e-13);
        }
    }

    #[test]
    fn moments_are_integrals() {
        for (p, q) in [(1, 1), (3, 2), (2, 5), (8, 8)] {
            let g = some(q);
            for (k, m) in moments(&g, p).into_iter().enumerate() {
                assert!((m - by_simpson(|s| value(&g, s) * bernstein(p, k, s))).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn integrals_of_products() {
        for (p, q) in [(1, 2), (0, 3), (4, 7)] {
            let (f, g) = (some(p), some(q));
            assert!((integral(&f, &g) - by_simpson(|s| value(&f, s) * value(&g, s))).abs() < 1e-9);
        }
    }

    #[test]
    fn moments_of_a_lower_degree_are_those_of_the_same_function() {
        let g = some(4);
        for p in 0..=6 {
            for (a, b) in lower_moments(&moments(&g, 6), p).into_iter().zip(moments(&g, p)) {
                assert!((a - b).abs() < 1e-13);
            }
        }
    }

    #[test]
    fn a_polynomial_comes_back_from_its_moments() {
        for p in 0..=8 {
            let g = some(p);
            for (a, b) in from_moments(&moments(&g, p)).into_iter().zip(g) {
                assert!((a - b).abs() < 1e-10, "degree {p}");
            }
        }
    }
}
