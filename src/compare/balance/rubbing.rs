//! Forces of friction on the nodes of a claimed solution: known where the sides slide, and within their bound where they stick.

use std::collections::HashMap;

use nalgebra::DVector;

use super::{Group, HELD, Solution, dot};
use crate::bounds::{Hold, Holds};
use crate::compare::friction::{EndSlide, inside};
use crate::problem::Problem;
use crate::vector::cross;

/// Directions whose cross product, or product, is smaller are parallel, or at right angles.
const ALIGNED: f64 = 1e-9;
/// How many times its bound friction may carry at a vertex where contacts along several directions meet, whose law couples them.
const COUPLED: f64 = 4.0;

impl Solution<'_> {
    /// Takes the forces of the coefficients inside the pairs out of `rest`.
    pub(super) fn slide_inside(&self, rest: &mut [[f64; 2]]) {
        let degree = self.candidate.degree;
        if self.candidate.on_quadrilaterals.is_some() && degree > 2 {
            return;
        }
        let coefficients = self.candidate.higher.as_ref().filter(|_| degree > 2);
        let value = |node: usize| coefficients.map_or_else(|| self.value(node), |field| field.values()[node]);
        let within = self.closed_within();
        let vertices = self.problem.mesh.points.len();
        for pair in self.problem.pairs() {
            for slide in inside(self.problem, pair, degree) {
                let force = slide.force(slide.row.excess_at(value), within).unwrap_or_else(|| {
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
                for v in pair.first.into_iter().chain(pair.second.into_iter().flatten()) {
                    rest[v] = self.holds.vertices[v].project(rest[v]);
                }
            }
        }
    }

    /// Takes the forces at vertices where the sides slide out of `rest`.
    pub(super) fn slide_at_vertices(&self, rest: &mut [[f64; 2]]) {
        let within = self.closed_within();
        for (slide, _) in self.slides.iter().filter(|(_, coupled)| !coupled) {
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

    /// The unit rows of a group along which the sides stick, each with the most that friction carries there.
    pub(super) fn sticking(&self, group: &Group, slot: &HashMap<usize, usize>) -> Vec<(DVector<f64>, f64)> {
        let within = self.closed_within();
        let own = self.slides.iter().filter(|(slide, _)| group.vertices.contains(&slide.first));
        let row = |(slide, coupled): &(EndSlide, bool)| {
            if !coupled && self.along(slide).abs() > within {
                return None;
            }
            let mut row = DVector::<f64>::zeros(2 * group.vertices.len());
            for (v, sign) in [(Some(slide.first), 1.0), (slide.second, -1.0)] {
                let Some(v) = v else { continue };
                let d = self.holds.vertices[v].project(slide.tangent);
                row[slot[&v]] += sign * d[0];
                row[slot[&v] + 1] += sign * d[1];
            }
            let length = row.norm();
            let limit = if *coupled { COUPLED * slide.limit } else { slide.limit };
            (length > HELD).then(|| (row / length, limit * length))
        };
        own.filter_map(row).collect()
    }

    /// j_t.
    fn along(&self, slide: &EndSlide) -> f64 {
        dot(self.value(slide.first), slide.tangent) - slide.second.map_or(0.0, |s| dot(self.value(s), slide.tangent))
    }
}

/// Which of the jumps do not follow the law of one tangent alone: several contacts, or several directions of one, meet there, or a
/// support holds it askew.
pub(super) fn coupled(problem: &Problem, holds: &Holds, slides: &[EndSlide]) -> Vec<bool> {
    let mut meeting: HashMap<usize, Vec<(usize, Option<usize>, [f64; 2])>> = HashMap::new();
    for pair in problem.pairs() {
        for k in 0..2 {
            let end = (pair.first[k], pair.second.map(|s| s[k]), pair.direction.ends[k]);
            [Some(end.0), end.1].into_iter().flatten().for_each(|v| meeting.entry(v).or_default().push(end));
        }
    }
    let askew = |v: usize, tangent: [f64; 2]| match holds.vertices[v] {
        Hold::Line { normal, .. } => dot(normal, tangent).abs().min(cross(normal, tangent).abs()) > ALIGNED,
        _ => false,
    };
    let is_coupled = |slide: &EndSlide| {
        let other = |&(first, second, n): &(usize, Option<usize>, [f64; 2])| {
            (first, second) != (slide.first, slide.second) || dot(n, slide.tangent).abs() > ALIGNED
        };
        let beside = |v: usize| meeting.get(&v).is_some_and(|ends| ends.iter().any(other));
        [Some(slide.first), slide.second].into_iter().flatten().any(|v| askew(v, slide.tangent) || beside(v))
    };
    slides.iter().map(is_coupled).collect()
}
