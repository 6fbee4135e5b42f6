//! Quantities of interest: guaranteed intervals for the numbers a scene is solved for.
//!
//! Displacement means, forces and moments of contacts and supports, stress means over regions, values at points: each a linear functional
//! of the exact solution ([`Functional`]), bounded from both sides by adjoint pairs ([`Known::interval`]), or what three of them determine
//! ([`Form`]).

mod adjoint;
mod ends;
mod functional;
mod interval;
mod invariant;
mod point;
mod tip;

pub use adjoint::pass::strained;
pub use ends::clipped;
pub use ends::outside;
pub use functional::form::Form;
pub use functional::local::Local;
pub use functional::value::{displaced, value_of};
pub use functional::{Functional, Kind, NotBounded};
pub use interval::{Interval, Known};
pub use invariant::Invariants;
pub use point::Wanted;
pub use tip::NoTip;
