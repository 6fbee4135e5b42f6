//! Contacts, bonds and obstacles.

use std::fmt;

use schemars::JsonSchema;
use serde::de::{Deserialize, Deserializer, SeqAccess, Visitor};

use super::{At, Pair, RawGap, Table, rows_or_ends};
use crate::scene::keys::range::RawNumber;

/// A contact, `between` two boundaries or `on` one against a rigid obstacle.
#[derive(Debug, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Contact", extend("oneOf" = [{"required": ["between"]}, {"required": ["on"]}]))]
pub(in crate::scene) struct RawContact {
    /// Two boundaries that coincide as polylines.
    #[schemars(with = "Option<[String; 2]>")]
    pub between: Option<At<Vec<At<String>>>>,
    /// One boundary that meets a rigid obstacle of its own shape.
    pub on: Option<At<String>>,
    /// Initial gap, zero where it is missing; one number below zero between two sides is an interference fit.
    pub gap: Option<At<RawGap>>,
    /// `smooth`, the default: edges that turn by up to 30° stand for a curve. `facets`: every edge has its own normal.
    #[schemars(extend("enum" = ["smooth", "facets"]))]
    pub normals: Option<At<String>>,
    /// The sides need not coincide: they are matched along this direction, the gap is their distance along it plus `gap`,
    /// and contact acts along it.
    #[schemars(with = "Option<[f64; 2]>")]
    pub direction: Option<Pair>,
    /// A rigid obstacle with a place of its own, which the boundary `on` may touch, or overlap at the start.
    pub obstacle: Option<At<Table<RawObstacle>>>,
    /// By how much the obstacle moves; with friction across itself alone.
    #[serde(rename = "move")]
    #[schemars(with = "Option<[f64; 2]>")]
    pub moved: Option<Pair>,
    /// What resists sliding; nothing where it is missing.
    pub friction: Option<At<Table<RawFriction>>>,
    /// Elastic contact: force per area and penetration beyond the gap, or the two ends of a range; rigid where it is missing.
    #[schemars(with = "Option<RawNumber>")]
    pub stiffness: Option<At<RawNumber>>,
}

/// Friction of a contact: a given `bound` of the tangential traction, or a `coefficient`, Coulomb's, for which theory guarantees less.
#[derive(Debug, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Friction", extend("oneOf" = [{"required": ["bound"]}, {"required": ["coefficient"]}]))]
pub(in crate::scene) struct RawFriction {
    /// The largest tangential traction, wherever the contact has one, whether it is open or closed.
    pub bound: Option<At<RawBound>>,
    /// The largest ratio of tangential to normal traction.
    #[schemars(extend("minimum" = 0))]
    pub coefficient: Option<At<f64>>,
}

/// A number, or the two ends [low, high] between which it is known to lie, or rows [s, bound]: piecewise linear in the arc length s of the first side, as of a gap.
#[derive(Debug, JsonSchema)]
#[serde(untagged)]
#[schemars(rename = "Bound")]
pub(in crate::scene) enum RawBound {
    /// The same everywhere.
    Constant(#[schemars(extend("minimum" = 0))] f64),
    /// The ends of a number that is known as a range, the lower first.
    Range(#[schemars(with = "[f64; 2]")] Vec<f64>),
    /// Rows [s, bound] with s increasing.
    Table(#[schemars(with = "Vec<[f64; 2]>", length(min = 1))] Vec<Pair>),
}

impl<'de> Deserialize<'de> for RawBound {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NumberOrRows;
        impl<'de> Visitor<'de> for NumberOrRows {
            type Value = RawBound;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a number or rows [[s, bound], ...]")
            }
            fn visit_f64<E>(self, number: f64) -> Result<RawBound, E> {
                Ok(RawBound::Constant(number))
            }
            fn visit_i64<E>(self, number: i64) -> Result<RawBound, E> {
                Ok(RawBound::Constant(number as f64))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, rows: A) -> Result<RawBound, A::Error> {
                let (table, ends) = rows_or_ends(rows)?;
                Ok(if ends.is_empty() { RawBound::Table(table) } else { RawBound::Range(ends) })
            }
        }
        deserializer.deserialize_any(NumberOrRows)
    }
}

/// Two boundaries that are glued to each other. Their vertices need not be the same.
#[derive(Debug, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Bond")]
pub(in crate::scene) struct RawBond {
    /// Two boundaries that coincide as polylines, or face each other along `direction`.
    #[schemars(with = "[String; 2]")]
    pub between: At<Vec<At<String>>>,
    /// An elastic layer in place of a rigid bond: force per area and relative displacement, [normal, tangential], each a number or
    /// the two ends of a range.
    #[schemars(with = "Option<[RawNumber; 2]>")]
    pub stiffness: Option<At<Vec<RawNumber>>>,
    /// The sides need not coincide: those of the second that face the first along this direction are moved onto it.
    #[schemars(with = "Option<[f64; 2]>")]
    pub direction: Option<Pair>,
}

/// A rigid obstacle: a straight line or a circle.
#[derive(Debug, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Obstacle", extend("oneOf" = [{"required": ["line"]}, {"required": ["circle"]}]))]
pub(in crate::scene) struct RawObstacle {
    /// Two points of the line, the body on its left.
    #[schemars(with = "Option<[[f64; 2]; 2]>")]
    pub line: Option<At<Vec<Pair>>>,
    /// A circle.
    pub circle: Option<At<Table<RawObstacleCircle>>>,
}

/// A circle and the side on which the body is.
#[derive(Debug, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "ObstacleCircle")]
pub(in crate::scene) struct RawObstacleCircle {
    /// Its centre.
    #[schemars(with = "[f64; 2]")]
    pub centre: Pair,
    /// Its radius.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub radius: At<f64>,
    /// Where the body is, `outside` where it is missing.
    #[schemars(extend("enum" = ["outside", "inside"]))]
    pub side: Option<At<String>>,
}
