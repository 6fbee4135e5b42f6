//! Meshes, polygons, and the boundaries that they leave without a name.

use schemars::JsonSchema;

use super::{At, Pair, Table};

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
