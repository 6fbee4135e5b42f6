//! The computing core of hypercircle: from a scene to its bracket, its quantities, and what a displacement field is held against.
//!
//! Nothing here writes a report, refines a mesh or reads a command line; that is the package `hypercircle`, which has these modules as its own.

pub mod bounds;
pub mod budget;
pub mod compare;
pub mod diagnose;
pub mod dual;
pub mod elasticity;
pub mod element;
mod lanes;
pub mod load;
pub mod mesh;
pub mod optimise;
pub mod primal;
pub mod problem;
pub mod process;
pub mod proof;
pub mod quantity;
pub mod scene;
pub mod sets;
pub mod statics;
pub mod vector;

/// A file of the repository, for tests: they run in the folder of their package or of the repository.
#[cfg(test)]
fn in_repository(path: &str) -> std::path::PathBuf {
    std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)
}
