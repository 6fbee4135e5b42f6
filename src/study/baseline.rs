//! A stored result to compare later runs with.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::Certified;
use crate::compare::{Allowances, Basis, Check, Comparison};

/// Largest relative change that a later run may show: the numbers are bit-stable for one build, other builds and
/// machines round differently.
const UNCHANGED: f64 = 1e-8;
const VERSION: u32 = 1;

/// The numbers of a run that later runs should reproduce.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Baseline {
    version: u32,
    scene: String,
    values: BTreeMap<String, f64>,
}

/// Why a baseline cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum BaselineError {
    /// It cannot be read or written.
    #[error("baseline {path}: {source}; write it first with --accept")]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// It is no baseline.
    #[error("baseline {path}: {reason}; write it again with --accept")]
    Content {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
}

impl Baseline {
    /// The numbers of a run.
    pub fn new(certified: &Certified, comparison: &Comparison) -> Self {
        let Certified { problem, bracket, .. } = certified;
        let mut values = BTreeMap::new();
        values.insert("triangles".to_string(), problem.mesh.triangles.len() as f64);
        values.insert("energy.lower".to_string(), bracket.complementary.lower());
        if let Ok(free) = &bracket.free {
            values.insert("energy.free upper".to_string(), free.potential.total());
        }
        for judged in &comparison.judged {
            values.insert(format!("energy.{}", judged.candidate.name), judged.field.potential.total());
        }
        for contact in &comparison.contacts {
            let [x, y] = contact.resultant.dual;
            let name = |what: &str| format!("{}.{what}", contact.name);
            values.insert(name("resultant x"), x);
            values.insert(name("resultant y"), y);
            values.insert(name("pressure max"), contact.pressure_max.dual);
            values.insert(name("open fraction"), contact.open_fraction);
        }
        Baseline { version: VERSION, scene: problem.scene.name.clone(), values }
    }

    /// Reads a baseline.
    ///
    /// # Errors
    /// [`BaselineError`].
    pub fn read(path: &Path) -> Result<Self, BaselineError> {
        let text =
            std::fs::read_to_string(path).map_err(|source| BaselineError::Io { path: path.to_path_buf(), source })?;
        let content = |reason: String| BaselineError::Content { path: path.to_path_buf(), reason };
        let baseline: Baseline = serde_json::from_str(&text).map_err(|e| content(e.to_string()))?;
        if baseline.version != VERSION {
            return Err(content(format!("it has version {}, this program reads {VERSION}", baseline.version)));
        }
        Ok(baseline)
    }

    /// Writes a baseline, whole or not at all.
    ///
    /// # Errors
    /// [`BaselineError`].
    pub fn write(&self, path: &Path) -> Result<(), BaselineError> {
        let io = |source: std::io::Error| BaselineError::Io { path: path.to_path_buf(), source };
        let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let mut file = tempfile::NamedTempFile::new_in(folder).map_err(io)?;
        let text = serde_json::to_string_pretty(self).map_err(|e| io(e.into()))?;
        writeln!(file, "{text}").map_err(io)?;
        file.persist(path).map_err(|e| io(e.error))?;
        Ok(())
    }

    /// Holds these numbers against stored ones: one check each, and one for every number that is new or missing.
    pub fn checks(&self, stored: &Baseline, allow: &Allowances) -> Vec<Check> {
        let mut checks = Vec::new();
        let largest = stored.values.values().fold(0.0_f64, |m, v| m.max(v.abs()));
        for (name, &reference) in &stored.values {
            let name_of = format!("baseline/{name}");
            let default = UNCHANGED * reference.abs().max(UNCHANGED * largest);
            let allowed = allow.get(&name_of, default);
            let why = format!("{name} against the stored value of {}.", stored.scene);
            checks.push(match self.values.get(name) {
                Some(&value) => Check::equal(&name_of, value, reference, allowed, Basis::Chosen, why),
                None => Check::not_made(
                    &name_of,
                    allowed,
                    Basis::Chosen,
                    format!("The baseline has {name}, this run does not; write the baseline again with --accept."),
                ),
            });
        }
        checks
    }
}
