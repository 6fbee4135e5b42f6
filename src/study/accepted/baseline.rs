//! A stored result to compare later runs with.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::compare::name::of_baseline;
use crate::compare::{Allowances, Basis, Check, Comparison};
use crate::report::folder::{refuse_file, replace_file};
use crate::study::{Accepted, Answer, Certified};

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
    /// It cannot be read.
    #[error("baseline {path}: {source}; write it first with --accept")]
    Io {
        /// The file.
        path: PathBuf,
        /// The error of the system.
        source: std::io::Error,
    },
    /// It cannot be written.
    #[error("baseline {path} cannot be written: {source}; give the path of a file in a folder that is writable")]
    Write {
        /// The file.
        path: PathBuf,
        /// The error of the system.
        source: std::io::Error,
    },
    /// Something else has its name.
    #[error("baseline {path} is not a regular file; give the path of a file")]
    NoFile {
        /// The path that was given.
        path: PathBuf,
    },
    /// Something else is there, and would be lost.
    #[error(
        "baseline {path}: the file is there and holds no baseline, and --accept would replace it; give the path of another file"
    )]
    Foreign {
        /// The file.
        path: PathBuf,
    },
    /// It is no baseline.
    #[error("baseline {path}: {reason}; write it again with --accept")]
    Content {
        /// The file.
        path: PathBuf,
        /// The fault, in words.
        reason: String,
    },
}

impl Baseline {
    /// The numbers of a run on the scene `scene`.
    pub fn new(scene: &str, values: BTreeMap<String, f64>) -> Self {
        Baseline { version: VERSION, scene: scene.to_string(), values }
    }

    /// The numbers of a run.
    pub fn numbers(certified: &Certified, comparison: &Comparison, answers: &[Answer]) -> BTreeMap<String, f64> {
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
        for answer in answers.iter().filter(|answer| answer.interval.half_width().is_finite()) {
            values.insert(format!("quantity.{}", answer.name), answer.interval.value);
            values.insert(format!("quantity.{}.half-width", answer.name), answer.interval.half_width());
        }
        for contact in &comparison.contacts {
            let [x, y] = contact.resultant.dual;
            let name = |what: &str| format!("{}.{what}", contact.name);
            values.insert(name("resultant x"), x);
            values.insert(name("resultant y"), y);
            values.insert(name("pressure max"), contact.pressure_max.dual);
            values.insert(name("open fraction"), contact.open_fraction);
        }
        values
    }

    /// Reads a baseline.
    ///
    /// # Errors
    /// [`BaselineError`].
    pub fn read(path: &Path) -> Result<Self, BaselineError> {
        let io = |source: std::io::Error| BaselineError::Io { path: path.to_path_buf(), source };
        if !std::fs::metadata(path).map_err(io)?.is_file() {
            return Err(BaselineError::NoFile { path: path.to_path_buf() });
        }
        let text = std::fs::read_to_string(path).map_err(io)?;
        let content = |reason: String| BaselineError::Content { path: path.to_path_buf(), reason };
        let baseline: Baseline = serde_json::from_str(&text).map_err(|e| content(e.to_string()))?;
        if baseline.version != VERSION {
            return Err(content(format!("it has version {}, this program reads {VERSION}", baseline.version)));
        }
        Ok(baseline)
    }

    /// Refuses a path that a baseline cannot be written to, or that something else has.
    ///
    /// # Errors
    /// [`BaselineError`].
    pub fn refuse(path: &Path) -> Result<(), BaselineError> {
        match std::fs::metadata(path) {
            Ok(kind) if !kind.is_file() => return Err(BaselineError::NoFile { path: path.to_path_buf() }),
            Ok(kind) if kind.len() > 0 && !Accepted::is_meant(path) && !is_baseline(path) => {
                return Err(BaselineError::Foreign { path: path.to_path_buf() });
            }
            _ => {}
        }
        refuse_file(path).map_err(|source| BaselineError::Write { path: path.to_path_buf(), source })
    }

    /// Writes a baseline, whole or not at all. A link to a file stays one, and the file keeps its mode.
    ///
    /// # Errors
    /// [`BaselineError`].
    pub fn write(&self, path: &Path) -> Result<(), BaselineError> {
        let io = |e: serde_json::Error| BaselineError::Write { path: path.to_path_buf(), source: e.into() };
        let text = serde_json::to_string_pretty(self).map_err(io)?;
        Self::write_text(path, format!("{text}\n"))
    }

    /// Writes the text of a baseline in the same way.
    ///
    /// # Errors
    /// [`BaselineError`].
    pub fn write_text(path: &Path, text: String) -> Result<(), BaselineError> {
        Self::refuse(path)?;
        let target = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
        let io = |source: std::io::Error| BaselineError::Write { path: path.to_path_buf(), source };
        replace_file(&target, text.into_bytes()).map_err(io)
    }

    /// Holds these numbers against stored ones: one check each, and one for every number that is new or missing.
    pub fn checks(&self, stored: &Baseline, allow: &Allowances) -> Vec<Check> {
        let mut checks = Vec::new();
        let largest = stored.values.values().fold(0.0_f64, |m, v| m.max(v.abs()));
        for (name, &reference) in &stored.values {
            let name_of = of_baseline(name);
            let default = unchanged(reference, largest);
            let allowed = allow.given(&name_of).unwrap_or(default);
            let why = format!("{name} against the stored value of {}.", stored.scene);
            checks.push(match self.values.get(name) {
                Some(&value) => Check::equal(&name_of, value, reference, allowed, Basis::Asked, why),
                None => Check::not_made(
                    &name_of,
                    allowed,
                    Basis::Asked,
                    format!("The baseline has {name}, this run does not; write the baseline again with --accept."),
                ),
            });
        }
        checks
    }
}

/// True if a file has the tables of a baseline, of any version.
fn is_baseline(path: &Path) -> bool {
    let content = std::fs::read(path).ok().and_then(|bytes| serde_json::from_slice::<serde_json::Value>(&bytes).ok());
    content.is_some_and(|content| ["version", "scene", "values"].iter().all(|key| content.get(key).is_some()))
}

/// The largest difference from `value` that rounding explains, beside numbers up to `largest`.
pub(in crate::study) fn unchanged(value: f64, largest: f64) -> f64 {
    UNCHANGED * value.abs().max(UNCHANGED * largest)
}

#[cfg(test)]
mod tests {
    use std::fs::Permissions;
    use std::os::unix::fs::PermissionsExt;

    use super::*;

    fn baseline(value: f64) -> Baseline {
        Baseline { version: VERSION, scene: "scene".into(), values: BTreeMap::from([("energy.lower".into(), value)]) }
    }

    #[test]
    fn a_file_keeps_its_mode_and_a_link_its_target() {
        let folder = tempfile::tempdir().expect("a folder");
        let (file, link) = (folder.path().join("kept.json"), folder.path().join("link.json"));
        baseline(1.0).write(&file).expect("writable");
        std::fs::set_permissions(&file, Permissions::from_mode(0o640)).expect("ours");
        std::os::unix::fs::symlink(&file, &link).expect("writable");
        baseline(2.0).write(&link).expect("writable");
        assert!(link.symlink_metadata().expect("there").is_symlink());
        assert_eq!(std::fs::metadata(&file).expect("there").permissions().mode() & 0o777, 0o640);
        assert_eq!(Baseline::read(&file).expect("a baseline"), baseline(2.0));
    }

    #[test]
    fn only_regular_files_are_baselines() {
        let folder = tempfile::tempdir().expect("a folder");
        let fifo = folder.path().join("fifo");
        let made = std::process::Command::new("mkfifo").arg(&fifo).status().expect("mkfifo");
        assert!(made.success());
        for path in [fifo.as_path(), Path::new("/dev/null"), folder.path()] {
            for refused in [baseline(1.0).write(path).err(), Baseline::read(path).err()] {
                assert!(matches!(refused, Some(BaselineError::NoFile { .. })), "{}: {refused:?}", path.display());
            }
            assert!(!path.is_file());
        }
        let nowhere = folder.path().join("no/such/folder.json");
        assert!(matches!(baseline(1.0).write(&nowhere), Err(BaselineError::Write { .. })));
        assert_eq!(std::fs::read_dir(folder.path()).expect("readable").count(), 1, "something was left");
    }
}
