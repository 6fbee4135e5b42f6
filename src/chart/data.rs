//! The data of a chart: scenes, their reference brackets, and the runs.

use serde::{Deserialize, Serialize};

use crate::measure::{Asked, Machine, Method};

/// Everything in `chart.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Chart {
    /// Version of this layout.
    pub schema_version: u32,
    /// Where the seconds were measured.
    pub machine: Machine,
    /// Runs of each kind, of which the median counts.
    pub repeats: usize,
    /// Seconds that one run may take.
    pub budget: f64,
    /// Threads of the runs.
    pub threads: usize,
    /// The command that was run in the place of FEniCSx.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub program: Option<String>,
    /// The command that makes it again.
    #[serde(default)]
    pub command: String,
    /// The scenes, in the order they were given.
    pub scenes: Vec<SceneChart>,
}

/// The layout that this program writes and reads.
pub const SCHEMA_VERSION: u32 = 1;

/// One scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SceneChart {
    /// File stem of the scene.
    pub name: String,
    /// Its title.
    pub title: String,
    /// Hash of the scene file; runs of another text are not kept.
    pub sha256: String,
    /// The bracket that errors are measured against; `None` where there is none, with the reason.
    pub reference: Result<Reference, String>,
    /// Seconds of the first use of FEniCSx, when nothing is compiled yet.
    pub cold: Vec<Cold>,
    /// The runs that were made, marked or skipped.
    pub runs: Vec<Run>,
}

/// A tight bracket of the energy of a scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Reference {
    /// The exact energy is above this …
    pub lower: f64,
    /// … and below this.
    pub upper: f64,
    /// 𝒮(λ_h) of the bracket, to which errors are relative.
    pub strain: f64,
    /// How it was computed.
    pub how: String,
}

impl Reference {
    /// Half the width of the bracket, as a relative error: the uncertainty of true errors.
    pub fn resolution(&self) -> f64 {
        (0.5 * (self.upper - self.lower).max(0.0) / self.strain).sqrt()
    }

    /// Least and most that √(|E − energy| / 𝒮) can be for an exact energy E anywhere in the bracket.
    pub fn errors(&self, energy: f64) -> [f64; 2] {
        distances([self.lower, self.upper], energy).map(|distance| (distance / self.strain).sqrt())
    }

    /// √(|E − energy| / 𝒮) for the exact energy E in the middle of the bracket.
    pub fn error(&self, energy: f64) -> f64 {
        ((0.5 * (self.lower + self.upper) - energy).abs() / self.strain).sqrt()
    }
}

/// Least and most distance of `value` from a point of an interval.
pub(super) fn distances([lower, upper]: [f64; 2], value: f64) -> [f64; 2] {
    let least = [lower - value, value - upper].into_iter().fold(0.0, f64::max);
    [least, (lower - value).abs().max((upper - value).abs())]
}

/// Costs of the first run of a degree, which later runs do not have.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Cold {
    /// The method.
    pub method: Method,
    /// Seconds of form compilation with an empty cache.
    pub compile: f64,
    /// Seconds of form compilation when the cache has the compiled forms.
    pub compile_warm: f64,
    /// Seconds of Python imports.
    pub import: f64,
}

/// One method at one refinement.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Run {
    /// The method.
    pub method: Method,
    /// The displacement solver that was run in the place of FEniCSx.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub solver: Option<String>,
    /// Uniform refinements, or steps of the tolerance for adaptive methods.
    pub level: usize,
    /// Tolerance asked for, for adaptive methods.
    pub tolerance: Option<f64>,
    /// How it ended.
    pub status: Status,
    /// The numbers, where it was done.
    pub plot: Option<Plot>,
}

/// How a run ended.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "kind", content = "reason", rename_all = "kebab-case")]
pub enum Status {
    /// With numbers.
    Done,
    /// It was ended at the budget.
    OverBudget,
    /// A coarser run of the method was over the budget or failed.
    Skipped(String),
    /// The method refused, did not converge, or crashed.
    Failed(String),
}

/// The numbers of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Plot {
    /// Triangles.
    pub triangles: usize,
    /// Unknowns.
    pub unknowns: usize,
    /// Seconds from the start of the process to the answer.
    pub whole: Spread,
    /// Seconds from the mesh in memory to the answer.
    pub solve: Spread,
    /// Seconds by phase of the run with the median whole time.
    pub phases: Vec<(String, f64)>,
    /// Largest peak of memory in bytes.
    pub peak_memory: Option<u64>,
    /// Guaranteed lower bound of the energy.
    pub lower: Option<f64>,
    /// Upper bound of the energy.
    pub upper: Option<f64>,
    /// Guaranteed relative error, where the method delivers one.
    pub guaranteed: Option<f64>,
    /// Relative error of the energy against the reference: of the lower bound, or of the displacement's energy.
    pub true_error: Option<f64>,
    /// The quantities that were asked for.
    #[serde(default)]
    pub quantities: Vec<Asked>,
}

/// Median and extremes of several runs.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// The smallest value.
    pub least: f64,
    /// The value in the middle, the lower one of two.
    pub median: f64,
    /// The largest value.
    pub most: f64,
}

impl Spread {
    /// Median and extremes of `values`; `None` if there are none.
    pub fn of(values: &[f64]) -> Option<Spread> {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let (least, most) = (*sorted.first()?, *sorted.last()?);
        Some(Spread { least, median: sorted[(sorted.len() - 1) / 2], most })
    }
}

impl Run {
    /// Displayed name: the method, or the solver used in place of FEniCSx with its degree.
    pub fn name(&self) -> String {
        self.method.name_with(self.solver.as_deref())
    }
}

impl SceneChart {
    /// Displayed name of the runs of a method.
    pub fn name_of(&self, method: Method) -> String {
        self.runs.iter().find(|run| run.method == method).map_or_else(|| method.name().to_string(), Run::name)
    }

    /// The runs of a method that ended with numbers, coarse to fine.
    pub fn done(&self, method: Method) -> impl Iterator<Item = (&Run, &Plot)> {
        self.runs.iter().filter(move |r| r.method == method).filter_map(|r| Some((r, r.plot.as_ref()?)))
    }

    /// The run of a method at a level, however it ended.
    pub fn run(&self, method: Method, level: usize) -> Option<&Run> {
        self.runs.iter().find(|r| r.method == method && r.level == level)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_is_a_value_that_was_measured() {
        let spread = Spread::of(&[3.0, 1.0, 2.0, 10.0]).expect("four values");
        assert_eq!((spread.least, spread.median, spread.most), (1.0, 2.0, 10.0));
        assert_eq!(Spread::of(&[]), None);
    }

    #[test]
    fn errors_are_relative_to_the_energy() {
        let reference = Reference { lower: -1.01, upper: -0.99, strain: 1.0, how: String::new() };
        assert!((reference.error(-1.04) - 0.2).abs() < 1e-12);
        assert!((reference.error(-0.96) - 0.2).abs() < 1e-12);
        assert!((reference.resolution() - 0.1).abs() < 1e-12);
    }
}
