//! The scene file as TOML types: every key, no meaning yet.
//!
//! These structs are the one description of the format: the reader and the JSON Schema both come from them.

mod body;
mod contact;
mod gap;
mod geometry;
mod load;
mod support;

use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::{Deserialize, Deserializer, MapAccess, SeqAccess, Visitor};
use toml::Spanned;

use crate::scene::keys::range::RawNumber;
use crate::scene::quantity::RawQuantity;
pub(in crate::scene) use body::*;
pub(in crate::scene) use contact::*;
pub(in crate::scene) use gap::*;
pub(in crate::scene) use geometry::*;
pub(in crate::scene) use load::*;
pub(in crate::scene) use support::*;

/// A value and where it stands in the file.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::scene) struct At<T> {
    pub value: T,
    pub start: usize,
    pub end: usize,
}

impl<T> At<T> {
    pub fn span(&self) -> Range<usize> {
        self.start..self.end
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for At<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let spanned = Spanned::<T>::deserialize(deserializer)?;
        let Range { start, end } = spanned.span();
        Ok(At { value: spanned.into_inner(), start, end })
    }
}

/// A TOML table; serde alone would also take the fields in order from a list.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::scene) struct Table<T>(pub T);

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Table<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct OnlyMap<T>(std::marker::PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for OnlyMap<T> {
            type Value = Table<T>;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a table")
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Table<T>, A::Error> {
                T::deserialize(serde::de::value::MapAccessDeserializer::new(map)).map(Table)
            }
        }
        deserializer.deserialize_map(OnlyMap(std::marker::PhantomData))
    }
}

macro_rules! schema_of_content {
    ($wrapper:ident) => {
        impl<T: JsonSchema> JsonSchema for $wrapper<T> {
            fn inline_schema() -> bool {
                T::inline_schema()
            }
            fn schema_name() -> std::borrow::Cow<'static, str> {
                T::schema_name()
            }
            fn schema_id() -> std::borrow::Cow<'static, str> {
                T::schema_id()
            }
            fn json_schema(generator: &mut SchemaGenerator) -> Schema {
                T::json_schema(generator)
            }
        }
    };
}
schema_of_content!(At);
schema_of_content!(Table);

/// A list of numbers, whose length is checked later; in the schema it has two.
pub(in crate::scene) type Pair = At<Vec<f64>>;

/// A scene of hypercircle: bodies, their conditions, and where the triangles come from.
#[derive(Debug, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Scene", extend("oneOf" = [{"required": ["mesh"]}, {"required": ["geometry"]}]))]
pub(in crate::scene) struct RawScene {
    /// A title for the report; the file name where it is missing.
    pub title: Option<String>,
    /// The mechanical model.
    pub model: At<Table<RawModel>>,
    /// A mesh file. Either this or `geometry`.
    pub mesh: Option<At<Table<RawMesh>>>,
    /// Polygons to be meshed by the program. Either this or `mesh`.
    pub geometry: Option<At<Table<RawGeometry>>>,
    /// One table per body, by its name.
    #[schemars(extend("minProperties" = 1))]
    pub bodies: BTreeMap<At<String>, At<Table<RawBody>>>,
    /// Names for parts of the outline that the mesh leaves without.
    #[serde(default)]
    pub boundaries: Vec<At<Table<RawBoundary>>>,
    /// Boundaries that are held.
    #[serde(default)]
    pub supports: Vec<At<Table<RawSupport>>>,
    /// Boundaries that are loaded.
    #[serde(default)]
    pub tractions: Vec<At<Table<RawTraction>>>,
    /// Boundaries that may touch.
    #[serde(default)]
    pub contacts: Vec<At<Table<RawContact>>>,
    /// Boundaries that are glued to each other.
    #[serde(default)]
    pub bonds: Vec<At<Table<RawBond>>>,
    /// What the scene is solved for.
    #[serde(default)]
    pub quantities: Vec<At<Table<RawQuantity>>>,
}

/// The mechanical model.
#[derive(Debug, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Model")]
pub(in crate::scene) struct RawModel {
    /// Plane strain, plane stress, or a body of revolution with points (r, z).
    #[schemars(extend("enum" = ["plane-strain", "plane-stress", "axisymmetric"]))]
    pub kinematics: At<String>,
    /// Thickness of the plate, 1 where it is missing; a body of revolution has none.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub thickness: Option<At<f64>>,
}

/// JSON Schema of the scene file. What a schema cannot say (names that must exist, one condition per boundary) is
/// left to [`crate::scene::Scene::parse`].
pub fn schema() -> serde_json::Value {
    schemars::schema_for!(RawScene).to_value()
}

/// The entries of a list, all of them rows of two numbers or all of them the ends of a range.
fn rows_or_ends<'de, A: SeqAccess<'de>>(mut rows: A) -> Result<(Vec<Pair>, Vec<f64>), A::Error> {
    let (mut table, mut ends) = (Vec::new(), Vec::new());
    while let Some(entry) = rows.next_element::<At<RawNumber>>()? {
        match entry.value {
            RawNumber::One(end) if table.is_empty() => ends.push(end),
            RawNumber::Range(value) if ends.is_empty() => {
                table.push(At { value, start: entry.start, end: entry.end });
            }
            _ => return Err(serde::de::Error::custom("rows of two numbers and numbers in one list")),
        }
    }
    Ok((table, ends))
}
