//! Opening a mesh file with the reader that its name asks for.

use std::path::Path;
use std::time::Duration;

use super::{MeshError, RawMesh, abaqus, foreign, gmsh};
use crate::scene::Note;

/// Reads a mesh file: Gmsh's `.msh` and Abaqus's `.inp` natively, everything else through meshio, which is given at most `limit`.
///
/// # Errors
/// [`MeshError`] when it does not exist, is no regular file, or does not follow its format.
pub fn read(file: &Path, limit: Duration) -> Result<(RawMesh, Vec<Note>), MeshError> {
    let kind = std::fs::metadata(file).map_err(|e| {
        MeshError::file(file, format!("cannot be opened: {e}"), "the path in mesh.file is relative to the scene file")
    })?;
    if kind.is_dir() {
        return Err(MeshError::file(file, "this is a directory", "give the path of the mesh file in it"));
    }
    if !kind.is_file() {
        return Err(MeshError::file(file, "this is not a regular file", "write the mesh into a file"));
    }
    let bytes = || {
        std::fs::read(file).map_err(|e| MeshError::file(file, format!("cannot be read: {e}"), "check its permissions"))
    };
    match file.extension().map(|extension| extension.to_ascii_lowercase()) {
        Some(extension) if extension == "msh" => gmsh::parse(&bytes()?, file),
        Some(extension) if extension == "inp" => abaqus::parse(&bytes()?, file),
        _ => foreign::read(file, limit),
    }
}
