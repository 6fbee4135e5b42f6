//! Friction in the space of a displacement solution of degree k: the coefficients of the tangential jump, and what each may carry.
//!
//! With j_t = Σ d_i B_i along a pair, a model's energy has Σ c_i |d_i|, c_i = ∫ τ̄ B_i ds, in the place of ∫ τ̄ |j_t| ds: nowhere
//! less, and as much wherever j_t keeps its sign. Its minimiser balances, on every function of its space,
//!
//!   ∫ c e(u_h):e(φ) + Σ_r R_r b_r(φ) + Σ_i F_i d_i(φ) = ∫ F·φ + ∫ P·φ,  |F_i| ≤ c_i,  F_i = c_i sgn d_i(u_h) where d_i(u_h) ≠ 0.
//!
//! Where contacts along several directions meet in a vertex, its law couples them, and is not held to them one by one.

use std::collections::BTreeMap;

use crate::bounds::{Nodes, Row, bernstein, of_pair, sides};
use crate::element::side;
use crate::problem::{Bow, ContactPair, Problem};
use crate::vector::cross;

/// Tangents whose cross product is smaller are one.
const PARALLEL: f64 = 1e-9;

/// One coefficient of a tangential jump.
#[derive(Debug, Clone)]
pub struct Slide {
    /// d_i as a function of the values at nodes.
    pub row: Row,
    /// c_i, thickness included.
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
    /// c_i of all pairs that end there, thickness included.
    pub limit: f64,
}

/// The jumps along t̂ at vertices, those of pairs that meet in one direction together.
pub fn at_ends(problem: &Problem, degree: usize) -> Vec<EndSlide> {
    let mut found: BTreeMap<(usize, usize, Option<usize>), Vec<EndSlide>> = BTreeMap::new();
    for (interface, contact) in problem.interfaces.iter().enumerate() {
        for pair in &contact.pairs {
            let (Some(friction), limits) = (pair.friction, limits(problem, pair, degree)) else { continue };
            for (end, limit) in [(0, limits.first()), (1, limits.last())] {
                let (first, second) = (pair.first[end], pair.second.map(|s| s[end]));
                let (tangent, limit) = (friction.tangent.ends[end], limit.copied().unwrap_or(0.0));
                let there = found.entry((interface, first, second)).or_default();
                match there.iter_mut().find(|other| cross(other.tangent, tangent).abs() < PARALLEL) {
                    Some(other) => other.limit += limit,
                    None => there.push(EndSlide { interface, first, second, tangent, limit }),
                }
            }
        }
    }
    found.into_values().flatten().collect()
}

/// The coefficients between the ends of a pair along which t̂ does not turn, as functions of values for degree 2 and of Bernstein
/// coefficients above; none without friction.
pub fn inside(problem: &Problem, pair: &ContactPair, degree: usize) -> Vec<Slide> {
    let Some(friction) = pair.friction.filter(|_| degree > 1 && pair.direction.is_constant()) else {
        return Vec::new();
    };
    let along = ContactPair { direction: friction.tangent, gap: [0.0; 2], bow: Bow::default(), ..pair.clone() };
    let vertices = problem.mesh.points.len();
    let rows = match degree {
        2 => bernstein(&along, vertices),
        _ => {
            let nodes = Nodes::new(vertices, std::iter::repeat_n(degree, problem.mesh.edges.len()));
            of_pair(&along, &sides(&along, &problem.mesh, &nodes))
        }
    };
    let slides = rows.into_iter().zip(limits(problem, pair, degree)).map(|(row, limit)| Slide { row, limit });
    slides.skip(1).take(degree - 1).collect()
}

/// c_0, …, c_k of a pair, thickness included; none without friction.
pub fn limits(problem: &Problem, pair: &ContactPair, degree: usize) -> Vec<f64> {
    let Some(friction) = pair.friction else { return Vec::new() };
    let [a, b] = friction.bound;
    let section = problem.section();
    let bound = if section.is_revolved() {
        let [r, s] = pair.first.map(|v| section.weight(problem.mesh.points[v]));
        vec![r * a, 0.5 * (r * b + s * a), s * b]
    } else {
        vec![a, b]
    };
    let whole = problem.scene.thickness * pair.length;
    side::moments(&bound, degree).into_iter().map(|moment| whole * moment).collect()
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
