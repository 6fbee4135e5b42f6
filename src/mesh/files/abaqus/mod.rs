//! Reader of the mesh in decks of Abaqus and CalculiX: nodes, plane elements, sets and surfaces, with included files, parts
//! and instances.
//!
//! The lines of a deck become keywords ([`deck`]), these the scopes of parts, instances and assembly ([`reader`]). Once all
//! are read, instances get their numbers ([`assembly`]), sets and surfaces their members ([`resolve`]), and all of it is put together
//! ([`content`]).

mod assembly;
mod content;
mod deck;
mod element;
mod elements;
mod keyword;
mod names;
mod reader;
mod remarks;
mod resolve;
mod scope;
mod side;
mod surfaces;
#[cfg(test)]
mod tests;

use std::path::Path;

use element::{Family, family};
use keyword::Keyword;
use reader::Reader;

use super::content::Kind;
use crate::mesh::{MeshError, RawMesh};
use crate::scene::Note;

const DAMAGED: &str = "correct the deck, or export the mesh again";

/// Reads the deck in `text`; `file` is for messages, and included files start in its folder.
///
/// # Errors
/// [`MeshError::Format`] with the line, or [`MeshError::File`].
pub(in crate::mesh) fn parse(text: &[u8], file: &Path) -> Result<(RawMesh, Vec<Note>), MeshError> {
    let deck = deck::read(text, file)?;
    let is_cell = |keyword: &Keyword| match keyword.parameter("TYPE").map(family) {
        Some(Family::Plane(kind, _)) => kind != Kind::Line,
        Some(Family::Shell(..) | Family::Space) => true,
        _ => false,
    };
    let all_rigid = !deck.iter().any(|keyword| keyword.name == "ELEMENT" && is_cell(keyword));
    let mut reader = Reader::new(all_rigid);
    for keyword in deck {
        reader.take(&keyword)?;
    }
    reader.closed()?;
    let Reader { instances, assembly, name, mut remarks, made_for, .. } = reader;
    let scopes = assembly::assembled(instances, assembly, &name, &mut remarks)?;
    let content = content::content(scopes, file, &mut remarks)?;
    let (mut raw, mut notes) = content.into_raw(file)?;
    raw.sets.made_for = made_for;
    notes.extend(remarks.notes());
    Ok((raw, notes))
}

/// True if a file of another ending is a deck: it begins with a keyword or a comment of one.
pub(in crate::mesh::files) fn is_deck(text: &[u8]) -> bool {
    let mut rest = text.trim_ascii_start().iter();
    rest.next() == Some(&b'*') && rest.next().is_some_and(|c| *c == b'*' || c.is_ascii_alphabetic())
}
