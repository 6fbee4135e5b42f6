//! Functionals whose load is no polynomial: it is projected in the degrees of the fields of a mesh.

use super::Functional;
use crate::element::Displacement;
use crate::problem::Problem;
use crate::quantity::point::Point;
use crate::quantity::tip::Tip;

/// A functional of a neighbourhood of a point.
#[derive(Debug, Clone)]
pub enum Local {
    /// A value at a point inside a body.
    Point(Point),
    /// The stress intensity at the tip of a crack.
    Tip(Tip),
}

impl Local {
    /// True if it changes with a displacement that has no strain.
    pub fn is_of_place(&self) -> bool {
        match self {
            Local::Point(point) => point.is_displacement(),
            Local::Tip(_) => false,
        }
    }

    /// The part of stresses, which `at` gives at points of subtriangles, of degree `degree` on each triangle.
    pub fn strained(
        &self,
        problem: &Problem,
        degree: impl Fn(usize) -> usize,
        at: impl FnMut(usize, usize, [f64; 3]) -> [f64; 3],
    ) -> f64 {
        match self {
            Local::Point(point) => point.strained(problem, degree, at),
            Local::Tip(tip) => tip.strained(problem, degree, at),
        }
    }

    /// The part of a displacement.
    pub fn displaced(&self, problem: &Problem, v: &Displacement) -> f64 {
        match self {
            Local::Point(point) => point.displaced(problem, v),
            Local::Tip(tip) => tip.displaced(problem, v),
        }
    }

    /// Adds what the adjoint problem is loaded with to `functional`, in the degrees of the fields on each triangle and of each edge.
    pub fn load(
        &self,
        problem: &Problem,
        functional: &mut Functional,
        stress_degree: impl Fn(usize) -> usize,
        edge_degree: impl Fn(usize) -> usize,
    ) {
        match self {
            Local::Point(point) => point.load(problem, functional, stress_degree, edge_degree),
            Local::Tip(tip) => tip.load(problem, functional, stress_degree, edge_degree),
        }
    }
}
