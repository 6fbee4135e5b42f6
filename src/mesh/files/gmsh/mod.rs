//! Native reader of Gmsh's MSH 1, 2.0 to 2.2, 4.0 and 4.1, text and, but for the first, binary.
//!
//! A physical surface is a body and a physical curve a boundary, by name, or by number where there is no name.

mod cursor;
mod partitions;
#[cfg(test)]
mod tests;
mod v1;
mod v2;
mod v4;

use std::path::Path;

use cursor::{Cursor, Encoding, shortened};
use partitions::Partitions;

use super::content::Content;
use super::{abaqus, encoding};
use crate::mesh::{MeshError, RawMesh};
use crate::scene::Note;

const SAVE_AGAIN: &str = "save it as MSH 4.1 or 2.2 (gmsh -save -format msh41)";

/// Reads the bytes of a `.msh` file; `file` is for messages. CalculiX GraphiX writes decks with this ending too.
///
/// # Errors
/// [`MeshError::Format`] with section and line or byte, or [`MeshError::File`].
pub fn parse(bytes: &[u8], file: &Path) -> Result<(RawMesh, Vec<Note>), MeshError> {
    if bytes.iter().all(u8::is_ascii_whitespace) {
        return Err(MeshError::file(file, "the file is empty", SAVE_AGAIN));
    }
    let bytes = encoding::text(bytes)
        .map_err(|found| MeshError::file(file, format!("the file is {found}"), encoding::SAVE_AS_UTF8))?;
    let bytes = &*encoding::with_line_feeds(bytes);
    if abaqus::is_deck(bytes) {
        return abaqus::parse(bytes, file);
    }
    let mut cursor = Cursor::new(bytes, file);
    let mut content = Content::default();
    let version = header(&mut cursor)?;
    let end = if version == Version::V1 { "$END" } else { "$End" };
    let mut partitions = Partitions::default();
    let (mut nodes, mut elements) = (false, false);
    while let Some(line) = cursor.full_line() {
        let Some(section) = line.strip_prefix('$') else {
            let what = format!("found '{}' between sections", shortened(&line));
            return Err(cursor.fault(what, "the file is damaged: write it again"));
        };
        cursor.section = format!("${section}");
        match (section, version) {
            ("PhysicalNames", _) => cursor.in_text(|cursor| physical_names(cursor, &mut content))?,
            ("Entities", Version::V4(minor)) => v4::entities(&mut cursor, &mut content, minor)?,
            ("PartitionedEntities", Version::V4(minor)) => {
                partitions.extend(partitions::entities(&mut cursor, &mut content, minor)?);
            }
            ("NOD" | "ELM", Version::V1) | ("Nodes" | "Elements", Version::V2 | Version::V4(_)) => {
                let of_nodes = matches!(section, "NOD" | "Nodes");
                let repeated = std::mem::replace(if of_nodes { &mut nodes } else { &mut elements }, true);
                if repeated {
                    return Err(cursor.fault("the section is there twice", "keep one of them"));
                }
                match (section, version) {
                    ("ELM", _) => v1::elements(&mut cursor, &mut content)?,
                    ("NOD", _) | ("Nodes", Version::V1 | Version::V2) => v2::nodes(&mut cursor, &mut content)?,
                    ("Nodes", Version::V4(minor)) => v4::nodes(&mut cursor, &mut content, minor)?,
                    (_, Version::V1 | Version::V2) => v2::elements(&mut cursor, &mut content)?,
                    (_, Version::V4(minor)) => v4::elements(&mut cursor, &mut content, minor, &mut partitions)?,
                }
            }
            // $Periodic, $NodeData, comments and the like.
            _ => {
                cursor.skip_past(&format!("{end}{section}"))?;
                continue;
            }
        }
        cursor.expect(&format!("{end}{section}"))?;
    }
    let sections = if version == Version::V1 { ["$NOD", "$ELM"] } else { ["$Nodes", "$Elements"] };
    for (found, name) in [nodes, elements].into_iter().zip(sections) {
        if !found {
            return Err(MeshError::file(
                file,
                format!("the section {name} is missing"),
                "the file is truncated, or holds no mesh: write it again",
            ));
        }
    }
    partitions::whole(&partitions, file)?;
    content.into_raw(file)
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Version {
    V1,
    V2,
    V4(Minor),
}

/// Versions 4.0 and 4.1 order the same numbers differently, and have other widths for them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Minor {
    Zero,
    One,
}

/// Reads up to `$EndMeshFormat`, which version 1 does not have; sets the encoding.
fn header(cursor: &mut Cursor) -> Result<Version, MeshError> {
    loop {
        match cursor.full_line().as_deref() {
            Some("$MeshFormat") => break,
            Some("$Comments") => cursor.skip_past("$EndComments")?,
            Some("$NOD") => {
                cursor.back();
                return Ok(Version::V1);
            }
            Some(other) => {
                let what = format!("found '{}' where $MeshFormat should be: this is no Gmsh file", shortened(other));
                return Err(cursor.fault(what, SAVE_AGAIN));
            }
            None => return Err(cursor.fault("the file holds no mesh", SAVE_AGAIN)),
        }
    }
    cursor.section = "$MeshFormat".into();
    let line = cursor.full_line().unwrap_or_default();
    let words: Vec<&str> = line.split_whitespace().collect();
    let (version, binary, size) = match words.as_slice() {
        ["2" | "2.0" | "2.1" | "2.2", binary @ ("0" | "1"), size] => (Version::V2, *binary, *size),
        ["4" | "4.0", binary @ ("0" | "1"), size] => (Version::V4(Minor::Zero), *binary, *size),
        ["4.1", binary @ ("0" | "1"), size] => (Version::V4(Minor::One), *binary, *size),
        [version, ..] if version.parse::<f64>().is_ok() && !version.starts_with('2') && !version.starts_with('4') => {
            return Err(cursor.fault(format!("this is MSH version {version}"), SAVE_AGAIN));
        }
        _ => {
            let what = format!("found '{}' where version, file type and data size should be", shortened(&line));
            return Err(cursor.fault(what, SAVE_AGAIN));
        }
    };
    cursor.size_bytes = match size {
        "8" => 8,
        "4" if version == Version::V4(Minor::One) => 4,
        _ => return Err(cursor.fault(format!("the data size is '{}'", shortened(size)), SAVE_AGAIN)),
    };
    if binary == "1" {
        cursor.encoding = Encoding::Little;
        cursor.encoding = match cursor.int()? {
            1 => Encoding::Little,
            one if one.swap_bytes() == 1 => Encoding::Big,
            other => {
                let what = format!("the byte order mark is {other}, not 1 in either byte order");
                return Err(cursor.fault(what, "the file was changed as if it were text: write it again"));
            }
        };
    }
    cursor.expect("$EndMeshFormat")?;
    Ok(version)
}

/// Lines of dimension, number and quoted name.
fn physical_names(cursor: &mut Cursor, content: &mut Content) -> Result<(), MeshError> {
    let count = cursor.size()?;
    cursor.line();
    for _ in 0..count {
        let line = cursor.full_line().unwrap_or_default();
        let mut words = line.splitn(3, char::is_whitespace);
        let dimension = words.next().and_then(|w| w.parse::<i32>().ok());
        let tag = words.next().and_then(|w| w.parse::<i64>().ok());
        let name = words.next().and_then(|w| w.trim().strip_prefix('"')?.strip_suffix('"'));
        let (Some(dimension), Some(tag), Some(name)) = (dimension, tag, name) else {
            let what = format!("found '{}' where dimension, number and \"name\" should be", shortened(&line));
            return Err(cursor.fault(what, "the file is truncated or damaged: write it again"));
        };
        let tag = content.tag(tag);
        content.names.insert((dimension, tag), name.to_string());
    }
    Ok(())
}

fn add_node(cursor: &Cursor, content: &mut Content, tag: u64, point: [f64; 3]) -> Result<(), MeshError> {
    if !point.iter().all(|x| x.is_finite()) {
        let what = format!("node {tag} has a coordinate that is not finite");
        return Err(cursor.fault(what, "write the mesh again"));
    }
    if content.nodes.insert(tag, point).is_some() {
        return Err(cursor.fault(format!("node {tag} is there twice"), "renumber the nodes and write the mesh again"));
    }
    Ok(())
}
