//! The equilibrium element of bodies of revolution.
//!
//! Points are (r, z). The element has the weighted stresses Σ = r λ, polynomials of degree p on the three subtriangles of a triangle, with
//! continuous Σ n inside and Σ = 0 on the axis. Balance along r defines the hoop stress (`stress.rs`), balance along z is left:
//! (Σ_rz, Σ_zz) = (∂_z χ, −∂_r χ) with χ of degree p + 1 on each subtriangle, and Σ_rr is arbitrary. Off the axis the dimension is 3(p + 1)²,
//! and of the 6(p + 1) coefficients of r T on the sides all are met whose resultant along z vanishes: 6(p + 1) − 1. An end of a side on the axis
//! takes the two coefficients there away, a side on the axis all of its own. As for the plane block, N(K) are the fields that
//! have the least energy among those with their tractions, in this order of columns:
//!
//! 1. uniform pressure, Σ = r I, soft as ν → ½ and orthogonal to all fields without traction;
//! 2. the fields without traction;
//! 3. the others;
//! 4. a field that balances the body force.
//!
//! Energies are integrals of rational functions: by quadrature for the basis, which decides about nothing but the choice of the
//! fields, and enclosed (`rule.rs`) for everything that is a bound.

mod body;
mod energies;
mod fields;
mod householder;
mod initial;
mod law;
mod modes;
mod rule;
mod sampled;
mod stress;

pub use body::Revolved;
pub use initial::{Held, Motion};
pub use law::{Law, Tensor, work};
pub use modes::Ring;
pub use rule::{Point, SidePoint, rule, side_rule};
pub use sampled::{Sampled, Strained};
pub use stress::Weighted;

/// True if coefficient `k` of `degree` of the traction on a side belongs to a point of the axis, where there is none; the flags tell which
/// ends of the side lie on the axis.
pub fn vanishes([first, last]: [bool; 2], k: usize, degree: usize) -> bool {
    first && (last || k == 0) || last && k == degree
}

/// Largest excess of the majorant of 1/r in a guaranteed bound, relative to 1/r.
pub const NEAR: f64 = 4.0 * f64::EPSILON;
/// Largest such excess in the choice of basis fields and in stiffness matrices that only guide a minimisation.
pub const ROUGH: f64 = 1e-9;
