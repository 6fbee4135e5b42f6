//! Nodes between corners that are not where straight sides have them.

use super::places::tolerance_of;
use super::{FieldError, ForeignField};
use crate::problem::Note;
use crate::vector::distance;

/// Part of its side by which a node between two corners may be beside the middle.
const FARTHEST: f64 = 0.25;

/// Nodes beside the places that straight sides have them at.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Curved {
    /// The largest distance; zero where all are there.
    pub off: f64,
    /// The length of that side.
    pub length: f64,
}

impl Curved {
    /// Counts a node at `point`, which a side of this length would have at `straight`.
    ///
    /// # Errors
    /// It is so far away that the nodes of the cell are in another order.
    pub fn note(
        &mut self,
        field: &ForeignField,
        point: [f64; 2],
        straight: [f64; 2],
        length: f64,
    ) -> Result<(), FieldError> {
        let off = distance(point, straight);
        if off > FARTHEST * length {
            let what = format!(
                "the node ({}, {}) is far from the middle of the two corners that it should be between",
                point[0], point[1]
            );
            let remedy = "write the nodes of a cell in the order of VTK: corners, the middles of the sides from corner to corner, centre";
            return Err(field.fault(what, remedy));
        }
        if off > self.off.max(tolerance_of(field, length)) {
            (self.off, self.length) = (off, length);
        }
        Ok(())
    }

    /// The remark on the field of this name.
    pub fn told(&self, name: &str) -> Note {
        let text = format!(
            "Mid-nodes of {name} are not where straight sides have them, up to {:.2e} off ({:.2} % of the side). The values were taken over \
         node by node on straight sides: the bounds are those of that field.",
            self.off,
            100.0 * self.off / self.length
        );
        Note { weakens_guarantee: true, text }
    }
}
