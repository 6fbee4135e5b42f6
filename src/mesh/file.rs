//! Opening a mesh file with the reader that its name asks for.

use std::path::Path;
use std::time::Duration;

use super::{MeshError, RawMesh, foreign, gmsh};
use crate::scene::Note;

/// Reads a mesh file: `.msh` natively, everything else through meshio, which is given at most `limit`.
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
    if file.extension().is_some_and(|e| e.eq_ignore_ascii_case("msh")) {
        let bytes = std::fs::read(file)
            .map_err(|e| MeshError::file(file, format!("cannot be read: {e}"), "check its permissions"))?;
        gmsh::parse(&bytes, file)
    } else {
        foreign::read(file, limit)
    }
}
