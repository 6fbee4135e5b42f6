//! Bodies and their materials.

use schemars::JsonSchema;

use super::{At, Pair, Table};
use crate::scene::keys::body_force::RawForce;
use crate::scene::keys::body_force::RawRotation;
use crate::scene::keys::range::RawNumber;

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
