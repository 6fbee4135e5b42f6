//! The sides of contacts and bonds: made to match, whatever divides them.

pub(crate) mod along;
pub(crate) mod bonded;
pub(super) mod bulge;
pub(crate) mod concentric;
pub mod glue;
#[cfg(test)]
pub(super) mod glue_tests;
pub(super) mod insert;
pub(super) mod nearby;
pub(crate) mod polyline;
