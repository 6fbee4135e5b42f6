//! Files that a run leaves behind, all derived from one [`Dossier`].
//!
//! [`write()`] makes the files; each of them is also a function here, from data to text, that knows nothing of files.

mod coulomb;
mod data;
mod deflate;
pub(crate) mod document;
pub mod figure;
pub mod folder;
mod guarantee;
mod html;
pub mod inventory;
mod lattice;
mod quantity;
#[cfg(test)]
mod sample;
#[cfg(test)]
mod sample_numbers;
pub(crate) mod text;
mod vtu;

pub use coulomb::{CoulombOutcome, CoulombStart};
pub use data::*;
pub use folder::run::run_of;
pub use folder::stored::*;
pub use folder::write::{NAMES, ReportError, write};
pub(crate) use html::CSS;
pub use html::page;
pub use quantity::{Data, firmness};
pub use text::csv::{tables, tables_of};
pub use text::json::{json, schema};
pub use text::junit::junit;
pub(crate) use text::junit::{case, for_jenkins};
pub use text::markdown::summary;
pub use vtu::{plain, vtu};
