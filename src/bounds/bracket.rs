//! The two-sided bracket that a dual solution gives without any help, widened by what rounding can have cost ([`super::rounding`]).

use std::borrow::Cow;

use super::energy::{Complementary, Potential};
use super::gap::LocalGap;
use super::jump::side_coefficients;
use super::oscillation;
use super::rounding::counted::Counted;
use super::rounding::terms::{LowerTerms, UpperTerms};
use super::upper::yielded;
use super::upper::{Groundwork, NoUpperBound, NodalValues, Prepared, admissible_on};
use crate::dual::{DualSolution, Equilibrium};
use crate::element::Displacement;
use crate::element::polynomial::side;
use crate::problem::{Problem, Scales};

/// Lower bound, free upper bound, and the gap between them in local terms.
#[derive(Debug, Clone)]
pub struct Bracket {
    /// Complementary energy of λ_h.
    pub complementary: Complementary,
    /// By how much rounding, what is left of equilibrium, and tractions of a degree that edges do not hold can have moved the lower bound.
    pub lower_widening: f64,
    /// Energies up to this size are none: what rounding leaves of the data of the problem.
    pub round_off: f64,
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
    /// By how much rounding, and tractions of a degree that edges do not hold, can have moved it.
    pub widening: f64,
    /// 𝓛(v) + Π(λ_h) in local terms.
    pub local: LocalGap,
    /// Data made on the way to it, kept where they are to be used again.
    pub prepared: Prepared,
}

impl UpperBound {
    /// Evaluates an admissible displacement against λ_h.
    pub fn new(problem: &Problem, dual: &DualSolution, displacement: Displacement) -> Self {
        let terms = UpperTerms::new(problem, &dual.stress, &displacement, Counted::ALL);
        Self::of_terms(problem, displacement, terms)
    }

    /// Builds the bound from precomputed energy terms.
    pub fn of_terms(problem: &Problem, displacement: Displacement, terms: UpperTerms) -> Self {
        let UpperTerms { potential, widening, triangles, pairs, springs } = terms;
        let local = LocalGap::of(problem, triangles, pairs, springs);
        let widening = widening + oscillation::above(problem, &displacement);
        UpperBound { displacement, potential, widening, local, prepared: Prepared::default() }
    }

    /// 𝓛(v), plus what rounding can have cost.
    pub fn upper(&self) -> f64 {
        self.potential.total() + self.widening
    }
}

impl Bracket {
    /// Computes both sides.
    pub fn new(problem: &Problem, dual: &DualSolution) -> Self {
        Self::from_start(problem, dual, None, false)
    }

    /// Computes both sides; the upper one may begin from `start`, and leaves what quantities on this mesh need again where it is
    /// to `keep` it.
    pub fn from_start(problem: &Problem, dual: &DualSolution, start: Option<NodalValues>, keep: bool) -> Self {
        let degrees = dual.moments.iter().map(|moments| moments.len() - 1);
        Self::on(Groundwork::new(problem, degrees), problem, dual, start, keep)
    }

    /// Does the same with what was made beside the dual solve for degrees of edges as those of its moments.
    pub fn on(
        ground: Result<Groundwork, NoUpperBound>,
        problem: &Problem,
        dual: &DualSolution,
        start: Option<NodalValues>,
        keep: bool,
    ) -> Self {
        let lower = LowerTerms::new(problem, &dual.stress, &dual.moments, Counted::ALL);
        let floor = lower.complementary.lower();
        let made = ground.and_then(|ground| {
            let (wider, stored) = yielded(problem, dual, &ground);
            let ground = match &wider {
                Cow::Borrowed(_) => ground,
                Cow::Owned(wider) => Groundwork::new(wider, dual.moments.iter().map(|moments| moments.len() - 1))?,
            };
            admissible_on(ground, &wider, dual, floor - problem.scene.thickness * stored, start, keep)
        });
        let free = made.map(|(v, prepared)| UpperBound { prepared, ..UpperBound::new(problem, dual, v) });
        Self::of_terms(problem, dual, lower, free)
    }

    /// Builds the bracket from the terms of the lower bound and from the upper bound.
    pub fn of_terms(
        problem: &Problem,
        dual: &DualSolution,
        lower: LowerTerms,
        free: Result<UpperBound, NoUpperBound>,
    ) -> Self {
        let held = free.as_ref().ok().map(|free| (&free.displacement, free.local.triangles.as_slice()));
        let oscillation = oscillation::below(problem, held);
        Bracket {
            complementary: lower.complementary,
            lower_widening: lower.rounding + problem.scene.thickness * dual.equilibrium.work + oscillation,
            round_off: Scales::new(problem).round_off.energy,
            free,
        }
    }

    /// −Π(λ_h), less what rounding and inexact equilibrium can have cost.
    pub fn lower(&self) -> f64 {
        self.complementary.lower() - self.lower_widening
    }

    /// True if the gap to the upper bound `upper` is a relative energy-norm error of at most `enough`, or no more than round-off of the
    /// data.
    pub fn tells(&self, upper: f64, enough: f64) -> bool {
        upper - self.lower() <= self.round_off || self.relative_error(upper) <= enough
    }

    /// √(gap / 𝒮(λ_h)) for an upper bound `upper`; zero where there is no stress, and no gap but round-off of the data, and infinite where
    /// `upper` is no number.
    pub fn relative_error(&self, upper: f64) -> f64 {
        if upper.is_nan() {
            return f64::INFINITY;
        }
        let (gap, strain) = ((upper - self.lower()).max(0.0), self.complementary.strain);
        // Without stress there is no energy to be relative to, and no error.
        if gap == 0.0 || (strain <= self.round_off && gap <= self.round_off) { 0.0 } else { (gap / strain).sqrt() }
    }
}

/// ∫ |what is left of equilibrium · v|, thickness included: by how much the energies of λ_h and v can miss the identity of the gap.
pub fn work_of_remainders(problem: &Problem, dual: &DualSolution, v: &Displacement) -> f64 {
    let mut moments = dual.moments.clone();
    for e in 0..moments.len() {
        let (length, _) = problem.mesh.edge_frame(e);
        let u = side_coefficients(problem, v, e);
        let own = moments.of_mut(e);
        for c in 0..2 {
            let along = side::component(&u, c);
            let found = side::moments(&along, own.len() - 1);
            own.iter_mut().zip(found).for_each(|(moment, found)| moment[c] = length * found);
        }
    }
    problem.scene.thickness * Equilibrium::measure(problem, &dual.stress, &moments).work
}
