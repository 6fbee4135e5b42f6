//! The stiffness of springs and elastic layers.

use super::range::{RawNumber, components, ends};
use crate::scene::reading::error::{Fault, SceneError};
use crate::scene::reading::raw::{At, RawContact, RawStiffness, RawSupport, Table};
use crate::scene::reading::source::Source;

const NEGATIVE: (&str, &str) =
    ("a spring stores no energy where its stiffness is negative", "write a stiffness of zero or more");
const NONE: (&str, &str) = (
    "springs without stiffness hold nothing",
    "write a positive stiffness, or leave the boundary without a condition, which makes it free",
);
const SLACK: (&str, &str) = (
    "an elastic layer resists in both directions",
    "write two positive numbers [normal, tangential]; for sides that slide freely write a [[contacts]]",
);

const NO_CONTACT: (&str, &str) = (
    "an elastic contact resists where it is closed",
    "write a positive stiffness, or delete the key: nothing penetrates then",
);

/// The stiffness of a support that is a spring, normal and tangential.
pub(in crate::scene) fn spring(
    raw: &At<Table<RawSupport>>,
    table: &str,
    source: &Source,
) -> Result<[f64; 2], SceneError> {
    let Table(support) = &raw.value;
    let remedy = "delete it: springs act along the normal and along the boundary, against all of the displacement";
    let other = "type = \"spring\"";
    let misplaced = |key| Fault::Misplaced { key, table: table.to_owned(), other, remedy };
    if let Some(displacement) = &support.displacement {
        return Err(source.error(displacement.span(), misplaced("displacement")));
    }
    if let Some(direction) = &support.direction {
        return Err(source.error(direction.span(), misplaced("direction")));
    }
    let Some(stiffness) = &support.stiffness else {
        let remedy = "add stiffness = 1.0e3, force per area and displacement along the normal, or [normal, tangential]";
        let fault = Fault::MissingKey { key: "stiffness".into(), table: table.to_owned(), remedy: remedy.to_owned() };
        return Err(source.error(raw.span(), fault));
    };
    let at = |value: f64| At { value, start: stiffness.start, end: stiffness.end };
    let place = (table, "stiffness");
    let both = match &stiffness.value {
        RawStiffness::Normal(normal) => [source.positive(&at(*normal), place, NONE)?, 0.0],
        RawStiffness::Both(both) => {
            let ends = components(both, stiffness.span(), place, source)?;
            for k in ends.as_flattened().iter().copied() {
                source.number(&at(k), place, |k| k >= 0.0, NEGATIVE)?;
                if k > 0.0 {
                    source.positive(&at(k), place, NONE)?;
                }
            }
            ends.map(|[low, _]| low)
        }
    };
    source.number(&at(both[0].max(both[1])), place, |k| k > 0.0, NONE)?;
    Ok(both)
}

/// The stiffness of an elastic layer, normal and tangential.
pub(in crate::scene) fn layer(
    stiffness: &At<Vec<RawNumber>>,
    table: &str,
    source: &Source,
) -> Result<[f64; 2], SceneError> {
    let ends = components(&stiffness.value, stiffness.span(), (table, "stiffness"), source)?;
    for value in ends.as_flattened().iter().copied() {
        source.positive(&At { value, start: stiffness.start, end: stiffness.end }, (table, "stiffness"), SLACK)?;
    }
    Ok(ends.map(|[low, _]| low))
}

/// The stiffness of an elastic contact, its lower end where it is known as a range.
pub(in crate::scene) fn stiffness_of(
    contact: &RawContact,
    table: &str,
    source: &Source,
) -> Result<Option<f64>, SceneError> {
    let Some(raw) = &contact.stiffness else { return Ok(None) };
    if let Some(direction) = &contact.direction {
        let remedy =
            "delete one of the two: the penetration of an elastic contact is measured along the normal of its sides";
        let (key, table, other) = ("direction", table.to_owned(), "`stiffness`, an elastic contact");
        let fault = Fault::Misplaced { key, table, other, remedy };
        return Err(source.error(direction.span(), fault).with_related(raw.span(), "the stiffness"));
    }
    let (low, high) = ends(raw, (table, "stiffness"), source)?;
    let low = source.positive(&low, (table, "stiffness"), NO_CONTACT)?;
    high.map(|high| source.positive(&high, (table, "stiffness"), NO_CONTACT)).transpose()?;
    Ok(Some(low))
}

/// Refuses a stiffness beside a support that is rigid.
pub(in crate::scene) fn no_stiffness(support: &RawSupport, table: &str, source: &Source) -> Result<(), SceneError> {
    let Some(stiffness) = &support.stiffness else { return Ok(()) };
    let remedy = "delete `stiffness`, or write type = \"spring\"";
    let (table, other) = (table.to_owned(), "a rigid support");
    Err(source.error(stiffness.span(), Fault::Misplaced { key: "stiffness", table, other, remedy }))
}
