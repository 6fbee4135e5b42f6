//! What a quantity is, for words and sizes.

use crate::problem::{Problem, Sizes};

/// What a quantity is, for the words of reports.
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
    /// Whether it is what contacts or supports carry.
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

    /// What such a quantity has of `sizes`; a moment has the largest arm.
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
