//! The tables of a scene, one file each: what their keys may be, and what they mean.

pub(super) mod body_force;
pub(super) mod bonds;
pub(super) mod circle;
pub(super) mod conditions;
pub(super) mod files;
pub(super) mod friction;
pub(super) mod geometry;
pub(super) mod material;
pub(super) mod obstacle;
pub(crate) mod polygon;
pub(super) mod range;
pub(super) mod selection;
pub(super) mod springs;
pub(super) mod table;
