//! Friction of contacts: the largest tangential traction, given along the first side.

use super::range::ordered;
use super::table::table_of;
use crate::scene::reading::error::{Fault, SceneError};
use crate::scene::reading::raw::{At, RawBound, RawContact};
use crate::scene::reading::source::Source;

/// The bound of the tangential traction of a contact (Tresca): it sticks below, and slides against it.
#[derive(Debug, Clone, PartialEq)]
pub enum FrictionBound {
    /// The same everywhere.
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

    /// Whether nothing resists sliding anywhere.
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

/// The bound of the friction of a contact; none where it has no `friction`.
pub(in crate::scene) fn friction(
    contact: &RawContact,
    table: &str,
    source: &Source,
) -> Result<Option<FrictionBound>, SceneError> {
    let Some(raw) = &contact.friction else { return Ok(None) };
    let (crate::scene::reading::raw::Table(friction), place) = (&raw.value, format!("friction of {table}"));
    let bound = match (&friction.bound, &friction.coefficient) {
        (Some(bound), None) => bound,
        (None, Some(coefficient)) => {
            let remedy = "write friction = { bound = … }, the largest tangential traction: with a given bound the energies \
                          have a guaranteed bracket, which Coulomb's law does not have";
            let (key, other) = ("coefficient", "what is solved here: friction with a given bound");
            let fault = Fault::Misplaced { key, table: place, other, remedy };
            return Err(source.error(coefficient.span(), fault));
        }
        (bound, coefficient) => {
            let both = bound.is_some() && coefficient.is_some();
            let fault = Fault::OneOf { table: place, first: "`bound`", second: "`coefficient`", both };
            return Err(source.error(raw.span(), fault));
        }
    };
    let number = |value: f64| {
        let number = At { value, start: bound.start, end: bound.end };
        source.number(&number, (&place, "bound"), |bound| bound >= 0.0, NEGATIVE)
    };
    Ok(Some(match &bound.value {
        RawBound::Constant(value) => FrictionBound::Constant(number(*value)?),
        RawBound::Range(ends) => {
            let ends = ordered(ends, bound.span(), (&place, "bound"), source)?;
            for value in ends {
                number(value)?;
            }
            // The end of the lowest energy.
            FrictionBound::Constant(ends[0])
        }
        RawBound::Table(rows) => {
            FrictionBound::Table(table_of(rows, bound.span(), (&place, "bound"), NEGATIVE, source)?)
        }
    }))
}
