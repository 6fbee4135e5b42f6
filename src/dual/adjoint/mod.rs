//! Stresses in equilibrium with other loads, from the factor of the problem that was solved.

pub(super) mod loaded;
pub(super) mod response;
