//! Refinement: uniform, and by bisection of the longest edge.

pub mod bisect;
pub(super) mod halves;
pub(super) mod quarter;
pub(super) mod uncut;
