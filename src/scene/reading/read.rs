//! Reading a scene, and the names it uses.

use std::fmt;
use std::fs::File;
use std::io::{ErrorKind, Read};
use std::os::unix::fs::OpenOptionsExt;
use std::path::Path;

use rustix::fs::OFlags;

use super::error::{FileFault, SceneError};
use super::{parse, validate};
use crate::scene::{ContactSides, Extent, MAX_BYTES, Scene, Target};

/// The condition that names a boundary; the index counts from 0 in the list of the scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BoundaryUse {
    /// `supports[i]`.
    Support(usize),
    /// `tractions[i]`.
    Traction(usize),
    /// `contacts[i]`.
    Contact(usize),
    /// `bonds[i]`.
    Bond(usize),
    /// `quantities[i]`.
    Quantity(usize),
}

impl fmt::Display for BoundaryUse {
    /// As scene messages name it: `[[supports]] number 2`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (table, i) = match self {
            BoundaryUse::Support(i) => ("supports", i),
            BoundaryUse::Traction(i) => ("tractions", i),
            BoundaryUse::Contact(i) => ("contacts", i),
            BoundaryUse::Bond(i) => ("bonds", i),
            BoundaryUse::Quantity(i) => ("quantities", i),
        };
        write!(f, "[[{table}]] number {}", i + 1)
    }
}

/// Opens a file to read. A pipe that nobody writes to is empty; it is not waited for.
fn open(path: &Path) -> std::io::Result<File> {
    let file = File::options().read(true).custom_flags(OFlags::NONBLOCK.bits() as i32).open(path)?;
    rustix::fs::fcntl_setfl(&file, OFlags::empty())?;
    Ok(file)
}

impl Scene {
    /// Reads and checks the scene file at `path`.
    ///
    /// # Errors
    /// The file cannot be read, is not TOML, or does not describe a valid scene; the error names the place and the
    /// remedy.
    pub fn read(path: &Path) -> Result<Self, SceneError> {
        let file = |fault| SceneError::file(path, fault);
        let broken = |error: std::io::Error| match error.kind() {
            ErrorKind::NotFound => file(FileFault::Missing),
            ErrorKind::IsADirectory => file(FileFault::Directory),
            _ => file(FileFault::Unreadable(error)),
        };
        let input = open(path).map_err(broken)?;
        if input.metadata().map_err(broken)?.is_dir() {
            return Err(file(FileFault::Directory));
        }
        let mut bytes = Vec::new();
        input.take(MAX_BYTES + 1).read_to_end(&mut bytes).map_err(broken)?;
        if bytes.len() as u64 > MAX_BYTES {
            return Err(file(FileFault::TooLarge));
        }
        match String::from_utf8(bytes) {
            Ok(text) => Self::parse(&text, path),
            Err(error) => {
                let offset = error.utf8_error().valid_up_to();
                let line = error.as_bytes().iter().take(offset).filter(|&&b| b == b'\n').count() + 1;
                Err(file(FileFault::NotText { line, offset }))
            }
        }
    }

    /// Checks the scene in `text`; `path` names it in messages, gives it its name, and its folder is where a relative
    /// mesh path starts.
    ///
    /// # Errors
    /// As [`Scene::read`], without those of the file.
    pub fn parse(text: &str, path: &Path) -> Result<Self, SceneError> {
        validate::validate(parse::parse(text, path)?, text, path)
    }

    /// Every boundary that a condition or a quantity names, in the order of the scene: what a mesh has to provide.
    pub fn boundary_names_used(&self) -> Vec<(String, BoundaryUse)> {
        let supports = self.supports.iter().enumerate().map(|(i, s)| (s.on.clone(), BoundaryUse::Support(i)));
        let tractions = self.tractions.iter().enumerate().map(|(i, t)| (t.on.clone(), BoundaryUse::Traction(i)));
        let contacts = self.contacts.iter().enumerate().flat_map(|(i, contact)| {
            let sides = match &contact.sides {
                ContactSides::Between([first, second]) => vec![first.clone(), second.clone()],
                ContactSides::Rigid(side) => vec![side.clone()],
            };
            sides.into_iter().map(move |side| (side, BoundaryUse::Contact(i)))
        });
        let bonds = self.bonds.iter().enumerate().flat_map(|(i, bond)| {
            let sides = bond.sides.iter().cloned();
            sides.map(move |side| (side, BoundaryUse::Bond(i)))
        });
        let quantities = self.quantities.iter().enumerate().filter_map(|(i, quantity)| match &quantity.target {
            Target::Displacement { of: Extent::Boundary(name), .. } => Some((name.clone(), BoundaryUse::Quantity(i))),
            _ => None,
        });
        supports.chain(tractions).chain(contacts).chain(bonds).chain(quantities).collect()
    }
}
