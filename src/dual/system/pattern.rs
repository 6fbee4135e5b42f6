//! Where the entries of K are, and where those of a triangle belong.

use faer::sparse::SymbolicSparseColMat;

use super::rows::Sides;
use super::unknowns::{Component, UnknownBlock, Unknowns};
use crate::problem::Problem;

/// Sparsity pattern of the lower triangle, block by block.
pub struct Pattern {
    /// Column by column, from the diagonal down.
    pub symbolic: SymbolicSparseColMat<usize>,
    block_of: Vec<u32>,
    blocks: Vec<UnknownBlock>,
    /// For each block, its later neighbours with the offset of their rows behind the block's own.
    neighbours: Vec<(u32, u32)>,
    neighbour_start: Vec<u32>,
}

impl Pattern {
    /// That of K.
    pub fn new(problem: &Problem, unknowns: &Unknowns) -> Self {
        let blocks = unknowns.blocks.clone();
        let block_of = unknowns.block_of();
        let mut touching: Vec<(u32, u32)> = Vec::new();
        for edges in &problem.mesh.triangle_edges {
            let mut all = [0; 12];
            let mut n = 0;
            for &e in edges {
                let (list, len) = unknowns.blocks_of_edge(e, &block_of);
                all[n..n + len].copy_from_slice(&list[..len]);
                n += len;
            }
            for &a in &all[..n] {
                for &b in &all[..n] {
                    if b > a {
                        touching.push((a as u32, b as u32));
                    }
                }
            }
        }
        touching.sort_unstable();
        touching.dedup();
        let mut neighbour_start = vec![0_u32; blocks.len() + 1];
        for &(a, _) in &touching {
            neighbour_start[a as usize + 1] += 1;
        }
        for b in 0..blocks.len() {
            neighbour_start[b + 1] += neighbour_start[b];
        }
        let mut neighbours = Vec::with_capacity(touching.len());
        let mut columns = Vec::with_capacity(unknowns.count + 1);
        let mut rows = Vec::new();
        columns.push(0);
        for (b, block) in blocks.iter().enumerate() {
            let list = &touching[neighbour_start[b] as usize..neighbour_start[b + 1] as usize];
            let mut offset = 0_u32;
            for &(_, n) in list {
                neighbours.push((n, offset));
                offset += blocks[n as usize].len as u32;
            }
            for own in 0..block.len {
                rows.extend(block.start + own..block.start + block.len);
                for &(_, n) in list {
                    let other = blocks[n as usize];
                    rows.extend(other.start..other.start + other.len);
                }
                columns.push(rows.len());
            }
        }
        let symbolic = SymbolicSparseColMat::new_checked(unknowns.count, unknowns.count, columns, None, rows);
        Pattern { symbolic, block_of, blocks, neighbours, neighbour_start }
    }

    /// Adds a triangle whose sides are all free, with unknowns from `first` on, block by block.
    pub fn add_blocks(
        &self,
        sides: &Sides,
        first: [usize; 3],
        stiffness: &[f64],
        load: &[f64],
        values: &mut [f64],
        rhs: &mut [f64],
    ) {
        let (m, columns) = (sides.len(), self.symbolic.col_ptr());
        // The place of each unknown of a side.
        let at = |side: usize| (0..=sides.degrees[side]).flat_map(move |k| [0, 1].map(|c| sides.at(side, k) + c));
        for p in 0..3 {
            for (i, own) in at(p).enumerate() {
                let unknown = first[p] + i;
                rhs[unknown] += load[own];
                let row = &stiffness[m * own..][..m];
                values[columns[unknown]..].iter_mut().zip(at(p).skip(i)).for_each(|(v, at)| *v += row[at]);
            }
            for q in 0..p {
                let (low, high) = if first[p] < first[q] { (p, q) } else { (q, p) };
                // Blocks are whole: the first entry of each column tells where its others are.
                let start = self.position(first[high], first[low]);
                for (column, own) in at(low).enumerate() {
                    let from = start - columns[first[low]] + columns[first[low] + column] - column;
                    let row = &stiffness[m * own..][..m];
                    values[from..].iter_mut().zip(at(high)).for_each(|(v, at)| *v += row[at]);
                }
            }
        }
    }

    /// Adds any triangle, term by term.
    pub fn add_terms(&self, terms: &[Component], stiffness: &[f64], load: &[f64], values: &mut [f64], rhs: &mut [f64]) {
        let m = load.len();
        for (a, own) in terms.iter().enumerate() {
            for &(i, ci) in own.terms() {
                rhs[i] += ci * load[a];
                for (b, other) in terms.iter().enumerate().take(a + 1) {
                    for &(j, cj) in other.terms() {
                        // (a, b) stands for (b, a) too: twice on the diagonal, once below it.
                        let twice = if i == j && a != b { 2.0 } else { 1.0 };
                        if a != b || i >= j {
                            values[self.position(i.max(j), i.min(j))] += twice * ci * cj * stiffness[m * a + b];
                        }
                    }
                }
            }
        }
    }

    /// Adds to entry (i, j), i ≥ j.
    pub fn add(&self, i: usize, j: usize, value: f64, values: &mut [f64]) {
        values[self.position(i, j)] += value;
    }

    /// Where entry (i, j), i ≥ j, is stored.
    fn position(&self, i: usize, j: usize) -> usize {
        let (bi, bj) = (self.block_of[i], self.block_of[j]);
        let column = self.symbolic.col_ptr()[j];
        if bi == bj {
            return column + (i - j);
        }
        let block = self.blocks[bj as usize];
        let behind = column + (block.start + block.len - j);
        let list = &self.neighbours
            [self.neighbour_start[bj as usize] as usize..self.neighbour_start[bj as usize + 1] as usize];
        for &(n, offset) in list {
            if n == bi {
                return behind + offset as usize + (i - self.blocks[n as usize].start);
            }
        }
        unreachable!("entry ({i}, {j}) is not in the pattern")
    }
}
