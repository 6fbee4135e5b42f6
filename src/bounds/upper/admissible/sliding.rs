//! Contacts with friction in the upper bound: pairs that stick in the dual solution do not slide, and all others slide one way.
//!
//! The energy ∫ τ̄ |j_t| has a kink at j_t = 0. Where the sense σ of the sliding is known it is ∫ τ̄ σ j_t, a load, with σ j_t ≥ 0, a bound
//! on the Bernstein coefficients like that of penetration. Both restrict the displacement and cost energy only where the dual solution has
//! a wrong state; the result is judged by ∫ τ̄ |j_t| itself.

use super::contact::{give, shift};
use super::ends::End;
use super::holds::{Hold, Holds};
use super::nodes::{NodalValues, Nodes};
use super::rows::{Row, along_pair, sides};
use crate::bounds::upper::energy::beds::BedEnergy;
use crate::dual::equilibrium::contact_tractions;
use crate::element::polynomial::side;
use crate::element::{SideValues, StressField};
use crate::problem::{ContactPair, Friction, Problem};
use crate::vector::dot;
use crate::vector::long::largest;

/// Part of the bound from which a traction is at it.
const AT_BOUND: f64 = 1.0 - 1e-6;
/// Part of the stresses nearby that rounding may leave of a traction.
const ROUNDING: f64 = 1e-11;

/// Cosine of the angle between the tangents of two pairs beyond which there is a corner between them: 30°.
const NO_CORNER: f64 = 0.866;

/// Motion allowed to a pair with friction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Motion {
    /// Both sides move alike along t̂.
    Sticks,
    /// The first side slides along t̂ times this, 1 or −1.
    Slides(f64),
}

/// The motion of each pair, one interface after the other; none without friction, or where both senses may be.
#[derive(Debug, Clone, Default)]
pub struct Sliding(Vec<Option<Motion>>);

/// A pair with friction and its motion.
struct Rubbing<'a> {
    number: usize,
    pair: &'a ContactPair,
    friction: Friction,
    motion: Motion,
}

impl Sliding {
    /// Motions of the pairs from the dual solution, by its tractions and the moments of its displacement. Pairs next to sliding ones may
    /// slide as those do, where the traction opposes it.
    pub fn of(problem: &Problem, stress: &StressField, moments: &SideValues<[f64; 2]>) -> Self {
        if !problem.has_friction() {
            return Sliding::default();
        }
        let mut all = Vec::new();
        for interface in &problem.interfaces {
            let pairs = &interface.pairs;
            let tractions: Vec<Vec<f64>> = pairs
                .iter()
                .map(|pair| {
                    let [_, t] = contact_tractions(problem, stress, pair);
                    t
                })
                .collect();
            let mean = |pair: &ContactPair| pair.friction.map_or(0.0, |f| mean_sliding(problem, moments, pair, &f));
            let means: Vec<f64> = pairs.iter().map(mean).collect();
            let rounding = |pair: &ContactPair| {
                let t = pair.edges[0].and_then(|e| problem.mesh.edges[e].triangles[0]);
                ROUNDING * t.map_or(0.0, |t| largest(stress.block(t).as_flattened()))
            };
            let of = |k: usize| Some(motion(&pairs[k].friction?, means[k], &tractions[k], rounding(&pairs[k])));
            let own: Vec<Option<Motion>> = (0..pairs.len()).map(of).collect();
            for k in 0..pairs.len() {
                let beside = [k.checked_sub(1), Some(k + 1)].into_iter().flatten();
                let beside = beside.filter(|n| pairs.get(*n).is_some_and(|pair| goes_on(pair, &pairs[k])));
                let neighbours = || beside.clone().filter_map(|n| Some((n, own[n]?)));
                all.push(match own[k] {
                    Some(Motion::Sticks) => {
                        let against = |sense: f64| sense * tractions[k].iter().sum::<f64>() < 0.0;
                        let slides = |(_, motion): &(usize, Motion)| matches!(motion, Motion::Slides(s) if against(*s));
                        neighbours().find(slides).map(|(_, motion)| motion).or(own[k])
                    }
                    // Where the sense changes it does so within the pair that slides less.
                    Some(Motion::Slides(sense)) => {
                        let turns = |(n, motion): (usize, Motion)| {
                            motion == Motion::Slides(-sense) && means[k].abs() <= means[n].abs()
                        };
                        own[k].filter(|_| !neighbours().any(turns))
                    }
                    None => None,
                });
            }
        }
        Sliding(all)
    }

    fn pairs<'a>(&'a self, problem: &'a Problem) -> impl Iterator<Item = Rubbing<'a>> + 'a {
        let all = problem.pairs().zip(&self.0).enumerate();
        all.filter_map(|(number, (pair, motion))| {
            Some(Rubbing { number, pair, friction: pair.friction?, motion: (*motion)? })
        })
    }

    /// Bernstein coefficients that are at most zero: of the sliding against its sense, both ways where pairs stick; each group with the
    /// number of its pair.
    pub fn rows(&self, problem: &Problem, nodes: &Nodes) -> Vec<(usize, Vec<Row>)> {
        let of = |Rubbing { number, pair, friction, motion }: Rubbing<'_>| {
            let sides = sides(pair, &problem.mesh, nodes);
            let senses: &[f64] = match motion {
                Motion::Sticks => &[1.0, -1.0],
                Motion::Slides(sense) if sense > 0.0 => &[-1.0],
                Motion::Slides(_) => &[1.0],
            };
            let rows = senses.iter().flat_map(|sense| along_pair(&friction.tangent, &sides, *sense)).collect();
            (number, rows)
        };
        self.pairs(problem).map(of).collect()
    }

    /// The energies τ̄ σ j_t of the pairs that slide, each with the number of its pair.
    pub fn energies(&self, problem: &Problem, nodes: &Nodes) -> Vec<(usize, BedEnergy)> {
        let of = |Rubbing { number, pair, friction, motion }: Rubbing<'_>| {
            let Motion::Slides(sense) = motion else { return None };
            let [first, second] = sides(pair, &problem.mesh, nodes);
            let (bound, [t, u]) = (friction.weighted(), friction.tangent.ends);
            let resists = [0, 1].map(|c| side::times_linear(&bound, [-sense * t[c], -sense * u[c]]));
            Some((number, BedEnergy::of_force([first?, second.unwrap_or_default()], pair.length, resists)))
        };
        self.pairs(problem).filter_map(of).collect()
    }

    /// Bounds of the sliding at the ends of pairs.
    pub fn ends<'a>(&'a self, problem: &'a Problem) -> impl Iterator<Item = End<'a>> + 'a {
        self.pairs(problem).flat_map(|Rubbing { pair, friction, motion, .. }| {
            let bounds = match motion {
                Motion::Sticks => [0.0; 2],
                Motion::Slides(sense) if sense > 0.0 => [0.0, f64::INFINITY],
                Motion::Slides(_) => [f64::NEG_INFINITY, 0.0],
            };
            [0, 1].map(|end| End::along(pair, end, friction.tangent.ends[end], bounds, give(problem, pair)))
        })
    }

    /// Takes the sliding away where pairs stick, and inside pairs what is against its sense.
    pub fn settle(&self, problem: &Problem, holds: &Holds, field: &mut NodalValues) {
        if self.0.is_empty() {
            return;
        }
        let holds: Vec<Hold> = holds.of_nodes(&field.nodes).collect();
        for Rubbing { pair, friction, motion, .. } in self.pairs(problem) {
            let [Some(first), second] = sides(pair, &problem.mesh, &field.nodes) else { continue };
            let (give, last) = (give(problem, pair), first.len() - 1);
            for (j, node) in first.iter().enumerate() {
                let tangent = friction.tangent.at(j as f64 / last as f64);
                let other = second.as_ref().map(|second| second[j]);
                let along = |node: usize| dot(field.values[node], tangent);
                let off = along(*node) - other.map_or(0.0, along);
                let off = match motion {
                    Motion::Sticks => off,
                    Motion::Slides(sense) if j > 0 && j < last && sense * off < 0.0 => off,
                    Motion::Slides(_) => continue,
                };
                let own = holds[*node].project(tangent);
                let opposite = other.map_or([0.0; 2], |node| holds[node].project(tangent));
                let room = [dot(own, tangent) * give[0], dot(opposite, tangent) * give[1]];
                if off == 0.0 || room[0] + room[1] < 1e-12 {
                    continue;
                }
                let step = off / (room[0] + room[1]);
                shift(&mut field.values[*node], own, -step * give[0]);
                if let Some(node) = other {
                    shift(&mut field.values[node], opposite, step * give[1]);
                }
            }
        }
    }
}

/// True if two pairs have a vertex in common, and no corner there.
fn goes_on(one: &ContactPair, other: &ContactPair) -> bool {
    let joined = one.first.iter().any(|v| other.first.contains(v));
    let tangents = one.friction.zip(other.friction).map(|(a, b)| dot(a.tangent.at(0.5), b.tangent.at(0.5)));
    joined && tangents.is_some_and(|cosine| cosine > NO_CORNER)
}

/// Motion of a pair from the coefficients `t` of its tangential traction, known up to `rounding`, and the mean of its sliding.
fn motion(friction: &Friction, mean: f64, t: &[f64], rounding: f64) -> Motion {
    let bounds = friction.coefficients(t.len().max(1) - 1);
    let at_bound = |(t, bound): (&f64, &f64)| t.abs() + rounding >= AT_BOUND * bound;
    if !t.iter().zip(&bounds).any(at_bound) {
        return Motion::Sticks;
    }
    let sense = if mean == 0.0 { -t.iter().sum::<f64>() } else { mean };
    if sense == 0.0 { Motion::Sticks } else { Motion::Slides(sense.signum()) }
}

/// ∫ (v' − v'')·t̂ along a pair, from the moments of the dual solution.
fn mean_sliding(problem: &Problem, moments: &SideValues<[f64; 2]>, pair: &ContactPair, friction: &Friction) -> f64 {
    let [t, u] = friction.tangent.ends;
    let total = |e: usize, start: usize, share: f64| {
        let lowered = |c: usize| side::lower_moments(&side::component(moments.of(e), c), 1);
        let [x, y] = [0, 1].map(lowered);
        let turned = problem.mesh.edges[e].vertices[0] != start;
        let [a, b] = if turned { [1, 0] } else { [0, 1] }.map(|end| [x[end], y[end]]);
        share * (dot(a, t) + dot(b, u))
    };
    let [c, d] = pair.direction.shares;
    let own = pair.edges[0].map_or(0.0, |e| total(e, pair.first[0], c));
    let other = pair.edges[1].zip(pair.second).map_or(0.0, |(e, second)| total(e, second[0], d));
    own - other
}
