//! What supports and contacts ask of the rigid motions: rows of small linear systems.
//!
//! A rigid motion moves a straight line so that its normal displacement is linear along it. A straight run of edges
//! therefore needs two rows, however many edges it has, and the normal is taken from the whole run: normals of single
//! short edges carry the round-off of their coordinates.

use super::components::{Components, DisjointSets};
use crate::problem::{Condition, ContactPair, Interface, Problem};
use nalgebra::DVector;

/// Relative distance from which points leave a straight line, and directions differ.
const STRAIGHT: f64 = 1e-10;

/// A straight stretch of one contact between two pieces, or one and something that does not move.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Run {
    /// Index of the interface.
    pub interface: usize,
    /// Pieces on the first and the second side; `None` for a rigid obstacle.
    pub sides: [Option<usize>; 2],
    /// Outward unit normal of the first side.
    pub normal: [f64; 2],
    /// The two ends.
    pub ends: [[f64; 2]; 2],
    /// Points a third of the last edge inside each end. A linear pressure that is nowhere negative on an edge has its
    /// resultant between these two points; they stand for the ends where pressure is linear per edge.
    pub thirds: [[f64; 2]; 2],
}

/// The straight runs of all contacts. Contacts of a piece with itself ask nothing of a rigid motion and are left out.
pub(super) fn runs(problem: &Problem, components: &Components) -> Vec<Run> {
    let mut all = Vec::new();
    for (index, interface) in problem.interfaces.iter().enumerate() {
        let sides = |pair: &ContactPair| {
            pair.edges.map(|e| problem.mesh.edges[e?].triangles[0].map(|t| components.of_triangle[t]))
        };
        let mut start = 0;
        while start < interface.pairs.len() {
            let here = sides(&interface.pairs[start]);
            let mut end = start + 1;
            while end < interface.pairs.len()
                && sides(&interface.pairs[end]) == here
                && continues_straight(problem, interface, start, end)
            {
                end += 1;
            }
            if here[0] != here[1] {
                all.push(run(problem, index, here, &interface.pairs[start..end]));
            }
            start = end;
        }
    }
    all
}

/// Whether pair `next` follows on pair `next` − 1 and the run from `start` stays straight with it.
fn continues_straight(problem: &Problem, interface: &Interface, start: usize, next: usize) -> bool {
    let pairs = &interface.pairs;
    if pairs[next].first[0] != pairs[next - 1].first[1] {
        return false;
    }
    let point = |v: usize| problem.mesh.points[v];
    let (a, b) = (point(pairs[start].first[0]), point(pairs[next].first[1]));
    let chord = [b[0] - a[0], b[1] - a[1]];
    let length = chord[0].hypot(chord[1]);
    let round_off = 4.0 * f64::EPSILON * a.iter().chain(&b).fold(0.0f64, |m, x| m.max(x.abs()));
    pairs[start..next].iter().all(|pair| {
        let p = point(pair.first[1]);
        let off = (chord[0] * (p[1] - a[1]) - chord[1] * (p[0] - a[0])).abs();
        let along = chord[0] * (p[0] - a[0]) + chord[1] * (p[1] - a[1]);
        off <= (STRAIGHT * length + round_off) * length && along > 0.0 && along < length * length
    })
}

fn run(problem: &Problem, interface: usize, sides: [Option<usize>; 2], pairs: &[ContactPair]) -> Run {
    let point = |v: usize| problem.mesh.points[v];
    let (head, tail) = (&pairs[0], &pairs[pairs.len() - 1]);
    let ends = [point(head.first[0]), point(tail.first[1])];
    let third =
        |end: [f64; 2], other: [f64; 2]| [end[0] + (other[0] - end[0]) / 3.0, end[1] + (other[1] - end[1]) / 3.0];
    let chord = [ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]];
    let length = chord[0].hypot(chord[1]);
    let across = [chord[1] / length, -chord[0] / length];
    let sign = (across[0] * head.normal[0] + across[1] * head.normal[1]).signum();
    Run {
        interface,
        sides,
        normal: across.map(|x| sign * x),
        ends,
        thirds: [third(ends[0], point(head.first[1])), third(ends[1], point(tail.first[0]))],
    }
}

/// Pieces that can only move together or against each other: linked by contacts, clamped ones taken away. Unknowns are
/// (a, b, s ω) per piece, s its size, so that all are displacements.
#[derive(Debug)]
pub(super) struct Group<'a> {
    pub components: &'a Components,
    /// Pieces of the group.
    pub members: Vec<usize>,
    /// Straight contact runs of the group.
    pub runs: Vec<&'a Run>,
}

/// Whether each piece has a clamped edge.
pub(super) fn clamped(problem: &Problem, components: &Components) -> Vec<bool> {
    let mut clamped = vec![false; components.count()];
    for (edge, condition) in problem.mesh.edges.iter().zip(&problem.conditions) {
        if let (Condition::Clamped(_), Some(t)) = (condition, edge.triangles[0]) {
            clamped[components.of_triangle[t]] = true;
        }
    }
    clamped
}

/// Splits what can move into groups.
pub(super) fn groups<'a>(components: &'a Components, clamped: &[bool], runs: &'a [Run]) -> Vec<Group<'a>> {
    let moving = |side: Option<usize>| side.filter(|c| !clamped[*c]);
    let mut sets = DisjointSets::new(components.count());
    for run in runs {
        if let [Some(first), Some(second)] = run.sides.map(moving) {
            sets.join(first, second);
        }
    }
    let (label, count) = sets.labels();
    let mut groups: Vec<_> = (0..count).map(|_| Group { components, members: Vec::new(), runs: Vec::new() }).collect();
    for c in (0..components.count()).filter(|c| !clamped[*c]) {
        groups[label[c]].members.push(c);
    }
    for run in runs {
        if let Some(c) = run.sides.into_iter().find_map(moving) {
            groups[label[c]].runs.push(run);
        }
    }
    groups.retain(|group| !group.members.is_empty());
    groups
}

impl Group<'_> {
    /// Number of unknowns.
    pub fn dimension(&self) -> usize {
        3 * self.members.len()
    }

    /// First unknown of piece `c`, if the group moves it.
    pub fn column(&self, c: usize) -> Option<usize> {
        self.members.binary_search(&c).ok().map(|i| 3 * i)
    }

    /// The row `direction` · u(`point`) of piece `c`; zero where the piece is held.
    pub fn displacement(&self, c: usize, point: [f64; 2], direction: [f64; 2]) -> DVector<f64> {
        let mut row = DVector::zeros(self.dimension());
        if let Some(i) = self.column(c) {
            let (centre, size) = (self.components.centre[c], self.components.size[c]);
            row[i] = direction[0];
            row[i + 1] = direction[1];
            row[i + 2] = ((point[0] - centre[0]) * direction[1] - (point[1] - centre[1]) * direction[0]) / size;
        }
        row
    }

    /// The row v_n' + v_n'' at `point` of `run`, scaled to unit length.
    pub fn jump(&self, run: &Run, point: [f64; 2]) -> DVector<f64> {
        let mut row = DVector::zeros(self.dimension());
        for (side, sign) in run.sides.iter().zip([1.0, -1.0]) {
            if let Some(c) = side {
                row += sign * self.displacement(*c, point, run.normal);
            }
        }
        unit(row)
    }

    /// The row of the relative displacement along `run` at `point`.
    pub fn slip(&self, run: &Run, point: [f64; 2]) -> DVector<f64> {
        let along = [-run.normal[1], run.normal[0]];
        let mut row = DVector::zeros(self.dimension());
        for (side, sign) in run.sides.iter().zip([1.0, -1.0]) {
            if let Some(c) = side {
                row += sign * self.displacement(*c, point, along);
            }
        }
        row
    }

    /// The rows that vanish when `run` keeps closed: relative displacement of its middle and relative rotation. Unlike
    /// the jumps at its two ends they stay independent however short the run is.
    pub fn ties(&self, run: &Run) -> [DVector<f64>; 2] {
        let [p, q] = run.ends;
        let middle = [0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])];
        let size = |c: &usize| self.components.size[*c];
        let smallest = run.sides.iter().flatten().map(size).fold(f64::INFINITY, f64::min);
        let mut turn = DVector::zeros(self.dimension());
        for (side, sign) in run.sides.iter().zip([1.0, -1.0]) {
            if let Some((c, i)) = side.and_then(|c| Some((c, self.column(c)?))) {
                turn[i + 2] = sign * smallest / size(&c);
            }
        }
        [self.jump(run, middle), unit(turn)]
    }

    /// The rows that vanish on rollers: no rotation, and no displacement across each direction of roller there is.
    pub fn rollers(&self, problem: &Problem) -> Vec<DVector<f64>> {
        let mesh = &problem.mesh;
        let mut directions: Vec<(usize, [f64; 2])> = Vec::new();
        for (e, condition) in problem.conditions.iter().enumerate() {
            let (Condition::Roller, Some(t)) = (condition, mesh.edges[e].triangles[0]) else { continue };
            let c = self.components.of_triangle[t];
            if self.column(c).is_none() {
                continue;
            }
            let (length, n) = mesh.edge_frame(e);
            // Weighted by length, equal directions add up to the normal of the line from end to end.
            let same = directions.iter_mut().find(|(other, sum)| {
                let turn = (n[0] * sum[1] - n[1] * sum[0]).abs();
                *other == c && turn <= 10.0 * STRAIGHT * sum[0].hypot(sum[1])
            });
            match same {
                Some((_, sum)) => {
                    let sign = (n[0] * sum[0] + n[1] * sum[1]).signum();
                    sum[0] += sign * length * n[0];
                    sum[1] += sign * length * n[1];
                }
                None => directions.push((c, [length * n[0], length * n[1]])),
            }
        }
        let rows = |(c, normal): (usize, [f64; 2])| {
            let mut still = DVector::zeros(self.dimension());
            if let Some(i) = self.column(c) {
                still[i + 2] = 1.0;
            }
            [still, unit(self.displacement(c, self.components.centre[c], normal))]
        };
        directions.into_iter().flat_map(rows).collect()
    }
}

fn unit(row: DVector<f64>) -> DVector<f64> {
    let norm = row.norm();
    if norm > 0.0 { row / norm } else { row }
}
