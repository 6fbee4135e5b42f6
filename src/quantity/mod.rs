//! Quantities of interest: guaranteed intervals for the numbers a scene is solved for.
//!
//! Displacement means, forces and moments of contacts and supports, stress means over regions, values at points: each a linear functional
//! of the exact solution ([`Functional`]), bounded from both sides by adjoint pairs ([`Known::interval`]), or what three of them determine
//! ([`Form`]).

mod end;
mod form;
mod functional;
mod interval;
mod invariant;
mod lift;
mod pass;
mod point;
mod region;
mod search;
mod tried;
mod value;

pub use form::Form;
pub use functional::{Functional, Kind, NotBounded};
pub use interval::{Interval, Known, outside};
pub use invariant::Invariants;
pub use point::Wanted;
pub use value::{displaced, value_of};
