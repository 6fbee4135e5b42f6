//! The scene file as TOML types: every key, no meaning yet.
//!
//! These structs are the one description of the format: the reader and the JSON Schema both come from them.

use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::{Deserialize, Deserializer, MapAccess, SeqAccess, Visitor};
use toml::Spanned;

use crate::scene::keys::body_force::{RawForce, RawRotation};
use crate::scene::keys::range::RawNumber;
use crate::scene::quantity::RawQuantity;

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

/// A mesh file or several: a physical surface is a body, a physical curve a boundary, both matched by name.
#[derive(Debug, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Mesh", extend("oneOf" = [{"required": ["file"]}, {"required": ["parts"]}]))]
pub(in crate::scene) struct RawMesh {
    /// Path relative to the scene. Gmsh MSH 2.0 to 4.1 and decks of Abaqus and CalculiX are read natively, anything else through meshio.
    #[schemars(length(min = 1))]
    pub file: Option<At<String>>,
    /// Several files in place of `file`.
    #[serde(default)]
    #[schemars(length(min = 1))]
    pub parts: Vec<At<Table<RawPart>>>,
}

/// One of several mesh files.
#[derive(Debug, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "MeshPart")]
pub(in crate::scene) struct RawPart {
    /// Path relative to the scene.
    #[schemars(length(min = 1))]
    pub file: At<String>,
    /// Stands before every name of this file; cells that it leaves without a name are called by the prefix, less a separator at its end.
    pub prefix: Option<At<String>>,
    /// Factor on the coordinates of the file, 1 where it is missing.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub scale: Option<At<f64>>,
    /// Added to the coordinates after scaling, zero where it is missing.
    #[schemars(with = "Option<[f64; 2]>")]
    pub translate: Option<Pair>,
}

/// Polygons to be meshed by the program.
#[derive(Debug, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Geometry")]
pub(in crate::scene) struct RawGeometry {
    /// Target edge length; without it the mesh is the coarsest that represents geometry and data.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub size: Option<At<f64>>,
    /// The polygons; several may belong to one body.
    #[schemars(length(min = 1))]
    pub polygons: At<Vec<At<Table<RawPolygon>>>>,
}

/// A simple polygon.
#[derive(Debug, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Polygon")]
pub(in crate::scene) struct RawPolygon {
    /// The body it belongs to.
    pub body: At<String>,
    /// Corners in either orientation.
    #[schemars(with = "Vec<[f64; 2]>", length(min = 3))]
    pub points: At<Vec<Pair>>,
    /// Name of the edge from corner i to corner i + 1; "" means free and unnamed.
    #[schemars(length(min = 3))]
    pub edges: At<Vec<At<String>>>,
    /// Edges that are arcs of circles; refinement stays on them.
    #[serde(default)]
    pub arcs: Vec<At<Table<RawArc>>>,
}

/// An edge that is an arc of a circle.
#[derive(Debug, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Arc")]
pub(in crate::scene) struct RawArc {
    /// The edge, counted from 0.
    pub edge: At<usize>,
    /// A point of the arc between its ends.
    #[schemars(with = "[f64; 2]")]
    pub through: Pair,
}

/// A homogeneous body: isotropic by `young` and `poisson`, or `orthotropic`, or a matrix, `stiffness` or `compliance`.
#[derive(Debug, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(
    rename = "Body",
    extend("oneOf" = [{"required": ["young", "poisson"]}, {"required": ["orthotropic"]}, {"required": ["stiffness"]},
                      {"required": ["compliance"]}])
)]
pub(in crate::scene) struct RawBody {
    /// Young's modulus, or the two ends [low, high] between which it is known to lie.
    pub young: Option<At<RawNumber>>,
    /// Poisson's ratio.
    #[schemars(with = "Option<f64>", extend("exclusiveMinimum" = -1, "exclusiveMaximum" = 0.5))]
    pub poisson: Option<At<RawNumber>>,
    /// Engineering constants of a body with three planes of symmetry.
    pub orthotropic: Option<At<Table<RawOrthotropic>>>,
    /// Stiffness in the axes of the body: six rows of six in the order 11, 22, 33, 23, 13, 12 with engineering shear strains, or in plane stress three of three for 11, 22, 12.
    #[schemars(with = "Option<Vec<Vec<f64>>>", extend("minItems" = 3, "maxItems" = 6))]
    pub stiffness: Option<At<Vec<Pair>>>,
    /// Compliance, likewise.
    #[schemars(with = "Option<Vec<Vec<f64>>>", extend("minItems" = 3, "maxItems" = 6))]
    pub compliance: Option<At<Vec<Pair>>>,
    /// Degrees from x to axis 1 of the matrix, anticlockwise.
    pub angle: Option<At<f64>>,
    /// Thermal expansion, or three along the axes of the body.
    pub expansion: Option<At<RawExpansion>>,
    /// Temperature above the one without stress: a number, or affine in x.
    pub temperature: Option<At<RawTemperature>>,
    /// Initial stress xx, yy, xy, and a fourth that is out of the plane; rr, zz, rz and tt of a body of revolution.
    #[schemars(with = "Option<Vec<f64>>", extend("minItems" = 3, "maxItems" = 4))]
    pub initial_stress: Option<Pair>,
    /// Force per volume, none where it is missing: the same everywhere, or value + gradient · x.
    pub body_force: Option<At<RawForce>>,
    /// The centrifugal force of a body that turns, beside any other.
    pub rotation: Option<At<Table<RawRotation>>>,
    /// Its cells are those of this physical group of the mesh file, or of this elementary entity where there is no such group.
    pub tag: Option<At<i32>>,
    /// Its cells are those of this set of the mesh file.
    #[schemars(length(min = 1))]
    pub set: Option<At<String>>,
}

/// The same in all directions, or along the axes of the body.
#[derive(Debug, serde::Deserialize, JsonSchema)]
#[serde(untagged, expecting = "a number, or three numbers, one for each axis of the body")]
pub(in crate::scene) enum RawExpansion {
    Isotropic(f64),
    Axes(Vec<f64>),
}

/// The same everywhere, or value + gradient · x.
#[derive(Debug, serde::Deserialize, JsonSchema)]
#[serde(untagged, expecting = "a number, or a table { value = 80.0, gradient = [gx, gy] }")]
pub(in crate::scene) enum RawTemperature {
    Constant(f64),
    Affine(RawAffineTemperature),
}

/// value + gradient · x.
#[derive(Debug, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Temperature")]
pub(in crate::scene) struct RawAffineTemperature {
    /// At the origin of coordinates.
    #[serde(default)]
    pub value: f64,
    /// Along x and y.
    #[schemars(with = "[f64; 2]")]
    pub gradient: Vec<f64>,
}

/// Engineering constants. Axis 3 is out of the plane.
#[derive(Debug, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Orthotropic")]
pub(in crate::scene) struct RawOrthotropic {
    /// E1, E2, E3.
    #[schemars(with = "[f64; 3]")]
    pub young: Pair,
    /// nu12, nu13, nu23: strain along j over strain along i, with the sign turned, under stress along i.
    #[schemars(with = "[f64; 3]")]
    pub poisson: Pair,
    /// G12.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub shear: At<f64>,
    /// Degrees from x to axis 1, anticlockwise.
    pub angle: Option<At<f64>>,
}

/// A name for edges of the outline; tables of one name are one boundary.
#[derive(Debug, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(
    rename = "Boundary",
    extend("oneOf" = [{"required": ["line"]}, {"required": ["box"]}, {"required": ["circle"]}, {"required": ["normal"]},
                      {"required": ["set"]}, {"required": ["tag"]}])
)]
pub(in crate::scene) struct RawBoundary {
    /// The name that conditions use.
    #[schemars(length(min = 1))]
    pub name: At<String>,
    /// The body on whose outline the edges lie.
    pub body: Option<At<String>>,
    /// The edges on this segment.
    #[schemars(with = "Option<[[f64; 2]; 2]>")]
    pub line: Option<At<Vec<Pair>>>,
    /// The edges inside the box with these opposite corners.
    #[serde(rename = "box")]
    #[schemars(with = "Option<[[f64; 2]; 2]>")]
    pub inside: Option<At<Vec<Pair>>>,
    /// The edges whose ends lie on this circle.
    pub circle: Option<At<Table<RawBoundaryCircle>>>,
    /// The edges whose outward normal is within `angle` of this direction.
    #[schemars(with = "Option<[f64; 2]>")]
    pub normal: Option<Pair>,
    /// Degrees, 30 where it is missing.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 180))]
    pub angle: Option<At<f64>>,
    /// The edges of this node, element or surface set of the mesh file.
    #[schemars(length(min = 1))]
    pub set: Option<At<String>>,
    /// The edges of this physical group of the mesh file, or of this elementary entity where there is no such group.
    pub tag: Option<At<i32>>,
}

/// A circle on which edges lie.
#[derive(Debug, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "BoundaryCircle")]
pub(in crate::scene) struct RawBoundaryCircle {
    /// Its centre.
    #[schemars(with = "[f64; 2]")]
    pub centre: Pair,
    /// Its radius.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub radius: At<f64>,
}

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

/// A boundary that is loaded, by `value` (with or without `gradient`) or by `pressure`.
#[derive(Debug, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Traction", extend("oneOf" = [{"required": ["value"]}, {"required": ["pressure"]}]))]
pub(in crate::scene) struct RawTraction {
    /// The boundary.
    #[schemars(length(min = 1))]
    pub on: At<String>,
    /// Traction at the origin.
    #[schemars(with = "Option<[f64; 2]>")]
    pub value: Option<Pair>,
    /// Rows of the constant gradient: P(x) = value + gradient · x.
    #[schemars(with = "Option<[[f64; 2]; 2]>")]
    pub gradient: Option<At<Vec<Pair>>>,
    /// Terms of a polynomial beyond it: P(x, y) = value + gradient · (x, y) + Σ term.value · xⁱ yʲ.
    pub terms: Option<At<Vec<RawTerm>>>,
    /// Pressure along the inward normal.
    pub pressure: Option<At<f64>>,
}

/// A term of a traction: value · xⁱ yʲ.
#[derive(Debug, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Term")]
pub(in crate::scene) struct RawTerm {
    /// i and j, whole numbers that add up to 2 … 6.
    #[schemars(with = "[u8; 2]")]
    pub powers: Pair,
    /// The factor.
    #[schemars(with = "[f64; 2]")]
    pub value: Pair,
}

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
    /// `smooth`, the default: edges that turn by less than 30° stand for a curve. `facets`: every edge has its own normal.
    #[schemars(extend("enum" = ["smooth", "facets"]))]
    pub normals: Option<At<String>>,
    /// The sides need not coincide: they are matched along this direction, the gap is their distance along it plus `gap`,
    /// and contact acts along it.
    #[schemars(with = "Option<[f64; 2]>")]
    pub direction: Option<Pair>,
    /// A rigid obstacle with a place of its own, which the boundary `on` may touch, or overlap at the start.
    pub obstacle: Option<At<Table<RawObstacle>>>,
    /// By how much the obstacle moves.
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

/// JSON Schema of the scene file. What a schema cannot say (names that must exist, one condition per boundary) is
/// left to [`crate::scene::Scene::parse`].
pub fn schema() -> serde_json::Value {
    schemars::schema_for!(RawScene).to_value()
}
