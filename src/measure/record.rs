//! Records of measured runs, as they travel between processes and into files.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// One run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// Name of the method.
    pub method: String,
    /// How it ended.
    pub end: End,
    /// Its answer, where it gave one.
    pub answer: Option<Answer>,
    /// Where the time went.
    pub seconds: Seconds,
    /// Largest resident memory of the process that solved, in bytes; `None` where the system does not tell.
    pub peak_memory: Option<u64>,
}

/// How a run ended.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "kind", content = "reason", rename_all = "kebab-case")]
pub enum End {
    /// With an answer.
    Solved,
    /// With the reason why there is no equilibrium.
    NoEquilibrium(String),
    /// With the reason why this input is refused.
    Refused(String),
    /// An iteration did not arrive, and says so.
    NotConverged(String),
    /// The method has nothing to do with the question.
    NotApplicable(String),
    /// A program that the method runs died.
    Crashed(String),
}

impl End {
    /// The reason in it.
    pub fn words(&self) -> &str {
        match self {
            End::Solved => "solved",
            End::NoEquilibrium(text)
            | End::Refused(text)
            | End::NotConverged(text)
            | End::NotApplicable(text)
            | End::Crashed(text) => text,
        }
    }
}

/// Wall-clock seconds of one run.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Seconds {
    /// From the start of the process to the answer: scene file in, numbers out.
    pub whole: f64,
    /// From mesh and data in memory to the answer: without start-up, imports, compilation and reading.
    pub solve: f64,
    /// Every phase in its order; they add up to `whole`.
    pub phases: Vec<(String, f64)>,
}

impl Seconds {
    /// Adds a phase after the others.
    pub fn add(&mut self, phase: &str, seconds: f64) {
        self.whole += seconds;
        self.solve += seconds;
        self.phases.push((phase.to_string(), seconds));
    }
}

/// The numbers of a run. Energies and forces include the thickness.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Answer {
    /// Name that the user's displacement solver gives itself.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub solver: Option<String>,
    /// Triangles of the (last) mesh.
    pub triangles: usize,
    /// Unknowns solved for.
    pub unknowns: usize,
    /// Iterations of the method.
    pub iterations: usize,
    /// Guaranteed lower bound of the energy, where the method gives one.
    #[serde(with = "finite_or_null")]
    pub lower: Option<f64>,
    /// Upper bound of the energy: of the bracket, or of the admissible displacement.
    #[serde(with = "finite_or_null")]
    pub upper: Option<f64>,
    /// 𝒮(λ_h), what errors are relative to; for displacements ½∫ c e:e.
    #[serde(with = "finite_or_null")]
    pub strain: Option<f64>,
    /// √(gap/𝒮(λ_h)), where the method gives a bracket.
    #[serde(with = "finite_or_null")]
    pub relative_error_bound: Option<f64>,
    /// Violation of equilibrium relative to the loads; zero for displacements, which do not claim it.
    #[serde(with = "finite_or_null")]
    pub equilibrium: Option<f64>,
    /// How far a displacement was from admissible, relative to its size.
    #[serde(with = "finite_or_null")]
    pub violation: Option<f64>,
    /// Force on the first side of each contact.
    pub resultants: Vec<[f64; 2]>,
    /// Largest pressure of each contact.
    pub pressure_max: Vec<f64>,
    /// Total variation of the pressure along each contact.
    pub variation: Vec<f64>,
    /// The quantities that were asked for.
    pub quantities: Vec<Asked>,
    /// Why there is no upper bound, or what else is missing.
    pub missing: Option<String>,
}

/// A quantity in a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Asked {
    /// Its name.
    pub name: String,
    /// Its value, where the method has one.
    #[serde(with = "finite_or_null")]
    pub value: Option<f64>,
    /// The exact value is above this …
    #[serde(with = "finite_or_null")]
    pub lower: Option<f64>,
    /// … and below this, where the method guarantees anything.
    #[serde(with = "finite_or_null")]
    pub upper: Option<f64>,
}

/// Numbers that may be missing or not finite: both are null in JSON.
pub mod finite_or_null {
    use super::*;

    /// Writes null for what is no number.
    ///
    /// # Errors
    /// The serialiser's.
    pub fn serialize<S: Serializer>(value: &Option<f64>, serializer: S) -> Result<S::Ok, S::Error> {
        value.filter(|v| v.is_finite()).serialize(serializer)
    }

    /// Reads a number or null.
    ///
    /// # Errors
    /// The deserialiser's.
    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
        Option::<f64>::deserialize(deserializer)
    }
}

impl Measured {
    /// A run without an answer.
    pub fn without_answer(method: &str, end: End) -> Self {
        Measured { method: method.to_string(), end, answer: None, seconds: Seconds::default(), peak_memory: None }
    }
}
