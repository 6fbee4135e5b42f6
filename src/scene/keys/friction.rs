//! Friction of contacts: the largest tangential traction, given along the first side, or as a part of the pressure.

use super::range::ordered;
use super::table::table_of;
use crate::scene::reading::error::{Fault, SceneError};
use crate::scene::reading::raw::{At, RawBound, RawContact};
use crate::scene::reading::source::Source;

/// The bound of the tangential traction of a contact (Tresca): it sticks below, and slides against it.
#[derive(Debug, Clone, PartialEq)]
pub enum FrictionBound {
    /// Uniform along the side.
    Constant(f64),
    /// Piecewise linear: (s, bound) with s ascending, s being the arc length along the first side as in [`crate::scene::Gap::Table`].
    /// Constant beyond the first and the last entry.
    Table(Vec<[f64; 2]>),
}

impl FrictionBound {
    /// The bound at arc length `s`.
    pub fn at(&self, s: f64) -> f64 {
        match self {
            FrictionBound::Constant(bound) => *bound,
            FrictionBound::Table(rows) => super::table::at(rows, s),
        }
    }

    /// The arc lengths at which it bends, and which have to be vertices.
    pub fn breaks(&self) -> Vec<f64> {
        match self {
            FrictionBound::Constant(_) => Vec::new(),
            FrictionBound::Table(rows) => rows.iter().map(|row| row[0]).collect(),
        }
    }

    /// True if nothing resists sliding anywhere.
    pub fn is_none(&self) -> bool {
        match self {
            FrictionBound::Constant(bound) => *bound == 0.0,
            FrictionBound::Table(rows) => rows.iter().all(|row| row[1] == 0.0),
        }
    }
}

const NEGATIVE: (&str, &str) = (
    "a bound of the tangential traction is not negative",
    "write the largest tangential traction that the contact transmits, zero for none",
);

const BACKWARD: (&str, &str) = (
    "a coefficient of friction is not negative",
    "write the largest ratio of tangential to normal traction, zero for none",
);

/// The bound of the friction of a contact, or its coefficient; none of the two where it has no `friction`.
pub(in crate::scene) fn friction(
    contact: &RawContact,
    table: &str,
    source: &Source,
) -> Result<(Option<FrictionBound>, Option<f64>), SceneError> {
    let Some(raw) = &contact.friction else { return Ok((None, None)) };
    let (crate::scene::reading::raw::Table(friction), place) = (&raw.value, format!("friction of {table}"));
    match (&friction.bound, &friction.coefficient) {
        (Some(bound), None) => Ok((Some(bound_of(bound, &place, source)?), None)),
        (None, Some(mu)) => Ok((None, Some(source.number(mu, (&place, "coefficient"), |mu| mu >= 0.0, BACKWARD)?))),
        (bound, coefficient) => {
            let both = bound.is_some() && coefficient.is_some();
            let fault = Fault::OneOf { table: place, first: "`bound`", second: "`coefficient`", both };
            Err(source.error(raw.span(), fault))
        }
    }
}

fn bound_of(bound: &At<RawBound>, place: &str, source: &Source) -> Result<FrictionBound, SceneError> {
    let number = |value: f64| {
        let number = At { value, start: bound.start, end: bound.end };
        source.number(&number, (place, "bound"), |bound| bound >= 0.0, NEGATIVE)
    };
    Ok(match &bound.value {
        RawBound::Constant(value) => FrictionBound::Constant(number(*value)?),
        RawBound::Range(ends) => {
            let ends = ordered(ends, bound.span(), (place, "bound"), source)?;
            for value in ends {
                number(value)?;
            }
            // The end of the lowest energy.
            FrictionBound::Constant(ends[0])
        }
        RawBound::Table(rows) => {
            FrictionBound::Table(table_of(rows, bound.span(), (place, "bound"), NEGATIVE, source)?)
        }
    })
}
