//! The ring of the same nodes that textbooks have.

use super::diagnosis::{Right, diagnose};
use crate::workbench::displacement::DisplacementElement;
use crate::workbench::finding::{Fault, Measured, Property};

pub const REFERENCE: Property<DisplacementElement> = Property {
    name: "reference",
    asks: "K is that of the isoparametric ring of the same nodes, P1, P2, Q4, Q8 or Q9, by a rule of as many points as it needs, or more",
    usual: false,
    measure,
};

fn measure(e: &DisplacementElement) -> Result<Measured, Fault> {
    let right = Right::of(e).map_err(Fault::NotMade)?;
    let (value, words) = right.nearest(&e.matrix);
    let sentence = match diagnose(e) {
        None => format!("K is that of the ring of the {words}"),
        Some(diagnosis) => format!("K is not that of the ring of the {}. {}", right.family.words(), diagnosis.sentence),
    };
    Ok(Measured::new(value, e.precision, sentence))
}
