//! A sparse A: that of many bodies, each of which couples the unknowns of its own contacts alone.

use std::sync::{Arc, Mutex, PoisonError};

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMat};
use faer::{Conj, MatMut, Par, Side, Spec};

use super::form::{Factor, Quadratic};

/// The places of the entries of A and of its factors, which are the same for all of them.
#[derive(Debug)]
pub struct Structure {
    /// Lower triangle, column by column from the diagonal down.
    pattern: SymbolicSparseColMat<usize>,
    symbolic: SymbolicCholesky<usize>,
}

impl Structure {
    /// That of unknowns coupled by `cliques`, each a set of them. Nothing where it is too large for the index type.
    pub fn of_cliques(len: usize, cliques: &[Vec<usize>]) -> Option<Self> {
        let mut of_unknown = vec![Vec::new(); len];
        for (c, clique) in cliques.iter().enumerate() {
            clique.iter().for_each(|&i| of_unknown[i].push(c));
        }
        let (mut columns, mut rows) = (vec![0], Vec::new());
        let mut own = Vec::new();
        for (i, of) in of_unknown.iter().enumerate() {
            own.clear();
            own.push(i);
            own.extend(of.iter().flat_map(|&c| &cliques[c]).copied().filter(|&row| row > i));
            own.sort_unstable();
            own.dedup();
            rows.extend_from_slice(&own);
            columns.push(rows.len());
        }
        let pattern = SymbolicSparseColMat::new_checked(len, len, columns, None, rows);
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..Default::default()
        };
        let symbolic =
            factorize_symbolic_cholesky(pattern.as_ref(), Side::Lower, SymmetricOrdering::Amd, params).ok()?;
        Some(Structure { pattern, symbolic })
    }

    /// The unknowns in the order of elimination.
    pub fn order(&self) -> Vec<usize> {
        match self.symbolic.perm() {
            Some(perm) => perm.arrays().0.to_vec(),
            None => (0..self.pattern.ncols()).collect(),
        }
    }

    /// The rows of column `k`, from the diagonal down, and where their values begin.
    pub fn column(&self, k: usize) -> (usize, &[usize]) {
        let start = self.pattern.col_ptr()[k];
        (start, &self.pattern.row_idx()[start..self.pattern.col_ptr()[k + 1]])
    }

    /// Number of entries.
    pub fn entries(&self) -> usize {
        self.pattern.row_idx().len()
    }
}

/// A with its structure.
#[derive(Debug)]
pub struct SparseForm {
    structure: Arc<Structure>,
    values: Vec<f64>,
    /// The last factor: solves in one state after the other often are in the same one.
    last: Mutex<Option<Arc<Numbers>>>,
}

/// A factor, and what it is one of.
#[derive(Debug)]
struct Numbers {
    added: Vec<f64>,
    held: Vec<bool>,
    values: Vec<f64>,
}

impl SparseForm {
    /// The matrix with these `values` of the entries of its structure.
    pub fn new(structure: Arc<Structure>, values: Vec<f64>) -> Self {
        SparseForm { structure, values, last: Mutex::new(None) }
    }

    /// The products of `rows`, entries (column, value) with no column twice, in so many `columns`, with each other.
    pub fn of_products(rows: &[Vec<(usize, f64)>], columns: usize) -> Option<Self> {
        let mut with_column = vec![Vec::new(); columns];
        rows.iter().enumerate().for_each(|(i, row)| row.iter().for_each(|(k, _)| with_column[*k].push(i)));
        let structure = Arc::new(Structure::of_cliques(rows.len(), &with_column)?);
        let mut values = vec![0.0; structure.entries()];
        let mut own = vec![0.0; columns];
        for (k, row) in rows.iter().enumerate() {
            row.iter().for_each(|(c, v)| own[*c] = *v);
            let (start, others) = structure.column(k);
            let product = |other: usize| rows[other].iter().map(|(c, v)| v * own[*c]).sum();
            others.iter().enumerate().for_each(|(at, other)| values[start + at] = product(*other));
            row.iter().for_each(|(c, _)| own[*c] = 0.0);
        }
        Some(SparseForm::new(structure, values))
    }

    /// Adds the product of the matrix of `entry`(a) with x, symmetric, to `out`.
    fn add(&self, x: &[f64], out: &mut [f64], entry: impl Fn(f64) -> f64) {
        for (k, &own) in x.iter().enumerate() {
            let (start, rows) = self.structure.column(k);
            let values = &self.values[start..start + rows.len()];
            let mut sum = entry(values[0]) * own;
            for (&row, &value) in rows.iter().zip(values).skip(1) {
                let value = entry(value);
                sum += value * x[row];
                out[row] += value * own;
            }
            out[k] += sum;
        }
    }
}

impl Quadratic for SparseForm {
    fn len(&self) -> usize {
        self.structure.pattern.ncols()
    }

    fn diagonal(&self, i: usize) -> f64 {
        self.values[self.structure.column(i).0]
    }

    fn add_product(&self, x: &[f64], out: &mut [f64]) {
        self.add(x, out, |a| a);
    }

    fn terms(&self, x: &[f64]) -> Vec<f64> {
        let size: Vec<f64> = x.iter().map(|x| x.abs()).collect();
        let mut out = vec![0.0; self.len()];
        self.add(&size, &mut out, f64::abs);
        out
    }

    fn is_loose(&self) -> bool {
        true
    }

    fn factor(&self, added: &[f64], held: &[bool]) -> Option<Box<dyn Factor + '_>> {
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        let kept = last.as_ref().filter(|kept| kept.held == held && kept.added == added);
        let numbers = match kept {
            Some(kept) => Arc::clone(kept),
            None => {
                // The memory of the last one, where nobody holds it any more.
                let spent = last.take().and_then(|last| Arc::try_unwrap(last).ok());
                let values = self.factorise(added, held, spent.map(|last| last.values).unwrap_or_default())?;
                let numbers = Arc::new(Numbers { added: added.to_vec(), held: held.to_vec(), values });
                Arc::clone(last.insert(numbers))
            }
        };
        Some(Box::new(SparseFactor { symbolic: &self.structure.symbolic, numbers }))
    }
}

impl SparseForm {
    /// The numbers of the factor of A + diag(`added`) on the unknowns that are not `held`, in place of what `numbers` has.
    fn factorise(&self, added: &[f64], held: &[bool], mut numbers: Vec<f64>) -> Option<Vec<f64>> {
        let Structure { pattern, symbolic } = &*self.structure;
        let mut values = self.values.clone();
        for (k, held_column) in held.iter().enumerate() {
            let (start, rows) = self.structure.column(k);
            values[start] = if *held_column { 1.0 } else { values[start] + added[k] };
            for (value, row) in values[start + 1..].iter_mut().zip(&rows[1..]) {
                if *held_column || held[*row] {
                    *value = 0.0;
                }
            }
        }
        numbers.clear();
        numbers.resize(symbolic.len_val(), 0.0);
        let mut memory = MemBuffer::new(symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Spec::default()));
        symbolic
            .factorize_numeric_llt(
                &mut numbers,
                SparseColMatRef::new(pattern.as_ref(), &values),
                Side::Lower,
                LltRegularization::default(),
                Par::Seq,
                MemStack::new(&mut memory),
                Spec::default(),
            )
            .ok()?;
        Some(numbers)
    }
}

struct SparseFactor<'a> {
    symbolic: &'a SymbolicCholesky<usize>,
    numbers: Arc<Numbers>,
}

impl Factor for SparseFactor<'_> {
    fn solve(&self, b: &[f64]) -> Vec<f64> {
        let mut x: Vec<f64> = b.iter().zip(&self.numbers.held).map(|(b, held)| if *held { 0.0 } else { *b }).collect();
        let n = x.len();
        let mut memory = MemBuffer::new(self.symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
        LltRef::new(self.symbolic, &self.numbers.values).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(&mut x, n, 1),
            Par::Seq,
            MemStack::new(&mut memory),
        );
        x
    }
}
