//! `[[quantities]]` as TOML types.

use schemars::JsonSchema;

use crate::scene::reading::raw::{At, Pair};

/// A number the scene is solved for, with a guaranteed interval: one of `displacement`, `force`, `moment`, `stress`,
/// `stress_intensity`.
#[derive(Debug, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Quantity", extend("oneOf" = [
    {"required": ["displacement", "direction"]},
    {"required": ["force"]},
    {"required": ["moment", "about"]},
    {"required": ["stress"]},
    {"required": ["stress_intensity", "tip"]}
]))]
pub(in crate::scene) struct RawQuantity {
    /// A name of its own, without `=`: reports and `--tolerance-of NAME=X` use it.
    #[schemars(length(min = 1), regex(pattern = "^[^=]+$"))]
    pub name: At<String>,
    /// A boundary or a body: the mean over it of the displacement along `direction`; a body with `point`: the displacement there.
    #[schemars(length(min = 1))]
    pub displacement: Option<At<String>>,
    /// A contact, as `first|second`, `first|rigid` or one of its sides: the normal force that presses its sides together,
    /// weighted by `window`; with `component = "tangential"` the force of friction on its first side along the arc length. Or the boundary of a support: the force along `direction` that it exerts on the bodies.
    #[schemars(length(min = 1))]
    pub force: Option<At<String>>,
    /// A contact or the boundary of a support: the counter-clockwise moment about the point `about` of the forces that it
    /// exerts, a contact on its first side.
    #[schemars(length(min = 1))]
    pub moment: Option<At<String>>,
    /// A body: the mean of the stress `component`, or of the normal stress along `direction`, over the `box` or `polygon`
    /// in it, or over all of it; with `point` the value there.
    #[schemars(length(min = 1))]
    pub stress: Option<At<String>>,
    /// `KI` or `KII`: the stress intensity at the `tip` of a crack with faces free of traction, or of half a model with a roller ahead of
    /// the tip; of KII the faces may touch without friction.
    #[schemars(extend("enum" = ["KI", "KII"]))]
    pub stress_intensity: Option<At<String>>,
    /// The tip of a crack, a vertex of the mesh.
    #[schemars(with = "Option<[f64; 2]>")]
    pub tip: Option<Pair>,
    /// A direction of any length.
    #[schemars(with = "Option<[f64; 2]>")]
    pub direction: Option<Pair>,
    /// The point a moment is taken about.
    #[schemars(with = "Option<[f64; 2]>")]
    pub about: Option<Pair>,
    /// [s0, s1, s2, s3]: the weight of a contact force in the arc length s of the first side, from its end that comes first
    /// in (x, y) order: 0 up to s0 and from s3 on, 1 from s1 to s2, linear between. s0 = s1 only at the beginning of the
    /// side, s = 0; a window up to its other end has s2 and s3 beyond it. Without it everything has weight 1.
    #[schemars(with = "Option<[f64; 4]>")]
    pub window: Option<At<Vec<f64>>>,
    /// The lower left and the upper right corner of a region.
    #[serde(rename = "box")]
    #[schemars(with = "Option<[[f64; 2]; 2]>")]
    pub corners: Option<At<Vec<Pair>>>,
    /// The corners of a region, in either orientation.
    #[schemars(with = "Option<Vec<[f64; 2]>>", length(min = 3))]
    pub polygon: Option<At<Vec<Pair>>>,
    /// The component of the stress, of a body of revolution `rr`, `zz`, `rz` or `tt`; at a point also von Mises' equivalent stress and the
    /// principal stresses in the plane. Of the force of a contact with friction `tangential`.
    #[schemars(extend("enum" = ["xx", "yy", "xy", "rr", "zz", "rz", "tt", "von-mises", "largest-principal", "smallest-principal", "tangential"]))]
    pub component: Option<At<String>>,
    /// A point inside an isotropic body, away from its outline, at which a displacement or a stress is wanted.
    #[schemars(with = "Option<[f64; 2]>")]
    pub point: Option<Pair>,
    /// How smooth the weight is of the mean that is the value at a point, 0 to 6; where nothing is said 2 for stresses, 4 for displacements.
    #[schemars(with = "Option<u8>", range(min = 0, max = 6))]
    pub smoothness: Option<At<f64>>,
}
