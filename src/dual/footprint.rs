//! How much memory a solve takes, from counts alone: a mesh can be judged before it is made.
//!
//! The counts of numbers in a factor are those of nested dissection, n log n with a factor that was fitted, and the jumps
//! of a long contact, ordered last, make their part dense. The symbolic factorisation knows the exact figure later on.

use crate::element::Elements;
use crate::problem::Problem;

/// The sizes that the memory of a solve depends on. Numbers that no mesh has can be asked for, so they are real.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Size {
    /// Triangles.
    pub triangles: f64,
    /// Triangles that are not congruent to another one: each has element matrices of its own.
    pub distinct: f64,
    /// Ends of contact pairs, two for each.
    pub contact_ends: f64,
}

/// Bytes of the program before there is a problem.
const PROGRAM: f64 = 16e6;
/// Bytes for each triangle: mesh, conditions, sparse matrix, ordering and symbolic factorisation.
const ASSEMBLED: f64 = 2400.0;
/// Bytes for each triangle with element matrices of its own.
const DISTINCT: f64 = 1600.0;
/// Bytes for each triangle while the displacement of the upper bound is relaxed: element stiffnesses, factors of patches.
const BRACKET: f64 = 7500.0;
/// Bytes for each triangle of what is kept of a mesh when the next one is solved on.
const KEPT: f64 = 1500.0;
/// Unknowns for each triangle: four for each of three edges that two triangles share, a few more on the boundary.
const UNKNOWNS: f64 = 6.2;
/// Bytes of scratch memory for each unknown.
const SCRATCH: f64 = 190.0;
const NUMBER: f64 = 8.0;

impl Size {
    /// That of a problem with these elements, in triangles of linear stresses that take as much: one of degree p has (p + 1)/2
    /// times the moments, and matrices of their square.
    pub fn of_degrees(problem: &Problem, elements: &Elements) -> Self {
        let part = |t: usize| 0.5 * (elements.degree(t) + 1) as f64;
        let all = 0..problem.mesh.triangles.len();
        let linear = Size::of(problem);
        Size {
            triangles: all.clone().map(|t| part(t).powi(2)).sum(),
            distinct: all.clone().map(|t| part(t).powf(2.5)).sum(),
            contact_ends: linear.contact_ends * all.map(part).fold(1.0, f64::max),
        }
    }

    /// That of a problem, as if no triangles were congruent.
    pub fn of(problem: &Problem) -> Self {
        let triangles = problem.mesh.triangles.len() as f64;
        let pairs: usize = problem.interfaces.iter().map(|interface| interface.pairs.len()).sum();
        Size { triangles, distinct: triangles, contact_ends: 2.0 * pairs as f64 }
    }

    /// After `n` uniform refinements, which cut triangles into congruent ones.
    pub fn refined(self, n: u32) -> Self {
        let parts = 2.0_f64.powi(n.min(1000) as i32);
        Size {
            triangles: self.triangles * parts * parts,
            distinct: if n == 0 { self.distinct } else { 2.0 * self.distinct },
            contact_ends: self.contact_ends * parts,
        }
    }

    /// On a mesh with so many triangles, refined where the error is: contact becomes longer as the root of it.
    pub fn grown(self, triangles: f64) -> Self {
        let growth = triangles / self.triangles;
        Size { triangles, distinct: self.distinct * growth, contact_ends: self.contact_ends * growth.sqrt() }
    }

    /// Bytes that stay taken when all but problem, solution and bracket has been given back.
    pub fn kept(self) -> f64 {
        KEPT * self.triangles
    }

    /// Bytes that the bracket takes while its displacement is relaxed.
    pub fn bracket(self) -> f64 {
        BRACKET * self.triangles
    }

    /// Bytes at the peak of a run with one sparse factorisation, its bracket included, where contacts of at most
    /// `longest_dense` ends are solved with dense matrices.
    pub fn factorised(self, longest_dense: usize) -> f64 {
        let unknowns = UNKNOWNS * self.triangles;
        let levels = unknowns.max(2.0).log2();
        let jumps = self.contact_ends * self.contact_ends;
        let factor = unknowns * levels * (2.4 + 0.16 * levels) + 6.0 * jumps;
        let dense = if self.contact_ends <= longest_dense as f64 { 4.0 * NUMBER * jumps } else { 0.0 };
        let system = ASSEMBLED * self.triangles + DISTINCT * self.distinct;
        PROGRAM + (system + NUMBER * factor + dense.max(SCRATCH * unknowns)).max(self.bracket())
    }

    /// Bytes at the peak of a run that takes `each` for each triangle.
    pub fn linear(self, each: f64) -> f64 {
        PROGRAM + each * self.triangles
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MESH: Size = Size { triangles: 304.0, distinct: 304.0, contact_ends: 16.0 };

    #[test]
    fn refinement_multiplies_triangles_by_four_and_contact_by_two() {
        let fine = MESH.refined(5);
        assert_eq!((fine.triangles, fine.contact_ends), (311_296.0, 512.0));
        assert_eq!(MESH.refined(0), MESH);
        assert!(MESH.refined(u32::MAX).triangles > 1e300, "no overflow");
    }

    /// Peaks of resident memory, measured.
    #[test]
    fn what_was_measured_is_estimated_well() {
        let measured = [(MESH.refined(3), 153e6), (MESH.refined(4), 633e6), (MESH.refined(5), 2757e6)];
        for (size, bytes) in measured {
            let found = size.factorised(6000);
            assert!((0.98..1.3).contains(&(found / bytes)), "{size:?}: {found:e}, measured {bytes:e}");
        }
    }

    #[test]
    fn a_long_contact_makes_the_factor_dense() {
        let long = Size { contact_ends: 60_000.0, ..MESH.refined(5) };
        assert!(long.factorised(6000) > NUMBER * 3.6e9, "{:e}", long.factorised(6000));
    }

    #[test]
    fn contact_grows_as_the_root_of_an_adaptive_mesh() {
        let next = MESH.grown(4.0 * MESH.triangles);
        assert_eq!((next.triangles, next.contact_ends), (1216.0, 32.0));
    }
}
