//! Which run the files of a folder belong to.

use std::path::Path;

use serde_json::Value;

use crate::report::ReportError;
use crate::report::text::csv::TABLES;

/// Text before the identifier in the files that are not JSON, in their order in [`crate::report::NAMES`].
const BEFORE: [(&str, &str); 4] = [
    ("report.html", "<meta name=\"run\" content=\""),
    ("junit.xml", "<property name=\"run\" value=\""),
    ("summary.md", " · run "),
    ("fields.vtu", "<!-- run "),
];

/// The identifier of the run that made the report in `dir`, once all its files that are there have been seen to name the
/// same one. Whoever reads several of them asks here first.
///
/// # Errors
/// [`ReportError::Read`] where there is no report, [`ReportError::Mixed`] where files of two runs lie side by side.
pub fn run_of(dir: &Path) -> Result<String, ReportError> {
    let path = dir.join("report.json");
    let text = std::fs::read(&path).map_err(|e| ReportError::Read { path: path.clone(), reason: e.to_string() })?;
    let report: Value =
        serde_json::from_slice(&text).map_err(|e| ReportError::Read { path: path.clone(), reason: e.to_string() })?;
    let Some(run) = report["run"].as_str() else {
        return Err(ReportError::Read { path, reason: "it has no `run`".to_string() });
    };
    for (name, before) in BEFORE.into_iter().chain(TABLES.map(|table| (table.name, ","))) {
        let path = dir.join(name);
        let Ok(bytes) = std::fs::read(&path) else { continue };
        let table = TABLES.into_iter().find(|table| table.name == name);
        if table.is_some_and(|table| !bytes.starts_with(table.header().as_bytes())) {
            // The user's, beside a report that has no such table.
            continue;
        }
        // The program writes it first, or last; a name in the scene cannot stand in both places.
        let own = [before.as_bytes(), run.as_bytes()].concat();
        if !bytes.windows(own.len()).any(|part| part == own) {
            return Err(ReportError::Mixed { path, run: run.to_string() });
        }
    }
    Ok(run.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::NAMES;
    use crate::report::sample::{Sample, Verdict};
    use crate::report::write;

    #[test]
    fn every_file_names_its_run_and_a_mixture_is_told() {
        let dirs = [(); 2].map(|()| tempfile::tempdir().expect("a folder"));
        for (dir, run) in dirs.iter().zip(["0000000000000001", "0000000000000002"]) {
            let sample = Sample::new(2, Verdict::Agree);
            let mut dossier = sample.dossier();
            dossier.report.run = run.to_string();
            write(&dossier, dir.path()).expect("writable");
            assert_eq!(run_of(dir.path()).expect("one run"), run);
        }
        for name in NAMES.into_iter().chain(TABLES.map(|table| table.name)) {
            let kept = std::fs::read(dirs[0].path().join(name)).expect("there");
            std::fs::copy(dirs[1].path().join(name), dirs[0].path().join(name)).expect("writable");
            let error = run_of(dirs[0].path()).expect_err("a mixture");
            assert!(matches!(error, ReportError::Mixed { .. }), "{name}: {error}");
            std::fs::write(dirs[0].path().join(name), kept).expect("writable");
        }
        std::fs::write(dirs[0].path().join("quantities.csv"), "mine").expect("writable");
        assert!(run_of(dirs[0].path()).is_ok());
    }

    #[test]
    fn a_folder_without_a_report_is_told() {
        let dir = tempfile::tempdir().expect("a folder");
        for content in [None, Some("{"), Some("{}")] {
            if let Some(text) = content {
                std::fs::write(dir.path().join("report.json"), text).expect("writable");
            }
            assert!(matches!(run_of(dir.path()), Err(ReportError::Read { .. })));
        }
    }
}
