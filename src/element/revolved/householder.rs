//! Orthonormal bases of a range and of its complement.

use nalgebra::{DMatrix, DVector};

/// An orthogonal matrix whose first `rank` columns span those of `a`, a matrix of that rank.
pub fn range_and_rest(mut a: DMatrix<f64>, rank: usize) -> DMatrix<f64> {
    let (rows, columns) = a.shape();
    let mut reflections: Vec<(DVector<f64>, f64)> = Vec::new();
    for k in 0..rows.min(columns).min(rank) {
        let size = |a: &DMatrix<f64>, j: usize| a.view((k, j), (rows - k, 1)).norm();
        let (pivot, norm) = (k..columns).map(|j| (j, size(&a, j))).fold((k, 0.0), |m, x| if x.1 > m.1 { x } else { m });
        if norm == 0.0 {
            break;
        }
        a.swap_columns(k, pivot);
        let mut v: DVector<f64> = a.view((k, k), (rows - k, 1)).column(0).into_owned();
        v[0] += norm.copysign(v[0]);
        let factor = 2.0 / v.norm_squared();
        reflect(&mut a, k, k, &v, factor);
        reflections.push((v, factor));
    }
    let mut q = DMatrix::identity(rows, rows);
    for (k, (v, factor)) in reflections.iter().enumerate().rev() {
        reflect(&mut q, k, 0, v, *factor);
    }
    q
}

/// Reflects the rows from `row` on of the columns from `column` on.
fn reflect(a: &mut DMatrix<f64>, row: usize, column: usize, v: &DVector<f64>, factor: f64) {
    for j in column..a.ncols() {
        let mut part = a.view_mut((row, j), (v.len(), 1));
        let by = factor * part.dot(v);
        part.iter_mut().zip(v.iter()).for_each(|(x, v)| *x -= by * v);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rest_is_at_right_angles_to_all_columns() {
        let mut a = DMatrix::from_fn(7, 5, |i, j| ((3 * i * (j + 1) + 5 * j * j + 1) as f64).sin());
        let sum = a.column(0) + 2.0 * a.column(1);
        a.set_column(3, &sum);
        let q = range_and_rest(a.clone(), 4);
        assert!((&q.transpose() * &q - DMatrix::identity(7, 7)).amax() < 1e-14);
        assert!((q.columns(4, 3).transpose() * a).amax() < 1e-13);
    }
}
