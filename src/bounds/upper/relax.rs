//! Relaxation of the free upper bound: one patch of triangles after the other gives up energy.
//!
//! The local fit leaves an error that oscillates from triangle to triangle, and it knows nothing of where supports and
//! gaps let the displacement go. Minimising the energy over the values at a group of vertices and on the edges that meet
//! there, with everything else fixed and no jump on Γ_K above its gap, removes most of both; the patches are large enough
//! to hold fields without change of volume, so that this works as ν → ½ as well. Every step stays admissible and lowers
//! the energy.

use nalgebra::{DMatrix, DVector};

use super::cholesky::{column, packed};
use super::contact::ROUNDING;
use super::groups::{Group, groups};
use super::model::Model;
use super::momentum::Momentum;
use super::nodes::{NodalValues, Nodes};
use super::patch::{Step, factorise, free_minimum, minimum};
use crate::problem::Problem;

/// Rounding of a step of all patches at once, in that of one: jumps that stay closed grow by it, and would cut the step short. What
/// penetrates by it is drawn back with the rest at the end.
const AT_ONCE: f64 = 1e3;
/// Sweeps over all patches. The first takes most of what there is to gain, at ν = 0.3 all of it; the third is worth
/// less than its time even at ν = 0.4999.
const SWEEPS: usize = 2;

/// More sweeps follow, up to this many, while one gains more than this part of the gap: slivers couple their vertices so
/// strongly that the local fit leaves errors far above the energy itself.
const MOST_SWEEPS: usize = 500;
const WORTH_A_SWEEP: f64 = 3e-3;

/// The same where the direction of contact turns: with every polygon it is another, and the displacement of the mesh before
/// is off by a little everywhere, which sweeps take away slowly.
const WORTH_WHERE_TURNING: f64 = 1e-3;

/// Part of the energy below which a gain is rounding, however little is wanted.
const NO_GAIN: f64 = 1e-13;

/// A gap above this part of the energy makes a poor bound, and smaller gains are worth a sweep in proportion: sweeps that
/// gain little lead to others that gain much.
const GOOD: f64 = 1e-3;

/// A field with more energy than this, relative to what bodies at rest have or to the lower bound, says nothing about the
/// displacement. On slivers a good one may have very much.
const WILD: f64 = 1e30;

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

/// When relaxing ends, after the sweeps that are always made; energies are per unit thickness.
#[derive(Debug, Clone, Copy)]
pub enum Until {
    /// A sweep gains a small part of what lies between the energy and this lower bound of it.
    Near(f64),
    /// A sweep gains no more than this.
    Gains(f64),
}

impl Until {
    /// Sweeps that are made in any case. Where it is known what a gain is worth the first may be enough: it often begins with a
    /// field that was relaxed under a similar pull.
    fn least_sweeps(self) -> usize {
        match self {
            Until::Near(_) => SWEEPS,
            Until::Gains(_) => 1,
        }
    }

    /// The size of the energy, as far as it is known.
    fn size(self) -> f64 {
        match self {
            Until::Near(size) | Until::Gains(size) => size.abs(),
        }
    }

    /// Whether a sweep that gained `gained` and led to the values was the last one.
    fn is_reached(self, problem: &Problem, model: &Model<'_>, values: &[[f64; 2]], gained: f64) -> bool {
        match self {
            Until::Gains(least) => gained <= least || gained <= NO_GAIN * model.energy(values).abs(),
            Until::Near(floor) => {
                let least = if problem.contact_turns() { WORTH_WHERE_TURNING } else { WORTH_A_SWEEP };
                let gap = (model.energy(values) - floor).max(0.0);
                gap == 0.0 || gained <= least * (GOOD * floor.abs() / gap).min(1.0) * gap
            }
        }
    }
}

/// What relaxing needs of a mesh, whatever the loads.
pub struct Patches {
    groups: Vec<Group>,
    kept: Vec<Kept>,
    patch: Patch,
}

impl Patches {
    /// Groups the vertices of a mesh; factors are computed when they are needed first.
    pub fn new(problem: &Problem, nodes: &Nodes) -> Self {
        let size = size(nodes);
        let groups = groups(problem, MOST_VERTICES_BY_DEGREE / nodes.highest());
        let patch = Patch {
            local: vec![usize::MAX; nodes.count()],
            room: (KEPT_BY_VERTEX as f64 * size * size) as usize * nodes.vertices(),
            most: (MOST_IN_PATCH as f64 * size) as usize,
            ..Patch::default()
        };
        Patches { kept: vec![None; groups.len()], groups, patch }
    }
}

/// Lowers the energy, that of `model`, of the best of several admissible fields, or of the one `at_rest` where these are
/// wild.
pub fn relax(
    problem: &Problem,
    model: &Model<'_>,
    patches: &mut Patches,
    until: Until,
    candidates: Vec<NodalValues>,
    at_rest: NodalValues,
) -> NodalValues {
    let Patches { groups, kept, patch } = patches;
    let fields = candidates.into_iter().map(|field| (model.energy(&field.values), field.values));
    // A displacement that is not a number has no energy to compare.
    let known = |energy: f64| if energy.is_nan() { f64::INFINITY } else { energy };
    let least = fields.min_by(|(a, _), (b, _)| known(*a).total_cmp(&known(*b)));
    let rest = at_rest.values;
    let tame = WILD * model.energy(&rest).abs().max(until.size());
    let mut values = least.filter(|(energy, _)| known(*energy) <= tame).map_or(rest, |(_, field)| field);
    let slack = ROUNDING * values.iter().flatten().fold(0.0_f64, |m, v| m.max(v.abs()));
    let mut momentum = Momentum::default();
    let mut gained = f64::INFINITY;
    for sweep in 0..MOST_SWEEPS {
        if sweep >= until.least_sweeps() && until.is_reached(problem, model, &values, gained) {
            break;
        }
        let before = (sweep >= until.least_sweeps()).then(|| values.clone());
        gained = 0.0;
        for k in 0..groups.len() {
            // Back and forth: what one direction pushes ahead of it the other brings back.
            let k = if sweep % 2 == 0 { k } else { groups.len() - 1 - k };
            let (group, kept) = (&groups[k], &mut kept[k]);
            gained += patch.relax(model, group, kept, slack, &mut values);
        }
        if let Some(before) = before {
            gained += momentum.push(model, &before, AT_ONCE * slack, &mut values);
        }
    }
    NodalValues { nodes: at_rest.nodes, values }
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
    fn relax(&mut self, model: &Model<'_>, group: &Group, kept: &mut Kept, slack: f64, values: &mut [[f64; 2]]) -> f64 {
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
    fn step(
        &mut self,
        model: &Model<'_>,
        group: &Group,
        kept: &mut Kept,
        slack: f64,
        values: &[[f64; 2]],
    ) -> Option<Step> {
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
    fn number(&mut self, model: &Model<'_>, group: &Group) {
        self.unknowns.clear();
        self.rows.clear();
        if group.triangles.iter().any(|&t| model.elements[t].is_none()) {
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
    fn terms(local: &[usize], model: &Model<'_>, node: usize) -> impl Iterator<Item = (usize, [f64; 2])> + use<> {
        let (first, free) = (local[node], model.free[node]);
        let count = if first == usize::MAX { 0 } else { free.count };
        (0..count).map(move |i| (first + i, free.unit[i]))
    }

    /// Residual forces.
    fn forces(&mut self, model: &Model<'_>, group: &Group, values: &[[f64; 2]]) {
        self.load.clear();
        self.load.resize(self.unknowns.len(), 0.0);
        for &t in &group.triangles {
            let Some(element) = &model.elements[t] else { continue };
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
    fn assemble(&mut self, model: &Model<'_>, group: &Group) {
        let n = self.unknowns.len();
        self.matrix.clear();
        self.matrix.resize(packed(n), 0.0);
        for &t in &group.triangles {
            let Some(element) = &model.elements[t] else { continue };
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
    fn inequalities(&self, model: &Model<'_>, values: &[[f64; 2]]) -> (DMatrix<f64>, DVector<f64>) {
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
