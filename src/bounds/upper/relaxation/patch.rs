//! One patch of triangles: its step to the minimum of the energy with everything else fixed.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

use nalgebra::{DMatrix, DVector};

use super::groups::Group;
use crate::bounds::upper::admissible::minimum::{Step, factorise, free_minimum, minimum};
use crate::bounds::upper::energy::cholesky::{column, packed};
use crate::bounds::upper::energy::model::Model;

/// A node, and by how much it moves.
pub type Move = (usize, [f64; 2]);

/// Moves a value.
pub fn add(value: &mut [f64; 2], by: [f64; 2]) {
    value[0] += by[0];
    value[1] += by[1];
}

/// The factors of the stiffness of patches, from the first sweep on.
pub struct Factors {
    kept: Vec<OnceLock<Box<[f64]>>>,
    /// How many numbers may still be kept.
    room: AtomicUsize,
}

impl Factors {
    /// None yet, of `count` patches, and no more than `room` numbers ever.
    pub fn new(count: usize, room: usize) -> Self {
        Factors { kept: vec![OnceLock::new(); count], room: AtomicUsize::new(room) }
    }

    /// Keeps the factor of patch `k`, where there is room.
    fn keep(&self, k: usize, factor: &[f64]) {
        let less = |room: usize| room.checked_sub(factor.len());
        if self.room.fetch_update(Ordering::Relaxed, Ordering::Relaxed, less).is_ok() {
            // Whoever was first has kept the same numbers.
            let _ = self.kept[k].set(factor.into());
        }
    }
}

/// The patch at hand, in memory that serves one after the other.
#[derive(Default)]
pub struct Patch {
    /// First unknown of each node, `usize::MAX` outside.
    local: Vec<usize>,
    /// Node and direction of each unknown.
    unknowns: Vec<(usize, [f64; 2])>,
    /// Rows of contact with an unknown in them.
    rows: Vec<usize>,
    /// Springs with an unknown in them.
    beds: Vec<usize>,
    /// Lower triangle of the stiffness, column by column.
    matrix: Vec<f64>,
    /// Residual forces.
    load: Vec<f64>,
    /// Larger patches are left as they are.
    most: usize,
    /// Values on the boundary of a triangle, and the forces there.
    of_triangle: [Vec<f64>; 2],
}

impl Patch {
    /// Room for patches of a mesh with `nodes` nodes, of no more than `most` unknowns.
    pub fn new(nodes: usize, most: usize) -> Self {
        Patch { local: vec![usize::MAX; nodes], most, ..Patch::default() }
    }

    /// The step of patch `k`, that of `group`, to the minimum of the energy.
    pub fn step(
        &mut self,
        model: &Model,
        group: &Group,
        k: usize,
        factors: &Factors,
        slack: f64,
        values: &[[f64; 2]],
    ) -> Option<Step> {
        self.number(model, group);
        let n = self.unknowns.len();
        if n == 0 || n > self.most {
            return None;
        }
        self.forces(model, group, values);
        let factor = match factors.kept[k].get() {
            Some(factor) => &factor[..],
            None if self.factorise(model, group) => {
                factors.keep(k, &self.matrix);
                &self.matrix
            }
            None => return None,
        };
        if self.rows.is_empty() {
            return free_minimum(factor, &self.load);
        }
        let (b, room) = self.inequalities(model, values);
        minimum(factor, &self.load, &b, &room, slack)
    }

    /// Makes the factor of patch `k`, that of `group`, for the steps that come.
    pub fn prepare(&mut self, model: &Model, group: &Group, k: usize, factors: &Factors) {
        self.number(model, group);
        let n = self.unknowns.len();
        if n > 0 && n <= self.most && self.factorise(model, group) {
            factors.keep(k, &self.matrix);
        }
    }

    /// Moves of the nodes by the step found last.
    pub fn moves(&self, step: &Step) -> impl Iterator<Item = Move> {
        self.unknowns.iter().zip(step.x.iter()).map(|((node, direction), x)| (*node, direction.map(|d| x * d)))
    }

    /// Numbers the unknowns. A patch with a triangle that has no unique minimum inside has none.
    fn number(&mut self, model: &Model, group: &Group) {
        for (node, _) in self.unknowns.drain(..) {
            self.local[node] = usize::MAX;
        }
        self.rows.clear();
        self.beds.clear();
        if group.triangles.iter().any(|&t| model.energies.of(t).is_none()) {
            return;
        }
        for &t in &group.triangles {
            for &node in model.nodes(t) {
                let free = model.free[node];
                if self.local[node] == usize::MAX && free.count > 0 && model.moves(node, group) {
                    self.local[node] = self.unknowns.len();
                    self.unknowns.extend(free.unit[..free.count].iter().map(|unit| (node, *unit)));
                }
            }
        }
        for &v in &group.vertices {
            self.rows.extend(&model.rows_at[v]);
            self.beds.extend(&model.beds_at[v]);
        }
        self.beds.sort_unstable();
        self.beds.dedup();
        self.rows.sort_unstable();
        self.rows.dedup();
    }

    /// The unknowns of a node and their directions, with the first unknown of every node in `local`.
    fn terms(local: &[usize], model: &Model, node: usize) -> impl Iterator<Item = (usize, [f64; 2])> + use<> {
        let (first, free) = (local[node], model.free[node]);
        let count = if first == usize::MAX { 0 } else { free.count };
        (0..count).map(move |i| (first + i, free.unit[i]))
    }

    /// Residual forces.
    fn forces(&mut self, model: &Model, group: &Group, values: &[[f64; 2]]) {
        self.load.clear();
        self.load.resize(self.unknowns.len(), 0.0);
        for &t in &group.triangles {
            let Some(element) = model.energies.of(t) else { continue };
            let [u, residual] = &mut self.of_triangle;
            model.about_corner(t, values, u);
            element.residual(u, residual);
            let residual = &self.of_triangle[1];
            for (a, &node) in model.nodes(t).iter().enumerate() {
                for (i, p) in Self::terms(&self.local, model, node) {
                    self.load[i] += p[0] * residual[2 * a] + p[1] * residual[2 * a + 1];
                }
            }
        }
        for &bed in &self.beds {
            let forces = model.beds[bed].forces(values);
            for (node, sign, at) in model.beds[bed].nodes() {
                for (i, p) in Self::terms(&self.local, model, node) {
                    self.load[i] += sign * (p[0] * forces[at][0] + p[1] * forces[at][1]);
                }
            }
        }
    }

    /// Assembles the stiffness and factorises it; `false` where the patch can move as a whole.
    fn factorise(&mut self, model: &Model, group: &Group) -> bool {
        self.assemble(model, group);
        factorise(&mut self.matrix, self.unknowns.len())
    }

    /// Stiffness.
    fn assemble(&mut self, model: &Model, group: &Group) {
        let n = self.unknowns.len();
        self.matrix.clear();
        self.matrix.resize(packed(n), 0.0);
        for &t in &group.triangles {
            let Some(element) = model.energies.of(t) else { continue };
            let nodes = model.nodes(t);
            for (a, &node) in nodes.iter().enumerate() {
                let (first, second) = (element.row(2 * a), element.row(2 * a + 1));
                for (i, p) in Self::terms(&self.local, model, node) {
                    let start = column(n, i);
                    for (b, &other) in nodes.iter().enumerate() {
                        let row = [0, 1].map(|d| p[0] * first[2 * b + d] + p[1] * second[2 * b + d]);
                        for (j, q) in Self::terms(&self.local, model, other).filter(|(j, _)| *j >= i) {
                            self.matrix[start + j - i] += row[0] * q[0] + row[1] * q[1];
                        }
                    }
                }
            }
        }
        for bed in self.beds.iter().map(|bed| &model.beds[*bed]) {
            for (node, sign, at) in bed.nodes() {
                for (i, p) in Self::terms(&self.local, model, node) {
                    for (other, with, to) in bed.nodes() {
                        for (j, q) in Self::terms(&self.local, model, other).filter(|(j, _)| *j >= i) {
                            self.matrix[column(n, i) + j - i] += sign * with * bed.entry((at, p), (to, q));
                        }
                    }
                }
            }
        }
    }

    /// Limits on the growth of jumps: B and s of Bx ≤ s.
    fn inequalities(&self, model: &Model, values: &[[f64; 2]]) -> (DMatrix<f64>, DVector<f64>) {
        let mut b = DMatrix::zeros(self.rows.len(), self.unknowns.len());
        let mut room = DVector::zeros(self.rows.len());
        for (i, &row) in self.rows.iter().enumerate() {
            let row = &model.rows[row];
            room[i] = (-row.excess(values)).max(0.0);
            for &(node, factor) in row.terms() {
                for (j, unit) in Self::terms(&self.local, model, node) {
                    b[(i, j)] += factor[0] * unit[0] + factor[1] * unit[1];
                }
            }
        }
        (b, room)
    }
}
