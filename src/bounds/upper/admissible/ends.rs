//! Jumps at the ends of contact pairs: values at vertices that neither penetrate nor leave the pairs between them no room
//! for the mean of the dual solution.
//!
//! Along a pair d = (v' − v'')·n̂ − g has Bernstein coefficients b_0 … b_k that sum to k + 1 times its mean d̄ ≤ 0, which the
//! dual solution knows. With b_0 and b_k in [(k + 1)/2 · d̄, 0] the others sum to no more than zero, so that all of them can be
//! at most zero: the jump is admissible everywhere and no volume is lost.

use super::contact::{ROUNDING, give, mean_excess, shift};
use super::holds::{Hold, jump_rounding};
use super::nodes::Nodes;
use super::rows::Row;
use crate::bounds::upper::NoUpperBound;
use crate::bounds::upper::relaxation::share::Share;
use crate::element::SideValues;
use crate::problem::{ContactPair, Problem};
use crate::vector::dot;

/// Bounds on the jump at one end of one pair.
pub struct End<'a> {
    pair: &'a ContactPair,
    first: usize,
    second: Option<usize>,
    /// The direction of contact there.
    normal: [f64; 2],
    low: f64,
    high: f64,
    give: [f64; 2],
}

impl<'a> End<'a> {
    /// Bounds of the jump along a direction at one end of a pair.
    pub fn along(pair: &'a ContactPair, end: usize, normal: [f64; 2], [low, high]: [f64; 2], give: [f64; 2]) -> Self {
        End { pair, first: pair.first[end], second: pair.second.map(|s| s[end]), normal, low, high, give }
    }
}

/// Sweeps over all ends; ends that share no vertex are settled by the first.
const MOST_SWEEPS: usize = 200;
/// How far inside a bound a jump is moved, relative to the size of the displacement.
const MARGIN: f64 = 1e-14;

/// Moves vertex values so that no vertex jump exceeds the bound of its row; `groups` are the rows of every pair.
///
/// # Errors
/// [`NoUpperBound::ForcedPenetration`] where supports leave no room for that.
pub fn restrict(
    problem: &Problem,
    groups: &[Vec<Row>],
    holds: &[Hold],
    vertex: &mut [[f64; 2]],
    share: &dyn Share,
) -> Result<(), NoUpperBound> {
    let ends = ends_below(problem, groups);
    draw(&ends, holds, vertex, share);
    let size = largest(vertex, share);
    for end in &ends {
        let by = excess(end, vertex);
        if by > jump_rounding(problem, end.pair, size) {
            let [x, y] = problem.scene.as_written(problem.mesh.points[end.first]);
            return Err(NoUpperBound::ForcedPenetration { x, y, by });
        }
    }
    Ok(())
}

/// Moves vertex values so that vertex jumps lie within the bounds of `ends`, as far as these do not contradict each
/// other: the normals of two short edges in line differ by rounding, and so does what they demand of a sliding vertex.
pub fn draw(ends: &[End<'_>], holds: &[Hold], vertex: &mut [[f64; 2]], share: &dyn Share) {
    let size = largest(vertex, share);
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

/// The largest component of a displacement, given by its values here, which are up to date.
pub fn largest(values: &[[f64; 2]], share: &dyn Share) -> f64 {
    share.largest(values.iter().flatten().fold(0.0_f64, |m, v| m.max(v.abs())))
}

/// By how much the jump is above (positive) or below (negative) its bounds.
fn excess(end: &End<'_>, vertex: &[[f64; 2]]) -> f64 {
    let jump = dot(vertex[end.first], end.normal) - end.second.map_or(0.0, |v| dot(vertex[v], end.normal));
    if jump > end.high { jump - end.high } else { (jump - end.low).min(0.0) }
}

/// Both ends of all pairs, bounded by their rows alone.
fn ends_below<'a>(problem: &'a Problem, groups: &[Vec<Row>]) -> Vec<End<'a>> {
    let pairs = problem.pairs();
    pairs
        .zip(groups)
        .filter_map(|(pair, rows)| Some((pair, [rows.first()?.bound(), rows.last()?.bound()])))
        .flat_map(|(pair, bounds)| {
            [0, 1].map(|end| End {
                pair,
                first: pair.first[end],
                second: pair.second.map(|s| s[end]),
                normal: pair.direction.ends[end],
                low: f64::NEG_INFINITY,
                high: bounds[end],
                give: give(problem, pair),
            })
        })
        .collect()
}

/// Both ends of all pairs, kept near the mean jumps of the dual solution; bounds of neighbouring pairs are merged.
pub fn ends_near<'a>(problem: &'a Problem, moments: &SideValues<[f64; 2]>, nodes: &Nodes) -> Vec<End<'a>> {
    let mut ends = Vec::new();
    for interface in &problem.interfaces {
        let least = |pair: &ContactPair| {
            let degree = pair.edges[0].map_or(2, |e| nodes.degree(e));
            0.5 * (degree + 1) as f64 * mean_excess(problem, moments, pair).min(0.0)
        };
        let least: Vec<f64> = interface.pairs.iter().map(least).collect();
        for (k, pair) in interface.pairs.iter().enumerate() {
            for end in 0..2 {
                // The neighbour that shares this vertex, where the interface goes on.
                let neighbour = if end == 0 { k.checked_sub(1) } else { Some(k + 1) };
                let shared = neighbour
                    .and_then(|n| interface.pairs.get(n).map(|p| (n, p)))
                    .filter(|(_, p)| p.first.contains(&pair.first[end]));
                let low = shared.map_or(least[k], |(n, _)| least[k].max(least[n]));
                ends.push(End {
                    pair,
                    first: pair.first[end],
                    second: pair.second.map(|s| s[end]),
                    normal: pair.direction.ends[end],
                    low: pair.gap[end] + low,
                    high: pair.gap[end],
                    give: give(problem, pair),
                });
            }
        }
    }
    ends
}
