//! The terms of both sides of a bracket: of a whole problem, or those that one of several ranks counts, and their sum.

use super::counted::Counted;
use super::sum::Sum;
use super::{ROUNDING_PER_TERM, across_rollers, balance_rounding, largest_by_edge};
use crate::bounds::energy::{Complementary, Potential, complementary_of, potential_of, work_of_excess};
use crate::bounds::gap::{constitutive_error, contact_error};
use crate::bounds::springs::spring_error;
use crate::element::{Displacement, SideValues, StressField};
use crate::problem::Problem;

/// Of the lower bound, thickness included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LowerTerms {
    /// The complementary energy of λ_h.
    pub complementary: Complementary,
    /// By how much rounding, and gaps that lie above their polynomials, can have moved it, without what is left of equilibrium.
    pub rounding: f64,
}

impl LowerTerms {
    /// Of a stress that goes with these edge moments.
    pub fn new(problem: &Problem, stress: &StressField, moments: &SideValues<[f64; 2]>, counted: Counted<'_>) -> Self {
        let complementary = complementary_of(problem, stress, counted);
        let largest = largest_by_edge(problem, moments);
        let size = |t: usize| problem.mesh.triangle_edges[t].map(|e| largest[e]).into_iter().fold(0.0, f64::max);
        let balance = balance_rounding(problem, stress, size, counted);
        let rounding = ROUNDING_PER_TERM * complementary.sensitivity + balance;
        LowerTerms { complementary, rounding: rounding + work_of_excess(problem, stress, counted) }
    }

    /// The numbers, as another process takes them.
    pub fn numbers(&self) -> [f64; 8] {
        let Complementary { strain, initial, support_work, gap_work, springs, magnitude, sensitivity } =
            self.complementary;
        [strain, initial, support_work, gap_work, springs, magnitude, sensitivity, self.rounding]
    }

    /// The sum of the terms of all ranks, each given by its numbers.
    pub fn sum<'a>(ranks: impl Iterator<Item = &'a [f64]> + Clone) -> Self {
        let [strain, initial, support_work, gap_work, springs, magnitude, sensitivity, rounding] = summed(ranks);
        let complementary = Complementary { strain, initial, support_work, gap_work, springs, magnitude, sensitivity };
        LowerTerms { complementary, rounding }
    }
}

/// Of the upper bound and of the gap, thickness included.
#[derive(Debug, Clone, PartialEq)]
pub struct UpperTerms {
    /// The energy of v.
    pub potential: Potential,
    /// By how much rounding can have moved it.
    pub widening: f64,
    /// ½‖c e(v) − λ‖²_a on each triangle; zero where it is not counted.
    pub triangles: Vec<f64>,
    /// As [`super::LocalGap::pairs`] on each contact pair, one interface after the other; zero where it is not counted.
    pub pairs: Vec<f64>,
    /// ½ ∫ (k j + t)²/k on each pair of springs, one after the other; zero where it is not counted.
    pub springs: Vec<f64>,
}

impl UpperTerms {
    /// Of an admissible displacement, against λ_h.
    pub fn new(problem: &Problem, stress: &StressField, v: &Displacement, counted: Counted<'_>) -> Self {
        let potential = potential_of(problem, v, counted);
        let rounding =
            ROUNDING_PER_TERM * potential.sensitivity + balance_rounding(problem, stress, |t| v.largest(t), counted);
        UpperTerms {
            potential,
            widening: rounding + across_rollers(problem, stress, v, counted),
            triangles: constitutive_error(problem, stress, v, counted),
            pairs: contact_error(problem, stress, v, counted),
            springs: spring_error(problem, stress, v, counted),
        }
    }

    /// The numbers of the energy, as another process takes them.
    pub fn numbers(&self) -> [f64; 6] {
        let Potential { strain, springs, friction: _, work, magnitude, sensitivity } = self.potential;
        [strain, springs, work, magnitude, sensitivity, self.widening]
    }

    /// The sum of the terms of all ranks, each given by the numbers of its energy, and the terms of the gap.
    pub fn sum<'a>(ranks: impl Iterator<Item = &'a [f64]> + Clone, triangles: Vec<f64>, pairs: Vec<f64>) -> Self {
        let [strain, springs, work, magnitude, sensitivity, widening] = summed(ranks);
        // Ranks share no scene that has springs or friction.
        let potential = Potential { strain, springs, friction: 0.0, work, magnitude, sensitivity };
        UpperTerms { potential, widening, triangles, pairs, springs: Vec::new() }
    }
}

/// The sums of the numbers at each place, with compensation; not a number where a rank has none.
fn summed<'a, const N: usize>(ranks: impl Iterator<Item = &'a [f64]> + Clone) -> [f64; N] {
    let at = |of_rank: &[f64], i: usize| of_rank.get(i).copied().unwrap_or(f64::NAN);
    std::array::from_fn(|i| ranks.clone().map(|of_rank| at(of_rank, i)).collect::<Sum>().value())
}
