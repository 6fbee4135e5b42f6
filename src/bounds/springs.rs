//! Energies of springs and elastic layers, and their share of the gap.
//!
//! With the traction t = T(λ)·d on the first side and the jump j = (v' − v'')·d along each direction d of stiffness k, their potential
//! energy is ½ ∫ k j², their complementary energy ∫ t²/2k, and their part of the gap ½ ∫ (k j + t)²/k, which is never negative.
//!
//! On a body of revolution tractions and k are multiplied by the distance r from the axis: ½ ∫ k r j², ∫ t²/2kr, ½ ∫ (k r j + t)²/kr.
//!
//! Elastic contact resists the excess of the jump over the gap g: with d = j − g these are ½ ∫ k d₊², ∫ t²/2k − ∫ t g, and ½ ∫ (k d₊ +
//! t)²/k + ∫ (−t)(d₊ − d).

use super::jump::side_coefficients;
use super::rounding::counted::Counted;
use super::rounding::sum::Sum;
use crate::element::polynomial::{positive, side};
use crate::element::{Displacement, StressField};
use crate::problem::{BedPair, ContactPair, OneSided, Problem};
use crate::vector::dot;

/// An energy of springs, thickness included.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct SpringEnergy {
    /// The energy.
    pub value: f64,
    /// Largest change caused by a relative error of one in every number that enters.
    pub sensitivity: f64,
}

/// Σ ∫ t²/2k, with what elastic contact has of it; −∫ t g of that is among the works of gaps where it is a contact.
pub fn complementary_of_springs(problem: &Problem, stress: &StressField, counted: Counted<'_>) -> SpringEnergy {
    let of = |pair: &BedPair, stiffness: [f64; 2], is_contact: bool| {
        let forces = spring_tractions(problem, stress, pair);
        let along = forces.iter().zip(stiffness).filter(|(_, k)| *k > 0.0);
        let on_gap = |t: &[f64]| match &pair.contact {
            Some(contact) if !is_contact => -pair.length * side::integral(t, &contact.gap()),
            _ => 0.0,
        };
        let energy = |(t, k): (&Vec<f64>, f64)| {
            let (stored, on_gap) = (pair.length * pair.weight.square_over(t) / (2.0 * k), on_gap(t));
            [stored + on_gap, 2.0 * stored + on_gap.abs()]
        };
        along.map(energy).collect()
    };
    summed(problem, counted, of)
}

/// Σ ½ ∫ k j².
pub fn potential_of_springs(problem: &Problem, v: &Displacement, counted: Counted<'_>) -> SpringEnergy {
    let of = |pair: &BedPair, stiffness: [f64; 2], _: bool| {
        let (jump, size) = spring_jumps(problem, v, pair);
        if let Some(contact) = &pair.contact {
            let (beyond, k) = (penetration(&jump[0], contact), stiffness[0]);
            let mut moved = 0.0;
            positive::points(&beyond, beyond.len(), |at, d, weight| moved += weight * pair.weight.at(at) * d);
            let stored = positive::square(&beyond, pair.weight.ends());
            return vec![[0.5 * pair.length * k * stored, pair.length * k * size[0] * moved]];
        }
        let along = jump.iter().zip(size).zip(stiffness).filter(|(_, k)| *k > 0.0);
        along
            .map(|((j, size), k)| {
                let least: Vec<f64> = j.iter().map(|j| j.abs()).collect();
                let moved = pair.length * k * size * side::integral(&pair.weight.times(&least), &[1.0]);
                [0.5 * pair.length * k * side::integral(j, &pair.weight.times(j)), moved]
            })
            .collect()
    };
    summed(problem, counted, of)
}

/// ½ ∫ (k j + t)²/k of every pair, one bed after the other, thickness included; zero where it is not counted.
pub fn spring_error(problem: &Problem, stress: &StressField, v: &Displacement, counted: Counted<'_>) -> Vec<f64> {
    let of = |(pair, stiffness): (&BedPair, [f64; 2])| {
        if !counted.boundary_edge(&problem.mesh, pair.edge) {
            return 0.0;
        }
        let (forces, (jump, _)) = (spring_tractions(problem, stress, pair), spring_jumps(problem, v, pair));
        if let Some(contact) = &pair.contact {
            return problem.scene.thickness
                * one_sided_error(pair, &forces[0], &penetration(&jump[0], contact), stiffness[0]);
        }
        let along = forces.iter().zip(&jump).zip(stiffness).filter(|(_, k)| *k > 0.0);
        let term = |((t, j), k): ((&Vec<f64>, &Vec<f64>), f64)| {
            let j = pair.weight.times(j);
            let degree = t.len().max(j.len()) - 1;
            let [t, j] = [side::elevate(t, degree), side::elevate(&j, degree)];
            let off: Vec<f64> = t.iter().zip(&j).map(|(t, j)| k * j + t).collect();
            pair.length * pair.weight.square_over(&off) / (2.0 * k)
        };
        problem.scene.thickness * along.map(term).sum::<f64>()
    };
    problem.bed_pairs().map(of).collect()
}

/// The Fenchel gap of an elastic contact along its edge; zero on a pair of another kind.
pub fn elastic_contact_error(problem: &Problem, stress: &StressField, v: &Displacement, pair: &ContactPair) -> f64 {
    let Some((pair, [k, _])) = BedPair::of_contact(pair, problem.section(), &problem.mesh) else { return 0.0 };
    let Some(contact) = &pair.contact else { return 0.0 };
    let ([t, _], ([jump, _], _)) = (spring_tractions(problem, stress, &pair), spring_jumps(problem, v, &pair));
    problem.scene.thickness * one_sided_error(&pair, &t, &penetration(&jump, contact), k)
}

/// By how much a jump exceeds the gap of an elastic contact.
fn penetration(jump: &[f64], contact: &OneSided) -> Vec<f64> {
    let gap = contact.gap();
    let degree = jump.len().max(gap.len()) - 1;
    let [jump, gap] = [jump, &gap].map(|f| side::elevate(f, degree));
    jump.iter().zip(&gap).map(|(jump, gap)| jump - gap).collect()
}

/// ∫ ((k r d₊ + t)²/2kr − t (d₊ − d)) along an edge for a weighted traction t, r being what its points count and d the jump beyond the gap.
fn one_sided_error(pair: &BedPair, t: &[f64], beyond: &[f64], k: f64) -> f64 {
    let mut sum = 0.0;
    for part in positive::parts(beyond) {
        for p in pair.weight.rule([part.from, part.to], 2 * t.len().max(beyond.len() + 1) - 2) {
            let (t, d) = (side::value(t, p.at), part.value(p.at));
            let open = d - side::value(beyond, p.at);
            let off = (k * p.radius * d + t).powi(2) / (k * p.radius);
            sum += p.weight * (0.5 * (1.0 + p.excess) * off - t * open.max(0.0));
        }
    }
    pair.length * sum
}

fn summed(
    problem: &Problem,
    counted: Counted<'_>,
    of: impl Fn(&BedPair, [f64; 2], bool) -> Vec<[f64; 2]>,
) -> SpringEnergy {
    let (mut value, mut sensitivity) = (Sum::default(), 0.0);
    let own = problem.bed_pairs().map(|(pair, k)| (*pair, k, false));
    let elastic = problem.pairs().filter_map(|pair| BedPair::of_contact(pair, problem.section(), &problem.mesh));
    let all = own.chain(elastic.map(|(pair, k)| (pair, k, true)));
    for (pair, stiffness, is_contact) in all.filter(|(pair, ..)| counted.boundary_edge(&problem.mesh, pair.edge)) {
        for [energy, moved] in of(&pair, stiffness, is_contact) {
            value.add(energy);
            sensitivity += moved;
        }
    }
    let t = problem.scene.thickness;
    SpringEnergy { value: t * value.value(), sensitivity: t * (sensitivity + value.magnitude()) }
}

/// On every pair of springs, one bed after the other, coefficients along its two axes.
pub type OnSprings = Vec<[Vec<f64>; 2]>;

/// The coefficients of the traction on the first side along both axes, from its first vertex to its second.
pub fn spring_tractions(problem: &Problem, stress: &StressField, pair: &BedPair) -> [Vec<f64>; 2] {
    let degree = problem.mesh.edges[pair.edge].triangles[0].map_or(1, |t| stress.degree(t));
    let own = stress.edge_traction(&problem.mesh, pair.edge, 0, degree);
    pair.axes.map(|axis| own.iter().map(|t| dot(*t, axis)).collect())
}

/// The coefficients of the jump along both axes, and the size of the displacements that it is the difference of.
pub fn spring_jumps(problem: &Problem, v: &Displacement, pair: &BedPair) -> ([Vec<f64>; 2], [f64; 2]) {
    let own = side_coefficients(problem, v, pair.edge);
    let other: Vec<[f64; 2]> = match pair.opposite {
        Some(e) => side_coefficients(problem, v, e).into_iter().rev().collect(),
        None => vec![[0.0; 2]],
    };
    let degree = own.len().max(other.len()) - 1;
    let along =
        |u: &[[f64; 2]], axis: [f64; 2]| side::elevate(&u.iter().map(|u| dot(*u, axis)).collect::<Vec<_>>(), degree);
    let largest = |u: &[f64]| u.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
    let both = pair.axes.map(|axis| {
        let (a, b) = (along(&own, axis), along(&other, axis));
        let size = largest(&a) + largest(&b);
        (a.iter().zip(&b).map(|(a, b)| a - b).collect::<Vec<f64>>(), size)
    });
    let sizes = [both[0].1, both[1].1];
    (both.map(|(jump, _)| jump), sizes)
}
