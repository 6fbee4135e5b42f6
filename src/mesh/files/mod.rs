//! Mesh files: opened by the reader that their name asks for, and made one mesh.

pub(super) mod abaqus;
pub(super) mod content;
mod encoding;
pub(super) mod file;
pub mod foreign;
pub mod gmsh;
pub mod meshio;
pub(super) mod parts;
pub mod plane;
