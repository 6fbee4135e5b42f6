//! What a run leaves behind, all derived from one [`Dossier`].
//!
//! [`write()`] makes the files; each of them is also a function here, from data to text, that knows nothing of files.

mod csv;
mod data;
mod deflate;
pub(crate) mod document;
pub mod figure;
pub mod folder;
mod guarantee;
mod html;
pub mod inventory;
mod json;
mod junit;
mod lattice;
pub(crate) mod markdown;
pub(crate) mod number;
mod quantities_csv;
mod quantity;
mod run;
#[cfg(test)]
mod sample;
#[cfg(test)]
mod sample_numbers;
mod stored;
mod vtu;
pub(crate) mod words;
mod write;

pub use csv::{tables, tables_of};
pub use data::*;
pub(crate) use html::CSS;
pub use html::page;
pub use json::{json, schema};
pub use junit::junit;
pub(crate) use junit::{case, for_jenkins};
pub use markdown::summary;
pub use run::run_of;
pub use stored::*;
pub use vtu::{plain, vtu};
pub use write::{NAMES, ReportError, write};
