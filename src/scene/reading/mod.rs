//! From the text of a scene to its tables, and what is said where something in it is wrong.

pub mod error;
pub(super) mod fault;
pub(super) mod nearest;
pub(super) mod parse;
pub(super) mod raw;
pub(super) mod read;
pub(super) mod source;
pub mod text;
pub(super) mod validate;
