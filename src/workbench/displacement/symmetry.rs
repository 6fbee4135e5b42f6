//! K = Kᵀ, as the work of nodal forces asks.

use super::DisplacementElement;
use crate::workbench::finding::{Fault, Measured, Property};

pub const SYMMETRY: Property<DisplacementElement> = Property {
    name: "symmetry",
    asks: "K = Kᵀ: the work that one motion does on the forces of another is mutual",
    usual: true,
    measure,
};

fn measure(e: &DisplacementElement) -> Result<Measured, Fault> {
    let off = (&e.matrix - e.matrix.transpose()).abs();
    let rows = off.nrows();
    let at = (0..off.len()).max_by(|&a, &b| off[a].total_cmp(&off[b])).unwrap_or(0);
    let value = off[at] / e.size();
    // The matrix is read column by column: the first of a pair lies below the diagonal.
    let (i, j) = ((at % rows).min(at / rows), (at % rows).max(at / rows));
    let sentence = if value <= e.precision {
        "K is symmetric, relative to its largest entry".to_string()
    } else {
        format!("K is not symmetric: entries ({i}, {j}) and ({j}, {i}) differ most, relative to the largest entry")
    };
    Ok(Measured::new(value, e.precision, sentence))
}
