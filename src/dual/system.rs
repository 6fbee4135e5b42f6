//! The hybrid form: element matrices and the sparse system they add up to.
//!
//! Eliminating the stresses element by element from the saddle-point problem leaves
//!
//! min ½ mᵀKm − fᵀm over moments m with jumps at most ∫ g q_p, K = Σ T Tᵀ, f = ∫P·(…) − T̄,
//!
//! whose minimum, less ½ Σ ∫ a λ̄:λ̄, equals −Π(λ_h).

use faer::sparse::{SparseColMat, SparseColMatRef, SymbolicSparseColMat};
use rayon::prelude::*;

use super::Options;
use super::modes::ModeTable;
use super::rows::{FreeEdge, SideEnd, free_edges, rows};
use super::unknowns::{Component, Unknowns};
use crate::problem::{Condition, Problem};

/// The assembled problem.
#[derive(Debug)]
pub struct System {
    /// Numbering.
    pub unknowns: Unknowns,
    /// Element matrices.
    pub modes: ModeTable,
    /// Lower triangle of K.
    pub matrix: SparseColMat<usize, f64>,
    /// f, given moments included.
    pub rhs: Vec<f64>,
    /// The part of f that comes from applied tractions.
    pub external: Vec<f64>,
    /// Upper bound ∫ g q_p of each jump, ∫ g where the direction of contact turns.
    pub jump_bound: Vec<f64>,
}

/// Stiffness and load of a triangle, in the components of its side ends (see [`rows`]).
struct Local {
    /// Its sides, if all are free.
    edges: Option<[FreeEdge; 3]>,
    stiffness: [[f64; 12]; 12],
    load: [f64; 12],
}

impl System {
    /// Numbers the unknowns of `problem` and assembles K and f.
    pub fn new(problem: &Problem, options: &Options) -> Self {
        Self::assemble(problem, Unknowns::new(problem), ModeTable::new(problem, options.element))
    }

    fn assemble(problem: &Problem, unknowns: Unknowns, modes: ModeTable) -> Self {
        let mesh = &problem.mesh;
        let pattern = Pattern::new(problem, &unknowns);
        let mut values = vec![0.0; pattern.rows.len()];
        let mut rhs = vec![0.0; unknowns.count];
        // Element contributions are computed in parallel in chunks and added in order: the sum does not depend on
        // the number of threads.
        const CHUNK: usize = 1024;
        let count = mesh.triangles.len();
        for start in (0..count).step_by(CHUNK) {
            let locals: Vec<Local> = (start..(start + CHUNK).min(count))
                .into_par_iter()
                .with_min_len(64)
                .map(|t| local(problem, &unknowns, &modes, t))
                .collect();
            for (local, t) in locals.iter().zip(start..) {
                match &local.edges {
                    Some(edges) => pattern.add_blocks(edges, local, &mut values, &mut rhs),
                    None => pattern.add_terms(problem, &unknowns, t, local, &mut values, &mut rhs),
                }
            }
        }
        let external = external_load(problem, &unknowns);
        rhs.iter_mut().zip(&external).for_each(|(r, e)| *r += e);
        let jump_bound = problem
            .interfaces
            .iter()
            .flat_map(|i| &i.pairs)
            .flat_map(|pair| {
                let [a, b] = pair.gap;
                match pair.direction.columns(1) {
                    2 => vec![pair.length * (2.0 * a + b) / 6.0, pair.length * (a + 2.0 * b) / 6.0],
                    _ => vec![pair.length * (a + b) / 2.0],
                }
            })
            .collect();
        let symbolic =
            SymbolicSparseColMat::new_checked(unknowns.count, unknowns.count, pattern.columns, None, pattern.rows);
        System { unknowns, modes, matrix: SparseColMat::new(symbolic, values), rhs, external, jump_bound }
    }

    /// y = K x.
    pub fn multiply(&self, x: &[f64]) -> Vec<f64> {
        symmetric_multiply(self.matrix.as_ref(), x)
    }
}

/// Takes the given unknowns out of a symmetric matrix: their rows and columns become those of a diagonal matrix.
pub fn isolate(matrix: &mut SparseColMat<usize, f64>, given: impl Fn(usize) -> bool) {
    let (symbolic, values) = matrix.parts_mut();
    let (columns, rows) = (symbolic.col_ptr(), symbolic.row_idx());
    for j in 0..columns.len() - 1 {
        let own = given(j);
        for k in columns[j]..columns[j + 1] {
            if rows[k] != j && (own || given(rows[k])) {
                values[k] = 0.0;
            }
        }
    }
}

/// ∫P q_p on every unknown of Γ_τ: the end values P_p themselves, by the choice of the moments.
fn external_load(problem: &Problem, unknowns: &Unknowns) -> Vec<f64> {
    let mut load = vec![0.0; unknowns.count];
    for (e, condition) in problem.conditions.iter().enumerate() {
        let Condition::Traction(p) = condition else { continue };
        for (end, value) in p.iter().enumerate() {
            for component in unknowns.components(e, end, [0.0; 2]) {
                for &(dof, c) in component.terms() {
                    load[dof] += c * (component.direction[0] * value[0] + component.direction[1] * value[1]);
                }
            }
        }
    }
    load
}

/// y = A x for a symmetric matrix given by its lower triangle.
pub fn symmetric_multiply(a: SparseColMatRef<'_, usize, f64>, x: &[f64]) -> Vec<f64> {
    let mut y = vec![0.0; x.len()];
    let (columns, rows, values) = (a.col_ptr(), a.row_idx(), a.val());
    for j in 0..x.len() {
        let mut sum = 0.0;
        for k in columns[j]..columns[j + 1] {
            let (i, v) = (rows[k], values[k]);
            sum += v * x[i];
            if i != j {
                y[i] += v * x[j];
            }
        }
        y[j] += sum;
    }
    y
}

/// T Tᵀ in the components of the numbering, and minus the load of the particular field and of given moments.
fn local(problem: &Problem, unknowns: &Unknowns, modes: &ModeTable, t: usize) -> Local {
    let element = modes.of(t);
    let mut modes = [[0.0; 12]; 9];
    modes.as_flattened_mut().copy_from_slice(element.traction());
    let edges = free_edges(&problem.mesh, unknowns, t);
    let mut local = Local { edges, stiffness: [[0.0; 12]; 12], load: [0.0; 12] };
    local.load.iter_mut().zip(element.particular_traction()).for_each(|(l, p)| *l = -p);
    if local.edges.is_none() {
        let mut fixed = [0.0; 9];
        for (SideEnd { at, .. }, components) in rows(&problem.mesh, unknowns, t) {
            let turn = |[x, y]: [f64; 2]| components.map(|c| c.direction[0] * x + c.direction[1] * y);
            for (mode, fixed) in modes.iter_mut().zip(&mut fixed) {
                let turned = turn([mode[at], mode[at + 1]]);
                mode[at..at + 2].copy_from_slice(&turned);
                *fixed += components[0].fixed * turned[0] + components[1].fixed * turned[1];
            }
            let turned = turn([local.load[at], local.load[at + 1]]);
            local.load[at..at + 2].copy_from_slice(&turned);
        }
        for (mode, fixed) in modes.iter().zip(fixed) {
            local.load.iter_mut().zip(mode).for_each(|(l, t)| *l -= fixed * t);
        }
    }
    for mode in &modes {
        for (row, a) in local.stiffness.iter_mut().zip(mode) {
            row.iter_mut().zip(mode).for_each(|(k, b)| *k += a * b);
        }
    }
    local
}

/// Sparsity pattern of the lower triangle, block by block.
struct Pattern {
    columns: Vec<usize>,
    rows: Vec<usize>,
    block_of: Vec<u32>,
    blocks: Vec<super::unknowns::Block>,
    /// For each block, its later neighbours with the offset of their rows behind the block's own.
    neighbours: Vec<(u32, u32)>,
    neighbour_start: Vec<u32>,
}

impl Pattern {
    fn new(problem: &Problem, unknowns: &Unknowns) -> Self {
        let blocks = unknowns.blocks.clone();
        let block_of = unknowns.block_of();
        let mut touching: Vec<(u32, u32)> = Vec::new();
        for edges in &problem.mesh.triangle_edges {
            let mut all = [0; 9];
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
        Pattern { columns, rows, block_of, blocks, neighbours, neighbour_start }
    }

    /// Adds a triangle whose sides are all free, block by block.
    fn add_blocks(&self, edges: &[FreeEdge; 3], local: &Local, values: &mut [f64], rhs: &mut [f64]) {
        for (p, edge) in edges.iter().enumerate() {
            for (i, (unknown, at)) in edge.unknowns().enumerate() {
                rhs[unknown] += local.load[at];
                for (value, row) in values[self.columns[unknown]..].iter_mut().zip(&edge.at[i..]) {
                    *value += local.stiffness[at][*row];
                }
            }
            for other in &edges[..p] {
                let (low, high) = if edge.first < other.first { (edge, other) } else { (other, edge) };
                // Blocks are whole: the first entry of each column tells where its others are.
                let start = self.position(high.first, low.first);
                for (column, at) in low.at.into_iter().enumerate() {
                    let from = start - self.columns[low.first] + self.columns[low.first + column] - column;
                    for (value, row) in values[from..from + 4].iter_mut().zip(high.at) {
                        *value += local.stiffness[at][row];
                    }
                }
            }
        }
    }

    /// Adds any triangle, term by term.
    fn add_terms(
        &self,
        problem: &Problem,
        unknowns: &Unknowns,
        t: usize,
        local: &Local,
        values: &mut [f64],
        rhs: &mut [f64],
    ) {
        let mut terms: [Component; 12] = [Component::default(); 12];
        for (SideEnd { at, .. }, components) in rows(&problem.mesh, unknowns, t) {
            terms[at..at + 2].copy_from_slice(&components);
        }
        for (a, own) in terms.iter().enumerate() {
            for &(i, ci) in own.terms() {
                rhs[i] += ci * local.load[a];
                for (b, other) in terms.iter().enumerate().take(a + 1) {
                    for &(j, cj) in other.terms() {
                        // (a, b) stands for (b, a) too: twice on the diagonal, once below it.
                        let twice = if i == j && a != b { 2.0 } else { 1.0 };
                        if a != b || i >= j {
                            values[self.position(i.max(j), i.min(j))] += twice * ci * cj * local.stiffness[a][b];
                        }
                    }
                }
            }
        }
    }

    /// Where entry (i, j), i ≥ j, is stored.
    fn position(&self, i: usize, j: usize) -> usize {
        let (bi, bj) = (self.block_of[i], self.block_of[j]);
        if bi == bj {
            return self.columns[j] + (i - j);
        }
        let block = self.blocks[bj as usize];
        let behind = self.columns[j] + (block.start + block.len - j);
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
