//! Orthonormal bases of a range and of its complement.

use nalgebra::{DMatrix, DVector};

/// Columns smaller than this, relative to the largest, depend on those before.
const DEPENDENT: f64 = 1e-10;

/// An orthogonal matrix of which the first columns span those of `a`, and their number, which is at most `most`.
pub fn range_and_rest(mut a: DMatrix<f64>, most: usize) -> (DMatrix<f64>, usize) {
    let (rows, columns) = a.shape();
    let mut reflections: Vec<(DVector<f64>, f64)> = Vec::new();
    let mut largest = 0.0_f64;
    for k in 0..rows.min(columns).min(most) {
        let size = |a: &DMatrix<f64>, j: usize| a.view((k, j), (rows - k, 1)).norm();
        let (pivot, norm) = (k..columns).map(|j| (j, size(&a, j))).fold((k, 0.0), |m, x| if x.1 > m.1 { x } else { m });
        largest = largest.max(norm);
        if norm <= DEPENDENT * largest {
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
    (q, reflections.len())
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
    fn dependent_columns_count_once_and_the_rest_is_at_right_angles() {
        let mut a = DMatrix::from_fn(7, 5, |i, j| ((3 * i * (j + 1) + 5 * j * j + 1) as f64).sin());
        let sum = a.column(0) + 2.0 * a.column(1);
        a.set_column(3, &sum);
        let (q, rank) = range_and_rest(a.clone(), usize::MAX);
        assert_eq!(rank, 4);
        assert!((&q.transpose() * &q - DMatrix::identity(7, 7)).amax() < 1e-14);
        assert!((q.columns(rank, 3).transpose() * a).amax() < 1e-13);
    }
}
