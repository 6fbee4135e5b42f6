//! Results of a comparison, as they stand in the report.

use schemars::JsonSchema;
use serde::Serialize;

use super::contact::friction::FrictionSummary;
use super::contact::mean::MeanPressure;

/// A pair of values, one from each side.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct TwoSides<T> {
    /// From λ_h.
    pub dual: T,
    /// From the best displacement solution; `null` without one.
    pub primal: Option<T>,
}

/// One contact.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ContactSummary {
    /// `first|second`.
    pub name: String,
    /// Force on the first side.
    pub resultant: TwoSides<[f64; 2]>,
    /// Moment about the origin on the first side.
    pub moment: TwoSides<f64>,
    /// Largest pressure.
    pub pressure_max: TwoSides<f64>,
    /// Where it is.
    pub pressure_max_at: TwoSides<[f64; 2]>,
    /// The mean of the pressure of λ_h around the place where it is largest; `null` where nothing presses, or what holds the
    /// contact there leaves no mean that is bounded.
    pub pressure_mean: Option<MeanPressure>,
    /// Fraction of the length that carries no pressure.
    pub open_fraction: f64,
    /// The same from the displacement solution.
    pub open_fraction_primal: Option<f64>,
    /// Arc length of each end of contact (where pressure falls to zero between the two ends of the interface).
    pub contact_ends: Vec<f64>,
    /// L² norm of the pressure difference relative to the L² norm of the dual pressure.
    pub pressure_l2_difference: Option<f64>,
    /// Friction in the dual solution; `null` where the contact has none.
    pub friction: Option<FrictionSummary>,
    /// Total length of the interface.
    pub length: f64,
    /// Pressure along the interface from every model, for the picture.
    pub profiles: Vec<Profile>,
}

/// Pressure along one interface from one model.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Profile {
    /// `dual`, `FEniCSx P2 reactions`, `FEniCSx P2 trace`, …
    pub model: String,
    /// (arc length, pressure ≥ 0 in compression); consecutive points with equal arc length are jumps.
    pub points: Vec<[f64; 2]>,
}

/// Stress of the dual against stress of the best displacement solution.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct StressSummary {
    /// Which displacement solution.
    pub against: String,
    /// ‖λ_h − σ(u_h)‖_a / ‖λ_h‖_a.
    pub relative_energy_norm_difference: f64,
    /// Triangle that contributes most.
    pub worst_triangle: usize,
    /// Centroid of that triangle.
    pub worst_at: [f64; 2],
    /// Its share of the squared difference.
    pub worst_share: f64,
    /// Largest von Mises stress, at triangle centroids.
    pub von_mises_max: TwoSides<f64>,
    /// Relative L² difference of σ_xx, σ_yy, σ_xy and von Mises, each relative to the L² norm of the whole dual stress.
    pub component_l2_difference: ComponentDifference,
}

/// Relative L² differences.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct ComponentDifference {
    /// σ_xx.
    pub xx: f64,
    /// σ_yy.
    pub yy: f64,
    /// The hoop stress of a body of revolution, whose xx, yy and xy are rr, zz and rz.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tt: Option<f64>,
    /// σ_xy.
    pub xy: f64,
    /// Von Mises stress.
    pub von_mises: f64,
}
