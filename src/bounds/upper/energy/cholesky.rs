//! Cholesky factors of the small matrices of patches and triangles, in memory that is given.
//!
//! Every vertex has one, and factorisations for any size and shape of matrix take ten times as long. Only the lower
//! triangle is stored: column by column, each from its diagonal down.

use crate::lanes::wide;

/// Numbers in the lower triangle of an n × n matrix.
pub const fn packed(n: usize) -> usize {
    n * (n + 1) / 2
}

/// Where column `j` begins.
pub const fn column(n: usize, j: usize) -> usize {
    j * (2 * n + 1 - j) / 2
}

/// Rows that are taken from another while that is in registers.
const TOGETHER: usize = 4;

/// Takes the rows times their factors, one after the other.
#[inline(always)]
fn take<const N: usize>(from: &mut [f64], factors: [f64; N], rows: [&[f64]; N]) {
    let rows = rows.map(|row| &row[..from.len()]);
    for (i, value) in from.iter_mut().enumerate() {
        let mut left = *value;
        for (factor, row) in factors.iter().zip(rows) {
            left -= factor * row[i];
        }
        *value = left;
    }
}

wide! {
    /// Turns `a` (n × n) into its factor L; `false` where a pivot is not above the part `least` of its diagonal entry.
    pub fn factorise(a: &mut [f64], n: usize, least: f64) -> bool {
        for j in 0..n {
            let (left, right) = a.split_at_mut(column(n, j));
            let own = &mut right[..n - j];
            let entry = own[0];
            // What column k of the factor has from row j on.
            let done = |k: usize| &left[column(n, k) + j - k..][..n - j];
            let whole = j - j % TOGETHER;
            for k in (0..whole).step_by(TOGETHER) {
                let done = [0, 1, 2, 3].map(|i| done(k + i));
                take(own, done.map(|l| l[0]), done);
            }
            for done in (whole..j).map(done) {
                take(own, [done[0]], [done]);
            }
            let pivot = own[0];
            // False for what is not a number, too.
            if !(pivot > least * entry && pivot.is_finite()) {
                return false;
            }
            let root = pivot.sqrt();
            own[0] = root;
            own[1..].iter_mut().for_each(|value| *value /= root);
        }
        true
    }

    /// x = A⁻¹ x with the factor `l` of A.
    pub fn solve(l: &[f64], x: &mut [f64]) {
        let n = x.len();
        let mut rest = l;
        for j in 0..n {
            let (own, next) = rest.split_at(n - j);
            let value = x[j] / own[0];
            x[j] = value;
            x[j + 1..].iter_mut().zip(&own[1..]).for_each(|(x, l)| *x -= value * l);
            rest = next;
        }
        backward(l, x);
    }

    /// x = L⁻ᵀ x.
    pub fn backward(l: &[f64], x: &mut [f64]) {
        let n = x.len();
        for j in (0..n).rev() {
            let own = &l[column(n, j)..][..n - j];
            let sum: f64 = own[1..].iter().zip(&x[j + 1..]).map(|(l, x)| l * x).sum();
            x[j] = (x[j] - sum) / own[0];
        }
    }

    /// X = L⁻¹ X for the `n` rows of X, one after the other.
    pub fn forward(l: &[f64], x: &mut [f64], n: usize) {
        let columns = x.len() / n.max(1);
        for j in 0..n {
            let (done, left) = x.split_at_mut(j * columns);
            let row = &mut left[..columns];
            let (of, entry) = (|k: usize| &done[k * columns..][..columns], |k: usize| l[column(n, k) + j - k]);
            let whole = j - j % TOGETHER;
            for k in (0..whole).step_by(TOGETHER) {
                let together = [k, k + 1, k + 2, k + 3];
                take(row, together.map(entry), together.map(of));
            }
            for k in whole..j {
                take(row, [entry(k)], [of(k)]);
            }
            row.iter_mut().for_each(|v| *v /= entry(j));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const A: [f64; packed(3)] = [4.0, 1.0, 0.5, 3.0, -0.2, 2.0];
    const FULL: [[f64; 3]; 3] = [[4.0, 1.0, 0.5], [1.0, 3.0, -0.2], [0.5, -0.2, 2.0]];

    #[test]
    fn solves_what_it_factorised() {
        let mut a = A;
        assert!(factorise(&mut a, 3, 1e-15));
        let mut x = [1.0, -2.0, 3.0];
        solve(&a, &mut x);
        for (row, b) in FULL.iter().zip([1.0, -2.0, 3.0]) {
            let sum: f64 = row.iter().zip(&x).map(|(a, x)| a * x).sum();
            assert!((sum - b).abs() < 1e-15 * 10.0);
        }
    }

    #[test]
    fn half_a_solve_twice_is_the_quadratic_form_of_the_inverse() {
        let mut a = A;
        assert!(factorise(&mut a, 3, 1e-15));
        let mut y = [1.0, 0.0, -2.0, 1.0, 3.0, 0.0];
        let mut x = [y[0], y[2], y[4]];
        let b = x;
        forward(&a, &mut y, 3);
        solve(&a, &mut x);
        let square: f64 = y.chunks_exact(2).map(|row| row[0] * row[0]).sum();
        let form: f64 = b.iter().zip(&x).map(|(b, x)| b * x).sum();
        assert!((square - form).abs() < 1e-14);
        let mixed: f64 = y.chunks_exact(2).map(|row| row[0] * row[1]).sum();
        assert!((mixed - x[1]).abs() < 1e-14);
    }

    #[test]
    fn a_matrix_that_is_not_definite_has_no_factor() {
        assert!(!factorise(&mut [1.0, -1.0, 1.0], 2, 1e-15));
        assert!(!factorise(&mut [f64::NAN], 1, 1e-15));
        assert!(!factorise(&mut [f64::INFINITY], 1, 1e-15));
        assert!(factorise(&mut [], 0, 1e-15));
    }
}
