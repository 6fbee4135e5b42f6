//! The residual of every piece of the mesh that nothing connects with the rest: its equations have nothing to do with the forces elsewhere.

use std::collections::BTreeSet;

use super::{SOLVER, Site, Solution};
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

/// Sums over the nodes of a piece.
#[derive(Clone, Default)]
struct Sums {
    /// Σ |f|²/K of what is left, of the loads, of loads other than initial strains, of those, of what supports carry, and of rounding.
    left: f64,
    load: f64,
    external: f64,
    initial: f64,
    supported: f64,
    size: f64,
    /// a(u, u).
    work: f64,
}

impl Solution<'_> {
    /// The nodes, those of one connected part of the mesh in one set.
    pub(super) fn bodies(&self) -> DisjointSets {
        let mesh = &self.problem.mesh;
        let vertices = mesh.points.len();
        let mut sets = DisjointSets::new(vertices + mesh.edges.len());
        for (corners, edges) in mesh.triangles.iter().zip(&mesh.triangle_edges) {
            corners[1..].iter().for_each(|v| sets.join(corners[0], *v));
            edges.iter().for_each(|e| sets.join(corners[0], vertices + e));
        }
        sets
    }

    /// The sets among `count` that contact touches, where forces of closed coefficients explain it; none where they do not.
    pub(super) fn pushed_among(&self, label: &[usize], count: usize) -> Vec<bool> {
        let mut is_pushed = vec![false; count];
        if self.is_pushed() {
            let touching = |site: &Site| [Some(site.first), site.second].into_iter().flatten();
            self.sites.list.iter().flat_map(touching).for_each(|node| is_pushed[label[node]] = true);
        }
        is_pushed
    }

    /// The piece that leaves more than its own equations allow, the worst one of them; `None` where there is none, or no piece stands apart.
    pub(super) fn apart(&self) -> Option<Apart> {
        let (piece, count) = self.pieces();
        if count == 1 {
            return None;
        }
        let mut sums = vec![Sums::default(); count];
        (0..self.rest.len()).for_each(|node| self.add(node, &mut sums[piece[node]]));
        let is_pushed = self.pushed_among(&piece, count);
        let judged = (0..count).filter(|own| !is_pushed[*own]).filter_map(|own| {
            let (residual, allowance) = self.alone(&sums[own])?;
            (residual > allowance.exact).then_some((own, residual, allowance))
        });
        let (own, residual, allowance) = judged.max_by(|a, b| a.1.total_cmp(&b.1))?;
        let mesh = &self.problem.mesh;
        let of_piece = |(corners, body): (&[usize; 3], &usize)| (piece[corners[0]] == own).then_some(*body);
        let bodies: BTreeSet<usize> = mesh.triangles.iter().zip(&mesh.body).filter_map(of_piece).collect();
        let bodies = bodies.into_iter().map(|b| self.problem.scene.bodies[b].name.clone()).collect();
        Some(Apart { residual, allowance, bodies })
    }

    /// The piece of every node, and how many there are; vertices of no triangle are pieces without forces.
    fn pieces(&self) -> (Vec<usize>, usize) {
        let vertices = self.problem.mesh.points.len();
        let mut sets = self.bodies();
        for pair in self.problem.pairs() {
            pair.second.iter().flatten().chain(&pair.first).for_each(|v| sets.join(pair.first[0], *v));
        }
        for (pair, _) in self.problem.bed_pairs() {
            pair.sides().for_each(|(_, e)| sets.join(vertices + pair.edge, vertices + e));
        }
        sets.labels()
    }

    fn add(&self, node: usize, sums: &mut Sums) {
        let forces = &self.forces;
        let ([left, load, initial], u) =
            ([&forces.left, &forces.load, &forces.initial].map(|f| f[node]), self.candidate.value(node));
        sums.work += (left[0] + load[0]) * u[0] + (left[1] + load[1]) * u[1];
        let k = forces.stiffness[node];
        if k <= 0.0 {
            return;
        }
        let square = |f: [f64; 2]| (f[0] * f[0] + f[1] * f[1]) / k;
        sums.left += square(self.rest[node]);
        sums.load += square(load);
        sums.external += square([load[0] - initial[0], load[1] - initial[1]]);
        sums.initial += square(initial);
        sums.supported += square(left);
        sums.size += forces.size[node].powi(2) / k;
    }

    /// The residual of a piece relative to its own scale, and what is allowed of it; `None` where nothing loads it and it is at rest but for
    /// what a solver leaves.
    fn alone(&self, sums: &Sums) -> Option<(f64, Allowance)> {
        let left = sums.left.sqrt();
        let scale = sums.load.sqrt() + sums.work.max(0.0).sqrt();
        let written = if self.candidate.precision > f64::EPSILON { self.candidate.precision } else { 0.0 };
        let digits = (written + ROUNDING) * sums.size.sqrt() + OF_ALL * self.scale;
        let sizes = Sizes { data: [sums.external, sums.initial].map(f64::sqrt), supported: sums.supported.sqrt() };
        if scale == 0.0 || (sizes.data == [0.0; 2] && left <= SOLVER * scale + digits) {
            return None;
        }
        let allowance =
            Allowance { exact: SOLVER, digits: digits / scale, ceiling: sizes.ceiling(self.larger) / scale };
        Some((left / scale, allowance))
    }
}
