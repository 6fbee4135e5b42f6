//! A definite matrix factored within its envelope: of every row, what lies between its first entry and the diagonal.

use nalgebra::{DMatrix, DVector};

/// The x with K x = f, by Cholesky's factors of the lower triangle of K; `None` where K is not definite.
pub fn solve(k: &DMatrix<f64>, f: &DVector<f64>) -> Option<DVector<f64>> {
    let n = k.nrows();
    let mut rows: Vec<(usize, Vec<f64>)> = Vec::with_capacity(n);
    for i in 0..n {
        let first = (0..i).find(|&j| k[(i, j)] != 0.0).unwrap_or(i);
        let mut row: Vec<f64> = (first..=i).map(|j| k[(i, j)]).collect();
        for j in first..i {
            let (start, other) = &rows[j];
            let from = first.max(*start);
            let known = dot(&row[from - first..j - first], &other[from - start..j - start]);
            row[j - first] = (row[j - first] - known) / other[j - start];
        }
        let (known, diagonal) = row.split_at_mut(i - first);
        let pivot = diagonal[0] - dot(known, known);
        if pivot.is_nan() || pivot <= 0.0 {
            return None;
        }
        diagonal[0] = pivot.sqrt();
        rows.push((first, row));
    }
    let mut x = f.clone();
    for (i, (first, row)) in rows.iter().enumerate() {
        let known: f64 = (*first..i).map(|j| row[j - first] * x[j]).sum();
        x[i] = (x[i] - known) / row[i - first];
    }
    for (i, (first, row)) in rows.iter().enumerate().rev() {
        x[i] /= row[i - first];
        let at = x[i];
        (*first..i).for_each(|j| x[j] -= row[j - first] * at);
    }
    Some(x)
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_banded_matrix_is_solved_and_an_indefinite_one_is_not() {
        let k = DMatrix::from_fn(7, 7, |i, j| match i.abs_diff(j) {
            0 => 4.0 + i as f64,
            1 => -1.0,
            3 => 0.5,
            _ => 0.0,
        });
        let x = DVector::from_fn(7, |i, _| (i as f64).cos());
        let found = solve(&k, &(&k * &x)).expect("definite");
        assert!((found - &x).amax() < 1e-14);
        assert_eq!(solve(&-&k, &x), None);
    }
}
