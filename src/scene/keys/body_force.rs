//! The force on a body as the scene file gives it: a vector, an affine field, a rotation.

use std::fmt;

use schemars::JsonSchema;
use serde::de::{Deserialize, Deserializer, MapAccess, SeqAccess, Visitor};

use super::conditions::affine;
use crate::load::{BodyForce, Rotation};
use crate::scene::Kinematics;
use crate::scene::reading::error::SceneError;
use crate::scene::reading::fault::Fault;
use crate::scene::reading::raw::{At, Pair, RawAffine, RawBody, Table};
use crate::scene::reading::source::{LARGEST, OVERFLOWS, Source};

/// A vector, or value + gradient · x.
#[derive(Debug, JsonSchema)]
#[serde(untagged)]
#[schemars(rename = "BodyForce")]
pub(in crate::scene) enum RawForce {
    /// The same everywhere.
    Constant(#[schemars(with = "[f64; 2]")] Vec<f64>),
    /// Affine in x.
    Affine(RawAffine),
}

/// A body that turns: ϱω²(x − about) acts on it, per volume.
#[derive(Debug, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Rotation")]
pub(in crate::scene) struct RawRotation {
    /// Mass per volume.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub density: At<f64>,
    /// Angular velocity, in radians per time.
    pub omega: At<f64>,
    /// The point that stays at rest, the origin where it is missing; a body of revolution turns about its axis.
    #[schemars(with = "Option<[f64; 2]>")]
    pub about: Option<Pair>,
}

impl<'de> Deserialize<'de> for RawForce {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct VectorOrField;
        impl<'de> Visitor<'de> for VectorOrField {
            type Value = RawForce;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a list [x, y], or { value = [x, y], gradient = [[a, b], [c, d]] }")
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<RawForce, A::Error> {
                RawAffine::deserialize(serde::de::value::MapAccessDeserializer::new(map)).map(RawForce::Affine)
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut entries: A) -> Result<RawForce, A::Error> {
                let mut vector = Vec::new();
                while let Some(entry) = entries.next_element()? {
                    vector.push(entry);
                }
                Ok(RawForce::Constant(vector))
            }
        }
        deserializer.deserialize_any(VectorOrField)
    }
}

/// All that acts on a body, whose table is `label`.
pub(in crate::scene) fn body_force(
    raw: &RawBody,
    label: &str,
    kinematics: Kinematics,
    source: &Source,
) -> Result<BodyForce, SceneError> {
    let force = match &raw.body_force {
        None => BodyForce::NONE,
        Some(At { value: RawForce::Constant(vector), start, end }) => {
            let vector = At { value: vector.clone(), start: *start, end: *end };
            BodyForce::constant(source.vector(&vector, (label, "body_force"))?)
        }
        Some(At { value: RawForce::Affine(field), .. }) => {
            BodyForce::affine(affine(field, (label, "body_force"), source)?)
        }
    };
    let Some(At { value: Table(rotation), .. }) = &raw.rotation else { return Ok(force) };
    let label = format!("the rotation of {label}");
    let words = ("a density must be positive", "write the mass per volume, in units that go with those of `omega`");
    let density = source.positive(&rotation.density, (&label, "density"), words)?;
    let omega = source.number(&rotation.omega, (&label, "omega"), |_| true, ("", ""))?;
    let about = rotation.about.as_ref().map(|about| source.vector(about, (&label, "about"))).transpose()?;
    let revolved = kinematics == Kinematics::Axisymmetric;
    if let Some(key) = rotation.about.as_ref().filter(|_| revolved && about.is_some_and(|[r, _]| r != 0.0)) {
        let (rule, remedy) = ("a body of revolution turns about its axis", "leave `about` out");
        let found = format!("{:?}", about.unwrap_or_default());
        let fault = Fault::Number { key: "about".to_owned(), table: label, found, rule, remedy };
        return Err(source.error(key.span(), fault));
    }
    let turning = Rotation { density, omega, about: about.unwrap_or_default() };
    if turning.stiffness() > LARGEST {
        let ((rule, remedy), found) = (OVERFLOWS, omega.to_string());
        let fault = Fault::Number { key: "omega".to_owned(), table: label, found, rule, remedy };
        return Err(source.error(rotation.omega.span(), fault));
    }
    let force = force.with_rotation(turning);
    Ok(if revolved { force.about_line() } else { force })
}
