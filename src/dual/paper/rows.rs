//! Sparse matrices by rows, which is how constraints come.

/// A matrix in compressed rows.
#[derive(Debug, Clone, PartialEq)]
pub struct SparseRows {
    columns: usize,
    starts: Vec<usize>,
    indices: Vec<usize>,
    values: Vec<f64>,
}

impl SparseRows {
    /// No rows yet, of the given length.
    pub fn new(columns: usize) -> Self {
        SparseRows { columns, starts: vec![0], indices: Vec::new(), values: Vec::new() }
    }

    /// Appends a row.
    pub fn push(&mut self, entries: impl IntoIterator<Item = (usize, f64)>) {
        for (index, value) in entries {
            self.indices.push(index);
            self.values.push(value);
        }
        self.starts.push(self.indices.len());
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// True if there is no row.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of columns.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Entries of row `i` as (column, value).
    pub fn row(&self, i: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let range = self.starts[i]..self.starts[i + 1];
        self.indices[range.clone()].iter().copied().zip(self.values[range].iter().copied())
    }

    /// These rows, and below them those of `other`.
    pub fn stack(&self, other: &SparseRows) -> SparseRows {
        let mut all = self.clone();
        for i in 0..other.len() {
            all.push(other.row(i));
        }
        all
    }

    /// Multiplies row i by `factors[i]`.
    pub fn scale(&mut self, factors: &[f64]) {
        for (i, &factor) in factors.iter().enumerate() {
            for value in &mut self.values[self.starts[i]..self.starts[i + 1]] {
                *value *= factor;
            }
        }
    }

    /// B x.
    pub fn multiply(&self, x: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; self.len()];
        self.multiply_into(x, &mut out);
        out
    }

    /// out = B x.
    pub fn multiply_into(&self, x: &[f64], out: &mut [f64]) {
        for (i, value) in out.iter_mut().enumerate() {
            let range = self.starts[i]..self.starts[i + 1];
            *value = self.indices[range.clone()].iter().zip(&self.values[range]).map(|(&j, v)| v * x[j]).sum();
        }
    }

    /// Bᵀ z.
    pub fn transposed_multiply(&self, z: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; self.columns];
        self.add_transposed(z, &mut out);
        out
    }

    /// out += Bᵀ z.
    pub fn add_transposed(&self, z: &[f64], out: &mut [f64]) {
        for (i, &zi) in z.iter().enumerate() {
            let range = self.starts[i]..self.starts[i + 1];
            for (&j, v) in self.indices[range.clone()].iter().zip(&self.values[range]) {
                out[j] += v * zi;
            }
        }
    }

    /// For each column, the rows with an entry there and its value.
    pub fn by_column(&self) -> Vec<Vec<(usize, f64)>> {
        let mut lists = vec![Vec::new(); self.columns];
        for i in 0..self.len() {
            for (j, v) in self.row(i) {
                lists[j].push((i, v));
            }
        }
        lists
    }
}
