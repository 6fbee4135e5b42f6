//! The patches of triangles that relaxing moves one after the other, and what is kept of them.

use nalgebra::{DMatrix, DVector};

use super::cholesky::{column, packed};
use super::groups::{Group, groups};
use super::minimum::{Step, factorise, free_minimum, minimum};
use super::model::Model;
use super::nodes::Nodes;
use crate::problem::Problem;

/// Patches with more unknowns than this for quadratics, at vertices with scores of triangles, are left as they are.
const MOST_IN_PATCH: usize = 300;

/// Flat triangles tie together no more vertices than this over the degree: patches grow with the square of both.
const MOST_VERTICES_BY_DEGREE: usize = 24;

/// Numbers of kept factors for each vertex at most, for quadratics: where patches are larger on average, some factors are
/// computed anew in every sweep.
const KEPT_BY_VERTEX: usize = 512;

/// How many unknowns a patch has, relative to quadratics.
fn size(nodes: &Nodes) -> f64 {
    let of_quadratics = nodes.vertices() + nodes.edges();
    nodes.count() as f64 / of_quadratics.max(1) as f64
}

/// The factor of the stiffness of a patch, from the first sweep on.
type Kept = Option<Box<[f64]>>;

/// What relaxing needs of a mesh, whatever the loads.
pub struct Patches {
    groups: Vec<Group>,
    /// The group of each vertex.
    of_vertex: Vec<usize>,
    kept: Vec<Kept>,
    /// What each patch gained when it was moved last.
    gained: Vec<f64>,
    patch: Patch,
}

impl Patches {
    /// Groups the vertices of a mesh; factors are computed when they are needed first.
    pub fn new(problem: &Problem, nodes: &Nodes) -> Self {
        let size = size(nodes);
        let groups = groups(problem, MOST_VERTICES_BY_DEGREE / nodes.highest());
        let mut of_vertex = vec![0; nodes.vertices()];
        for (number, group) in groups.iter().enumerate() {
            group.vertices.iter().for_each(|v| of_vertex[*v] = number);
        }
        let patch = Patch {
            local: vec![usize::MAX; nodes.count()],
            room: (KEPT_BY_VERTEX as f64 * size * size) as usize * nodes.vertices(),
            most: (MOST_IN_PATCH as f64 * size) as usize,
            ..Patch::default()
        };
        let count = groups.len();
        Patches { groups, of_vertex, kept: vec![None; count], gained: vec![0.0; count], patch }
    }

    /// How many they are.
    pub fn count(&self) -> usize {
        self.groups.len()
    }

    /// Moves the patches `which`, in this order or from the last one `back`, each to its minimum, and gives the energy gained.
    pub fn sweep(
        &mut self,
        model: &Model,
        which: impl DoubleEndedIterator<Item = usize> + ExactSizeIterator,
        back: bool,
        slack: f64,
        values: &mut [[f64; 2]],
    ) -> f64 {
        let Patches { groups, kept, gained, patch, .. } = self;
        let mut sum = 0.0;
        let mut relax = |k: usize| {
            gained[k] = patch.relax(model, &groups[k], &mut kept[k], slack, values);
            sum += gained[k];
        };
        if back {
            which.rev().for_each(&mut relax)
        } else {
            which.for_each(&mut relax)
        }
        sum
    }

    /// The patches that gained more than `quiet` when they were moved last, and those beside them, in order.
    pub fn to_move(&self, problem: &Problem, quiet: f64) -> Vec<usize> {
        self.and_gaining(problem, quiet, vec![false; self.count()])
    }

    /// The same with those that contact bounds.
    pub fn to_move_or_bounded(&self, problem: &Problem, model: &Model, quiet: f64) -> Vec<usize> {
        let bounded = |group: &Group| group.vertices.iter().any(|v| !model.rows_at[*v].is_empty());
        self.and_gaining(problem, quiet, self.groups.iter().map(bounded).collect())
    }

    fn and_gaining(&self, problem: &Problem, quiet: f64, mut moves: Vec<bool>) -> Vec<usize> {
        for (group, _) in self.groups.iter().zip(&self.gained).filter(|(_, gained)| **gained > quiet) {
            for v in group.triangles.iter().flat_map(|t| problem.mesh.triangles[*t]) {
                moves[self.of_vertex[v]] = true;
            }
        }
        (0..self.count()).filter(|k| moves[*k]).collect()
    }
}

/// The patch at hand, in memory that serves one after the other.
#[derive(Default)]
struct Patch {
    /// First unknown of each node, `usize::MAX` outside.
    local: Vec<usize>,
    /// Node and direction of each unknown.
    unknowns: Vec<(usize, [f64; 2])>,
    /// Rows of contact with an unknown in them.
    rows: Vec<usize>,
    /// Lower triangle of the stiffness, column by column.
    matrix: Vec<f64>,
    /// Residual forces.
    load: Vec<f64>,
    /// How many numbers of factors may still be kept.
    room: usize,
    /// Larger patches are left as they are.
    most: usize,
    /// Values on the boundary of a triangle, and the forces there.
    of_triangle: [Vec<f64>; 2],
}

impl Patch {
    /// Moves the patch of `group` to the minimum of the energy, and gives the energy gained.
    fn relax(&mut self, model: &Model, group: &Group, kept: &mut Kept, slack: f64, values: &mut [[f64; 2]]) -> f64 {
        self.number(model, group);
        let mut gained = 0.0;
        if let Some(step) = self.step(model, group, kept, slack, values) {
            for ((node, direction), x) in self.unknowns.iter().zip(step.x.iter()) {
                values[*node][0] += x * direction[0];
                values[*node][1] += x * direction[1];
            }
            gained = step.gain;
        }
        for (node, _) in &self.unknowns {
            self.local[*node] = usize::MAX;
        }
        gained
    }

    /// The step to the minimum.
    fn step(&mut self, model: &Model, group: &Group, kept: &mut Kept, slack: f64, values: &[[f64; 2]]) -> Option<Step> {
        let n = self.unknowns.len();
        if n == 0 || n > self.most {
            return None;
        }
        self.forces(model, group, values);
        let factor = match kept {
            Some(factor) => &factor[..],
            None => {
                self.assemble(model, group);
                if !factorise(&mut self.matrix, n) {
                    return None;
                }
                if self.room >= packed(n) {
                    self.room -= packed(n);
                    *kept = Some(self.matrix.as_slice().into());
                }
                &self.matrix
            }
        };
        if self.rows.is_empty() {
            return free_minimum(factor, &self.load);
        }
        let (b, room) = self.inequalities(model, values);
        minimum(factor, &self.load, &b, &room, slack)
    }

    /// Numbers the unknowns. A patch with a triangle that has no unique minimum inside has none.
    fn number(&mut self, model: &Model, group: &Group) {
        self.unknowns.clear();
        self.rows.clear();
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
        }
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
    }

    /// What jumps may still grow by: B and s of Bx ≤ s.
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
