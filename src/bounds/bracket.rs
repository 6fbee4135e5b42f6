//! The two-sided bracket that a dual solution gives without any help.

use super::energy::{Complementary, LocalGap, Potential, complementary, local_gap, potential};
use super::upper::{NoUpperBound, admissible};
use crate::dual::DualSolution;
use crate::element::Displacement;
use crate::problem::Problem;

/// Unit round-offs that evaluating one term of an energy is allowed to cost: the arithmetic of a term has fewer than
/// a hundred operations, each with an error of at most one unit, on numbers of the size of the term.
const ROUNDING_PER_TERM: f64 = 128.0 * f64::EPSILON;

/// Lower bound, free upper bound, and the gap between them in local terms.
#[derive(Debug, Clone)]
pub struct Bracket {
    /// Complementary energy of λ_h.
    pub complementary: Complementary,
    /// By how much rounding and what is left of equilibrium can have moved the lower bound.
    pub lower_widening: f64,
    /// The displacement built from the dual solve, where one could be built.
    pub free: Result<UpperBound, NoUpperBound>,
}

/// An admissible displacement with its energy.
#[derive(Debug, Clone)]
pub struct UpperBound {
    /// The field v.
    pub displacement: Displacement,
    /// Its energy.
    pub potential: Potential,
    /// By how much rounding can have moved it.
    pub widening: f64,
    /// 𝓛(v) + Π(λ_h) in local terms.
    pub local: LocalGap,
}

impl UpperBound {
    /// Evaluates an admissible displacement against λ_h.
    pub fn new(problem: &Problem, dual: &DualSolution, displacement: Displacement) -> Self {
        let potential = potential(problem, &displacement);
        let local = local_gap(problem, &dual.stress, &displacement);
        UpperBound { widening: ROUNDING_PER_TERM * potential.magnitude, displacement, potential, local }
    }

    /// 𝓛(v), plus what rounding can have cost.
    pub fn upper(&self) -> f64 {
        self.potential.total() + self.widening
    }
}

impl Bracket {
    /// Computes both sides.
    pub fn new(problem: &Problem, dual: &DualSolution) -> Self {
        let complementary = complementary(problem, &dual.stress);
        let rounding = ROUNDING_PER_TERM * complementary.magnitude;
        let remainder = problem.scene.thickness * dual.equilibrium.work;
        let free = admissible(problem, dual).map(|v| UpperBound::new(problem, dual, v));
        Bracket { complementary, lower_widening: rounding + remainder, free }
    }

    /// −Π(λ_h), less what rounding and inexact equilibrium can have cost.
    pub fn lower(&self) -> f64 {
        self.complementary.lower() - self.lower_widening
    }

    /// √(gap / 𝒮(λ_h)) for an upper bound `upper`.
    pub fn relative_error(&self, upper: f64) -> f64 {
        ((upper - self.lower()).max(0.0) / self.complementary.strain).sqrt()
    }
}
