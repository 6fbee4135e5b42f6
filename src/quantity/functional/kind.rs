//! The kind of a quantity, for words and sizes.

use crate::problem::{Problem, Sizes};
use crate::scene::{PointValue, Target};

/// The kind of a quantity, for the words of reports.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Mean displacement.
    Displacement,
    /// Force of a contact or support.
    Force,
    /// Moment of a contact or support.
    Moment,
    /// Mean stress.
    Stress,
    /// Stress intensity at the tip of a crack.
    StressIntensity,
}

impl Kind {
    /// That of what a scene asks for.
    pub fn of(target: &Target) -> Self {
        match target {
            Target::Displacement { .. } | Target::Point { value: PointValue::Displacement(_), .. } => {
                Kind::Displacement
            }
            Target::Stress { .. } | Target::Point { .. } => Kind::Stress,
            Target::StressIntensity { .. } => Kind::StressIntensity,
            Target::ContactForce { .. } | Target::SupportForce { .. } => Kind::Force,
            Target::Moment { .. } => Kind::Moment,
        }
    }

    /// True if it is a force or moment transmitted by contacts or supports.
    pub fn is_carried(self) -> bool {
        matches!(self, Kind::Force | Kind::Moment)
    }

    /// The word for it.
    pub fn name(self) -> &'static str {
        match self {
            Kind::Displacement => "displacement",
            Kind::Force => "force",
            Kind::Moment => "moment",
            Kind::Stress => "stress",
            Kind::StressIntensity => "stress_intensity",
        }
    }

    /// The entry of `sizes` for such a quantity; a moment has the largest arm.
    pub fn size(self, problem: &Problem, sizes: &Sizes) -> f64 {
        match self {
            Kind::Displacement => sizes.displacement,
            Kind::Stress => sizes.stress,
            Kind::StressIntensity => {
                let [low, high] = [f64::min, f64::max]
                    .map(|of| [0, 1].map(|c| problem.mesh.points.iter().map(|p| p[c]).reduce(of).unwrap_or(0.0)));
                sizes.stress * (high[0] - low[0]).hypot(high[1] - low[1]).sqrt()
            }
            Kind::Moment => sizes.force * problem.mesh.points.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs())),
            Kind::Force => sizes.force,
        }
    }
}
