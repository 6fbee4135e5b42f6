//! What a run leaves behind, all derived from one [`Dossier`].

mod data;

pub use data::*;
