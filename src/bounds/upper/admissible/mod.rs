//! Displacements that are admissible: what supports hold and contact leaves room for, from the dual solution to jumps that penetrate nowhere.

pub(super) mod contact;
pub(super) mod edges;
pub(super) mod ends;
pub(super) mod fit;
pub(super) mod holds;
pub(super) mod lift;
pub(super) mod minimum;
pub(super) mod nearest;
pub(super) mod nodes;
pub(super) mod rows;
pub(super) mod sliding;
pub(super) mod yielded;
