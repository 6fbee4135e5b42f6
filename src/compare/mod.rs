//! The dual solution against displacement models: energies, contact pressure, stresses, verdict.

mod check;

pub use check::{Basis, Check};
