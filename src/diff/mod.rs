//! Two reports beside each other: what changed from one to the other, and whether it matters.
//!
//! Outcomes of checks matter, and so do brackets of one scene that have no point in common: both cannot be right.
//! Numbers that moved are reported, and times are for information.

mod compare;
mod page;
mod text;

pub use compare::{CheckChange, Difference, Kind, NumberChange, compare};
pub use page::page;
pub use text::text;
