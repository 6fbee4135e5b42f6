//! The inside of an edge: the displacement of degree p + 1 with given end values and the moments of the dual solution up to
//! degree p − 1.
//!
//! For p = 1 that is Simpson's rule. The moments of degree zero make every triangle change its volume as the dual solution
//! says.

use std::sync::OnceLock;

use nalgebra::DMatrix;

use crate::element::displacement::MOST;
use crate::element::side::{lower_moments, product};

/// The p inner Bernstein coefficients of degree p + 1, from the p + 1 moments of degree p on an edge of the given length
/// and the values at its ends.
pub fn inside(moments: &[[f64; 2]], length: f64, ends: [[f64; 2]; 2]) -> Vec<[f64; 2]> {
    let p = moments.len() - 1;
    let inverse = inverse(p);
    let component = |c: usize| {
        let lowered = lower_moments(&moments.iter().map(|m| m[c]).collect::<Vec<_>>(), p - 1);
        let rest = |i: usize| {
            let of_ends = product(p - 1, i, p + 1, 0) * ends[0][c] + product(p - 1, i, p + 1, p + 1) * ends[1][c];
            lowered[i] / length - of_ends
        };
        let rest: Vec<f64> = (0..p).map(rest).collect();
        (0..p).map(|j| (0..p).map(|i| inverse[(j, i)] * rest[i]).sum::<f64>()).collect::<Vec<_>>()
    };
    let [x, y] = [0, 1].map(component);
    x.into_iter().zip(y).map(|(x, y)| [x, y]).collect()
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
    use crate::element::side;

    #[test]
    fn a_polynomial_comes_back_from_its_moments_and_ends() {
        for p in 1..MOST {
            let some: Vec<f64> = (0..=p + 1).map(|k| ((5 * k + 2) as f64).cos()).collect();
            let length = 0.7;
            let moments: Vec<[f64; 2]> =
                side::moments(&some, p).into_iter().map(|m| [length * m, -2.0 * length * m]).collect();
            let ends = [some[0], some[p + 1]].map(|u| [u, -2.0 * u]);
            for (found, exact) in inside(&moments, length, ends).into_iter().zip(&some[1..]) {
                assert!((found[0] - exact).abs() < 1e-10 && (found[1] + 2.0 * exact).abs() < 1e-10, "degree {p}");
            }
        }
    }
}
