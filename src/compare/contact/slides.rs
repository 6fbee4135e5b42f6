//! Friction in the space of a displacement solution of degree k: the coefficients of the tangential jump, and what each may carry.
//!
//! With j_t = Σ d_i B_i along a pair, a model's energy has Σ c_i |d_i|, c_i = ∫ τ̄ B_i ds, in the place of ∫ τ̄ |j_t| ds: nowhere
//! less, and as much wherever j_t keeps its sign. Its minimiser balances, on every function of its space,
//!
//!   ∫ c e(u_h):e(φ) + Σ_r R_r b_r(φ) + Σ_i F_i d_i(φ) = ∫ F·φ + ∫ P·φ,  |F_i| ≤ c_i,  F_i = c_i sgn d_i(u_h) where d_i(u_h) ≠ 0.
//!
//! Where contacts along several directions meet in a vertex, its law couples them and is not checked for each alone.
//!
//! With Coulomb's law c_i = μ R_i, with the reaction R_i of the same place.

use std::collections::BTreeMap;

use super::piece::Piece;
use super::pressure::{resultant_of_pressure, trace_along};
use crate::bounds::{Nodes, Row, bernstein, of_pair, sides};
use crate::compare::candidate::{Judged, Reactions};
use crate::element::polynomial::side;
use crate::problem::{Bow, ContactPair, Direction, Interface, Problem};
use crate::vector::cross;

/// Tangents whose cross product is smaller are one.
const PARALLEL: f64 = 1e-9;

/// One coefficient of a tangential jump.
#[derive(Debug, Clone)]
pub struct Slide {
    /// d_i as a function of the values at nodes.
    pub row: Row,
    /// c_i, thickness included; one that means nothing with Coulomb's law.
    pub limit: f64,
}

impl Slide {
    /// The force F_i of a jump `d` that is zero within `within`, where nothing but the limit is known of it.
    pub fn force(&self, d: f64, within: f64) -> Option<f64> {
        (d.abs() > within).then(|| self.limit * d.signum())
    }
}

/// A tangential jump at the ends of pairs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EndSlide {
    /// The contact.
    pub interface: usize,
    /// Vertex of the first side.
    pub first: usize,
    /// Vertex of the second side.
    pub second: Option<usize>,
    /// t̂.
    pub tangent: [f64; 2],
    /// c_i of all pairs that end there, thickness included; one that means nothing with Coulomb's law.
    pub limit: f64,
    /// Coulomb's coefficient, where the displacement is held to it.
    pub coefficient: Option<f64>,
}

/// The jumps along t̂ at vertices, those of pairs that meet in one direction together.
pub fn at_ends(problem: &Problem, degree: usize) -> Vec<EndSlide> {
    let mut found: BTreeMap<(usize, usize, Option<usize>), Vec<EndSlide>> = BTreeMap::new();
    for (interface, contact) in problem.interfaces.iter().enumerate() {
        for pair in &contact.pairs {
            let (Some(friction), limits) = (pair.friction, limits(problem, pair, degree_along(pair, degree))) else {
                continue;
            };
            for (end, limit) in [(0, limits.first()), (1, limits.last())] {
                let (first, second) = (pair.first[end], pair.second.map(|s| s[end]));
                let (tangent, limit) = (friction.tangent.ends[end], limit.copied().unwrap_or(0.0));
                let there = found.entry((interface, first, second)).or_default();
                match there.iter_mut().find(|other| cross(other.tangent, tangent).abs() < PARALLEL) {
                    Some(other) => other.limit += limit,
                    None => {
                        let coefficient = friction.coefficient;
                        there.push(EndSlide { interface, first, second, tangent, limit, coefficient });
                    }
                }
            }
        }
    }
    found.into_values().flatten().collect()
}

/// The degree of the jump along t̂: one more where that turns, though of a displacement of degree 1 the ends alone are counted.
fn degree_along(pair: &ContactPair, degree: usize) -> usize {
    if degree > 1 && !pair.direction.is_constant() { degree + 1 } else { degree }
}

/// The coefficients between the ends of a pair, as functions of values for degree 2 and of Bernstein coefficients above; none without
/// friction.
pub fn inside(problem: &Problem, pair: &ContactPair, degree: usize) -> Vec<Slide> {
    let Some(friction) = pair.friction.filter(|_| degree > 1) else { return Vec::new() };
    let tangential = ContactPair { direction: friction.tangent, gap: [0.0; 2], bow: Bow::default(), ..*pair };
    let limits = limits(problem, pair, degree_along(pair, degree)).into_iter().skip(1);
    rows_inside(problem, &tangential, degree).into_iter().zip(limits).map(|(row, limit)| Slide { row, limit }).collect()
}

/// The coefficients of the jump between the ends of a pair, as functions of values for degree 2 and of Bernstein coefficients above.
pub fn rows_inside(problem: &Problem, pair: &ContactPair, degree: usize) -> Vec<Row> {
    let mut rows = match degree {
        2 => bernstein(pair, problem.mesh.points.len()),
        _ => of_pair(pair, &sides(pair, &problem.mesh, &Nodes::of_degree(&problem.mesh, degree))),
    };
    rows.pop();
    rows.split_off(1.min(rows.len()))
}

/// c_0, …, c_k of a pair, thickness included; none without friction.
pub fn limits(problem: &Problem, pair: &ContactPair, degree: usize) -> Vec<f64> {
    let Some(friction) = pair.friction else { return Vec::new() };
    let whole = problem.scene.thickness * pair.length;
    side::moments(&friction.weighted(), degree).into_iter().map(|moment| whole * moment).collect()
}

/// The traction along t̂ on the first side from the stresses of a displacement; zero where there is no friction.
pub fn trace_friction(problem: &Problem, interface: &Interface, judged: &Judged) -> Vec<Piece> {
    trace_along(problem, interface, judged, |pair| pair.friction.map_or([0.0; 2], |friction| friction.tangent.at(0.5)))
}

/// Force and moment about the origin of tractions along t̂, as they act on the first side, thickness included.
pub fn friction_resultant(problem: &Problem, interface: &Interface, pieces: &[Piece]) -> ([f64; 2], f64) {
    let along = |pair: &ContactPair| {
        let direction = pair.friction.map(|friction| friction.tangent);
        let reversed = |d: Direction| Direction { ends: d.ends.map(|t| t.map(|x| -x)), ..d };
        direction.map(|d| ContactPair { direction: reversed(d), ..*pair })
    };
    let rubbing = interface.pairs.iter().zip(pieces).filter_map(|(pair, piece)| Some((along(pair)?, piece.clone())));
    let (pairs, pieces): (Vec<ContactPair>, Vec<Piece>) = rubbing.unzip();
    resultant_of_pressure(problem, &Interface { name: interface.name.clone(), pairs, centre: None }, &pieces)
}

/// Moment about the origin of reported forces of friction, as they act on the first side.
pub fn reported_moment(problem: &Problem, interface: &Interface, reactions: &Reactions) -> f64 {
    let Some(friction) = reactions.friction.as_ref().filter(|_| !problem.section().is_revolved()) else { return 0.0 };
    let arm = |[x, y]: [f64; 2], t: [f64; 2]| x * t[1] - y * t[0];
    let (mut tangents, mut moment) = (BTreeMap::new(), 0.0);
    for (k, pair) in interface.pairs.iter().enumerate() {
        let Some(Direction { ends, .. }) = pair.friction.map(|friction| friction.tangent) else { continue };
        for (v, t) in pair.first.into_iter().zip(ends) {
            tangents.entry(v).or_insert(t);
        }
        let [a, b] = pair.first.map(|v| problem.mesh.points[v]);
        let inner = friction.edge.as_ref().and_then(|e| e.get(k)).map_or(&[][..], Vec::as_slice);
        for (j, force) in inner.iter().enumerate() {
            let s = (j + 1) as f64 / (inner.len() + 1) as f64;
            moment += force * arm([0, 1].map(|c| a[c] + s * (b[c] - a[c])), ends[0]);
        }
    }
    for (v, force) in reactions.vertices.iter().zip(&friction.vertex) {
        moment += tangents.get(v).map_or(0.0, |t| force * arm(problem.mesh.points[*v], *t));
    }
    moment
}

/// Σ c_i |d_i| of a displacement solution of degree `degree` with these values, or coefficients, at nodes.
pub fn work(problem: &Problem, degree: usize, value: impl Fn(usize) -> [f64; 2]) -> f64 {
    let along = |node: usize, t: [f64; 2]| {
        let u = value(node);
        u[0] * t[0] + u[1] * t[1]
    };
    let of_end = |end: &EndSlide| {
        let jump = along(end.first, end.tangent) - end.second.map_or(0.0, |s| along(s, end.tangent));
        end.limit * jump.abs()
    };
    let ends: f64 = at_ends(problem, degree).iter().map(of_end).sum();
    let between = problem.pairs().flat_map(|pair| inside(problem, pair, degree));
    ends + between.map(|slide| slide.limit * slide.row.excess_at(&value).abs()).sum::<f64>()
}
