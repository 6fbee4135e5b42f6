//! The inside of an edge: the displacement of degree p + 1 with given end values and the moments of the dual solution up to
//! degree p − 1.
//!
//! For p = 1 that is Simpson's rule. The moments of degree zero make every triangle change its volume as the dual solution
//! says.

use std::sync::OnceLock;

use nalgebra::DMatrix;

use crate::element::displacement::MOST;
use crate::element::polynomial::side::{elevation, product};

/// The p inner Bernstein coefficients of degree p + 1, from the p + 1 moments of degree p on an edge of the given length
/// and the values at its ends.
pub fn inside(moments: &[[f64; 2]], length: f64, ends: [[f64; 2]; 2]) -> impl Iterator<Item = [f64; 2]> {
    let p = moments.len() - 1;
    let inverse = inverse(p);
    let mut rest = [[0.0; 2]; MOST];
    for (i, rest) in rest[..p].iter_mut().enumerate() {
        let of_ends = [product(p - 1, i, p + 1, 0), product(p - 1, i, p + 1, p + 1)];
        let lower = [elevation(p - 1, p, i, i), elevation(p - 1, p, i + 1, i)];
        *rest = [0, 1].map(|c| {
            let lowered = lower[0] * moments[i][c] + lower[1] * moments[i + 1][c];
            lowered / length - (of_ends[0] * ends[0][c] + of_ends[1] * ends[1][c])
        });
    }
    (0..p).map(move |j| [0, 1].map(|c| (0..p).map(|i| inverse[(j, i)] * rest[i][c]).sum::<f64>()))
}

/// The inner Bernstein coefficients of degree k: of degree p + 1 as [`inside`] gives them, of degree p + 2 with all moments.
pub fn inside_of(k: usize, moments: &[[f64; 2]], length: f64, ends: [[f64; 2]; 2]) -> Vec<[f64; 2]> {
    let p = moments.len() - 1;
    if k <= p + 1 {
        return inside(moments, length, ends).collect();
    }
    let matrix = DMatrix::from_fn(p + 1, p + 1, |i, j| product(p, i, k, j + 1));
    let inverse = matrix.try_inverse().unwrap_or_else(|| DMatrix::identity(p + 1, p + 1));
    let rest = |i: usize, c: usize| {
        moments[i][c] / length - product(p, i, k, 0) * ends[0][c] - product(p, i, k, k) * ends[1][c]
    };
    (0..=p).map(|j| [0, 1].map(|c| (0..=p).map(|i| inverse[(j, i)] * rest(i, c)).sum::<f64>())).collect()
}

/// The inverse of ∫ B_i B_{j + 1} ds of degrees p − 1 and p + 1.
fn inverse(p: usize) -> &'static DMatrix<f64> {
    static KNOWN: [OnceLock<DMatrix<f64>>; MOST] = [const { OnceLock::new() }; MOST];
    KNOWN[p].get_or_init(|| {
        let matrix = DMatrix::from_fn(p, p, |i, j| product(p - 1, i, p + 1, j + 1));
        matrix.try_inverse().unwrap_or_else(|| DMatrix::identity(p, p))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::polynomial::side;

    #[test]
    fn a_polynomial_comes_back_from_its_moments_and_ends() {
        for p in 1..MOST {
            let some: Vec<f64> = (0..=p + 1).map(|k| ((5 * k + 2) as f64).cos()).collect();
            let length = 0.7;
            let moments: Vec<[f64; 2]> =
                side::moments(&some, p).into_iter().map(|m| [length * m, -2.0 * length * m]).collect();
            let ends = [some[0], some[p + 1]].map(|u| [u, -2.0 * u]);
            for (found, exact) in inside(&moments, length, ends).zip(&some[1..]) {
                assert!((found[0] - exact).abs() < 1e-10 && (found[1] + 2.0 * exact).abs() < 1e-10, "degree {p}");
            }
        }
    }
}
