//! The mistakes that are known, one family a file.

pub(super) mod anisotropic;
pub(super) mod contact;
pub(super) mod initial;
pub(super) mod integration;
pub(super) mod layer;
pub(super) mod loads;
pub(super) mod local;
pub(super) mod lumped;
pub(super) mod material;
pub(super) mod moved;
pub(super) mod outline;
pub(super) mod sampled;
pub(super) mod shift;
pub(super) mod single;
pub(super) mod springs;
pub(super) mod supports;
pub(super) mod turned;
pub(super) mod values;
