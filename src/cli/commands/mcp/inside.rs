//! Files of the folder that the server was given, which is the current one: nothing else is read.

use std::fs;
use std::path::{Component, Path};

use crate::cli::{CliError, Exit};
use crate::scene::{MeshSource, Scene};

/// Formats of meshes that are one file each, and are read and not run.
const MESHES: [&str; 11] = ["msh", "inp", "vtu", "vtk", "unv", "frd", "bdf", "nas", "fem", "mesh", "su2"];
/// Formats of displacements that are one file each, and are read and not run.
const FIELDS: [&str; 5] = ["vtu", "vtk", "frd", "unv", "msh"];

/// Refuses a scene with a mesh file that lies outside.
///
/// # Errors
/// Names the first such file.
pub fn meshes(scene: &Scene) -> Result<(), CliError> {
    match &scene.mesh {
        MeshSource::File(file) => inside(file, &MESHES),
        MeshSource::Parts(parts) => parts.iter().try_for_each(|part| inside(&part.file, &MESHES)),
        MeshSource::Geometry { .. } => Ok(()),
    }
}

/// Refuses a displacement file that lies outside.
///
/// # Errors
/// Names it.
pub fn field(file: &Path) -> Result<(), CliError> {
    inside(file, &FIELDS)
}

fn inside(file: &Path, formats: &[&str]) -> Result<(), CliError> {
    let refused = |what: &str, remedy: String| {
        // What lies elsewhere is not told from what does not exist.
        let what = format!("{}: {what}", file.display());
        Err(CliError::stopped(Exit::BadInput, what, remedy))
    };
    let stays = file.components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
    let root = Path::new(".").canonicalize();
    let whole = file.canonicalize().ok().filter(|whole| root.is_ok_and(|root| whole.starts_with(root)));
    let Some(whole) = whole.filter(|whole| stays && whole.is_file()) else {
        let remedy = "name a file relative to the folder that the server was given, without `..`";
        return refused("there is no such file in the folder of this server", remedy.into());
    };
    let format = |file: &Path| file.extension().map(|name| name.to_string_lossy().to_lowercase()).unwrap_or_default();
    // A link may have another name than its file.
    if ![file, &whole].iter().all(|file| formats.contains(&format(file).as_str())) {
        return refused("this server does not read this format", format!("write it as one of {}", formats.join(", ")));
    }
    match fs::read(&whole) {
        Ok(bytes) if includes(&bytes) => refused(
            "it has the keyword INCLUDE, and a file may not lead to others here",
            "write one deck without it".into(),
        ),
        _ => Ok(()),
    }
}

/// True if the text may lead to other files: decks of Abaqus and of Nastran have a keyword for that, at the start of a line, whatever their
/// readers take for the end of the one before.
fn includes(text: &[u8]) -> bool {
    const WORD: &str = "INCLUDE";
    let text = String::from_utf8_lossy(text).to_ascii_uppercase();
    let ends_line =
        |c: char| c.is_control() && c != '\t' || matches!(c, '\u{2028}' | '\u{2029}' | char::REPLACEMENT_CHARACTER);
    text.match_indices(WORD).any(|(at, _)| {
        let before = text[..at].trim_end_matches(|c: char| c.is_whitespace() && !ends_line(c));
        before.chars().next_back().is_none_or(|c| c == '*' || ends_line(c))
    })
}

#[cfg(test)]
mod tests {
    use super::includes;

    #[test]
    fn every_spelling_of_include_is_seen() {
        for deck in [
            "*INCLUDE, INPUT=/etc/passwd",
            "*NODE\n1, 0, 0\n  *include,input=a",
            "** \n* \tInclude",
            "*\u{a0}INCLUDE",
            "include",
            "GRID\r\n\t Include 'a'",
        ] {
            assert!(includes(deck.as_bytes()), "{deck}");
        }
        assert!(includes(b"GRID\x85INCLUDE 'a'"), "a line ends there in Latin-1");
        for deck in ["*NODE\n1, 0, 0", "* INCL UDE", "$ bolts, which include nuts", "*", ""] {
            assert!(!includes(deck.as_bytes()), "{deck}");
        }
    }
}
