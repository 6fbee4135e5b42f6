//! The data structure behind every output file.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use super::coulomb::CoulombSummary;
pub use super::guarantee::{Guarantee, GuaranteeLevel};
pub use super::quantity::{QuantityOfModel, QuantitySummary};
pub use crate::cause::{Cause, Place};
pub use crate::compare::{
    BoundDistance, Check, ComponentDifference, ContactSummary, FrictionState, FrictionSummary, Profile, StressSummary,
    TwoSides,
};
pub use crate::diagnose::{Diagnosis, Finding};
use crate::dual::{DualSolution, Phases};
use crate::element::{Displacement, StressField};
use crate::problem::{Note, Problem};

/// Version of `report.json`.
pub const SCHEMA_VERSION: u32 = 1;

/// `report.json`.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Report {
    /// Version of this format.
    pub schema_version: u32,
    /// Scene name.
    pub scene: String,
    /// Scene title.
    pub title: String,
    /// The command that made it: `verify`, `solve`, `certify`.
    pub command: String,
    /// Identifies the run: the files of one report carry the same, those of two runs differ.
    pub run: String,
    /// The verdict.
    pub status: Status,
    /// One sentence that says the verdict in words.
    pub verdict: String,
    /// What the checks that did not pass have in common: why, where, and what to try.
    pub causes: Vec<Cause>,
    /// The energy bracket; `null` where no dual solution exists.
    pub energy: Option<Energy>,
    /// What holds for all data in the ranges of the scene; missing where every number is known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub data_range: Option<DataRangeSummary>,
    /// What holds of Coulomb friction; missing without.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub coulomb: Option<CoulombSummary>,
    /// The dual solve.
    pub dual: Option<DualSummary>,
    /// Displacement solutions.
    pub primal: Vec<PrimalSummary>,
    /// Contacts, in scene order.
    pub contact: Vec<ContactSummary>,
    /// Stress comparison; `null` without a primal solution.
    pub stress: Option<StressSummary>,
    /// The quantities of the scene, in its order.
    pub quantities: Vec<QuantitySummary>,
    /// Every check that decides the verdict, made or not: what theory guarantees, what is equal but for round-off, and
    /// what the user asks for.
    pub checks: Vec<Check>,
    /// Comparisons with a tolerance that this program chose, because theory sets none. One that does not pass is worth a
    /// look; none turns the verdict, unless `--allow` makes a check of it.
    pub remarks: Vec<Check>,
    /// What explains that a displacement field is not the discrete solution it claims to be.
    pub diagnosis: Vec<Diagnosis>,
    /// What the reader has to know.
    pub notes: Vec<Note>,
    /// How the numbers of this run compare with those of the baseline; empty without one.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub baseline: Vec<BaselineRow>,
    /// How adaptive refinement went, one row per mesh; empty without it.
    pub history: Vec<HistoryRow>,
    /// What made the numbers.
    pub provenance: Provenance,
}

impl Report {
    /// True if bounds and intervals hold for the scene as written; otherwise notes say what weakens them.
    pub fn is_guaranteed(&self) -> bool {
        !self.notes.iter().any(|note| note.weakens_guarantee)
    }
}

/// The verdict.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    /// All checks passed.
    Agree,
    /// At least one check did not.
    Disagree,
    /// All checks passed, but the bracket is too wide to tell two models apart.
    Undecided,
    /// The scene has no equilibrium.
    Infeasible,
    /// A solver failed.
    Failed,
}

/// One number beside that of the baseline.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BaselineRow {
    /// Its name.
    pub name: String,
    /// As found; `null` where only the baseline has it.
    pub value: Option<f64>,
    /// As accepted; `null` where the baseline does not have it.
    pub accepted: Option<f64>,
    /// The largest difference that counts as none; `null` where the baseline does not have it.
    pub allowed: Option<f64>,
    /// What came of it.
    pub change: Change,
}

/// How a number compares with the accepted one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Change {
    /// Within what is allowed.
    Unchanged,
    /// Further away.
    Changed,
    /// Not in the baseline.
    New,
    /// Only in the baseline.
    Missing,
}

/// The two-sided bound of the exact energy 𝓛(u).
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Energy {
    /// −Π(λ_h), less what rounding can have cost.
    pub lower: f64,
    /// The best admissible 𝓛(v), plus what rounding can have cost.
    pub upper: f64,
    /// upper − lower.
    pub gap: f64,
    /// √(gap / 𝒮(λ_h)).
    pub relative_error_bound: f64,
    /// Which displacement gives `upper`: `free`, `FEniCSx P1`, `FEniCSx P2`, or the file of a certified
    /// field.
    pub upper_from: String,
    /// The upper bound from the dual solve alone; `null` where none could be built.
    pub free_upper: Option<f64>,
    /// The gap of the free bound from its local terms: constitutive-relation error plus contact complementarity.
    pub gap_local: Option<f64>,
    /// 𝒮(λ_h) = ½∫ a λ_h : λ_h.
    pub complementary: f64,
    /// By how much rounding and residual equilibrium widened the bracket, already contained in `lower` and `upper`.
    pub widening: f64,
    /// Largest relative energy-norm error of the mid-field (λ_h + σ(v))/2, with v the displacement that gives `upper`:
    /// half of `relative_error_bound` where no contact complementarity takes part.
    pub mid_error_bound: f64,
    /// Two numbers between which −2𝓛(u) lies: the work ∫F·u + ∫P·u of the loads and ∫τ:ε0 of the stresses on initial strains, less the work
    /// ∫T·u0 + ∫T_n g of the reactions on prescribed displacements and gaps.
    pub enclosed_work: [f64; 2],
    /// Two numbers between which the compliance ∫F·u + ∫P·u lies, twice the elastic energy; `null` where prescribed
    /// displacements, gaps, initial strains or friction take part in the work.
    pub compliance: Option<[f64; 2]>,
    /// Whether the bracket holds for the scene as written; otherwise `notes` say what weakens it.
    pub guaranteed: bool,
    /// On whose word it holds.
    pub guarantee: Guarantee,
    /// What it holds for: the `scene`, or with Coulomb friction the `friction bound` that was used.
    pub guaranteed_for: String,
    /// ∫ τ̄ |v_t' − v_t''| ds, what friction takes up of the work of the loads, of the displacement that gives `upper`; `null` without
    /// friction.
    pub friction_work: Option<f64>,
}

/// What is guaranteed for all data of a scene some of whose numbers are known as ranges: the lower bound of the ends with the
/// lowest energy, and the upper bound of those with the highest.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct DataRangeSummary {
    /// The numbers that are known between two ends.
    pub parameters: Vec<RangedParameter>,
    /// No energy of data in these ranges is lower.
    pub lower: f64,
    /// No energy of data in these ranges is higher; `null` where no upper bound could be built.
    pub upper: Option<f64>,
    /// Two numbers between which the compliance lies for all of them; `null` where prescribed displacements, gaps or initial strains take part.
    pub compliance: Option<[f64; 2]>,
    /// The exact energy at the other ends lies between these; `null` where no upper bound could be built.
    pub other_end: Option<[f64; 2]>,
}

/// A number that is known between two ends.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct RangedParameter {
    /// What it is.
    pub name: String,
    /// Its lower end.
    pub low: f64,
    /// Its upper end.
    pub high: f64,
    /// The end that all other numbers of the report are for.
    pub taken: f64,
}

/// The dual solve in numbers.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct DualSummary {
    /// `condensed`, `clarabel`, `uzawa` or `active-set`.
    pub method: String,
    /// Lowest polynomial degree of the stress on a triangle.
    pub degree_min: usize,
    /// Highest polynomial degree of the stress on a triangle.
    pub degree_max: usize,
    /// Number of triangles.
    pub triangles: usize,
    /// Number of unknowns.
    pub unknowns: usize,
    /// Steps of the contact iteration.
    pub iterations: usize,
    /// Largest violation of equilibrium relative to the applied load.
    pub equilibrium_residual: f64,
    /// Seconds by phase.
    pub seconds: Phases,
}

/// One displacement solution.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct PrimalSummary {
    /// `FEniCSx P1`, `FEniCSx P2`, or the file of a certified field.
    pub name: String,
    /// Program.
    pub solver: String,
    /// Its version.
    pub version: String,
    /// Polynomial degree; on quadrilaterals that in each coordinate of a square.
    pub degree: usize,
    /// `triangles`, or `quadrilaterals` where the displacement is one on those of the mesh file.
    pub cells: String,
    /// 𝓛(u_h).
    pub energy: f64,
    /// Whether the field is admissible everywhere, so that its energy is an upper bound, unless it is that of a quadrature.
    pub admissible: bool,
    /// Guaranteed relative energy-norm error of its stress, √((𝓛(u_h) + Π(λ_h)) / 𝒮(λ_h)); `null` on quadrilaterals that are
    /// no parallelograms, whose energy is that of a quadrature.
    pub relative_error_bound: Option<f64>,
    /// Nonlinear iterations, where the program tells them.
    pub iterations: Option<usize>,
    /// Unknowns, where the program tells them.
    pub unknowns: Option<usize>,
    /// Seconds by phase, as reported by the program; `total` is always there.
    pub seconds: std::collections::BTreeMap<String, f64>,
}

impl PrimalSummary {
    /// True if the energy is that of a quadrature, on quadrilaterals that are no parallelograms.
    pub fn is_of_quadrature(&self) -> bool {
        self.cells == "quadrilaterals" && self.relative_error_bound.is_none()
    }
}

/// One mesh of an adaptive run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct HistoryRow {
    /// Number of triangles.
    pub triangles: usize,
    /// Number of unknowns.
    pub unknowns: usize,
    /// −Π(λ_h).
    pub lower: f64,
    /// 𝓛(v).
    pub upper: f64,
    /// √(gap / 𝒮).
    pub relative_error_bound: f64,
    /// Seconds since the start.
    pub seconds: f64,
    /// Seconds on this mesh alone: refinement to it is not contained, statics, solve and bracket are.
    pub step_seconds: f64,
    /// The exponent r of bound ≈ C · unknowns⁻ʳ between the mesh before and this one; `null` on the first.
    pub rate: Option<f64>,
}

/// What made the numbers.
#[derive(Debug, Clone, PartialEq, Default, Serialize, JsonSchema)]
pub struct Provenance {
    /// Version of hypercircle.
    pub version: String,
    /// Versions of the libraries and programs that took part.
    pub components: std::collections::BTreeMap<String, String>,
    /// SHA-256 of the scene file.
    pub scene_sha256: String,
    /// SHA-256 of the mesh (points, triangles, bodies) as solved.
    pub mesh_sha256: String,
    /// SHA-256 of the committed Cargo.lock.
    pub lock_sha256: String,
    /// Threads used.
    pub threads: usize,
    /// The command that made them, as typed; empty where it is not known.
    pub command_line: String,
    /// The date on which it was run, of the meridian of Greenwich.
    pub date: String,
    /// Seconds by phase of the whole run.
    pub seconds: std::collections::BTreeMap<String, f64>,
}

/// A displacement by its values at nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct Given {
    /// The name of the model.
    pub name: String,
    /// True if it is one on the quadrilaterals of the mesh file.
    pub on_quadrilaterals: bool,
    /// Values at vertices, and at edge middles behind them where it is quadratic; that of a diagonal of a quadrilateral is the one in the
    /// centre.
    pub values: Vec<[f64; 2]>,
}

/// Everything a run produced: the report and the fields behind its pictures.
#[derive(Debug)]
pub struct Dossier<'a> {
    /// The numbers.
    pub report: Report,
    /// Scene and mesh.
    pub problem: &'a Problem,
    /// λ_h; `None` where no dual solution exists.
    pub dual: Option<&'a DualSolution>,
    /// Displacements by name; the first is the free upper bound where there is one.
    pub displacements: Vec<(String, &'a Displacement)>,
    /// Linear and quadratic displacements that were held against the bound, as they were given.
    pub given: Vec<Given>,
    /// The stress half-way between λ_h and that of the best displacement.
    pub mid: Option<&'a StressField>,
    /// Stresses of the displacement models, by name.
    pub stresses: Vec<(String, &'a StressField)>,
    /// Scalar fields on triangles for maps and VTU.
    pub maps: Vec<Map>,
    /// A rigid motion to show, for a scene without equilibrium: displacement per vertex.
    pub motion: Option<Vec<[f64; 2]>>,
    /// The bytes of `proof.npz`, where a proof travels with the report.
    pub proof: Option<Vec<u8>>,
}

/// A scalar per triangle.
#[derive(Debug, Clone, PartialEq)]
pub struct Map {
    /// Key used in the VTU.
    pub key: String,
    /// Whose it is: a model, a quantity.
    pub title: String,
    /// The quantity shown; maps of one kind share a scale.
    pub kind: MapKind,
    /// One value per triangle.
    pub values: Vec<f64>,
}

/// The quantity that a map shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MapKind {
    /// Residual of equilibrium of a claimed solution.
    Residual,
    /// How far two stresses are apart: the root of twice the density of the energy of their difference.
    Difference,
    /// Von Mises stress of the mean over each triangle.
    VonMises,
    /// Share of each triangle in the gap between the lower bound and an upper one, relative to the whole.
    GapShare,
    /// Share of each triangle in the width of the interval of a quantity, relative to the whole.
    QuantityShare,
}

impl MapKind {
    /// All of them; the first that there is is shown first.
    pub const ALL: [MapKind; 5] =
        [Self::Residual, Self::Difference, Self::VonMises, Self::GapShare, Self::QuantityShare];

    /// Its name in words.
    pub fn in_words(self) -> &'static str {
        match self {
            Self::Residual => "Missing equilibrium",
            Self::Difference => "Stress difference",
            Self::VonMises => "Von Mises stress",
            Self::GapShare => "Share in the gap",
            Self::QuantityShare => "Share in the interval",
        }
    }

    /// Its meaning, in a sentence.
    pub fn explanation(self) -> &'static str {
        match self {
            Self::Residual => {
                "What equilibrium misses at the nodes of each triangle, relative to the whole: next to nothing everywhere for a discrete solution."
            }
            Self::Difference => {
                "How far the stresses of two models are apart: the root of twice the energy density of their difference."
            }
            Self::VonMises => "Von Mises stress of the mean stress over each triangle.",
            Self::GapShare => {
                "What each triangle adds to the width of the bracket with this upper bound: large where a finer mesh pays."
            }
            Self::QuantityShare => "What each triangle adds to the width of the interval of this quantity.",
        }
    }
}
