//! Outputs that are text, for people and for services, and the words and numbers that they share.

pub(super) mod csv;
pub(super) mod json;
pub(super) mod junit;
pub(crate) mod markdown;
pub(crate) mod number;
pub(super) mod quantities_csv;
pub(crate) mod words;
