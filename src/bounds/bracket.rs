//! The two-sided bracket that a dual solution gives without any help, widened by what rounding can have cost.
//!
//! Four things separate the numbers computed from bounds in exact arithmetic; each has its term, none is estimated from
//! the result.
//! 1. *Evaluation.* Every energy is a sum of products of a few numbers. One relative error u in each of them changes the
//!    energy by at most u times its sensitivity Σ |∂E/∂x| |x|, which is added up along with it: not the size of the
//!    terms alone, because near ν = ½, in bodies that turn and in slivers the numbers behind a term are much larger
//!    than the term. The sums themselves are compensated (Neumaier) and add one unit of the result.
//! 2. *Equilibrium.* λ_h misses it by what [`Equilibrium`] measures on every edge and of every triangle by itself. An exactly
//!    equilibrated field λ_h + δ is near; aλ_h being the strain of the edge displacement, Π changes by the traction
//!    jumps of δ times the moments of that displacement, up to ½‖δ‖²_a, the square of a rounding error. The absolute
//!    values are added up, so that no cancellation is relied upon.
//! 3. *Equilibrium within triangles in balance*, where it is a property of the basis and not measured: a rounding error of λ_h
//!    times the displacement along the boundary of the triangle.
//! 4. *Admissibility* of the displacement: supports and gaps are met to a rounding error of the displacement, and what
//!    that is worth is the traction times that error; the same expression. Where triangles are tiny, rounding of their corners
//!    turns the edges of a roller against each other, and a displacement along one has a part across another. That part is
//!    measured.

use std::convert::Infallible;

use rayon::prelude::*;

use super::energy::{Complementary, LocalGap, Potential, complementary, local_gap, potential};
use super::jump::side_coefficients;
use super::upper::{Groundwork, NoUpperBound, NodalValues, Prepared, admissible_on};
use crate::dual::{DualSolution, Equilibrium};
use crate::element::{Displacement, StressField, side};
use crate::problem::{Condition, Problem, Scales};

/// Relative errors that the evaluation of one term can pick up: some thirty operations one after the other, each with an
/// error of at most half a unit.
pub const ROUNDING_PER_TERM: f64 = 16.0 * f64::EPSILON;

/// Relative error of a nodal stress in the balance of its triangle, or of a displacement in a support or contact.
const ROUNDING_PER_VALUE: f64 = 8.0 * f64::EPSILON;

/// Lower bound, free upper bound, and the gap between them in local terms.
#[derive(Debug, Clone)]
pub struct Bracket {
    /// Complementary energy of λ_h.
    pub complementary: Complementary,
    /// By how much rounding and what is left of equilibrium can have moved the lower bound.
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
    /// By how much rounding can have moved it.
    pub widening: f64,
    /// 𝓛(v) + Π(λ_h) in local terms.
    pub local: LocalGap,
    /// What was made on the way to it, where it is to be used again.
    pub prepared: Prepared,
}

impl UpperBound {
    /// Evaluates an admissible displacement against λ_h.
    pub fn new(problem: &Problem, dual: &DualSolution, displacement: Displacement) -> Self {
        let potential = potential(problem, &displacement);
        let local = local_gap(problem, &dual.stress, &displacement);
        let size = |t: usize| displacement.largest(t);
        let rounding = ROUNDING_PER_TERM * potential.sensitivity + balance_rounding(problem, &dual.stress, size);
        let widening = rounding + across_rollers(problem, &dual.stress, &displacement);
        UpperBound { widening, displacement, potential, local, prepared: Prepared::default() }
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
        let free =
            |floor| Ok::<_, Infallible>(ground.and_then(|g| admissible_on(g, problem, dual, floor, start, keep)));
        let Ok(bracket) = Self::with(problem, dual, free);
        bracket
    }

    /// Does the same with an admissible displacement that `free` makes, given a lower bound of its energy.
    ///
    /// # Errors
    /// That of `free`.
    pub fn with<E>(
        problem: &Problem,
        dual: &DualSolution,
        free: impl FnOnce(f64) -> Result<Result<(Displacement, Prepared), NoUpperBound>, E>,
    ) -> Result<Self, E> {
        let complementary = complementary(problem, &dual.stress);
        let largest = largest_by_edge(problem, dual);
        let size = |t: usize| problem.mesh.triangle_edges[t].map(|e| largest[e]).into_iter().fold(0.0, f64::max);
        let rounding = ROUNDING_PER_TERM * complementary.sensitivity + balance_rounding(problem, &dual.stress, size);
        let remainder = problem.scene.thickness * dual.equilibrium.work;
        let free = free(complementary.lower())?
            .map(|(v, prepared)| UpperBound { prepared, ..UpperBound::new(problem, dual, v) });
        Ok(Bracket {
            complementary,
            lower_widening: rounding + remainder,
            round_off: Scales::new(problem).round_off.energy,
            free,
        })
    }

    /// −Π(λ_h), less what rounding and inexact equilibrium can have cost.
    pub fn lower(&self) -> f64 {
        self.complementary.lower() - self.lower_widening
    }

    /// Whether the gap to the upper bound `upper` is a relative energy-norm error of at most `enough`, or none but round-off
    /// of the data.
    pub fn tells(&self, upper: f64, enough: f64) -> bool {
        upper - self.lower() <= self.round_off || self.relative_error(upper) <= enough
    }

    /// √(gap / 𝒮(λ_h)) for an upper bound `upper`; zero where there is no stress, and no gap but round-off of the data.
    pub fn relative_error(&self, upper: f64) -> f64 {
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
            let along: Vec<f64> = u.iter().map(|u| u[c]).collect();
            let found = side::moments(&along, own.len() - 1);
            own.iter_mut().zip(found).for_each(|(moment, found)| moment[c] = length * found);
        }
    }
    problem.scene.thickness * Equilibrium::measure(problem, &dual.stress, &moments).work
}

/// The largest displacement on every edge that its moments in the dual solution stand for: a polynomial lies between its
/// coefficients.
fn largest_by_edge(problem: &Problem, dual: &DualSolution) -> Vec<f64> {
    let of = |e: usize| {
        let along = |c: usize| side::from_moments(&dual.moments.of(e).iter().map(|m| m[c]).collect::<Vec<_>>());
        let largest = along(0).iter().zip(along(1)).fold(0.0_f64, |m, (x, y)| m.max(x.hypot(y)));
        largest / problem.mesh.edge_frame(e).0
    };
    (0..problem.mesh.edges.len()).into_par_iter().with_min_len(256).map(of).collect()
}

/// A rounding error of the tractions on the boundary of every triangle times the displacement there, whose size `size`
/// gives by triangle; thickness included.
fn balance_rounding(problem: &Problem, stress: &StressField, size: impl Fn(usize) -> f64 + Sync) -> f64 {
    let mesh = &problem.mesh;
    let term = |t: usize| {
        let perimeter: f64 = mesh.triangle_edges[t].iter().map(|&e| mesh.edge_frame(e).0).sum();
        let largest = stress.block(t).iter().flatten().fold(0.0_f64, |m, s| m.max(s.abs()));
        perimeter * largest * size(t)
    };
    // Threads make the terms, and one adds them up in their order.
    let terms: Vec<f64> = (0..mesh.triangles.len()).into_par_iter().with_min_len(256).map(term).collect();
    ROUNDING_PER_VALUE * problem.scene.thickness * terms.iter().sum::<f64>()
}

/// The traction on rollers times the displacement across them; thickness included.
fn across_rollers(problem: &Problem, stress: &StressField, v: &Displacement) -> f64 {
    let term = |e: usize| {
        let (length, [x, y]) = problem.mesh.edge_frame(e);
        let across = |values: &[[f64; 2]]| values.iter().map(|v| (v[0] * x + v[1] * y).abs()).fold(0.0, f64::max);
        let degree = problem.mesh.edges[e].triangles[0].map_or(0, |t| stress.degree(t));
        let traction = stress.edge_traction(&problem.mesh, e, 0, degree);
        length * across(&traction) * across(&side_coefficients(problem, v, e))
    };
    let rollers = (0..problem.mesh.edges.len()).filter(|&e| problem.conditions[e] == Condition::Roller);
    problem.scene.thickness * rollers.map(term).sum::<f64>()
}
