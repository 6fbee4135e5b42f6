//! The Schur complement of the unknowns of interfaces, as the sparse matrix that it is: what the columns before them leave of K.

use faer::linalg::matmul::matmul;
use faer::sparse::SparseColMatRef;
use faer::{Accum, Mat};

use super::Factor;
use crate::dual::contact::interface::Interface;

/// No place.
const NONE: usize = usize::MAX;

impl Factor {
    /// The entries, in the order of its structure, of K_JJ − L_JI L_JIᵀ for the unknowns J of `interface` and all others I, from the
    /// lower triangle of K.
    pub fn complement(&self, interface: &Interface, matrix: SparseColMatRef<'_, usize, f64>) -> Vec<f64> {
        let structure = &interface.structure;
        let mut out = vec![0.0; structure.entries()];
        // Where the entries of one column of the result are, by their rows.
        let mut places = vec![NONE; interface.unknowns.len()];
        let with_column = |places: &mut [usize], k: usize, set: bool| {
            let (start, rows) = structure.column(k);
            rows.iter().enumerate().for_each(|(at, row)| places[*row] = if set { start + at } else { NONE });
        };
        let mut number = vec![NONE; matrix.ncols()];
        interface.unknowns.iter().enumerate().for_each(|(k, unknown)| number[*unknown] = k);
        let columns = matrix.col_ptr();
        let entries = interface.unknowns.iter().enumerate().flat_map(|(k, &unknown)| {
            let own = columns[unknown]..columns[unknown + 1];
            let number = &number;
            own.map(move |at| (k, number[matrix.row_idx()[at]], matrix.val()[at])).filter(|(_, row, _)| *row != NONE)
        });
        for (k, row, value) in entries {
            let (start, rows) = structure.column(k.min(row));
            if let Ok(at) = rows.binary_search(&k.max(row)) {
                out[start + at] += value;
            }
        }
        let first = self.symbolic.leading;
        let Some(factor) = self.supernodal() else { return out };
        let nodes = factor.symbolic();
        let mut product = Mat::new();
        for s in 0..nodes.n_supernodes() {
            let node = factor.supernode(s);
            let (start, size) = (node.start(), node.val().ncols());
            if start >= first {
                break;
            }
            // Rows of J in this node: of its own block where it reaches beyond I, and of its pattern.
            let inner = size.min(first - start);
            let skipped = node.pattern().partition_point(|row| *row < first);
            let own = (start + inner..start + size).map(|row| (row - start, row));
            let below = node.pattern().iter().enumerate().skip(skipped).map(|(at, row)| (size + at, *row));
            let rows: Vec<(usize, usize)> = own.chain(below).map(|(at, row)| (at, interface.at(row - first))).collect();
            let (Some((from, _)), Some((to, _))) = (rows.first(), rows.last()) else { continue };
            // They lie one below the other, but for a part of the pattern between both kinds that is empty where there are any of the first.
            let block = node.val().submatrix(*from, 0, to - from + 1, inner);
            product.resize_with(rows.len(), rows.len(), |_, _| 0.0);
            matmul(&mut product, Accum::Replace, block, block.transpose(), 1.0, self.par);
            for (i, &(_, column)) in rows.iter().enumerate() {
                with_column(&mut places, column, true);
                for (k, &(_, row)) in rows.iter().enumerate() {
                    if places[row] != NONE {
                        out[places[row]] -= product[(k, i)];
                    }
                }
                with_column(&mut places, column, false);
            }
        }
        out
    }
}
