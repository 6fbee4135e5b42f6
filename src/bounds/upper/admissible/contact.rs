//! Admissible jumps inside contact pairs, by their Bernstein coefficients ([`super::rows`]).
//!
//! The coefficients at the ends are those of the vertices ([`super::ends`]). The ones between them are kept at most zero, and
//! their sum is kept with the mean of the jump: what is above zero is taken from those below.

use super::ends::largest;
use super::nodes::{NodalValues, Nodes};
use super::rows::{Row, of_pair, sides};
use crate::bounds::upper::relaxation::share::Share;
use crate::element::SideValues;
use crate::element::polynomial::side::{component, lower_moments};
use crate::problem::{ContactPair, Problem};
use crate::vector::dot;

/// Jumps beyond a bound by less than this, relative to the size of the displacement, are at the bound: the widening of
/// the upper bound covers rounding of this size.
pub const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// How much of a jump each side of `pair` gives way: the softer one more, so that moving a stiff body by what a soft one
/// needs costs no energy. The two add up to one.
pub fn give(problem: &Problem, pair: &ContactPair) -> [f64; 2] {
    let young = |e: Option<usize>| {
        let triangle = e.and_then(|e| problem.mesh.edges[e].triangles[0]);
        triangle.map(|t| problem.material(problem.mesh.body[t]).young()[0])
    };
    match [young(pair.edges[0]), young(pair.edges[1])] {
        [Some(first), Some(second)] => [1.0 / (1.0 + first / second), 1.0 / (1.0 + second / first)],
        _ => [1.0, 0.0],
    }
}

/// Mean of (v' − v'')·n̂ − g over a pair, from the moments of the dual solve.
pub fn mean_excess(problem: &Problem, moments: &SideValues<[f64; 2]>, pair: &ContactPair) -> f64 {
    let n = pair.direction.ends;
    let total = |e: usize, start: usize, share: f64| {
        let lowered = |c: usize| lower_moments(&component(moments.of(e), c), 1);
        let [x, y] = [0, 1].map(lowered);
        let turned = problem.mesh.edges[e].vertices[0] != start;
        let [a, b] = if turned { [1, 0] } else { [0, 1] }.map(|end| [x[end], y[end]]);
        if pair.direction.is_constant() {
            return share * dot([a[0] + b[0], a[1] + b[1]], n[0]);
        }
        share * (dot(a, n[0]) + dot(b, n[1]))
    };
    let [c, d] = pair.direction.shares;
    let own = pair.edges[0].map_or(0.0, |e| total(e, pair.first[0], c));
    let other = pair.edges[1].zip(pair.second).map_or(0.0, |(e, second)| total(e, second[0], d));
    (own - other) / pair.length - pair.mean_gap()
}

/// A contact pair whose jump is being changed.
struct Jump<'a> {
    pair: &'a ContactPair,
    sides: [Option<Vec<usize>>; 2],
    give: [f64; 2],
    degree: usize,
}

impl<'a> Jump<'a> {
    /// That of a pair with a body on its first side.
    fn new(problem: &Problem, pair: &'a ContactPair, nodes: &Nodes) -> Option<Self> {
        let sides = sides(pair, &problem.mesh, nodes);
        let degree = sides[0].as_ref()?.len() - 1;
        Some(Jump { pair, sides, give: give(problem, pair), degree })
    }

    /// All of them.
    fn all(problem: &'a Problem, nodes: &'a Nodes) -> impl Iterator<Item = Jump<'a>> {
        problem.pairs().filter_map(move |pair| Jump::new(problem, pair, nodes))
    }

    /// The coefficients of the jump less the gap.
    fn excesses(&self, values: &[[f64; 2]]) -> Vec<f64> {
        of_pair(self.pair, &self.sides).iter().map(|row| row.excess(values)).collect()
    }

    /// Changes coefficient `j` of v' − v'' by `by` times `direction`, shared among the two sides.
    fn shift(&self, values: &mut [[f64; 2]], j: usize, direction: [f64; 2], by: f64) {
        for (side, part) in self.sides.iter().zip([self.give[0], -self.give[1]]) {
            if let Some(side) = side {
                shift(&mut values[side[j]], direction, part * by);
            }
        }
    }

    /// n̂ where coefficient `j` of v' − v'' stands.
    fn direction(&self, j: usize) -> [f64; 2] {
        self.pair.direction.at(j as f64 / self.degree as f64)
    }
}

/// Deepest penetration of all pairs: of all coefficients, and at the vertices.
pub fn penetration(problem: &Problem, field: &NodalValues) -> [f64; 2] {
    let mut deepest = [0.0_f64; 2];
    for jump in Jump::all(problem, &field.nodes) {
        let all = jump.excesses(&field.values);
        deepest[0] = all.iter().copied().fold(deepest[0], f64::max);
        deepest[1] = deepest[1].max(all[0]).max(all[all.len() - 1]);
    }
    deepest
}

/// Gives the jump of every pair the mean of the dual solution where inner coefficients would penetrate, or the direction of
/// contact turns.
pub fn match_means(problem: &Problem, moments: &SideValues<[f64; 2]>, field: &mut NodalValues) {
    for jump in Jump::all(problem, &field.nodes) {
        if jump.pair.direction.is_constant() {
            keep_sum(&jump, &mut field.values);
        } else {
            match_mean(&jump, mean_excess(problem, moments, jump.pair).min(0.0), &mut field.values);
        }
    }
}

/// Takes what inner coefficients have above zero from those below zero, in proportion.
fn keep_sum(jump: &Jump<'_>, values: &mut [[f64; 2]]) {
    let found = jump.excesses(values);
    let inner = &found[1..jump.degree];
    let above: f64 = inner.iter().map(|b| b.max(0.0)).sum();
    let below: f64 = inner.iter().map(|b| b.min(0.0)).sum();
    if above == 0.0 || above + below >= 0.0 {
        return;
    }
    for (j, b) in (1..).zip(inner) {
        let wanted = if *b > 0.0 { 0.0 } else { b * (1.0 + above / below) };
        jump.shift(values, j, jump.direction(j), wanted - b);
    }
}

/// Moves the inside of a pair along which the direction turns so that the jump has the given mean, and for quadratic sides
/// both inner coefficients are the same where it would penetrate.
///
/// The mean depends on how the sliding varies along the edge too, which vertex values know better than edge moments:
/// without this the bodies would come to lie apart by the difference, all along the contact. The two inner coefficients of
/// a quadratic differ by the second difference of the sliding, and are evened out along the contact, not across it.
fn match_mean(jump: &Jump<'_>, mean: f64, values: &mut [[f64; 2]]) {
    let (k, [m, n]) = (jump.degree, jump.pair.direction.ends);
    let found = jump.excesses(values);
    let inner = &found[1..=k];
    let wanted = ((k + 2) as f64 * mean - found[0] - found[k + 1]).min(0.0);
    let more = wanted - inner.iter().sum::<f64>();
    if k == 2 {
        let penetrates = inner[0].max(inner[1]) + 0.5 * more > 0.0;
        let changes = if penetrates { [0.5 * wanted - inner[0], 0.5 * wanted - inner[1]] } else { [0.5 * more; 2] };
        // A coefficient δ of the jump changes the two by 2/3 of its components along the directions at the ends.
        let cross = m[0] * n[1] - m[1] * n[0];
        let step = [
            1.5 / cross * (changes[0] * n[1] - changes[1] * m[1]),
            1.5 / cross * (changes[1] * m[0] - changes[0] * n[0]),
        ];
        jump.shift(values, 1, step, 1.0);
        return;
    }
    // By how much a unit step of every inner coefficient along n̂ changes the sum.
    let part = |j: usize| {
        let d = jump.direction(j);
        ((k + 1 - j) as f64 * dot(d, m) + (j + 1) as f64 * dot(d, n)) / (k + 1) as f64
    };
    let all: f64 = (1..k).map(part).sum();
    (1..k).for_each(|j| jump.shift(values, j, jump.direction(j), more / all));
}

/// Draws inner coefficients that are above zero down to it; `groups` are the rows of every pair.
pub fn restrict_inside(problem: &Problem, groups: &[Vec<Row>], field: &mut NodalValues, share: &dyn Share) {
    let size = largest(field.vertices(), share);
    let pairs = problem.pairs().zip(groups);
    for (jump, rows) in pairs.filter_map(|(pair, rows)| Some((Jump::new(problem, pair, &field.nodes)?, rows))) {
        let k = jump.degree;
        for (j, row) in rows.iter().enumerate().take(rows.len() - 1).skip(1) {
            let off = row.excess(&field.values);
            if off <= ROUNDING * size {
                continue;
            }
            // Where n̂ turns, coefficient j belongs to the inner coefficients j and j − 1 of v' − v'': the nearer one moves.
            // No coefficient of the jump grows by that.
            let (node, part) = if jump.pair.direction.is_constant() {
                (j, 1.0)
            } else if 2 * j <= k + 1 {
                let part = (k + 1 - j) as f64 * dot(jump.direction(j), jump.pair.direction.ends[0]);
                (j, part / (k + 1) as f64)
            } else {
                let part = j as f64 * dot(jump.direction(j - 1), jump.pair.direction.ends[1]);
                (j - 1, part / (k + 1) as f64)
            };
            jump.shift(&mut field.values, node, jump.direction(node), -off / part);
        }
    }
}

/// Adds `step` times `direction` to `u`.
pub fn shift(u: &mut [f64; 2], direction: [f64; 2], step: f64) {
    u[0] += step * direction[0];
    u[1] += step * direction[1];
}
