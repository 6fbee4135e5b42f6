//! A `report.json` that somebody has written before, as far as others read it.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Deserialize;

use crate::cause::Cause;
use crate::compare::{Basis, Check};
use crate::report::{BaselineRow, ReportError, Status, run_of};

/// A stored report. Numbers that were not finite when it was written are missing.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct Stored {
    /// Version of the format.
    pub schema_version: u32,
    /// Scene name.
    pub scene: String,
    /// Scene title.
    pub title: String,
    /// `verify`, `solve` or `certify`.
    pub command: String,
    /// Identifies the run.
    pub run: String,
    /// The verdict.
    pub status: Status,
    /// The verdict in words.
    pub verdict: String,
    /// Why checks did not pass.
    #[serde(default)]
    pub causes: Vec<Cause>,
    /// The energy bracket.
    pub energy: Option<StoredEnergy>,
    /// The dual solve.
    pub dual: Option<StoredDual>,
    /// Displacement solutions.
    pub primal: Vec<StoredPrimal>,
    /// Contacts.
    pub contact: Vec<StoredContact>,
    /// Checks that decide.
    #[serde(deserialize_with = "checks")]
    pub checks: Vec<Check>,
    /// Those that do not.
    #[serde(deserialize_with = "checks")]
    pub remarks: Vec<Check>,
    /// Quantities of interest, where the report has them.
    #[serde(default)]
    pub quantities: Vec<StoredQuantity>,
    /// How its numbers compare with a baseline.
    #[serde(default)]
    pub baseline: Vec<BaselineRow>,
    /// Origin of the numbers.
    pub provenance: StoredProvenance,
}

/// The bracket.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
pub struct StoredEnergy {
    /// Lower bound.
    pub lower: Option<f64>,
    /// Upper bound.
    pub upper: Option<f64>,
    /// √(gap / 𝒮).
    pub relative_error_bound: Option<f64>,
    /// True if it holds for the scene as written.
    pub guaranteed: bool,
}

/// The dual solve.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct StoredDual {
    /// The method.
    pub method: String,
    /// Number of triangles.
    pub triangles: usize,
    /// Number of unknowns.
    pub unknowns: usize,
}

/// A displacement solution.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct StoredPrimal {
    /// Its name.
    pub name: String,
    /// 𝓛(u_h).
    pub energy: Option<f64>,
}

/// A contact.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct StoredContact {
    /// Its name.
    pub name: String,
    /// Force on the first side.
    pub resultant: Sided<[Option<f64>; 2]>,
    /// Largest pressure.
    pub pressure_max: Sided<Option<f64>>,
}

/// The dual side of a pair.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
pub struct Sided<T> {
    /// From λ_h.
    pub dual: T,
}

/// A quantity of interest.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct StoredQuantity {
    /// Its name.
    pub name: String,
    /// Its value.
    #[serde(default)]
    pub value: Option<f64>,
    /// Lower end of its interval.
    #[serde(default)]
    pub lower: Option<f64>,
    /// Upper end.
    #[serde(default)]
    pub upper: Option<f64>,
}

/// Origin of the numbers.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct StoredProvenance {
    /// Version of hypercircle.
    pub version: String,
    /// SHA-256 of the scene file.
    pub scene_sha256: String,
    /// SHA-256 of the mesh.
    pub mesh_sha256: String,
    /// Threads.
    pub threads: usize,
    /// Seconds by phase.
    pub seconds: BTreeMap<String, Option<f64>>,
}

impl Stored {
    /// Reads the report of a folder, whose files must be of one run, or a `report.json`.
    ///
    /// # Errors
    /// [`ReportError::Read`] where there is none or it is not one, [`ReportError::Mixed`] where the files beside it are of
    /// another run.
    pub fn read(path: &Path) -> Result<Self, ReportError> {
        let is_named_so = path.file_name().is_some_and(|name| name == "report.json");
        let folder = match (path.is_dir(), path.parent()) {
            (true, _) => Some(path),
            (false, Some(parent)) if is_named_so => Some(parent),
            _ => None,
        };
        let file = if path.is_dir() { path.join("report.json") } else { path.to_path_buf() };
        let refused = |reason: String| ReportError::Read { path: file.clone(), reason };
        let text = std::fs::read(&file).map_err(|e| refused(e.to_string()))?;
        let stored: Stored = serde_json::from_slice(&text).map_err(|e| refused(format!("it is no report: {e}")))?;
        if stored.schema_version != crate::report::SCHEMA_VERSION {
            let known = crate::report::SCHEMA_VERSION;
            return Err(refused(format!("its version is {}, this program reads {known}", stored.schema_version)));
        }
        match folder {
            Some(folder) if run_of(folder)? != stored.run => Err(ReportError::Mixed { path: file, run: stored.run }),
            _ => Ok(stored),
        }
    }

    /// Seconds of the whole run.
    pub fn seconds(&self) -> Option<f64> {
        self.provenance.seconds.get("total").copied().flatten()
    }
}

/// A check as it stands in the file.
#[derive(Deserialize)]
struct StoredCheck {
    name: String,
    value: Option<f64>,
    reference: Option<f64>,
    difference: Option<f64>,
    allowed: Option<f64>,
    margin: Option<f64>,
    passed: bool,
    #[serde(default)]
    excused: bool,
    why: String,
    basis: Basis,
}

fn checks<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<Vec<Check>, D::Error> {
    let stored: Vec<StoredCheck> = Vec::deserialize(deserializer)?;
    let check = |c: StoredCheck| Check {
        name: c.name,
        value: c.value,
        reference: c.reference,
        difference: c.difference,
        allowed: c.allowed.unwrap_or(f64::NAN),
        margin: c.margin,
        passed: c.passed,
        excused: c.excused,
        why: c.why,
        basis: c.basis,
    };
    Ok(stored.into_iter().map(check).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample::{Sample, Verdict};
    use crate::report::write;

    #[test]
    fn a_report_is_read_as_it_was_written() {
        let folder = tempfile::tempdir().expect("a folder");
        let sample = Sample::new(2, Verdict::Disagree);
        let mut dossier = sample.dossier();
        dossier.report.checks[0].allowed = f64::INFINITY;
        write(&dossier, folder.path()).expect("writable");
        for path in [folder.path().to_path_buf(), folder.path().join("report.json")] {
            let stored = Stored::read(&path).expect("a report");
            assert_eq!((&stored.run, stored.status), (&dossier.report.run, dossier.report.status));
            assert!(stored.checks[0].allowed.is_nan());
            assert_eq!(stored.checks[1..], dossier.report.checks[1..]);
            assert_eq!(stored.energy.expect("a bracket").lower, dossier.report.energy.as_ref().map(|e| e.lower));
            assert_eq!(stored.contact[0].resultant.dual[0], Some(dossier.report.contact[0].resultant.dual[0]));
        }
    }
}
