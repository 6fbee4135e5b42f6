//! Gaps of contacts.

use std::fmt;

use schemars::JsonSchema;
use serde::de::{Deserialize, Deserializer, MapAccess, SeqAccess, Visitor};

use super::{Pair, rows_or_ends};

/// A number, or the two ends [low, high] between which it is known to lie, or rows [s, g]: piecewise linear in the arc length s from the end of the first side that comes first in
/// (x, y) order, all around a body anticlockwise from its first vertex in that order; or a circle or parabola of a radius that touches at an s.
#[derive(Debug, JsonSchema)]
#[serde(untagged)]
#[schemars(rename = "Gap")]
pub(in crate::scene) enum RawGap {
    /// The same everywhere.
    Constant(f64),
    /// The ends of a number that is known as a range, the lower first.
    Range(#[schemars(with = "[f64; 2]")] Vec<f64>),
    /// Rows [s, g] with s increasing.
    Table(#[schemars(with = "Vec<[f64; 2]>", length(min = 1))] Vec<Pair>),
    /// A curve that touches the side at one point.
    Curve(RawCurve),
}

/// The distance of a curve, between vertices too; a circle goes on as its tangent from 45° on.
#[derive(Debug, Clone, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "GapCurve", extend("oneOf" = [{"required": ["circle"]}, {"required": ["parabola"]}]))]
pub(in crate::scene) struct RawCurve {
    /// Radius of a circle.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub circle: Option<f64>,
    /// Radius of curvature of a parabola at its vertex.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub parabola: Option<f64>,
    /// Arc length at which it touches.
    #[schemars(range(min = 0))]
    pub at: f64,
}

impl<'de> Deserialize<'de> for RawGap {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NumberOrRows;
        impl<'de> Visitor<'de> for NumberOrRows {
            type Value = RawGap;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a number or rows [[s, g], ...], or { circle = R, at = s }")
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<RawGap, A::Error> {
                RawCurve::deserialize(serde::de::value::MapAccessDeserializer::new(map)).map(RawGap::Curve)
            }
            fn visit_f64<E>(self, number: f64) -> Result<RawGap, E> {
                Ok(RawGap::Constant(number))
            }
            fn visit_i64<E>(self, number: i64) -> Result<RawGap, E> {
                Ok(RawGap::Constant(number as f64))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, rows: A) -> Result<RawGap, A::Error> {
                let (table, ends) = rows_or_ends(rows)?;
                Ok(if ends.is_empty() { RawGap::Table(table) } else { RawGap::Range(ends) })
            }
        }
        deserializer.deserialize_any(NumberOrRows)
    }
}
