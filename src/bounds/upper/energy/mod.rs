//! The energy of a displacement as a function of its nodes: of triangles, springs and loads.

pub(super) mod beds;
pub(super) mod cholesky;
pub(super) mod energies;
pub(super) mod interior;
pub(super) mod model;
pub(super) mod pull;
pub(super) mod split;
pub(super) mod stiffness;
