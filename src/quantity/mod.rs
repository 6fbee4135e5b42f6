//! Quantities of interest: guaranteed intervals for the numbers a scene is solved for.
//!
//! Displacement means, forces and moments of contacts and supports, stress means over regions: each a linear functional of
//! the exact solution ([`Functional`]), bounded from both sides by adjoint pairs ([`Known::interval`]).

mod end;
mod functional;
mod interval;
mod lift;
mod pass;
mod region;
mod search;
mod springs;
mod tried;
mod value;

pub use functional::{Functional, Kind, NotBounded};
pub use interval::{Interval, Known, outside};
pub use value::{displaced, value_of};
