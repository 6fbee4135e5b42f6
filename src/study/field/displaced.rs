//! Files whose points are where the displacement takes them, as Elmer and some converters write.

use super::matching::{self, Matched};
use super::{FieldError, ForeignField};
use crate::problem::{Note, Problem};

/// Brings `field` onto the mesh of `problem`, from where its points are or, where only that fits, from where they were before they were displaced.
pub(super) fn onto(field: &ForeignField, problem: &Problem) -> Result<(Matched, Option<Note>), FieldError> {
    let error = match matching::onto(field, problem) {
        Ok(matched) => return Ok((matched, None)),
        Err(error) => error,
    };
    let Some(matched) = moved_back(field).and_then(|back| matching::onto(&back, problem).ok()) else {
        return Err(error);
    };
    let text = format!(
        "The points of {} are displaced: less the displacement they are the vertices of the scene's mesh, from where they were taken.",
        field.name()
    );
    Ok((matched, Some(Note { weakens_guarantee: false, text })))
}

/// The field with its points less the displacement; none where a point has no displacement.
fn moved_back(field: &ForeignField) -> Option<ForeignField> {
    let mut back = field.clone();
    for (point, value) in back.points.iter_mut().zip(&field.values) {
        let u = (*value)?;
        *point = [point[0] - u[0], point[1] - u[1]];
    }
    Some(back)
}
