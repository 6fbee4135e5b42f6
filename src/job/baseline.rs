//! The baseline of a job: what is to be accepted, as a patch or at once.

use std::collections::BTreeMap;
use std::path::Path;

use super::plan::Plan;
use super::{Gathered, JobError};
use crate::report::{BaselineRow, Stored};
use crate::study::{Accepted, Baseline, Signature, today};

/// Differences of a job from its baseline.
#[derive(Debug, Default)]
pub(super) struct Kept {
    /// Scenes that only the baseline has.
    pub not_in_job: Vec<String>,
    /// Patch that would bring the baseline up to date.
    pub patch: Option<String>,
}

/// The baseline of `plan` beside the numbers of the reports.
///
/// # Errors
/// It cannot be read.
pub(super) fn of(plan: &Plan, reports: &[Option<Stored>]) -> Result<Kept, JobError> {
    let Some(path) = &plan.baseline else { return Ok(Kept::default()) };
    let accepted = if plan.accept { Accepted::read_if_there(path)? } else { Accepted::read(path)? };
    let in_job = |name: &str| plan.scenes.iter().any(|scene| scene.name == name);
    let not_in_job = accepted.scenes().filter(|name| !in_job(name)).map(str::to_string).collect();
    let unsigned = Signature { by: String::new(), on: today(), reason: String::new() };
    let found = found(plan, reports.iter().map(Option::as_ref));
    let patch = (!plan.accept).then(|| accepted.patch(&place(path), &found, &unsigned)).flatten();
    Ok(Kept { not_in_job, patch })
}

/// Writes the numbers of a job into its baseline, if its plan says so; gives whether anything changed.
///
/// # Errors
/// It cannot be read or written.
pub fn accept(plan: &Plan, gathered: &Gathered, signature: &Signature) -> Result<bool, JobError> {
    let Some(path) = plan.baseline.as_ref().filter(|_| plan.accept) else { return Ok(false) };
    let found = found(plan, gathered.reports.iter().map(Option::as_ref));
    match Accepted::read_if_there(path)?.with(&found, signature) {
        Some(text) => Baseline::write_text(path, text).map(|()| true).map_err(JobError::Baseline),
        None => Ok(false),
    }
}

fn found<'a>(plan: &Plan, reports: impl Iterator<Item = Option<&'a Stored>>) -> BTreeMap<String, Vec<BaselineRow>> {
    let rows = plan.scenes.iter().zip(reports);
    rows.filter_map(|(scene, report)| Some((scene.name.clone(), report?.baseline.clone()))).collect()
}

/// The path of a file as `git apply` wants it: from the top of the working tree that the file is in, from here otherwise.
fn place(path: &Path) -> String {
    let whole = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
    let tree = whole.ancestors().skip(1).find(|folder| folder.join(".git").exists());
    let here = std::env::current_dir().and_then(|here| here.canonicalize()).ok();
    let inside = tree.or(here.as_deref()).and_then(|top| whole.strip_prefix(top).ok());
    let own = whole.file_name().map(Path::new).unwrap_or(path);
    inside.unwrap_or(own).display().to_string()
}
