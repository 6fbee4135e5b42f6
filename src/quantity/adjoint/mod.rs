//! Pairs of adjoint fields: their integrals, the bound that one gives, and the search for the best.

pub(super) mod constants;
pub(super) mod end;
pub(super) mod lift;
pub(super) mod pass;
pub(super) mod revolved;
pub(super) mod search;
pub(super) mod springs;
pub(super) mod tried;
