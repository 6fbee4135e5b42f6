//! Polynomials on sides and triangles by their Bernstein coefficients, and the rules that integrate them.

pub mod positive;
pub mod quadrature;
pub(super) mod samples;
pub mod side;
pub(super) mod side_values;
pub mod subdivision;
pub mod symmetric_rules;
pub mod triangle;
