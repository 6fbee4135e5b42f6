//! Opening a mesh file with the reader that its name asks for.

use std::borrow::Cow;
use std::io::Read;
use std::path::Path;
use std::time::Duration;

use flate2::read::MultiGzDecoder;

use super::{abaqus, encoding, foreign, gmsh};
use crate::mesh::{MeshError, RawMesh};
use crate::scene::Note;

/// Reads a mesh file: Gmsh's `.msh` and Abaqus's `.inp` natively, everything else in a Python process, which is given at most `limit`.
///
/// # Errors
/// [`MeshError`] when it does not exist, is no regular file, or does not follow its format.
pub fn read(file: &Path, limit: Duration) -> Result<(RawMesh, Vec<Note>), MeshError> {
    let kind = std::fs::metadata(file).map_err(|e| {
        MeshError::file(file, format!("cannot be opened: {e}"), "the path in mesh.file is relative to the scene file")
    })?;
    if kind.is_dir() && file.join("mesh.nodes").is_file() {
        return foreign::read(file, limit);
    }
    if kind.is_dir() {
        return Err(MeshError::file(file, "this is a directory", "give the path of the mesh file in it"));
    }
    if !kind.is_file() {
        return Err(MeshError::file(file, "this is not a regular file", "write the mesh into a file"));
    }
    let bytes = || content(file);
    match encoding::unpacked_name(file).extension().map(|extension| extension.to_ascii_lowercase()) {
        Some(extension) if extension == "msh" => match bytes()? {
            text if others(&text) => foreign::read(file, limit),
            text => gmsh::parse(&text, file),
        },
        Some(extension) if extension == "inp" => match bytes()? {
            text if is_avs(&text) || is_ansys(&text) => foreign::read(file, limit),
            text => abaqus::parse(&text, file),
        },
        _ => foreign::read(file, limit),
    }
}

/// Bytes of a file that was packed: more are no mesh that anything here could solve, and may fill the memory.
const MOST_UNPACKED: u64 = 1 << 30;

/// The bytes of a file, unpacked where it is packed with gzip.
fn content(file: &Path) -> Result<Vec<u8>, MeshError> {
    let fault = |what: String, remedy: &str| MeshError::file(file, what, remedy);
    let bytes = std::fs::read(file).map_err(|e| fault(format!("cannot be read: {e}"), "check its permissions"))?;
    if encoding::unpacked_name(file) == file {
        return Ok(bytes);
    }
    let mut unpacked = Vec::new();
    let read = MultiGzDecoder::new(&*bytes).take(MOST_UNPACKED + 1).read_to_end(&mut unpacked);
    let length = read.map_err(|e| {
        fault(format!("cannot be unpacked with gzip: {e}"), "pack it again, or give the file that was packed")
    })?;
    if length as u64 > MOST_UNPACKED {
        return Err(fault("is longer than 1 GiB when it is unpacked".to_string(), "give a smaller mesh"));
    }
    Ok(unpacked)
}

/// True if a `.msh` file is not Gmsh's: FreeFEM's begins with three counts, GiD's with `MESH`, GetFEM's with a comment, and Fluent's with a bracket.
fn others(text: &[u8]) -> bool {
    let head = head(text);
    let first = first(&head);
    is_counts(first, 3)
        || first.starts_with('(')
        || first.to_ascii_lowercase().starts_with("mesh ")
        || head.contains("BEGIN POINTS LIST")
}

/// True if an `.inp` file is AVS's: it begins with five counts.
fn is_avs(text: &[u8]) -> bool {
    is_counts(first(&head(text)), 5)
}

/// True if an `.inp` file is Ansys's: it enters its preprocessor.
fn is_ansys(text: &[u8]) -> bool {
    let begins = |line: &str| ["/prep7", "/batch", "/com"].iter().any(|word| line.starts_with(word));
    head(text).lines().any(|line| begins(&line.trim_start().to_ascii_lowercase()))
}

/// The beginning of a text, far enough to tell its format.
fn head(text: &[u8]) -> Cow<'_, str> {
    String::from_utf8_lossy(&text[..text.len().min(4000)])
}

/// The first line that is neither empty nor a comment.
fn first(head: &str) -> &str {
    head.lines().map(str::trim).find(|line| !line.is_empty() && !line.starts_with('#')).unwrap_or_default()
}

/// True if a line is so many counts.
fn is_counts(line: &str, count: usize) -> bool {
    let words: Vec<&str> = line.split_whitespace().collect();
    words.len() == count && words.iter().all(|word| word.parse::<usize>().is_ok())
}
