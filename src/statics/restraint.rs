//! Constraints of supports and contacts on the rigid motions: rows of small linear systems.
//!
//! A rigid motion moves a straight line so that its normal displacement is linear along it. A straight run of edges
//! therefore needs two rows, however many edges it has, and the normal is taken from the whole run: normals of single
//! short edges carry the round-off of their coordinates. An edge along which the direction of contact turns is a run of its
//! own; where contact acts along a given direction, the jump is linear across it however the sides run.

use super::LoadResultants;
use super::balance::RANK;
use super::components::Components;
use super::cone::span::Span;
use super::reach::{Degree, pressure_degree, reach};
use crate::element::polynomial::side;
use crate::problem::{Condition, ContactPair, Interface, Problem};
use crate::sets::DisjointSets;
use nalgebra::{DVector, Vector3};

/// Relative distance from which points leave a straight line, and directions differ.
const STRAIGHT: f64 = 1e-10;

/// A stretch of one contact between two pieces, or one and something that does not move, along which rigid motions have a
/// linear jump; or one edge along which the direction of contact turns.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Run {
    /// Index of the interface.
    pub interface: usize,
    /// Pieces on the first and the second side; `None` for a rigid obstacle.
    pub sides: [Option<usize>; 2],
    /// The direction of contact, out of the first side: a unit vector. Where it turns, that at the middle.
    pub normal: [f64; 2],
    /// The direction at the two ends where it turns.
    pub turning: Option<[[f64; 2]; 2]>,
    /// The two ends.
    pub ends: [[f64; 2]; 2],
    /// How far towards each end the resultant of a pressure on the last edge can move (`reach.rs`). The points stand for the
    /// ends where pressure is of a degree.
    pub reach: [[f64; 2]; 2],
    /// The degree of the pressure on the edges at the two ends.
    pub degree: [usize; 2],
    /// The largest force of friction, ∫ τ̄ ds times the thickness; zero without friction.
    pub friction: f64,
}

impl Run {
    /// The direction of contact at `point`.
    pub fn normal_at(&self, point: [f64; 2]) -> [f64; 2] {
        let (Some([m, n]), [a, b]) = (self.turning, self.ends) else { return self.normal };
        let chord = [b[0] - a[0], b[1] - a[1]];
        let along = (point[0] - a[0]) * chord[0] + (point[1] - a[1]) * chord[1];
        let t = (along / (chord[0] * chord[0] + chord[1] * chord[1])).clamp(0.0, 1.0);
        [0, 1].map(|c| m[c] + t * (n[c] - m[c]))
    }
}

/// The part of a row that belongs to one member of a group: its number, and the coefficients of (a, b, s ω).
pub(super) type Part = (usize, Vector3<f64>);

/// The straight runs of all contacts, with stresses of these degrees. Contacts of a piece with itself ask nothing of a rigid
/// motion and are left out.
pub(super) fn runs(problem: &Problem, components: &Components, degree: Degree<'_>) -> Vec<Run> {
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
                all.push(run(problem, index, here, &interface.pairs[start..end], degree));
            }
            start = end;
        }
    }
    all
}

/// True if pair `next` continues pair `next` − 1 and the run from `start` stays straight with it.
fn continues_straight(problem: &Problem, interface: &Interface, start: usize, next: usize) -> bool {
    let pairs = &interface.pairs;
    let (from, to) = (&pairs[start], &pairs[next]);
    if to.first[0] != pairs[next - 1].first[1] || [from, to].iter().any(|pair| !pair.direction.is_constant()) {
        return false;
    }
    if [from, to].iter().any(|pair| along_line(pair)) {
        return from.direction.ends == to.direction.ends;
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

/// True if contact acts along a direction that is not the normal of the pair.
fn along_line(pair: &ContactPair) -> bool {
    pair.direction.is_constant() && pair.direction.ends[0] != pair.normal
}

fn run(
    problem: &Problem,
    interface: usize,
    sides: [Option<usize>; 2],
    pairs: &[ContactPair],
    degree: Degree<'_>,
) -> Run {
    let point = |v: usize| problem.mesh.points[v];
    let (head, tail) = (&pairs[0], &pairs[pairs.len() - 1]);
    let ends = [point(head.first[0]), point(tail.first[1])];
    let chord = [ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]];
    let length = chord[0].hypot(chord[1]);
    let across = [chord[1] / length, -chord[0] / length];
    let sign = (across[0] * head.normal[0] + across[1] * head.normal[1]).signum();
    let normal = if along_line(head) { head.direction.ends[0] } else { across.map(|x| sign * x) };
    let degree = [head, tail].map(|pair| pressure_degree(problem, pair, degree));
    let resists =
        |pair: &ContactPair| pair.friction.map_or(0.0, |f| pair.length * side::integral(&f.weighted(), &[1.0]));
    let friction = problem.scene.thickness * pairs.iter().map(resists).sum::<f64>();
    let reach = [reach(ends[0], point(head.first[1]), degree[0]), reach(ends[1], point(tail.first[0]), degree[1])];
    if head.direction.is_constant() {
        return Run { interface, sides, normal, turning: None, ends, reach, degree, friction };
    }
    // Force and line of action of B_j n̂, n̂ linear, are those of n̂ at the centroid of B_j. Where t is constant both ends have
    // the same, the middle.
    let middle = [0, 1].map(|c| 0.5 * (ends[0][c] + ends[1][c]));
    let reach = if degree[0] == 0 { [middle; 2] } else { reach };
    let [x, y] = head.direction.at(0.5);
    let normal = [x / x.hypot(y), y / x.hypot(y)];
    Run { interface, sides, normal, turning: Some(head.direction.ends), ends, reach, degree, friction }
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

/// For each piece, true if it has a clamped edge.
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

    /// Number of piece `c` among the members, if the group moves it.
    pub fn member(&self, c: usize) -> Option<usize> {
        self.members.binary_search(&c).ok()
    }

    /// The vector of all unknowns with the entries of `row`.
    pub fn dense(&self, row: &[Part]) -> DVector<f64> {
        let mut out = DVector::zeros(self.dimension());
        for (m, part) in row {
            (0..3).for_each(|i| out[3 * m + i] += part[i]);
        }
        out
    }

    /// The loads on the group, by the unknowns.
    pub fn load(&self, loads: &LoadResultants) -> DVector<f64> {
        let mut load = DVector::zeros(self.dimension());
        for (i, c) in self.members.iter().enumerate() {
            load[3 * i] = loads.force[*c][0];
            load[3 * i + 1] = loads.force[*c][1];
            load[3 * i + 2] = loads.moment[*c] / self.components.size[*c];
        }
        load
    }

    /// Their sizes, added up.
    pub fn magnitude(&self, loads: &LoadResultants) -> f64 {
        self.members.iter().map(|c| loads.magnitude[*c]).sum()
    }

    /// All that rows with one part each span.
    pub fn span(&self, rows: &[Part]) -> Span {
        let mut span = Span::empty(self.dimension());
        let rows: Vec<_> = rows.iter().map(|part| self.dense(std::slice::from_ref(part))).collect();
        span.extend(&rows, RANK);
        span
    }

    /// The row `direction` · u(`point`) of piece `c`; none where the piece is held.
    pub fn displacement(&self, c: usize, point: [f64; 2], direction: [f64; 2]) -> Option<Part> {
        let (centre, size) = (self.components.centre[c], self.components.size[c]);
        let turn = ((point[0] - centre[0]) * direction[1] - (point[1] - centre[1]) * direction[0]) / size;
        Some((self.member(c)?, Vector3::new(direction[0], direction[1], turn)))
    }

    /// The row `direction` · (u' − u'') at `point` of `run`.
    pub(super) fn apart(&self, run: &Run, point: [f64; 2], direction: [f64; 2]) -> Vec<Part> {
        let sides = run.sides.iter().zip([1.0, -1.0]);
        sides
            .filter_map(|(side, sign)| {
                let (m, part) = self.displacement((*side)?, point, direction)?;
                Some((m, sign * part))
            })
            .collect()
    }

    /// The row (v' − v'')·n̂ at `point` of `run`.
    pub fn across(&self, run: &Run, point: [f64; 2]) -> Vec<Part> {
        self.apart(run, point, run.normal_at(point))
    }

    /// The row of the relative displacement along `run` at `point`.
    pub fn slip(&self, run: &Run, point: [f64; 2]) -> Vec<Part> {
        let [x, y] = run.normal_at(point);
        self.apart(run, point, [-y, x])
    }

    /// The rows that vanish on rollers, and on springs that do not give: no rotation, and no displacement along each normal there is; at both ends of an edge that
    /// is held along another direction, none along that.
    pub fn rollers(&self, problem: &Problem) -> Vec<Part> {
        let mesh = &problem.mesh;
        let mut directions: Vec<Vec<[f64; 2]>> = vec![Vec::new(); self.members.len()];
        let mut oblique: Vec<Part> = Vec::new();
        if problem.section().is_revolved() {
            // A body of revolution moves along its axis alone.
            oblique.extend((0..self.members.len()).flat_map(|m| [(m, Vector3::x()), (m, Vector3::z())]));
        }
        for (e, direction) in held_directions(problem) {
            let Some(t) = mesh.edges[e].triangles[0] else { continue };
            let c = self.components.of_triangle[t];
            let Some(m) = self.member(c) else { continue };
            let (length, n) = mesh.edge_frame(e);
            if (direction[0] * n[1] - direction[1] * n[0]).abs() > STRAIGHT {
                let ends = mesh.edges[e].vertices.map(|v| mesh.points[v]);
                oblique.extend(ends.iter().filter_map(|p| self.displacement(c, *p, direction)));
                continue;
            }
            // Weighted by length, equal directions add up to the normal of the line from end to end.
            let same = directions[m].iter_mut().find(|sum| {
                let turn = (n[0] * sum[1] - n[1] * sum[0]).abs();
                turn <= 10.0 * STRAIGHT * sum[0].hypot(sum[1])
            });
            match same {
                Some(sum) => {
                    let sign = (n[0] * sum[0] + n[1] * sum[1]).signum();
                    sum[0] += sign * length * n[0];
                    sum[1] += sign * length * n[1];
                }
                None => directions[m].push([length * n[0], length * n[1]]),
            }
        }
        let rows = |(m, normals): (usize, Vec<[f64; 2]>)| {
            let across = normals.into_iter().map(move |n| (m, Vector3::new(n[0], n[1], 0.0).normalize()));
            let mut rows: Vec<Part> = across.collect();
            if !rows.is_empty() {
                rows.push((m, Vector3::z()));
            }
            rows
        };
        directions.into_iter().enumerate().flat_map(rows).chain(oblique).collect()
    }
}

/// The directions in which rollers hold edges, and springs to the ground.
pub(super) fn held_directions(problem: &Problem) -> impl Iterator<Item = (usize, [f64; 2])> + '_ {
    let rollers = problem.conditions.iter().enumerate().filter_map(|(e, condition)| match condition {
        Condition::Roller { direction, .. } => Some((e, *direction)),
        _ => None,
    });
    let grounded = problem.bed_pairs().filter(|(pair, _)| pair.opposite.is_none());
    let springs = grounded.flat_map(|(pair, stiffness)| {
        let along = pair.axes.into_iter().zip(stiffness).filter(|(_, k)| *k > 0.0);
        along.map(move |(axis, _)| (pair.edge, axis))
    });
    rollers.chain(springs)
}

/// The product of `part` of a row with a vector of all unknowns.
pub(super) fn along((m, part): &Part, all: &DVector<f64>) -> f64 {
    (0..3).map(|i| part[i] * all[3 * m + i]).sum()
}

pub(super) fn unit(mut row: Vec<Part>) -> Vec<Part> {
    let norm = row.iter().map(|(_, part)| part.norm_squared()).sum::<f64>().sqrt();
    if norm > 0.0 {
        row.iter_mut().for_each(|(_, part)| *part /= norm);
    }
    row
}
