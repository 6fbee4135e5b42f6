//! Equilibrium elements: the seam, and one file per element.

mod field;
pub mod quadrature;

pub use field::{Displacement, StressField, lattice_len};
