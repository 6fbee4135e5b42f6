//! Contact pressure from both sides, along each interface.

use std::collections::HashMap;

pub use super::piece::{Piece, variation};
use crate::bounds::openings;
use crate::compare::candidate::{Judged, Reactions};
use crate::compare::revolved::stress_at;
use crate::dual::DualSolution;
use crate::element::displacement::through;
use crate::element::polynomial::side;
use crate::element::{Strains, elastic_degree};
use crate::problem::{ContactPair, EdgeWeight, Interface, Problem};

/// −t of the dual solution.
pub fn dual_pressure(dual: &DualSolution, interface: usize) -> Vec<Piece> {
    let pressure = |t: &[f64]| Piece::polynomial(t.iter().map(|t| -t).collect());
    dual.contact_traction[interface].iter().map(pressure).collect()
}

/// Pressures from their products with the weight of the section, the only ones known on the edges of a body of revolution; interpolated
/// between the points of the degree.
pub fn unweighted(problem: &Problem, interface: &Interface, own: &[Piece]) -> Vec<Piece> {
    let section = problem.section();
    if !section.is_revolved() {
        return own.to_vec();
    }
    let of_pair = |(pair, piece): (&ContactPair, &Piece)| {
        let [a, b] = pair.first.map(|v| section.weight(problem.mesh.points[v]));
        let coefficients: Vec<f64> = piece.coefficients().collect();
        if a == b {
            return Piece::polynomial(coefficients.iter().map(|c| c / a).collect());
        }
        let last = (coefficients.len() - 1).max(1);
        let at = |i: usize| {
            // On the axis the value close by.
            let s = (i as f64 / last as f64).clamp(ASIDE, 1.0 - ASIDE);
            [side::value(&coefficients, s) / (a + s * (b - a)), 0.0]
        };
        Piece::polynomial(through(&(0..=last).map(at).collect::<Vec<_>>()).iter().map(|c| c[0]).collect())
    };
    interface.pairs.iter().zip(own).map(of_pair).collect()
}

/// The mean weight of the section near vertex `v` of a pair, averaged with the Bernstein polynomial of that vertex, if there are `inner`
/// more polynomials between the ends.
fn around(problem: &Problem, pair: &ContactPair, v: usize, inner: usize) -> f64 {
    let [a, b] = pair.first.map(|v| problem.section().weight(problem.mesh.points[v]));
    let degree = (inner + 1) as f64;
    let (own, other) = if v == pair.first[0] { (a, b) } else { (b, a) };
    if a == b { a } else { ((degree + 1.0) * own + other) / (degree + 2.0) }
}

/// As [`around`], for the `inner` polynomials between the ends.
fn around_between(problem: &Problem, pair: &ContactPair, inner: usize) -> Vec<f64> {
    let [a, b] = pair.first.map(|v| problem.section().weight(problem.mesh.points[v]));
    let degree = (inner + 1) as f64;
    let at = |j: usize| ((degree + 1.0 - j as f64) * a + (j as f64 + 1.0) * b) / (degree + 2.0);
    (1..=inner).map(|j| if a == b { a } else { at(j) }).collect()
}

/// Nearest distance from an axis at which pressures are evaluated, as a fraction of the edge.
const ASIDE: f64 = 1e-6;

/// Pressure from consistent reactions: each is spread over the part of Γ_K that its shape function covers.
pub fn reaction_pressure(problem: &Problem, interface: &Interface, reactions: &Reactions) -> Vec<Piece> {
    let thickness = problem.scene.thickness;
    // ∫ of the shape function per unit edge length: hat functions, or Bernstein polynomials of the jump.
    let inner = |k: usize| reactions.edge.as_ref().and_then(|e| e.get(k)).map_or(&[][..], Vec::as_slice);
    let share = |k: usize| 1.0 / (inner(k).len() + 2) as f64;
    let mut weight = HashMap::new();
    for (k, pair) in interface.pairs.iter().enumerate() {
        for v in pair.first {
            *weight.entry(v).or_insert(0.0) +=
                share(k) * pair.length * thickness * around(problem, pair, v, inner(k).len());
        }
    }
    let force: HashMap<_, _> = reactions.vertices.iter().copied().zip(reactions.vertex.iter().copied()).collect();
    let at = |v: usize| force.get(&v).copied().unwrap_or(0.0) / weight[&v];
    interface
        .pairs
        .iter()
        .enumerate()
        .map(|(k, pair)| {
            let [a, b] = pair.first.map(at);
            let part = share(k) * pair.length * thickness;
            let between = around_between(problem, pair, inner(k).len());
            let inner = inner(k).iter().zip(between).map(|(r, around)| r / (part * around));
            if !pair.direction.is_constant() && inner.len() > 0 {
                // Apart, those of a direction that hardly turns say little; together they do.
                let count = inner.len() as f64;
                return Piece::broken(vec![a, inner.sum::<f64>() / count, b]);
            }
            Piece::broken(std::iter::once(a).chain(inner).chain([b]).collect())
        })
        .collect()
}

/// −σ_n(u_h) on the first side.
pub fn trace_pressure(problem: &Problem, interface: &Interface, judged: &Judged) -> Vec<Piece> {
    trace_along(problem, interface, judged, |pair| pair.normal.map(|n| -n))
}

/// d·σ(u_h)n' on the first side, with the direction d of each pair.
pub fn trace_along(
    problem: &Problem,
    interface: &Interface,
    judged: &Judged,
    direction: impl Fn(&ContactPair) -> [f64; 2],
) -> Vec<Piece> {
    let mesh = &problem.mesh;
    let materials = problem.materials();
    let trace = |pair: &ContactPair| {
        if let Some(k) = pair.stiffness {
            return spring_pressure(&openings(problem, &judged.field.displacement, pair), k);
        }
        let Some(e) = pair.edges[0] else { return Piece::polynomial(vec![0.0]) };
        let t = mesh.edges[e].triangles[0].unwrap_or(0);
        let sub = mesh.triangle_edges[t].iter().position(|&x| x == e).unwrap_or(0);
        let mut strains = Strains::default();
        let material = &materials[mesh.body[t]];
        strains.elastic(mesh.corners(t), &judged.field.displacement, t, sub, material);
        let (n, d) = (pair.normal, direction(pair));
        let revolved = problem.section().revolved();
        let pressure = |e: [f64; 3], l: [f64; 3]| {
            let s = match revolved {
                None => material.stress(e),
                Some(revolved) => {
                    let [rr, zz, _, rz] = stress_at(problem, revolved, &judged.field.displacement, t, sub, l);
                    [rr, zz, rz]
                }
            };
            d[0] * (s[0] * n[0] + s[2] * n[1]) + d[1] * (s[2] * n[0] + s[1] * n[1])
        };
        // Of degree k − 1 on the edge, from corner to corner of the subtriangle.
        let degree = elastic_degree(judged.field.displacement.degree(t), material);
        let values: Vec<[f64; 2]> = (0..=degree.max(1))
            .map(|j| j as f64 / degree.max(1) as f64)
            .map(|s| [pressure(strains.at([1.0 - s, s, 0.0]), [1.0 - s, s, 0.0]), 0.0])
            .collect();
        let mut pressures: Vec<f64> = through(&values).into_iter().map(|p| p[0]).collect();
        if mesh.edges[e].vertices[0] != pair.first[0] {
            pressures.reverse();
        }
        Piece::polynomial(pressures)
    };
    interface.pairs.iter().map(trace).collect()
}

/// Parts of an edge on which the pressure of an elastic contact that ends there is drawn as linear.
const PARTS: usize = 32;

/// k times the excess of a jump over the gap, from the coefficients of the opening.
fn spring_pressure(opening: &[f64], k: f64) -> Piece {
    let pressed: Vec<f64> = opening.iter().map(|open| -k * open).collect();
    if pressed.iter().all(|p| *p >= 0.0) {
        return Piece::polynomial(pressed);
    }
    if pressed.iter().all(|p| *p <= 0.0) {
        return Piece::polynomial(vec![0.0]);
    }
    Piece::broken((0..=PARTS).map(|i| side::value(&pressed, i as f64 / PARTS as f64).max(0.0)).collect())
}

/// Resultant force and moment about the origin of a pressure, as it acts on the first side, thickness included; in a body of revolution
/// the pressure is given times the distance from the axis.
pub fn resultant(problem: &Problem, interface: &Interface, pieces: &[Piece]) -> ([f64; 2], f64) {
    resultant_of(problem, interface, pieces, |_| EdgeWeight::default())
}

/// As [`resultant`], for a pressure that is not multiplied by the distance from the axis.
pub fn resultant_of_pressure(problem: &Problem, interface: &Interface, pieces: &[Piece]) -> ([f64; 2], f64) {
    resultant_of(problem, interface, pieces, |pair| EdgeWeight::of_pair(problem.section(), &problem.mesh, pair))
}

fn resultant_of(
    problem: &Problem,
    interface: &Interface,
    pieces: &[Piece],
    weight: impl Fn(&ContactPair) -> EdgeWeight,
) -> ([f64; 2], f64) {
    let cross = |[x, y]: [f64; 2], n: [f64; 2]| x * n[1] - y * n[0];
    let (mut force, mut moment) = ([0.0; 2], 0.0);
    for (pair, p) in interface.pairs.iter().zip(pieces) {
        let [a, b] = pair.first.map(|v| problem.mesh.points[v]);
        let [m, n] = pair.direction.ends;
        let size = pair.length * problem.scene.thickness;
        for c in 0..2 {
            force[c] -= size * p.integral(&weight(pair).times(&[m[c], n[c]]));
        }
        // The arm of a force along a direction that turns is quadratic.
        moment -= size * p.integral(&[cross(a, m), 0.5 * (cross(a, n) + cross(b, m)), cross(b, n)]);
    }
    (without_radial(problem, force), if problem.section().is_revolved() { 0.0 } else { moment })
}

/// A force without its radial component on a body of revolution: around the axis radial forces and moments cancel.
pub fn without_radial(problem: &Problem, force: [f64; 2]) -> [f64; 2] {
    if problem.section().is_revolved() { [0.0, force[1]] } else { force }
}

/// Moment about the origin of reactions as they act on the first side: the work of each on a unit rotation.
pub fn reaction_moment(problem: &Problem, interface: &Interface, reactions: &Reactions) -> f64 {
    let cross = |[x, y]: [f64; 2], n: [f64; 2]| x * n[1] - y * n[0];
    if problem.section().is_revolved() {
        return 0.0;
    }
    let mut normal = HashMap::new();
    let mut moment = 0.0;
    for (k, pair) in interface.pairs.iter().enumerate() {
        for (v, n) in pair.first.into_iter().zip(pair.direction.ends) {
            normal.entry(v).or_insert(n);
        }
        let [a, b] = pair.first.map(|v| problem.mesh.points[v]);
        let on = |s: f64| [0, 1].map(|c| a[c] + s * (b[c] - a[c]));
        let [m, n] = pair.direction.ends;
        let inner = reactions.edge.as_ref().and_then(|e| e.get(k)).map_or(&[][..], Vec::as_slice);
        let degree = (inner.len() + 1) as f64;
        for (j, r) in inner.iter().enumerate() {
            let steps = (j + 1) as f64;
            moment -= r * if pair.direction.is_constant() {
                // The Bernstein coefficients of a linear function are its values at equal steps.
                cross(on(steps / degree), n)
            } else {
                let [before, here] = [steps - 1.0, steps].map(|i| on(i / (degree - 1.0)));
                ((degree - steps) * cross(here, m) + steps * cross(before, n)) / degree
            };
        }
    }
    for (v, r) in reactions.vertices.iter().zip(&reactions.vertex) {
        moment -= normal.get(v).map_or(0.0, |n| r * cross(problem.mesh.points[*v], *n));
    }
    moment
}

/// −∫ φ t of the one contact on whose pairs `weights` φ lie, from the `reactions` of all; `None` where the weights lie on
/// several, or there are none.
pub fn weighted_reactions(problem: &Problem, weights: &[Vec<f64>], reactions: &[Reactions]) -> Option<f64> {
    let mut rest = weights;
    let mut found = None;
    for (interface, own) in problem.interfaces.iter().zip(reactions) {
        let (here, after) = rest.split_at_checked(interface.pairs.len())?;
        rest = after;
        if here.iter().all(|weights| weights.is_empty()) {
            continue;
        }
        if found.is_some() {
            return None;
        }
        let mut at: HashMap<usize, f64> = HashMap::new();
        let mut sum = 0.0;
        for (k, (pair, weights)) in interface.pairs.iter().zip(here).enumerate().filter(|(_, (_, w))| !w.is_empty()) {
            let inner = own.edge.as_ref().and_then(|e| e.get(k)).map_or(&[][..], Vec::as_slice);
            let degree = inner.len() + 1;
            let weights = match weights.len() - 1 <= degree {
                true => side::elevate(weights, degree),
                false => side::from_moments(&side::moments(weights, degree)),
            };
            sum -= inner.iter().zip(&weights[1..]).map(|(r, w)| r * w).sum::<f64>();
            for (vertex, weight) in pair.first.into_iter().zip([weights[0], weights[degree]]) {
                at.entry(vertex).or_insert(weight);
            }
        }
        sum -= own.vertices.iter().zip(&own.vertex).map(|(v, r)| r * at.get(v).copied().unwrap_or(0.0)).sum::<f64>();
        found = Some(sum);
    }
    found
}

/// Largest value and its place.
pub fn maximum(problem: &Problem, interface: &Interface, pieces: &[Piece]) -> (f64, [f64; 2]) {
    let mut best = (0.0, interface.pairs.first().map_or([0.0; 2], |p| problem.mesh.points[p.first[0]]));
    for (pair, p) in interface.pairs.iter().zip(pieces) {
        let (value, s) = p.largest();
        if value > best.0 {
            let [a, b] = pair.first.map(|v| problem.mesh.points[v]);
            best = (value, [0, 1].map(|c| (1.0 - s) * a[c] + s * b[c]));
        }
    }
    best
}

/// L² norms of p and of p − q.
pub fn l2(interface: &Interface, p: &[Piece], q: &[Piece]) -> (f64, f64) {
    let (mut norm, mut difference) = (0.0, 0.0);
    for ((pair, p), q) in interface.pairs.iter().zip(p).zip(q) {
        norm += pair.length * p.square();
        difference += pair.length * p.squared_difference(q);
    }
    (norm.sqrt(), difference.sqrt())
}

/// True if the pressure is nowhere above `threshold` on a pair.
fn is_open(piece: &Piece, threshold: f64) -> bool {
    piece.largest().0 <= threshold
}

/// Length that carries less than `threshold` of pressure throughout an edge.
pub fn open_length(interface: &Interface, pieces: &[Piece], threshold: f64) -> f64 {
    let open = |p: &Piece| is_open(p, threshold);
    interface.pairs.iter().zip(pieces).filter(|(_, p)| open(p)).map(|(pair, _)| pair.length).sum()
}

/// The extent to which two models disagree about contact.
pub struct Disagreement {
    /// Length of the edges that only one of them calls open.
    pub length: f64,
    /// The longest of them.
    pub longest: f64,
}

/// Compares which edges carry more than a threshold of pressure in two models.
pub fn disagreement(interface: &Interface, p: (&[Piece], f64), q: (&[Piece], f64)) -> Disagreement {
    let open = |pieces: &[Piece], threshold: f64, k: usize| is_open(&pieces[k], threshold);
    let lengths = interface.pairs.iter().enumerate().filter(|(k, _)| open(p.0, p.1, *k) != open(q.0, q.1, *k));
    let mut found = Disagreement { length: 0.0, longest: 0.0 };
    for (_, pair) in lengths {
        found.length += pair.length;
        found.longest = found.longest.max(pair.length);
    }
    found
}

/// Arc lengths at which contact begins or ends: where a pair that carries more than `threshold` somewhere meets one that does
/// not. A polynomial without negative coefficients that is zero between the ends of its pair is zero on all of it.
pub fn contact_ends(interface: &Interface, pieces: &[Piece], threshold: f64) -> Vec<f64> {
    let open: Vec<bool> = pieces.iter().map(|p| is_open(p, threshold)).collect();
    let changes = interface.pairs.iter().zip(open.windows(2)).filter(|(_, open)| open[0] != open[1]);
    changes.map(|(pair, _)| pair.arc[1]).collect()
}

/// Points (arc length, pressure) for a plot.
pub fn profile(interface: &Interface, pieces: &[Piece]) -> Vec<[f64; 2]> {
    let along = |(pair, p): (&ContactPair, &Piece)| {
        let [from, to] = pair.arc;
        p.points().into_iter().map(move |[s, value]| [(1.0 - s) * from + s * to, value])
    };
    interface.pairs.iter().zip(pieces).flat_map(along).collect()
}
