//! How conditioning of K grows with the shape.

use super::{DisplacementElement, nodes_on, shapes};
use crate::report::text::number::significant;
use crate::workbench::finding::{Fault, Measured, Property};
use crate::workbench::picture;

pub const CONDITION: Property<DisplacementElement> = Property {
    name: "conditioning",
    asks: "stretching the element by a lets the condition of K grow no faster than a⁴, as bending of a beam does",
    usual: true,
    measure,
};

const ASPECTS: [f64; 6] = [1.0, 2.0, 5.0, 10.0, 30.0, 100.0];
/// Largest condition number allowed at aspect a, relative to a⁴ times that of the regular shape.
const GROWTH: f64 = 10.0;

fn measure(e: &DisplacementElement) -> Result<Measured, Fault> {
    e.formula()?;
    let (layout, material) = (e.layout()?, e.material()?);
    let regular = shapes::regular(e.outline.corners.len());
    let (mut points, mut rank) = (Vec::new(), 0);
    for aspect in ASPECTS {
        let corners: Vec<[f64; 2]> = regular.iter().map(|[x, y]| [*x, y / aspect]).collect();
        let k = e.stiffness(&nodes_on(&layout, &corners), &material)?;
        let mut values: Vec<f64> = k.singular_values().iter().copied().collect();
        values.sort_by(|a, b| b.total_cmp(a));
        if points.is_empty() {
            rank = values.iter().filter(|v| **v > e.precision * values[0]).count();
        }
        points.push([aspect, values[0] / values[rank - 1].max(f64::MIN_POSITIVE)]);
    }
    let first = points[0][1];
    let value = points.iter().map(|[a, c]| c / (first * a.powi(4))).fold(0.0, f64::max);
    let text = format!(
        "The condition of K off the motions that store nothing is {} on the regular shape and {} stretched 1 : 100; relative to a⁴ it grows by this factor at most",
        significant(first, 3),
        significant(points[points.len() - 1][1], 3)
    );
    let drawn = picture::curves(
        "Condition of K off the motions that store nothing",
        ["aspect ratio", "largest over least eigenvalue"],
        &[(e.name.clone(), points.clone()), ("a⁴".into(), ASPECTS.iter().map(|a| [*a, first * a.powi(4)]).collect())],
    );
    Ok(Measured::new(value, GROWTH, text).drawn(drawn))
}
