//! `$ELM` of MSH 1, which is text. Its `$NOD` is `$Nodes` of MSH 2.

use super::cursor::Cursor;
use super::v2;
use crate::mesh::MeshError;
use crate::mesh::files::content::Content;

/// Rows of number, type, physical and elementary entity, number of nodes, and these.
pub(super) fn elements(cursor: &mut Cursor, content: &mut Content) -> Result<(), MeshError> {
    for _ in 0..cursor.size()? {
        let tag = cursor.size()?;
        let number = cursor.int()?;
        let (shape, expected) = v2::shape(cursor, number)?;
        let (physical, entity) = (cursor.entity()?, cursor.entity()?);
        let count = cursor.size()?;
        if count != expected as u64 {
            let what = format!("element {tag} is of type {number}, which has {expected} nodes, and has {count}");
            return Err(cursor.fault(what, "the file is damaged: write it again"));
        }
        let nodes = (0..count).map(|_| cursor.size()).collect::<Result<Vec<_>, _>>()?;
        v2::add(content, shape, tag, nodes, physical, i32::try_from(entity).ok());
    }
    Ok(())
}
