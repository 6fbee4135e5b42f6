//! Coulomb friction in a report.

use schemars::JsonSchema;
use serde::Serialize;

/// What is guaranteed, and what is not, where friction goes with the pressure. All other numbers of the report are for the friction bound
/// that was used.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct CoulombSummary {
    /// Every solution of Coulomb's law has an energy between these two: the lower bound without friction, and the upper bound of sides
    /// that stick. `null` where there is no such bound.
    pub energy_range: [Option<f64>; 2],
    /// Where the search for a bound that goes with its pressure began, and how it ended. The report is for the first that arrived.
    pub starts: Vec<CoulombStart>,
    /// By how much the bounds differ at which the starts arrived, relative to them; `null` where one alone arrived.
    pub bounds_differ: Option<f64>,
    /// Whether two starts arrived at different bounds.
    pub several_solutions: bool,
    /// The contacts whose forces friction can keep in balance without a load, with a sentence each.
    pub wedging: Vec<String>,
    /// What can be said, in words: of every solution, of the bound that was used, and of how many solutions there are.
    pub statements: [String; 3],
}

/// One search for a friction bound that goes with its pressure.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct CoulombStart {
    /// `sticking` or `frictionless`: whose pressure the first bound is from.
    pub from: String,
    /// How it ended.
    pub outcome: CoulombOutcome,
    /// Solutions on the way; `null` where the bodies lost their hold.
    pub iterations: Option<usize>,
}

/// How a search for a friction bound ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum CoulombOutcome {
    /// At a bound that goes with its pressure.
    Arrived,
    /// With a bound with which nothing holds the bodies.
    NoEquilibrium,
    /// Not at all.
    NotConverged,
}
