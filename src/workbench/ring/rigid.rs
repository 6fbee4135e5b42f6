//! The one rigid motion of a body of revolution, along its axis.

use nalgebra::DMatrix;

use super::shift;
use crate::report::text::number::significant;
use crate::workbench::displacement::{DisplacementElement, spurious};
use crate::workbench::finding::{Fault, Measured, Property};
use crate::workbench::picture;

pub const MOTION: Property<DisplacementElement> = Property {
    name: "rigid-motions",
    asks: "K e = 0: moving the ring along its axis takes no force",
    usual: true,
    measure: |e| {
        let good = "The shift along the axis is annihilated, relative to the largest entry of K";
        Ok(vanishing(e, &e.matrix, [good, "K gives forces for a shift along the axis, relative to its largest entry"]))
    },
};

pub const FORCE: Property<DisplacementElement> = Property {
    name: "self-equilibrium",
    asks: "eᵀ K = 0: the nodal forces of every motion have no resultant along the axis",
    usual: true,
    measure: |e| {
        let good = "Nodal forces balance along the axis, relative to the largest entry of K";
        let bad = "Nodal forces have a resultant along the axis, relative to the largest entry of K";
        Ok(vanishing(e, &e.matrix.transpose(), [good, bad]))
    },
};

pub const RANK: Property<DisplacementElement> = Property {
    name: "rank",
    asks: "only the shift along the axis stores no energy: the rank of K is 2n − 1",
    usual: true,
    measure: rank,
};

/// The forces that K, or its transpose, gives for the shift along the axis.
fn vanishing(e: &DisplacementElement, k: &DMatrix<f64>, [good, bad]: [&str; 2]) -> Measured {
    let value = (k * shift(e.nodes.len())).amax() / e.size();
    Measured::new(value, e.precision, if value <= e.precision { good } else { bad })
}

fn rank(e: &DisplacementElement) -> Result<Measured, Fault> {
    let found = spurious(&e.matrix, &shift(e.nodes.len()), e.precision);
    let count = found.ncols();
    if count == 0 {
        let singular = e.matrix.clone().singular_values();
        let soft = singular.iter().copied().filter(|s| *s > e.precision * singular.max()).fold(f64::INFINITY, f64::min);
        let part = significant(soft / singular.max(), 3);
        let text = format!(
            "Only the shift along the axis stores no energy; the softest other motion stores {part} times the energy of the stiffest."
        );
        return Ok(Measured::count(0, text));
    }
    let plural = if count == 1 { "motion stores" } else { "motions store" };
    let text = format!(
        "{count} spurious {plural} nothing beside the shift along the axis: the rank of K is too low by {count}."
    );
    let panels: Vec<_> = found.column_iter().map(|c| c.into_owned()).collect();
    let drawn = picture::motions("spurious motions", &e.nodes, &e.outline, &panels);
    Ok(Measured::count(count, text).drawn(Some(drawn)))
}
