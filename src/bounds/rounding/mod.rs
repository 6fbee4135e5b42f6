//! Bounds on the error of a bound from rounding.
//!
//! Four things separate the numbers computed from bounds in exact arithmetic; each has its term, none is estimated from
//! the result.
//! 1. *Evaluation.* Every energy is a sum of products of a few numbers. One relative error u in each of them changes the
//!    energy by at most u times its sensitivity Σ |∂E/∂x| |x|, which is added up along with it: not the size of the
//!    terms alone, because near ν = ½, in bodies that turn and in slivers the numbers behind a term are much larger
//!    than the term. The sums themselves are compensated (Neumaier) and add one unit of the result, and where ranks have made sums of
//!    their terms, one unit of those.
//! 2. *Equilibrium.* λ_h misses it by what [`crate::dual::Equilibrium`] measures on every edge, of every triangle by itself, and across the
//!    segments inside it. An exactly
//!    equilibrated field λ_h + δ is near; aλ_h being the strain of the edge displacement, Π changes by the traction
//!    jumps of δ times the moments of that displacement, up to ½‖δ‖²_a, the square of a rounding error. The absolute
//!    values are added up, so that no cancellation is relied upon.
//! 3. *Equilibrium within subtriangles*, where it is a property of the basis and not measured: a rounding error of λ_h
//!    times the displacement along the boundary of the triangle.
//! 4. *Admissibility* of the displacement: supports and gaps are met to a rounding error of the displacement, and what
//!    that is worth is the traction times that error; the same expression. Where triangles are tiny, rounding of their corners
//!    turns the edges of a roller against each other, and a displacement along one has a part across another. That part is
//!    measured.
pub(super) mod counted;
pub(super) mod sum;
pub(super) mod terms;

use rayon::prelude::*;

use super::jump::side_coefficients;
use crate::element::polynomial::side;
use crate::element::{Displacement, SideValues, StressField};
use crate::problem::{Condition, Problem};
use counted::Counted;

/// Relative errors that the evaluation of one term can pick up: some thirty operations one after the other, each with an
/// error of at most half a unit.
pub const ROUNDING_PER_TERM: f64 = 16.0 * f64::EPSILON;

/// Relative error of a nodal stress in the balance of its triangle, or of a displacement in a support or contact.
const ROUNDING_PER_VALUE: f64 = 8.0 * f64::EPSILON;

/// The largest displacement on every edge that its moments in the dual solution stand for: a polynomial lies between its
/// coefficients.
pub fn largest_by_edge(problem: &Problem, moments: &SideValues<[f64; 2]>) -> Vec<f64> {
    let of = |e: usize| {
        let along = |c: usize| side::from_moments(&side::component(moments.of(e), c));
        let largest = along(0).iter().zip(along(1)).fold(0.0_f64, |m, (x, y)| m.max(x.hypot(y)));
        largest / problem.mesh.edge_frame(e).0
    };
    (0..problem.mesh.edges.len()).into_par_iter().with_min_len(256).map(of).collect()
}

/// A rounding error of the tractions on the boundary of every triangle times the displacement there, whose size `size`
/// gives by triangle; thickness included.
pub fn balance_rounding(
    problem: &Problem,
    stress: &StressField,
    size: impl Fn(usize) -> f64 + Sync,
    counted: Counted<'_>,
) -> f64 {
    let mesh = &problem.mesh;
    let term = |t: usize| {
        if !counted.triangle(t) {
            return 0.0;
        }
        let perimeter: f64 = mesh.triangle_edges[t].iter().map(|&e| mesh.edge_frame(e).0).sum();
        let largest = stress.block(t).iter().flatten().fold(0.0_f64, |m, s| m.max(s.abs()));
        perimeter * largest * size(t)
    };
    // Threads make the terms, and one adds them up in their order.
    let terms: Vec<f64> = (0..mesh.triangles.len()).into_par_iter().with_min_len(256).map(term).collect();
    ROUNDING_PER_VALUE * problem.scene.thickness * terms.iter().sum::<f64>()
}

/// The traction on rollers times the displacement across them; thickness included.
pub fn across_rollers(problem: &Problem, stress: &StressField, v: &Displacement, counted: Counted<'_>) -> f64 {
    let term = |e: usize| {
        let Condition::Roller { direction: [x, y], displacement } = problem.conditions[e] else { return 0.0 };
        let (length, _) = problem.mesh.edge_frame(e);
        let along = |values: &[[f64; 2]], less: f64| {
            values.iter().map(|v| (v[0] * x + v[1] * y - less).abs()).fold(0.0, f64::max)
        };
        let degree = problem.mesh.edges[e].triangles[0].map_or(0, |t| stress.degree(t));
        let traction = stress.edge_traction(&problem.mesh, e, 0, degree);
        length * along(&traction, 0.0) * along(&side_coefficients(problem, v, e), displacement)
    };
    let rollers = (0..problem.mesh.edges.len()).filter(|e| counted.boundary_edge(&problem.mesh, *e));
    problem.scene.thickness * rollers.map(term).sum::<f64>()
}
