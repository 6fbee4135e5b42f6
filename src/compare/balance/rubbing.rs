//! Forces of friction on the nodes of a claimed solution: known where the sides slide, and within their bound where they stick.

use std::collections::{HashMap, HashSet};

use nalgebra::DVector;

use super::cones::follows_cone;
use super::{Group, HELD, Solution, dot};
use crate::bounds::{Hold, Holds};
use crate::compare::contact::slides::{EndSlide, inside};
use crate::problem::{Interface, Problem};
use crate::vector::cross;

/// Directions whose cross product, or dot product, is smaller are parallel, or at right angles.
pub(super) const ALIGNED: f64 = 1e-9;
/// Sweeps of the coordinate descent that distributes forces over several directions.
const SWEEPS: usize = 4000;

impl<'a> Solution<'a> {
    /// Takes the forces of the coefficients inside the pairs out of `rest`.
    pub(super) fn slide_inside(&self, rest: &mut [[f64; 2]]) {
        let degree = self.candidate.degree;
        let Some(value) = self.inside_values() else { return };
        let within = self.closed_within();
        let vertices = self.problem.mesh.points.len();
        let pairs = |(index, interface): (usize, &'a Interface)| {
            interface.pairs.iter().enumerate().map(move |(k, pair)| (index, k, pair))
        };
        let all = self.problem.interfaces.iter().enumerate().flat_map(pairs);
        for (index, k, pair) in all.filter(|(_, _, pair)| !follows_cone(pair)) {
            for (i, slide) in inside(self.problem, pair, degree).into_iter().enumerate() {
                let force = slide.force(slide.row.excess_at(value), within).unwrap_or_else(|| {
                    // Where the direction turns the forces of several coefficients act on the same nodes: those reported are as good as any.
                    let told = self.reported_inside(index, k, i).filter(|_| !pair.direction.is_constant());
                    if let Some(force) = told {
                        return (-force).clamp(-slide.limit, slide.limit);
                    }
                    // The nodes inside the edges are those that no other coefficient moves.
                    let own = || slide.row.terms().iter().filter(|(node, _)| *node >= vertices);
                    let pull: f64 = own().map(|(node, factor)| dot(rest[*node], *factor)).sum();
                    let square: f64 = own().map(|(_, factor)| dot(*factor, *factor)).sum();
                    if square > HELD * HELD { (-pull / square).clamp(-slide.limit, slide.limit) } else { 0.0 }
                });
                for (node, factor) in slide.row.terms() {
                    rest[*node] = [0, 1].map(|c| rest[*node][c] + force * factor[c]);
                }
            }
            if pair.friction.is_some() {
                self.rest_on_supports(pair, rest);
            }
        }
    }

    /// The reported friction force of coefficient `i` inside pair `k` of interface `index`.
    fn reported_inside(&self, index: usize, k: usize, i: usize) -> Option<f64> {
        let friction = self.candidate.reactions.as_ref()?.get(index)?.friction.as_ref()?;
        friction.edge.as_ref()?.get(k)?.get(i).copied()
    }

    /// Takes the forces at vertices where the sides slide out of `rest`.
    pub(super) fn slide_at_vertices(&self, rest: &mut [[f64; 2]]) {
        let within = self.closed_within();
        for (slide, _) in self.slides.iter().filter(|(slide, _)| slide.coefficient.is_none()) {
            let jump = self.along(slide);
            if jump.abs() <= within {
                continue;
            }
            let force = slide.limit * jump.signum();
            for (v, sign) in [(Some(slide.first), 1.0), (slide.second, -1.0)] {
                let Some(v) = v else { continue };
                let d = self.holds.vertices[v].project(slide.tangent);
                rest[v] = [0, 1].map(|c| rest[v][c] + sign * force * d[c]);
            }
        }
    }

    /// The unit rows of a group along which the sides stick, each with the largest friction force there.
    pub(super) fn sticking(&self, group: &Group, slot: &HashMap<usize, usize>) -> Vec<(DVector<f64>, f64)> {
        let within = self.closed_within();
        let own = self.slides.iter().filter(|(slide, _)| group.vertices.contains(&slide.first));
        let row = |(slide, _): &(EndSlide, bool)| {
            if slide.coefficient.is_some() || self.along(slide).abs() > within {
                return None;
            }
            let (row, length) = self.unit_row((slide.first, slide.second), slide.tangent, slot)?;
            Some((row, slide.limit * length))
        };
        own.filter_map(row).collect()
    }

    /// True if the friction force at one place of a group depends on that at another, or on the pressure there.
    pub(super) fn couples(&self, group: &Group) -> bool {
        self.slides
            .iter()
            .any(|(slide, coupled)| *coupled && slide.coefficient.is_none() && group.vertices.contains(&slide.first))
    }

    /// The tangential jump j_t.
    pub(super) fn along(&self, slide: &EndSlide) -> f64 {
        dot(self.value(slide.first), slide.tangent) - slide.second.map_or(0.0, |s| dot(self.value(s), slide.tangent))
    }
}

/// The vertices at an end of a contact pair, and the direction of contact there.
type PairEnd = (usize, Option<usize>, [f64; 2]);

/// Tells for each jump if it does not follow the law of one tangent alone: several contacts, or several directions of one, meet
/// there, or a support holds it at a skew angle.
pub(super) fn coupled(problem: &Problem, holds: &Holds, slides: &[EndSlide]) -> Vec<bool> {
    let mut meeting: HashMap<usize, Vec<PairEnd>> = HashMap::new();
    for pair in problem.pairs() {
        for k in 0..2 {
            let end = (pair.first[k], pair.second.map(|s| s[k]), pair.direction.ends[k]);
            [Some(end.0), end.1].into_iter().flatten().for_each(|v| meeting.entry(v).or_default().push(end));
        }
    }
    // Two contacts on one line share what resists sliding where they meet.
    let mut rubbing: HashMap<usize, HashSet<usize>> = HashMap::new();
    for slide in slides {
        for v in [Some(slide.first), slide.second].into_iter().flatten() {
            rubbing.entry(v).or_default().insert(slide.interface);
        }
    }
    let shared = |v: usize| rubbing.get(&v).is_some_and(|contacts| contacts.len() > 1);
    let askew = |v: usize, tangent: [f64; 2]| match holds.vertices[v] {
        Hold::Line { normal, .. } => dot(normal, tangent).abs().min(cross(normal, tangent).abs()) > ALIGNED,
        _ => false,
    };
    let is_coupled = |slide: &EndSlide| {
        let other = |&(first, second, n): &PairEnd| {
            (first, second) != (slide.first, slide.second) || dot(n, slide.tangent).abs() > ALIGNED
        };
        let beside = |v: usize| meeting.get(&v).is_some_and(|ends| ends.iter().any(other));
        [Some(slide.first), slide.second]
            .into_iter()
            .flatten()
            .any(|v| askew(v, slide.tangent) || beside(v) || shared(v))
    };
    slides.iter().map(is_coupled).collect()
}

/// The least remainder of a load after forces ≥ 0 on the unit rows `pushing` and forces within their limits on the rows `sticking`,
/// found by coordinate descent, since rows of several contacts may be linearly dependent.
pub(super) fn least(load: &DVector<f64>, pushing: &[DVector<f64>], sticking: &[(DVector<f64>, f64)]) -> DVector<f64> {
    let bounded = sticking.iter().map(|(row, limit)| (row, [-limit, *limit]));
    let rows: Vec<(&DVector<f64>, [f64; 2])> =
        pushing.iter().map(|row| (row, [0.0, f64::INFINITY])).chain(bounded).collect();
    let (mut forces, mut left) = (vec![0.0; rows.len()], load.clone());
    for _ in 0..SWEEPS {
        let mut moved = 0.0_f64;
        for ((row, [low, high]), force) in rows.iter().zip(&mut forces) {
            let next = (*force + row.dot(&left)).clamp(*low, *high);
            left.axpy(*force - next, row, 1.0);
            moved = moved.max((next - *force).abs());
            *force = next;
        }
        if moved <= f64::EPSILON * load.norm() {
            break;
        }
    }
    left
}
