//! The files of a job.

use std::path::Path;

use super::data::Gathered;
use super::{JobError, badge, junit, page, summary};
use crate::report::{ReportError, folder};

/// The names of the files that every job has.
pub const FILES: [&str; 6] = ["index.html", "junit.xml", "summary.md", "job.json", "badge.json", "badge.svg"];
/// The one that only a job with another baseline has.
const PATCH: &str = "baseline.patch";

/// Writes the files of a job into `out`, beside the folders of its scenes; gives the summary.
///
/// # Errors
/// [`JobError`]; files of an earlier job are then still there.
pub fn write(gathered: &Gathered, out: &Path) -> Result<String, JobError> {
    let fail = |file, reason: String| ReportError::Render { file, reason };
    let summary = summary::summary(gathered, out);
    let mut json = serde_json::to_string_pretty(&gathered.job).map_err(|e| fail("job.json", e.to_string()))?;
    json.push('\n');
    let junit = junit::junit(gathered).map_err(|e| fail("junit.xml", e.to_string()))?;
    let mut files = vec![
        ("index.html", page::page(gathered).into_bytes()),
        ("junit.xml", junit.into_bytes()),
        ("summary.md", summary.clone().into_bytes()),
        ("job.json", json.into_bytes()),
        ("badge.json", badge::json(&gathered.job).into_bytes()),
        ("badge.svg", badge::svg(&gathered.job).into_bytes()),
    ];
    let patch = out.join(PATCH);
    match &gathered.patch {
        Some(text) => files.push((PATCH, text.clone().into_bytes())),
        // One of an earlier job would be taken for this one's.
        None if patch.is_file() => {
            std::fs::remove_file(&patch).map_err(|source| JobError::Write { path: patch, source })?;
        }
        None => {}
    }
    folder::replace(out, &files, &[])?;
    Ok(summary)
}
