//! Sparse least squares by conjugate gradients on the normal equations.

/// A sparse matrix, row by row.
pub struct Rows {
    /// Entries (column, value) of every row.
    pub rows: Vec<Vec<(usize, f64)>>,
    /// Number of columns.
    pub columns: usize,
}

/// Steps for every column, at most: edges alternate, and their matrix is as badly conditioned as there are many.
const STEPS: usize = 8;
/// The iteration stops once the gradient has fallen by this factor.
const FALLEN: f64 = 1e-15;

impl Rows {
    fn times(&self, x: &[f64]) -> Vec<f64> {
        self.rows.iter().map(|row| row.iter().map(|(c, a)| a * x[*c]).sum()).collect()
    }

    fn transposed_times(&self, y: &[f64]) -> Vec<f64> {
        let mut x = vec![0.0; self.columns];
        for (row, y) in self.rows.iter().zip(y) {
            row.iter().for_each(|(c, a)| x[*c] += a * y);
        }
        x
    }

    /// The x that brings Ax nearest to `wanted`, and |Ax − wanted|.
    pub fn least_squares(&self, wanted: &[f64]) -> (Vec<f64>, f64) {
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        let mut x = vec![0.0; self.columns];
        let mut left = wanted.to_vec();
        let mut gradient = self.transposed_times(&left);
        let mut step = gradient.clone();
        let mut size = dot(&gradient, &gradient);
        let enough = FALLEN * FALLEN * size;
        for _ in 0..STEPS * self.columns {
            if size <= enough {
                break;
            }
            let moved = self.times(&step);
            let length = size / dot(&moved, &moved);
            if !length.is_finite() {
                break;
            }
            x.iter_mut().zip(&step).for_each(|(x, p)| *x += length * p);
            left.iter_mut().zip(&moved).for_each(|(r, q)| *r -= length * q);
            gradient = self.transposed_times(&left);
            let next = dot(&gradient, &gradient);
            let turned = next / size;
            step.iter_mut().zip(&gradient).for_each(|(p, g)| *p = g + turned * *p);
            size = next;
        }
        (x, dot(&left, &left).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_that_alternate_are_found() {
        // A force of every node from the pressures of the edges beside it.
        let edges = 40;
        let row = |i: usize| [i.checked_sub(1), Some(i).filter(|i| *i < edges)].into_iter().flatten();
        let rows = Rows { rows: (0..=edges).map(|i| row(i).map(|e| (e, 0.5)).collect()).collect(), columns: edges };
        let pressure: Vec<f64> = (0..edges).map(|e| 1.0 + ((7 * e) % 5) as f64).collect();
        let (found, left) = rows.least_squares(&rows.times(&pressure));
        assert!(left < 1e-9, "{left}");
        assert!(found.iter().zip(&pressure).all(|(a, b)| (a - b).abs() < 1e-8));
    }
}
