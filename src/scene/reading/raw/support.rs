//! Supports.

use std::fmt;

use schemars::JsonSchema;
use serde::de::{Deserialize, Deserializer, MapAccess, SeqAccess, Visitor};

use super::{At, Pair};
use crate::scene::keys::range::RawNumber;

/// A boundary that is held.
#[derive(Debug, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Support")]
pub(in crate::scene) struct RawSupport {
    /// The boundary.
    #[schemars(length(min = 1))]
    pub on: At<String>,
    /// `clamped`: u = displacement. `roller`: one component of u is prescribed, mostly the normal one at zero, and there is no traction across it.
    /// `spring`: traction against the displacement, as strong as `stiffness` says.
    #[serde(rename = "type")]
    #[schemars(extend("enum" = ["clamped", "roller", "spring"]))]
    pub kind: At<String>,
    /// What is prescribed, zero where it is missing: the displacement of a clamped boundary, the component that a roller holds.
    pub displacement: Option<At<RawDisplacement>>,
    /// The component that a roller holds, without traction across it; the outward normal where it is missing.
    #[schemars(with = "Option<[f64; 2]>")]
    pub direction: Option<Pair>,
    /// Force per area and displacement of springs: normal, with the tangential direction free, or both, [normal, tangential].
    pub stiffness: Option<At<RawStiffness>>,
}

/// A number, the normal stiffness of springs, or both components, [normal, tangential].
#[derive(Debug, JsonSchema)]
#[serde(untagged)]
#[schemars(rename = "Stiffness")]
pub(in crate::scene) enum RawStiffness {
    /// Along the normal; the tangential direction is free.
    Normal(#[schemars(extend("exclusiveMinimum" = 0))] f64),
    /// Along the normal and along the boundary, each a number or the two ends of a range.
    Both(#[schemars(with = "[RawNumber; 2]")] Vec<RawNumber>),
}

impl<'de> Deserialize<'de> for RawStiffness {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NumberOrBoth;
        impl<'de> Visitor<'de> for NumberOrBoth {
            type Value = RawStiffness;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a number, the normal stiffness, or [normal, tangential]")
            }
            fn visit_f64<E>(self, number: f64) -> Result<RawStiffness, E> {
                Ok(RawStiffness::Normal(number))
            }
            fn visit_i64<E>(self, number: i64) -> Result<RawStiffness, E> {
                Ok(RawStiffness::Normal(number as f64))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut entries: A) -> Result<RawStiffness, A::Error> {
                let mut both = Vec::new();
                while let Some(entry) = entries.next_element()? {
                    both.push(entry);
                }
                Ok(RawStiffness::Both(both))
            }
        }
        deserializer.deserialize_any(NumberOrBoth)
    }
}

/// A number on rollers; on clamped boundaries a vector, or value + gradient · x.
#[derive(Debug, JsonSchema)]
#[serde(untagged)]
#[schemars(rename = "Displacement")]
pub(in crate::scene) enum RawDisplacement {
    /// One component.
    Component(f64),
    /// The same along the boundary.
    Constant(#[schemars(with = "[f64; 2]")] Vec<f64>),
    /// Affine in x.
    Affine(RawAffine),
}

/// value + gradient · x.
#[derive(Debug, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Affine")]
pub(in crate::scene) struct RawAffine {
    /// The value at the origin, zero where it is missing.
    #[schemars(with = "Option<[f64; 2]>")]
    pub value: Option<Pair>,
    /// Rows of the gradient.
    #[schemars(with = "[[f64; 2]; 2]")]
    pub gradient: At<Vec<Pair>>,
}

impl<'de> Deserialize<'de> for RawDisplacement {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NumberOrVector;
        impl<'de> Visitor<'de> for NumberOrVector {
            type Value = RawDisplacement;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a number for rollers, or [x, y], or { value = [x, y], gradient = [[a, b], [c, d]] }")
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<RawDisplacement, A::Error> {
                RawAffine::deserialize(serde::de::value::MapAccessDeserializer::new(map)).map(RawDisplacement::Affine)
            }
            fn visit_f64<E>(self, number: f64) -> Result<RawDisplacement, E> {
                Ok(RawDisplacement::Component(number))
            }
            fn visit_i64<E>(self, number: i64) -> Result<RawDisplacement, E> {
                Ok(RawDisplacement::Component(number as f64))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut entries: A) -> Result<RawDisplacement, A::Error> {
                let mut vector = Vec::new();
                while let Some(entry) = entries.next_element()? {
                    vector.push(entry);
                }
                Ok(RawDisplacement::Constant(vector))
            }
        }
        deserializer.deserialize_any(NumberOrVector)
    }
}
