//! Sparse orthogonal elimination: null vectors and least squares of systems whose rows have few entries.
//!
//! Rows are merged one by one into a triangular factor by Givens rotations (George & Heath 1980). A column whose pivot
//! would be below the tolerance stays free (Heath 1982): the number of free columns is the number of null vectors.

use nalgebra::DVector;

use crate::statics::balance::RANK;

/// Entries (column, value) with columns ascending.
pub(in crate::statics) type Row = Vec<(usize, f64)>;

/// The upper triangular factor of the rows seen so far, with a gap for every free column.
pub(in crate::statics) struct Triangular {
    rows: Vec<Option<Row>>,
}

/// Corrections of a least-squares solution: the first is the solution, the others bring it to round-off.
pub(in crate::statics) const CORRECTIONS: usize = 4;

impl Triangular {
    /// The factor of no rows at all in `columns` unknowns.
    pub fn new(columns: usize) -> Self {
        Triangular { rows: vec![None; columns] }
    }

    /// The factor of `rows`.
    pub fn of<'a>(columns: usize, rows: impl IntoIterator<Item = &'a Row>) -> Self {
        let mut all = Triangular::new(columns);
        rows.into_iter().for_each(|row| all.insert(row.clone()));
        all
    }

    /// Merges a row of length about one.
    pub fn insert(&mut self, mut row: Row) {
        let mut done = 0;
        while let Some(&(column, lead)) = row.get(done) {
            match &mut self.rows[column] {
                Some(own) => {
                    row = rotate(own, &row[done..]);
                    done = 0;
                }
                None if lead.abs() > RANK => {
                    self.rows[column] = Some(row.split_off(done));
                    return;
                }
                None => done += 1,
            }
        }
    }

    /// Number of columns that are not free.
    pub fn rank(&self) -> usize {
        self.rows.iter().flatten().count()
    }

    /// For each free column the null vector with a one there and zeros in all other free columns.
    pub fn null_vectors(&self) -> Vec<Row> {
        let free = (0..self.rows.len()).filter(|column| self.rows[*column].is_none());
        let vector = |column: usize| {
            let mut x = vec![0.0; self.rows.len()];
            x[column] = 1.0;
            self.back_substitute(&mut x[..=column]);
            let largest = x.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
            x.into_iter().enumerate().filter(|(_, v)| v.abs() > 1e-13 * largest).collect()
        };
        free.map(vector).collect()
    }

    /// Norm of `row` in the free columns after elimination: zero if and only if it depends on the rows seen so far.
    pub fn remainder(&self, row: &Row) -> f64 {
        let mut rest: std::collections::BTreeMap<usize, f64> = row.iter().copied().collect();
        let mut left = 0.0_f64;
        while let Some((column, value)) = rest.pop_first() {
            match &self.rows[column] {
                Some(own) => {
                    let factor = value / own[0].1;
                    own[1..].iter().for_each(|(k, v)| *rest.entry(*k).or_default() -= factor * v);
                }
                None => left = left.hypot(value),
            }
        }
        left
    }

    /// Solves R x = 0 for the columns that are not free, from the values that `x` has in the free ones; or R x = b where
    /// `x` comes with b in the others.
    fn back_substitute(&self, x: &mut [f64]) {
        for column in (0..x.len()).rev() {
            if let Some(own) = &self.rows[column] {
                let after: f64 = own[1..].iter().map(|(k, v)| v * x.get(*k).copied().unwrap_or(0.0)).sum();
                x[column] = (x[column] - after) / own[0].1;
            }
        }
    }

    /// x of RᵀR x = b, zero in free columns.
    pub fn solve_normal(&self, mut b: Vec<f64>) -> Vec<f64> {
        for column in 0..b.len() {
            match &self.rows[column] {
                Some(own) => {
                    b[column] /= own[0].1;
                    let value = b[column];
                    own[1..].iter().for_each(|(k, v)| b[*k] -= v * value);
                }
                None => b[column] = 0.0,
            }
        }
        self.back_substitute(&mut b);
        b
    }
}

/// Turns `own` and `other`, which start in the same column, so that `other` loses that entry; returns the rest of it.
fn rotate(own: &mut Row, other: &[(usize, f64)]) -> Row {
    let (a, b) = (own[0].1, other[0].1);
    let r = a.hypot(b);
    let (c, s) = (a / r, b / r);
    let mut turned = Vec::with_capacity(own.len() + other.len());
    let mut rest = Vec::with_capacity(own.len() + other.len());
    let (mut i, mut k) = (0, 0);
    while i < own.len() || k < other.len() {
        let column = own.get(i).map_or(usize::MAX, |e| e.0).min(other.get(k).map_or(usize::MAX, |e| e.0));
        let take = |row: &[(usize, f64)], at: &mut usize| match row.get(*at) {
            Some((here, value)) if *here == column => {
                *at += 1;
                *value
            }
            _ => 0.0,
        };
        let (x, y) = (take(own, &mut i), take(other, &mut k));
        turned.push((column, c * x + s * y));
        if turned.len() > 1 {
            let left = c * y - s * x;
            if left.abs() > f64::EPSILON * (x.abs() + y.abs()) {
                rest.push((column, left));
            }
        }
    }
    *own = turned;
    rest
}

/// x that minimises |Ax − b|, zero in columns that depend on those before them, and b − Ax. `rows` are those of A.
pub(in crate::statics) fn least_squares(rows: &[Row], columns: usize, b: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let factor = Triangular::of(columns, rows);
    let (mut x, mut rest) = (vec![0.0; columns], b.to_vec());
    for _ in 0..CORRECTIONS {
        let mut gradient = vec![0.0; columns];
        for (row, r) in rows.iter().zip(&rest) {
            row.iter().for_each(|(k, v)| gradient[*k] += v * r);
        }
        let step = factor.solve_normal(gradient);
        x.iter_mut().zip(&step).for_each(|(x, d)| *x += d);
        for (row, r) in rows.iter().zip(&mut rest) {
            *r -= row.iter().map(|(k, v)| v * step[*k]).sum::<f64>();
        }
    }
    (x, rest)
}

/// The rows of the matrix with the given columns.
pub(in crate::statics) fn transposed<'a>(columns: impl IntoIterator<Item = &'a Row>, rows: usize) -> Vec<Row> {
    let mut out = vec![Row::new(); rows];
    for (k, column) in columns.into_iter().enumerate() {
        column.iter().for_each(|(i, v)| out[*i].push((k, *v)));
    }
    out
}

pub(in crate::statics) fn dot(row: &Row, v: &[f64]) -> f64 {
    row.iter().map(|(k, value)| value * v[*k]).sum()
}

pub(in crate::statics) fn norm(row: &Row) -> f64 {
    row.iter().fold(0.0, |m: f64, (_, v)| m.hypot(*v))
}

/// The dense vector with the entries of `row`.
pub(in crate::statics) fn dense(row: &Row, dimension: usize) -> DVector<f64> {
    let mut out = DVector::zeros(dimension);
    row.iter().for_each(|(k, v)| out[*k] = *v);
    out
}
