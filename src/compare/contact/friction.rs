//! Friction along a contact in the dual solution: zones of stick and slip, and the resultant of its traction.

use serde::Serialize;

use super::pressure::{Piece, unweighted, without_radial};
use crate::dual::DualSolution;
use crate::dual::equilibrium::contact_tractions;
use crate::element::polynomial::side;
use crate::problem::{ContactPair, Friction, Problem};
use crate::vector::long::largest;

/// Fraction of the bound from which a traction counts as being at the bound.
const AT_BOUND: f64 = 1.0 - 1e-6;
/// Rounding error of a traction, as a fraction of the largest stress nearby.
const ROUNDING: f64 = 1e-11;
/// Parts of a pair whose states are distinguished.
const PARTS: usize = 8;

/// Friction on a contact.
#[derive(Debug, Clone, PartialEq, Serialize, schemars::JsonSchema)]
pub struct FrictionSummary {
    /// `bound`: the largest tangential traction is given; `coulomb`: it goes with the pressure.
    pub kind: String,
    /// Coulomb's coefficient; `null` where the bound is given.
    pub coefficient: Option<f64>,
    /// How far the bound that was used is from the coefficient times the pressure; `null` where it is given.
    pub bound_distance: Option<BoundDistance>,
    /// Solutions with other bounds on the way to this one; one where the bound is given.
    pub iterations: usize,
    /// Fraction of the length along which the sides stick to each other: their tangential traction is below its bound.
    pub stick_fraction: f64,
    /// Fraction along which it is at a bound that is not zero: the sides slide, or may begin to.
    pub slip_fraction: f64,
    /// The tangential force on the first side, positive along its arc length.
    pub force: f64,
    /// Where the sides stick, slide, or have neither pressure nor friction, from one end to the other.
    pub zones: Vec<FrictionZone>,
    /// The tangential traction on the first side as (arc length, traction), positive along its arc length; consecutive points with equal
    /// arc length are jumps.
    pub traction: Vec<[f64; 2]>,
    /// Its bound, likewise.
    pub bound: Vec<[f64; 2]>,
}

/// How far the friction bound that was used is from μ times the pressure of the stresses that go with it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, schemars::JsonSchema)]
pub struct BoundDistance {
    /// The largest difference at a point of the contact.
    pub largest: f64,
    /// The same, relative to the largest value of μ times the pressure.
    pub largest_relative: f64,
    /// The integral of the difference along the contact, relative to that of μ times the pressure.
    pub relative: f64,
}

/// A stretch of a contact in one state.
#[derive(Debug, Clone, PartialEq, Serialize, schemars::JsonSchema)]
pub struct FrictionZone {
    /// Arc length of its beginning.
    pub from: f64,
    /// That of its end.
    pub to: f64,
    /// The state.
    pub state: FrictionState,
}

/// What the sides of a contact do along it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FrictionState {
    /// The tangential traction is below its bound.
    Stick,
    /// It is at its bound.
    Slip,
    /// Sides that touch and have no friction.
    Free,
    /// Neither pressure nor tangential traction.
    Open,
}

/// Friction on a contact: its summary, and the force and moment about the origin of the tangential tractions on the first
/// side, thickness included.
pub struct OnContact {
    /// The summary.
    pub summary: FrictionSummary,
    /// Force and moment.
    pub resultant: ([f64; 2], f64),
}

/// The friction of contact `index` with these `pressures`, of which those below `open` count as zero; `None` without friction.
pub fn on_contact(
    problem: &Problem,
    dual: &DualSolution,
    index: usize,
    (pressures, open): (&[Piece], f64),
) -> Option<OnContact> {
    let (interface, coefficient) = (&problem.interfaces[index], problem.coefficient(index));
    if coefficient.is_none() && interface.pairs.iter().all(|pair| pair.friction.is_none()) {
        return None;
    }
    let (mut traction, mut bound, mut zones) = (Vec::new(), Vec::new(), Vec::new());
    let (mut total, mut force, mut moment) = (0.0, [0.0; 2], 0.0);
    let tangential = |pair: &ContactPair| {
        let [_, t] = contact_tractions(problem, &dual.stress, pair);
        if t.is_empty() { vec![0.0; 2] } else { t }
    };
    // On a body of revolution all are times the distance from the axis.
    let weighted: Vec<Vec<f64>> = interface.pairs.iter().map(tangential).collect();
    let pieces: Vec<Piece> = weighted.iter().map(|t| Piece::polynomial(t.clone())).collect();
    let drawn = unweighted(problem, interface, &pieces);
    for (((pair, pressure), t), drawn) in interface.pairs.iter().zip(pressures).zip(&weighted).zip(drawn) {
        let ends = pair.friction.map_or([0.0; 2], |friction| friction.bound);
        // What stresses of this degree reach: linear ones stay below a bound that is quadratic with the weight.
        let most = pair.friction.map_or_else(|| vec![0.0], |friction| friction.coefficients(t.len() - 1));
        let place = |s: f64| pair.arc[0] + s * (pair.arc[1] - pair.arc[0]);
        traction.extend(drawn.points().into_iter().map(|[s, t]| [place(s), t]));
        bound.extend([[pair.arc[0], ends[0]], [pair.arc[1], ends[1]]]);
        let rounding = rounding(problem, dual, pair);
        for part in 0..PARTS {
            let [from, to] = [part, part + 1].map(|i| i as f64 / PARTS as f64);
            let s = 0.5 * (from + to);
            let (own, most) = (side::value(t, s).abs(), side::value(&most, s));
            let state = match () {
                () if pressure.at(s) <= open && own <= rounding => FrictionState::Open,
                () if most == 0.0 => FrictionState::Free,
                () if own + rounding >= AT_BOUND * most => FrictionState::Slip,
                () => FrictionState::Stick,
            };
            add(&mut zones, [place(from), place(to)], state);
        }
        let Some(friction) = pair.friction else { continue };
        let (size, [f, g], m) = resultant(problem, pair, &friction, t);
        total += size;
        force = [force[0] + f, force[1] + g];
        moment += m;
    }
    let length: f64 = interface.pairs.iter().map(|pair| pair.arc[1] - pair.arc[0]).sum();
    let fraction = |state: FrictionState| {
        let own = zones.iter().filter(|zone: &&FrictionZone| zone.state == state);
        // The sum of nothing would be minus zero.
        own.map(|zone| zone.to - zone.from).fold(0.0, |sum, part| sum + part) / length
    };
    let summary = FrictionSummary {
        kind: if coefficient.is_some() { "coulomb" } else { "bound" }.to_string(),
        coefficient,
        bound_distance: None,
        iterations: 1,
        stick_fraction: fraction(FrictionState::Stick),
        slip_fraction: fraction(FrictionState::Slip),
        force: total,
        zones: zones.clone(),
        traction,
        bound,
    };
    Some(OnContact { summary, resultant: (force, moment) })
}

/// Appends a stretch, merged with the one before it if both have the same state.
fn add(zones: &mut Vec<FrictionZone>, [from, to]: [f64; 2], state: FrictionState) {
    match zones.last_mut() {
        Some(last) if last.state == state && (from - last.to).abs() <= 1e-12 * to.abs() => last.to = to,
        _ => zones.push(FrictionZone { from, to, state }),
    }
}

/// Rounding error of a traction on a pair.
fn rounding(problem: &Problem, dual: &DualSolution, pair: &ContactPair) -> f64 {
    let t = pair.edges[0].and_then(|e| problem.mesh.edges[e].triangles[0]);
    ROUNDING * t.map_or(0.0, |t| largest(dual.stress.block(t).as_flattened()))
}

/// ∫ t ds, and force and moment about the origin of t t̂ on the first side, thickness included; of a body of revolution the force along its
/// axis.
fn resultant(problem: &Problem, pair: &ContactPair, friction: &Friction, t: &[f64]) -> (f64, [f64; 2], f64) {
    let cross = |[x, y]: [f64; 2], n: [f64; 2]| x * n[1] - y * n[0];
    let [a, b] = pair.first.map(|v| problem.mesh.points[v]);
    let [m, n] = friction.tangent.ends;
    let size = pair.length * problem.scene.thickness;
    let along = |weight: &[f64]| size * side::integral(t, weight);
    let force = without_radial(problem, [0, 1].map(|c| along(&[m[c], n[c]])));
    let moment = along(&[cross(a, m), 0.5 * (cross(a, n) + cross(b, m)), cross(b, n)]);
    (along(&[1.0]), force, if problem.section().is_revolved() { 0.0 } else { moment })
}
