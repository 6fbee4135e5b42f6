//! Admissible jumps on Γ_K.
//!
//! Along a contact edge d = (v' − v'')·n̂ − g is quadratic with Bernstein coefficients b0, b1, b2 and mean
//! d̄ = (b0 + b1 + b2)/3 ≤ 0 known from the dual solve. With b0, b2 in [1.5 d̄, 0] the middle coefficient
//! b1 = 3d̄ − b0 − b2 is at most zero as well: the jump is admissible everywhere and no volume is lost.
//!
//! Where n̂ turns along the edge d is cubic. Its coefficients at the ends are those of the vertices, the two between them
//! add up to 4d̄ − b0 − b3; sliding parts them a little, and what is then above zero is drawn back.

use super::NoUpperBound;
use super::holds::Hold;
use crate::dual::DualSolution;
use crate::problem::{ContactPair, Problem};

/// Bounds on the jump at one end of one pair.
pub struct End {
    first: usize,
    second: Option<usize>,
    /// The direction of contact there.
    normal: [f64; 2],
    low: f64,
    high: f64,
    give: [f64; 2],
}

/// How much of a jump each side of `pair` gives way: the softer one more, so that moving a stiff body by what a soft one
/// needs costs no energy. The two add up to one.
fn give(problem: &Problem, pair: &ContactPair) -> [f64; 2] {
    let young = |e: Option<usize>| {
        let triangle = e.and_then(|e| problem.mesh.edges[e].triangles[0]);
        triangle.map(|t| problem.scene.bodies[problem.mesh.body[t]].young)
    };
    match [young(pair.edges[0]), young(pair.edges[1])] {
        [Some(first), Some(second)] => [1.0 / (1.0 + first / second), 1.0 / (1.0 + second / first)],
        _ => [1.0, 0.0],
    }
}

/// Sweeps over all ends; ends that share no vertex are settled by the first.
const MOST_SWEEPS: usize = 200;
/// How far inside a bound a jump is moved, relative to the size of the displacement.
const MARGIN: f64 = 1e-14;
/// Jumps beyond a bound by less than this, relative to the size of the displacement, are at the bound: the widening of
/// the upper bound covers rounding of this size.
pub const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Moves vertex values so that no vertex jump exceeds the gap.
///
/// # Errors
/// [`NoUpperBound::ForcedPenetration`] where supports leave no room for that.
pub fn restrict_vertices(problem: &Problem, holds: &[Hold], vertex: &mut [[f64; 2]]) -> Result<(), NoUpperBound> {
    let ends = ends_below_gap(problem);
    draw(&ends, holds, vertex);
    let size = vertex.iter().flatten().fold(0.0_f64, |m, v| m.max(v.abs()));
    for end in &ends {
        let by = excess(end, vertex);
        if by > 1e-12 * size {
            let [x, y] = problem.scene.as_written(problem.mesh.points[end.first]);
            return Err(NoUpperBound::ForcedPenetration { x, y, by });
        }
    }
    Ok(())
}

/// Moves vertex values so that vertex jumps lie within the bounds of `ends`, as far as these do not contradict each
/// other: the normals of two short edges in line differ by rounding, and so does what they demand of a sliding vertex.
pub fn draw(ends: &[End], holds: &[Hold], vertex: &mut [[f64; 2]]) {
    let size = vertex.iter().flatten().fold(0.0_f64, |m, v| m.max(v.abs()));
    let tolerance = 1e-13 * size;
    for _ in 0..MOST_SWEEPS {
        let mut moved = false;
        for end in ends {
            let mut off = excess(end, vertex);
            if off.abs() <= ROUNDING * size {
                continue;
            }
            // A little beyond the bound: where a vertex lies on sides of different directions the sweeps only approach it.
            if off > 0.0 {
                off += MARGIN * size.min((end.high - end.low) / MARGIN);
            }
            let own = holds[end.first].project(end.normal);
            let other = end.second.map_or([0.0; 2], |v| holds[v].project(end.normal));
            let room = [dot(own, end.normal), dot(other, end.normal)];
            if room[0] + room[1] < 1e-12 {
                continue;
            }
            // A side that supports hold gives nothing; the other one then gives all.
            let give = [0, 1].map(|i| if room[i] < 1e-12 { 0.0 } else { end.give[i] });
            let step = off / (give[0] * room[0] + give[1] * room[1]);
            shift(&mut vertex[end.first], own, -step * give[0]);
            if let Some(v) = end.second {
                shift(&mut vertex[v], other, step * give[1]);
            }
            moved |= off.abs() > tolerance;
        }
        if !moved {
            break;
        }
    }
}

/// By how much the jump is above (positive) or below (negative) its bounds.
fn excess(end: &End, vertex: &[[f64; 2]]) -> f64 {
    let jump = dot(vertex[end.first], end.normal) - end.second.map_or(0.0, |v| dot(vertex[v], end.normal));
    if jump > end.high { jump - end.high } else { (jump - end.low).min(0.0) }
}

/// Both ends of all pairs, bounded by the gap alone.
fn ends_below_gap(problem: &Problem) -> Vec<End> {
    let pairs = problem.interfaces.iter().flat_map(|i| &i.pairs);
    pairs
        .flat_map(|pair| {
            [0, 1].map(|end| End {
                first: pair.first[end],
                second: pair.second.map(|s| s[end]),
                normal: pair.direction.ends[end],
                low: f64::NEG_INFINITY,
                high: pair.gap[end],
                give: give(problem, pair),
            })
        })
        .collect()
}

/// Both ends of all pairs, kept near the mean jumps of the dual solution; bounds of neighbouring pairs are merged.
pub fn ends_near(problem: &Problem, dual: &DualSolution) -> Vec<End> {
    let mut ends = Vec::new();
    for interface in &problem.interfaces {
        let mean: Vec<f64> = interface.pairs.iter().map(|pair| mean_excess(problem, dual, pair).min(0.0)).collect();
        for (k, pair) in interface.pairs.iter().enumerate() {
            for end in 0..2 {
                // The neighbour that shares this vertex, where the interface goes on.
                let neighbour = if end == 0 { k.checked_sub(1) } else { Some(k + 1) };
                let shared = neighbour
                    .and_then(|n| interface.pairs.get(n).map(|p| (n, p)))
                    .filter(|(_, p)| p.first.contains(&pair.first[end]));
                let low = shared.map_or(mean[k], |(n, _)| mean[k].max(mean[n]));
                ends.push(End {
                    first: pair.first[end],
                    second: pair.second.map(|s| s[end]),
                    normal: pair.direction.ends[end],
                    low: pair.gap[end] + 1.5 * low,
                    high: pair.gap[end],
                    give: give(problem, pair),
                });
            }
        }
    }
    ends
}

/// Mean of (v' − v'')·n̂ − g over a pair, from the moments of the dual solve.
fn mean_excess(problem: &Problem, dual: &DualSolution, pair: &ContactPair) -> f64 {
    let n = pair.direction.ends;
    let total = |e: usize, start: usize, share: f64| {
        let (a, b) = (dual.moments.of(e)[0], dual.moments.of(e)[1]);
        if pair.direction.is_constant() {
            return share * dot([a[0] + b[0], a[1] + b[1]], n[0]);
        }
        let turned = problem.mesh.edges[e].vertices[0] != start;
        let (a, b) = if turned { (b, a) } else { (a, b) };
        share * (dot(a, n[0]) + dot(b, n[1]))
    };
    let [c, d] = pair.direction.shares;
    let own = pair.edges[0].map_or(0.0, |e| total(e, pair.first[0], c));
    let other = pair.edges[1].zip(pair.second).map_or(0.0, |(e, second)| total(e, second[0], d));
    (own - other) / pair.length - 0.5 * (pair.gap[0] + pair.gap[1])
}

/// One Bernstein coefficient of (v' − v'')·n̂ − g, a linear function of the values at nodes: vertices, then edges.
#[derive(Debug, Clone)]
pub struct Row {
    terms: Vec<(usize, [f64; 2])>,
    gap: f64,
}

impl Row {
    /// Node and factor of its value.
    pub fn terms(&self) -> &[(usize, [f64; 2])] {
        &self.terms
    }

    /// The coefficient for the given values: admissible where it is not positive.
    pub fn excess(&self, values: &[[f64; 2]]) -> f64 {
        self.excess_at(|node| values[node])
    }

    /// The same, with a function that gives the values.
    pub fn excess_at(&self, value: impl Fn(usize) -> [f64; 2]) -> f64 {
        self.terms.iter().map(|(node, factor)| dot(value(*node), *factor)).sum::<f64>() - self.gap
    }
}

/// The coefficients of every pair, in the order of the pairs: three, or four where the direction of contact turns.
pub fn rows(problem: &Problem) -> Vec<Row> {
    let pairs = problem.interfaces.iter().flat_map(|i| &i.pairs);
    pairs.flat_map(|pair| bernstein(pair, problem.mesh.points.len())).collect()
}

/// The coefficients of a pair from end to end, as functions of the values at nodes: `vertices` of them, then the edges.
pub fn bernstein(pair: &ContactPair, vertices: usize) -> Vec<Row> {
    let [first, last] = pair.direction.ends;
    let jump = |nodes: [Option<usize>; 2], factor: f64, n: [f64; 2]| {
        let term = move |node: Option<usize>, sign: f64| node.map(|k| (k, n.map(|n| sign * factor * n)));
        [term(nodes[0], 1.0), term(nodes[1], -1.0)].into_iter().flatten()
    };
    let end = |k: usize, factor: f64, n: [f64; 2]| jump([Some(pair.first[k]), pair.second.map(|s| s[k])], factor, n);
    let centre = |factor: f64, n: [f64; 2]| jump(pair.edges.map(|e| e.map(|e| vertices + e)), factor, n);
    let [ga, gb] = pair.gap;
    let head = Row { terms: end(0, 1.0, first).collect(), gap: ga };
    let tail = Row { terms: end(1, 1.0, last).collect(), gap: gb };
    if pair.direction.is_constant() {
        let middle = centre(2.0, first).chain(end(0, -0.5, first)).chain(end(1, -0.5, first));
        return vec![head, Row { terms: middle.collect(), gap: 0.5 * (ga + gb) }, tail];
    }
    // The product of the quadratic with coefficients V0, V1 = 2 v_mid − ½ (V0 + V2), V2 and of the linear n̂.
    let inner = |near: usize, n: [f64; 2], m: [f64; 2]| {
        let own = [n, m].map(|n| n.map(|n| n / 3.0));
        let ends = end(near, -1.0, own[0]).chain(end(1 - near, -1.0, own[0])).chain(end(near, 1.0, own[1]));
        centre(4.0, own[0]).chain(ends).collect::<Vec<_>>()
    };
    let near_head = Row { terms: inner(0, first, last), gap: (2.0 * ga + gb) / 3.0 };
    let near_tail = Row { terms: inner(1, last, first), gap: (ga + 2.0 * gb) / 3.0 };
    vec![head, near_head, near_tail, tail]
}

/// The values of the coefficients of a pair.
fn coefficients(pair: &ContactPair, vertex: &[[f64; 2]], middle: &[[f64; 2]]) -> Vec<f64> {
    let value = |node: usize| if node < vertex.len() { vertex[node] } else { middle[node - vertex.len()] };
    bernstein(pair, vertex.len()).iter().map(|row| row.excess_at(value)).collect()
}

/// Deepest penetration of all pairs: of all coefficients, and at the vertices.
pub fn penetration(problem: &Problem, vertex: &[[f64; 2]], middle: &[[f64; 2]]) -> [f64; 2] {
    let mut deepest = [0.0_f64; 2];
    for pair in problem.interfaces.iter().flat_map(|i| &i.pairs) {
        let all = coefficients(pair, vertex, middle);
        deepest[0] = all.iter().copied().fold(deepest[0], f64::max);
        deepest[1] = deepest[1].max(all[0]).max(all[all.len() - 1]);
    }
    deepest
}

/// Moves the midpoints of pairs along which the direction turns so that the jump has the mean of the dual solution, and
/// where it would penetrate both inner coefficients are the same.
///
/// The mean of the cubic jump depends on how the sliding varies along the edge too, which vertex values know better than
/// edge moments: without this the bodies would come to lie apart by the difference, all along the contact. The two inner
/// coefficients differ by the second difference of the sliding, and are evened out along the contact, not across it.
pub fn match_means(problem: &Problem, dual: &DualSolution, vertex: &[[f64; 2]], middle: &mut [[f64; 2]]) {
    for pair in problem.interfaces.iter().flat_map(|i| &i.pairs).filter(|pair| !pair.direction.is_constant()) {
        let [Some(own), other] = pair.edges else { continue };
        let found = coefficients(pair, vertex, middle);
        let wanted = (4.0 * mean_excess(problem, dual, pair).min(0.0) - found[0] - found[3]).min(0.0);
        let more = 0.5 * (wanted - found[1] - found[2]);
        let penetrates = found[1].max(found[2]) + more > 0.0;
        let changes = if penetrates { [0.5 * wanted - found[1], 0.5 * wanted - found[2]] } else { [more; 2] };
        // A jump δ at the midpoint changes the coefficients by 4/3 of its components along the directions at the ends.
        let [m, n] = pair.direction.ends;
        let cross = m[0] * n[1] - m[1] * n[0];
        let step = [
            0.75 / cross * (changes[0] * n[1] - changes[1] * m[1]),
            0.75 / cross * (changes[1] * m[0] - changes[0] * n[0]),
        ];
        let [first, second] = give(problem, pair);
        shift(&mut middle[own], step, first);
        if let Some(e) = other {
            shift(&mut middle[e], step, -second);
        }
    }
}

/// Draws midpoints back where supports at the vertices, sliding or rounding left an inner coefficient above zero.
pub fn restrict_middles(problem: &Problem, vertex: &[[f64; 2]], middle: &mut [[f64; 2]]) {
    let size = vertex.iter().flatten().fold(0.0_f64, |m, v| m.max(v.abs()));
    for pair in problem.interfaces.iter().flat_map(|i| &i.pairs) {
        let [Some(own), other] = pair.edges else { continue };
        let inner = coefficients(pair, vertex, middle);
        let off = inner[1..inner.len() - 1].iter().fold(0.0_f64, |m, b| m.max(*b));
        if off <= ROUNDING * size {
            continue;
        }
        // The jump at the midpoint changes a coefficient by twice itself, and by two thirds of that where there are two.
        let (n, step) = match inner.len() {
            3 => (pair.direction.ends[0], 0.5 * off),
            _ => {
                let n = pair.direction.at(0.5);
                let least = pair.direction.ends.map(|m| dot(n, m)).into_iter().fold(f64::INFINITY, f64::min);
                (n, 0.75 * off / least)
            }
        };
        let [first, second] = give(problem, pair);
        shift(&mut middle[own], n, -first * step);
        if let Some(e) = other {
            shift(&mut middle[e], n, second * step);
        }
    }
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn shift(u: &mut [f64; 2], direction: [f64; 2], step: f64) {
    u[0] += step * direction[0];
    u[1] += step * direction[1];
}
