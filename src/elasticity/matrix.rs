//! Small symmetric matrices of [`Twofold`] numbers.

use super::twofold::Twofold;

/// A matrix row by row.
pub type Square<const N: usize> = [[Twofold; N]; N];

/// R, upper triangular, of A = RᵀR.
///
/// # Errors
/// The first row whose pivot is not positive.
pub fn cholesky<const N: usize>(a: &Square<N>) -> Result<Square<N>, usize> {
    let mut r = [[Twofold::ZERO; N]; N];
    for i in 0..N {
        for j in i..N {
            let left = (0..i).fold(a[i][j], |left, k| left - r[k][i] * r[k][j]);
            if i != j {
                r[i][j] = left / r[i][i];
            } else if left.value() > 0.0 && left.value().is_finite() {
                r[i][i] = left.sqrt();
            } else {
                return Err(i);
            }
        }
    }
    Ok(r)
}

/// R⁻¹ of an upper triangular R.
pub fn inverse_upper<const N: usize>(r: &Square<N>) -> Square<N> {
    let mut inverse = [[Twofold::ZERO; N]; N];
    for j in 0..N {
        inverse[j][j] = Twofold::from(1.0) / r[j][j];
        for i in (0..j).rev() {
            let sum = (i + 1..=j).fold(Twofold::ZERO, |sum, k| sum + r[i][k] * inverse[k][j]);
            inverse[i][j] = -(sum / r[i][i]);
        }
    }
    inverse
}

/// A⁻¹ of a positive definite A.
///
/// # Errors
/// As [`cholesky`].
pub fn inverse<const N: usize>(a: &Square<N>) -> Result<Square<N>, usize> {
    let half = inverse_upper(&cholesky(a)?);
    let entry = |i: usize, j: usize| (0..N).fold(Twofold::ZERO, |sum, k| sum + half[i][k] * half[j][k]);
    Ok(std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j))))
}

/// BᵀAB, the columns of B being the new unknowns in the old ones.
pub fn congruent<const N: usize>(a: &Square<N>, b: &Square<N>) -> Square<N> {
    let product = |x: &Square<N>, y: &Square<N>, transposed: bool| -> Square<N> {
        let of = |i: usize, k: usize| if transposed { x[k][i] } else { x[i][k] };
        std::array::from_fn(|i| std::array::from_fn(|j| (0..N).fold(Twofold::ZERO, |sum, k| sum + of(i, k) * y[k][j])))
    };
    product(b, &product(a, b, false), true)
}

/// The nearest numbers in `f64`.
pub fn values<const N: usize>(a: &Square<N>) -> [[f64; N]; N] {
    a.map(|row| row.map(Twofold::value))
}
