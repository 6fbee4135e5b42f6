//! The residual of every piece of the mesh that nothing connects with the rest: its equations have nothing to do with the forces elsewhere.

use super::{SOLVER, Solution};
use crate::compare::balance::ROUNDING;
use crate::compare::ceiling::{Allowance, Sizes};
use crate::sets::DisjointSets;

/// Residual that a solver may leave in one piece, relative to the forces of all: it stops by the sum over all equations.
const OF_ALL: f64 = 1e-10;

/// The residual of a piece, with what may be left of it.
pub(super) struct Apart {
    /// Relative to the scale of the piece.
    pub residual: f64,
    pub allowance: Allowance,
    /// The bodies that it consists of.
    pub bodies: Vec<String>,
}

impl Solution<'_> {
    /// The piece that leaves more than its own equations allow, the worst one of them; `None` where there is none, or no piece stands apart.
    pub(super) fn apart(&self) -> Option<Apart> {
        let (piece, count) = self.pieces();
        if count == 1 {
            return None;
        }
        let mut is_pushed = vec![false; count];
        if self.is_pushed() {
            self.sites.list.iter().for_each(|site| is_pushed[piece[site.first]] = true);
        }
        let too_much = |of: &Apart| of.residual > of.allowance.exact;
        let all = (0..count).filter(|own| !is_pushed[*own]).filter_map(|own| self.alone(&piece, own));
        all.filter(too_much).max_by(|a, b| a.residual.total_cmp(&b.residual))
    }

    /// The piece of every node, and how many there are.
    fn pieces(&self) -> (Vec<usize>, usize) {
        let mesh = &self.problem.mesh;
        let vertices = mesh.points.len();
        let mut sets = DisjointSets::new(vertices + mesh.edges.len());
        for (corners, edges) in mesh.triangles.iter().zip(&mesh.triangle_edges) {
            corners[1..].iter().for_each(|v| sets.join(corners[0], *v));
            edges.iter().for_each(|e| sets.join(corners[0], vertices + e));
        }
        for pair in self.problem.pairs() {
            pair.second.iter().flatten().chain(&pair.first).for_each(|v| sets.join(pair.first[0], *v));
        }
        for (pair, _) in self.problem.bed_pairs() {
            pair.sides().for_each(|(_, e)| sets.join(vertices + pair.edge, vertices + e));
        }
        // Vertices of no triangle are pieces without forces.
        sets.labels()
    }

    /// Piece `own` by itself; `None` where nothing loads it and it is at rest but for what a solver leaves.
    fn alone(&self, piece: &[usize], own: usize) -> Option<Apart> {
        let forces = &self.forces;
        let size = |f: &[[f64; 2]]| forces.energy_size(|i| if piece[i] == own { f[i][0].hypot(f[i][1]) } else { 0.0 });
        let nodes = || (0..self.rest.len()).filter(|n| piece[*n] == own);
        let work = |n: usize| {
            let ([left, load], u) = ([forces.left[n], forces.load[n]], self.candidate.value(n));
            (left[0] + load[0]) * u[0] + (left[1] + load[1]) * u[1]
        };
        let left = size(&self.rest);
        let scale = size(&forces.load) + nodes().map(work).sum::<f64>().max(0.0).sqrt();
        let written = if self.candidate.precision > f64::EPSILON { self.candidate.precision } else { 0.0 };
        let rounded = (written + ROUNDING) * forces.energy_size(|i| if piece[i] == own { forces.size[i] } else { 0.0 });
        let digits = rounded + OF_ALL * self.scale;
        let external: Vec<[f64; 2]> =
            forces.load.iter().zip(&forces.initial).map(|(f, held)| [f[0] - held[0], f[1] - held[1]]).collect();
        let sizes = Sizes { data: [size(&external), size(&forces.initial)], supported: size(&forces.left) };
        if scale == 0.0 || (sizes.data == [0.0; 2] && left <= SOLVER * scale + digits) {
            return None;
        }
        let ceiling = sizes.ceiling(self.larger) / scale;
        let allowance = Allowance { exact: SOLVER, digits: digits / scale, ceiling };
        let mesh = &self.problem.mesh;
        let of_piece = |t: &usize| piece[mesh.triangles[*t][0]] == own;
        let mut bodies: Vec<usize> = (0..mesh.triangles.len()).filter(of_piece).map(|t| mesh.body[t]).collect();
        bodies.sort_unstable();
        bodies.dedup();
        let name = |b: usize| self.problem.scene.bodies[b].name.clone();
        Some(Apart { residual: left / scale, allowance, bodies: bodies.into_iter().map(name).collect() })
    }
}
