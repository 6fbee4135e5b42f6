//! All findings on one element, and the files they go into.

use std::path::Path;

use quick_junit::{NonSuccessKind, Report as JunitReport, TestCase, TestCaseStatus, TestSuite, XmlString};
use schemars::JsonSchema;
use serde::Serialize;

use super::diagnosis::{Diagnosis, diagnose, known, untold};
use super::digits::Rounded;
use super::displacement::{self, DisplacementElement};
use super::finding::{Finding, Property};
use super::material::{Material, Written};
use super::page;
use super::ring;
use super::stress::{self, StressElement};
use crate::report::folder;
use crate::report::text::number::{clean, optional};
use crate::report::{ReportError, for_jenkins};

/// Version of `report.json`.
const SCHEMA_VERSION: u32 = 1;

/// The names of the files.
pub const NAMES: [&str; 3] = ["report.json", "report.html", "junit.xml"];

/// Deviations of an element from the usual claims.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Options {
    /// Properties that it does not claim.
    pub waived: Vec<String>,
    /// Properties that it claims though they are not usual.
    pub claimed: Vec<String>,
}

impl Options {
    fn claims<S: ?Sized>(&self, property: &Property<S>) -> bool {
        let named = |list: &[String]| list.iter().any(|name| name == property.name);
        named(&self.claimed) || property.usual && !named(&self.waived)
    }
}

/// True if a name is that of a property.
pub fn is_property(name: &str) -> bool {
    let of_displacements = displacement::PROPERTIES.iter().chain(ring::PROPERTIES).map(|p| p.name);
    let mut names = of_displacements.chain(stress::PROPERTIES.iter().map(|p| p.name));
    names.any(|known| known == name)
}

/// All findings on one element: `report.json`.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Report {
    /// Version of this layout.
    pub schema_version: u32,
    /// This program's version.
    pub version: &'static str,
    /// What the element is called.
    pub element: String,
    /// `displacement` or `stress`.
    pub kind: &'static str,
    /// Its nodes, or nothing.
    pub nodes: Vec<[f64; 2]>,
    /// Its material, where one is known.
    #[schemars(with = "Option<Written>")]
    pub material: Option<Material>,
    /// Whether no property that it claims is missing.
    pub passed: bool,
    /// All of it in a sentence.
    pub verdict: String,
    /// Which mistake explains the matrix, where it is not that of its reference.
    pub diagnosis: Option<Diagnosis>,
    /// What to say of the input so that it is taken for what it is, or nothing.
    pub hint: Option<String>,
    /// What a matrix of one shape cannot tell; nothing for a formula.
    pub untold: Option<String>,
    /// Property by property.
    pub findings: Vec<Finding>,
}

/// The JSON Schema of `report.json`.
pub fn schema() -> serde_json::Value {
    let written = schemars::generate::SchemaSettings::default().for_serialize();
    written.into_generator().into_root_schema_for::<Report>().to_value()
}

/// Where what is missing is no more than the rounding of entries of few digits: how to say how many they have.
fn hint(e: &DisplacementElement, findings: &[Finding]) -> Option<String> {
    let rounded = Rounded::of(&e.matrix)?;
    let precision = rounded.precision();
    let of_rounding = |f: &Finding| f.is_missing() && f.value.is_some_and(|v| v > e.precision && v < 30.0 * precision);
    (e.precision < precision && findings.iter().any(of_rounding)).then(|| {
        format!(
            "The entries of K have {}, and what is missing is of the size of their rounding. Say so with --precision {precision:e} \
             (from Python precision={precision:e}); a mistake smaller than that is not seen then.",
            rounded.words()
        )
    })
}

impl Report {
    /// Looks at every property of a displacement element.
    pub fn of_displacement(e: &DisplacementElement, options: &Options) -> Self {
        // Incompatible modes and selective integration are no mistake, and their energies may lie below the bound.
        let may_be_below = !e.is_ring() && known(e).is_some_and(|r| !r.is_conforming());
        let claims = |p: &Property<DisplacementElement>| {
            let is_said = options.claimed.iter().any(|name| name == p.name);
            options.claims(p) && (is_said || !(may_be_below && p.name == displacement::BOUND))
        };
        let find = |p: &Property<DisplacementElement>| p.find(e, claims(p));
        let properties = if e.is_ring() { ring::PROPERTIES } else { displacement::PROPERTIES };
        let diagnosis = if e.is_ring() { ring::diagnose(e) } else { diagnose(e) };
        let findings: Vec<Finding> = properties.iter().map(find).collect();
        Report {
            nodes: e.nodes.clone(),
            material: e.material,
            hint: hint(e, &findings),
            untold: untold(e),
            ..Self::new(&e.name, "displacement", findings, diagnosis)
        }
    }

    /// Looks at every property of an equilibrium element.
    pub fn of_stress(e: &(dyn StressElement + 'static), options: &Options) -> Self {
        let find = |p: &Property<dyn StressElement>| p.find(e, options.claims(p));
        Self::new(e.name(), "stress", stress::PROPERTIES.iter().map(find).collect(), None)
    }

    fn new(name: &str, kind: &'static str, findings: Vec<Finding>, diagnosis: Option<Diagnosis>) -> Self {
        let missing: Vec<&str> = findings.iter().filter(|f| f.is_missing()).map(|f| f.name.as_str()).collect();
        let of = |passed: Option<bool>| findings.iter().filter(|f| f.passed == passed).count();
        let absent = of(Some(false)) - missing.len();
        let mut verdict = match missing.as_slice() {
            [] => format!("{name} has every property it claims: {} hold", of(Some(true))),
            [one] => format!("{name} lacks a property it claims: {one}; {} hold", of(Some(true))),
            several => format!(
                "{name} lacks {} properties it claims: {}; {} hold",
                several.len(),
                several.join(", "),
                of(Some(true))
            ),
        };
        if absent > 0 {
            verdict += &format!(", {absent} not claimed and absent");
        }
        if of(None) > 0 {
            verdict += &format!(", {} not made", of(None));
        }
        Report {
            schema_version: SCHEMA_VERSION,
            version: env!("CARGO_PKG_VERSION"),
            element: name.into(),
            kind,
            nodes: Vec::new(),
            material: None,
            passed: missing.is_empty(),
            verdict: verdict + ".",
            diagnosis,
            hint: None,
            untold: None,
            findings,
        }
    }

    /// The finding of that name.
    pub fn finding(&self, name: &str) -> Option<&Finding> {
        self.findings.iter().find(|f| f.name == name)
    }

    /// Writes `report.json`, `report.html` and `junit.xml` into `dir`.
    ///
    /// # Errors
    /// [`ReportError`].
    pub fn write(&self, dir: &Path) -> Result<(), ReportError> {
        let fail = |file, reason: String| ReportError::Render { file, reason };
        let mut json = serde_json::to_string_pretty(self).map_err(|e| fail("report.json", e.to_string()))?;
        json.push('\n');
        let junit = self.junit().map_err(|e| fail("junit.xml", e.to_string()))?;
        let [a, b, c] = NAMES;
        folder::replace(dir, &[(a, json.into()), (b, page::page(self).into()), (c, junit.into())], &[])
    }

    /// `junit.xml`: a test case a finding. What was not made, or is absent and not claimed, is skipped.
    ///
    /// # Errors
    /// The text cannot be put together.
    pub fn junit(&self) -> Result<String, quick_junit::SerializeError> {
        let mut suite = TestSuite::new(format!("hypercircle element {}", clean(&self.element)));
        for finding in &self.findings {
            let mut status = match (finding.passed, finding.claim) {
                (Some(true), _) => TestCaseStatus::success(),
                (Some(false), true) => TestCaseStatus::non_success(NonSuccessKind::Failure),
                _ => TestCaseStatus::skipped(),
            };
            if finding.passed != Some(true) {
                status.set_message(clean(&finding.sentence));
            }
            if finding.is_missing() {
                let (value, allowed) = (optional(finding.value, 6), optional(finding.allowed, 6));
                status.set_description(clean(&format!("{}\nvalue {value}\nallowed {allowed}", finding.asks)));
            }
            let mut case = TestCase::new(finding.name.as_str(), status);
            case.classname = Some(XmlString::new(format!("hypercircle.element.{}", clean(&self.element))));
            suite.add_test_case(case);
        }
        if let Some(diagnosis) = &self.diagnosis {
            suite.set_system_out(clean(&diagnosis.sentence));
        }
        let mut junit = JunitReport::new("hypercircle");
        junit.add_test_suite(suite);
        junit.to_string().map(for_jenkins)
    }
}
