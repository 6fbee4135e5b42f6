//! The methods that solve the dual problem, each a [`DualMethod`](method::DualMethod), and their names.

pub(super) mod active_set;
pub(super) mod clarabel;
pub(super) mod condensed;
pub(super) mod method;
pub(super) mod solver;
