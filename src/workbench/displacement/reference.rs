//! The element of the same nodes that every textbook has.

use super::DisplacementElement;
use crate::workbench::diagnosis::{Reference, diagnose};
use crate::workbench::finding::{Fault, Measured, Property};

pub const REFERENCE: Property<DisplacementElement> = Property {
    name: "reference",
    asks: "K is that of the isoparametric element of the same nodes, P1, P2, Q4, Q8 or Q9",
    usual: false,
    measure,
};

fn measure(e: &DisplacementElement) -> Result<Measured, Fault> {
    let reference = Reference::of(e).map_err(Fault::NotMade)?;
    let value = reference.off(&e.matrix);
    let of = match e.material {
        Some(_) => "",
        None => ", with the material that constant strains show",
    };
    let sentence = match diagnose(e) {
        None => format!("K is that of the {}{of}", reference.words()),
        Some(diagnosis) => {
            format!("K is not that of the {}{of}. {}", reference.words(), diagnosis.sentence)
        }
    };
    Ok(Measured::new(value, e.precision, sentence))
}
