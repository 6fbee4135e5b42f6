//! The cone of allowed motions of a group of many pieces, with sparse rows.
//!
//! Supports are taken out piece by piece: what they leave of (a, b, s ω) are the coordinates here, so that projections
//! stay orthogonal. The projection of the loads is found as a quadratic program (`interior`). Where that is not it to the last
//! digits, elimination decides: pieces are numbered along the contacts (Cuthill & McKee), so that it fills in little, and
//! primal–dual active sets begin from closed contacts; where these come back to a state they have been in, single rows change
//! in the manner of Lawson and Hanson, as for small groups.

use std::collections::{HashSet, VecDeque};

use nalgebra::{DVector, Vector3};

use super::Unsettled;
use super::interior;
use super::span::Span;
use super::sparse::{CORRECTIONS, Row, Triangular, dense, dot, least_squares, norm, transposed};
use crate::statics::balance::{Cone, RANK};
use crate::statics::openings::{Points, Ties};
use crate::statics::restraint::{Group, Part, along};

/// Forces and pulls below this fraction of the loads are round-off.
const ROUND_OFF: f64 = 1e-13;

/// Steps of whole sets before single rows are changed.
const BLOCK_STEPS: usize = 12;

/// The allowed motions of a group.
pub(in crate::statics) struct SparseCone<'a> {
    group: &'a Group<'a>,
    points: Points,
    /// First coordinate of each member, in the numbering along the contacts, and what its coordinates stand for.
    start: Vec<usize>,
    free: Vec<Vec<Vector3<f64>>>,
    coordinates: usize,
    /// Motions allowed both ways.
    held: Vec<Row>,
    /// Unit rows g with g · y ≤ 0.
    rows: Vec<Row>,
}

impl<'a> SparseCone<'a> {
    /// From rows (member, row) that must vanish, the two points of each contact run where the jump must not be positive, and where contact keeps
    /// closed in motions allowed both ways.
    pub fn new(group: &'a Group<'a>, vanishing: &[Part], points: Points, ties: Ties) -> Self {
        let members = group.members.len();
        let mut supports = vec![Vec::new(); members];
        vanishing.iter().for_each(|(m, row)| supports[*m].push(DVector::from_column_slice(row.as_slice())));
        let free: Vec<Vec<Vector3<f64>>> = supports
            .iter()
            .map(|rows| {
                if rows.is_empty() {
                    return vec![Vector3::x(), Vector3::y(), Vector3::z()];
                }
                let mut span = Span::empty(3);
                span.extend(rows, RANK);
                span.complement().basis.iter().map(|q| Vector3::new(q[0], q[1], q[2])).collect()
            })
            .collect();
        let mut start = vec![0; members];
        let mut coordinates = 0;
        for m in along_contacts(group) {
            start[m] = coordinates;
            coordinates += free[m].len();
        }
        let mut cone = SparseCone { group, points, start, free, coordinates, held: Vec::new(), rows: Vec::new() };
        let ties: Vec<Row> =
            group.runs.iter().flat_map(|run| group.ties(run, ties)).map(|row| cone.row(&row)).collect();
        if !interior::see_every_motion(&ties, coordinates) {
            cone.held = Triangular::of(coordinates, &ties).null_vectors();
        }
        let jumps = group.runs.iter().flat_map(|run| group.jumps(run, points));
        cone.rows = jumps.map(|row| cone.row(&row)).filter(|row| norm(row) > RANK).map(unit).collect();
        cone.rows.sort_by_key(|row| row.last().map(|entry| entry.0));
        cone
    }

    /// A row over (a, b, s ω) of the members in the coordinates here.
    fn row(&self, local: &[Part]) -> Row {
        let entry = |(m, part): &Part| {
            let (start, part) = (self.start[*m], *part);
            self.free[*m].iter().enumerate().map(move |(k, q)| (start + k, q.dot(&part)))
        };
        let mut row: Row = local.iter().flat_map(entry).filter(|(_, v)| *v != 0.0).collect();
        row.sort_unstable_by_key(|entry| entry.0);
        row
    }

    fn inward(&self, motion: &DVector<f64>) -> Vec<f64> {
        let mut out = vec![0.0; self.coordinates];
        for (m, free) in self.free.iter().enumerate() {
            let own = Vector3::new(motion[3 * m], motion[3 * m + 1], motion[3 * m + 2]);
            free.iter().enumerate().for_each(|(k, q)| out[self.start[m] + k] = q.dot(&own));
        }
        out
    }

    fn outward(&self, coordinates: &[f64]) -> DVector<f64> {
        let mut out = DVector::zeros(self.group.dimension());
        for (m, free) in self.free.iter().enumerate() {
            for (k, q) in free.iter().enumerate() {
                (0..3).for_each(|i| out[3 * m + i] += q[i] * coordinates[self.start[m] + k]);
            }
        }
        out
    }

    /// Forces on the `active` rows that balance `load` best, and what they leave.
    fn balance(&self, active: &[usize], load: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let matrix = transposed(active.iter().map(|i| &self.rows[*i]), self.coordinates);
        least_squares(&matrix, active.len(), load)
    }

    /// The least forces on the `active` rows that balance `load` best, and what they leave. The factor is that of the rows
    /// themselves, whose order along the contacts keeps it narrow; where rows depend on each other forces are shared.
    fn least_forces(&self, active: &[usize], load: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let rows: Vec<&Row> = active.iter().map(|i| &self.rows[*i]).collect();
        let factor = Triangular::of(self.coordinates, rows.iter().copied());
        let free = factor.null_vectors();
        let mut rest = load.to_vec();
        let mut unbalanced = vec![0.0; load.len()];
        if !free.is_empty() {
            let (_, balanced) = least_squares(&transposed(&free, self.coordinates), free.len(), load);
            unbalanced.iter_mut().zip(load.iter().zip(&balanced)).for_each(|(u, (load, part))| *u = load - part);
            rest = balanced;
        }
        let mut forces = vec![0.0; rows.len()];
        for _ in 0..CORRECTIONS {
            let motion = factor.solve_normal(rest.clone());
            for (force, row) in forces.iter_mut().zip(&rows) {
                let more = dot(row, &motion);
                *force += more;
                row.iter().for_each(|(k, v)| rest[*k] -= v * more);
            }
        }
        rest.iter_mut().zip(&unbalanced).for_each(|(rest, part)| *rest += part);
        (forces, rest)
    }

    /// The part of `load` that no forces on the rows can balance, see [`super::unbalanced`].
    fn unbalanced_rest(&self, load: &[f64]) -> Result<Vec<f64>, Unsettled> {
        let size = load.iter().fold(0.0, |m: f64, v| m.hypot(*v));
        if size == 0.0 || self.rows.is_empty() {
            return Ok(load.to_vec());
        }
        interior::projection(&self.rows, self.coordinates, load, ROUND_OFF)
            .ok_or(())
            .or_else(|()| self.block_steps((0..self.rows.len()).collect(), load, size))
            .or_else(|active| self.one_by_one(active, load, size))
    }

    /// Primal–dual steps of whole sets from the rows `active`. The unbalanced part of `load`, or the set at which the steps came back
    /// to one that they had been at.
    fn block_steps(&self, mut active: Vec<usize>, load: &[f64], size: f64) -> Result<Vec<f64>, Vec<usize>> {
        let mut seen = HashSet::new();
        while seen.len() < BLOCK_STEPS && seen.insert(active.clone()) {
            let (forces, rest) = self.least_forces(&active, load);
            let next = self.next_set(&active, |k| forces[k], |i| dot(&self.rows[i], &rest), ROUND_OFF * size);
            if next == active {
                return Ok(rest);
            }
            active = next;
        }
        Err(active)
    }

    /// The `active` rows whose `force` (that of the k-th of them) does not pull, and the others that `violation` breaks.
    fn next_set(
        &self,
        active: &[usize],
        force: impl Fn(usize) -> f64,
        violation: impl Fn(usize) -> f64,
        round_off: f64,
    ) -> Vec<usize> {
        let mut next = vec![None; self.rows.len()];
        active.iter().enumerate().for_each(|(k, i)| next[*i] = Some(force(k) >= -round_off));
        let stays = |i: usize| next[i].unwrap_or_else(|| violation(i) > round_off);
        (0..self.rows.len()).filter(|i| stays(*i)).collect()
    }

    /// The unbalanced part of `load`, from the rows `active`: one row joins at a time, and rows whose force would turn negative leave.
    fn one_by_one(&self, mut active: Vec<usize>, load: &[f64], size: f64) -> Result<Vec<f64>, Unsettled> {
        let mut forces = vec![0.0; active.len()];
        let mut refused = HashSet::new();
        let mut best = f64::INFINITY;
        let mut entered = None;
        for _ in 0..100 + 20 * self.rows.len() {
            let (wanted, rest) = self.balance(&active, load);
            let step = |(old, new): (&f64, &f64)| if *new >= 0.0 { f64::INFINITY } else { old / (old - new) };
            let blocking = forces.iter().zip(&wanted).map(step).enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
            if let Some((at, length)) = blocking.filter(|(_, length)| *length < 1.0) {
                forces.iter_mut().zip(&wanted).for_each(|(old, new)| *old += length * (new - *old));
                if Some(active[at]) == entered && length == 0.0 {
                    refused.insert(active[at]);
                }
                active.remove(at);
                forces.remove(at);
                continue;
            }
            forces = wanted;
            let left = rest.iter().fold(0.0, |m: f64, v| m.hypot(*v));
            match entered {
                Some(row) if left >= best => drop(refused.insert(row)),
                _ => refused.clear(),
            }
            best = best.min(left);
            let pull = |i: usize| (i, dot(&self.rows[i], &rest));
            let outside = (0..self.rows.len()).filter(|i| !active.contains(i) && !refused.contains(i)).map(pull);
            let next = outside.filter(|(_, pull)| *pull > ROUND_OFF * size).max_by(|a, b| a.1.total_cmp(&b.1));
            let Some((next, _)) = next else { return Ok(rest) };
            active.push(next);
            forces.push(0.0);
            entered = Some(next);
        }
        Err(Unsettled)
    }
}

impl Cone for SparseCone<'_> {
    fn unbalanced(&self, load: &DVector<f64>) -> Result<[DVector<f64>; 2], Unsettled> {
        let load = self.inward(load);
        let (_, rest) = least_squares(&transposed(&self.held, self.coordinates), self.held.len(), &load);
        let both: Vec<f64> = load.iter().zip(&rest).map(|(load, rest)| load - rest).collect();
        let one = self.unbalanced_rest(&rest)?;
        Ok([self.outward(&both), self.outward(&one)])
    }

    fn rows(&self) -> (usize, DVector<f64>) {
        let mut sum = vec![0.0; self.coordinates];
        self.rows.iter().flatten().for_each(|(k, v)| sum[*k] += v);
        (self.rows.len(), self.outward(&sum))
    }

    fn held(&self) -> Vec<DVector<f64>> {
        self.held.iter().map(|row| self.outward(dense(row, self.coordinates).as_slice())).collect()
    }

    fn without_sliding(&self, motion: DVector<f64>) -> DVector<f64> {
        let Some(touching) = self.group.touching(&motion, self.points).filter(|_| !self.held.is_empty()) else {
            return motion;
        };
        let by_coordinate = transposed(&self.held, self.coordinates);
        let (mut rows, mut slips) = (Vec::new(), Vec::new());
        for (run, end) in touching {
            let slip = self.group.slip(run, end);
            slips.push(-slip.iter().map(|part| along(part, &motion)).sum::<f64>());
            let mut on_held = std::collections::BTreeMap::new();
            for (k, value) in self.row(&slip) {
                by_coordinate[k].iter().for_each(|(h, v)| *on_held.entry(*h).or_default() += value * v);
            }
            rows.push(on_held.into_iter().collect::<Row>());
        }
        let (amounts, _) = least_squares(&rows, self.held.len(), &slips);
        let mut sum = vec![0.0; self.coordinates];
        for (row, amount) in self.held.iter().zip(amounts) {
            row.iter().for_each(|(k, v)| sum[*k] += amount * v);
        }
        motion + self.outward(&sum)
    }
}

fn unit(mut row: Row) -> Row {
    let length = norm(&row);
    row.iter_mut().for_each(|(_, v)| *v /= length);
    row
}

/// The members of `group` in the order of their distance along contacts from one at an end of it.
fn along_contacts(group: &Group) -> Vec<usize> {
    let mut neighbours = vec![Vec::new(); group.members.len()];
    for run in &group.runs {
        if let [Some(a), Some(b)] = run.sides.map(|side| side.and_then(|c| group.member(c))) {
            neighbours[a].push(b);
            neighbours[b].push(a);
        }
    }
    let from = |first: usize| {
        let mut order = Vec::with_capacity(neighbours.len());
        let mut met = vec![false; neighbours.len()];
        let mut next = VecDeque::from([first]);
        met[first] = true;
        while let Some(m) = next.pop_front() {
            order.push(m);
            for other in &neighbours[m] {
                if !std::mem::replace(&mut met[*other], true) {
                    next.push_back(*other);
                }
            }
        }
        order
    };
    let ahead = from(0);
    ahead.last().map_or(ahead.clone(), |end| from(*end))
}
