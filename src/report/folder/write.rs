//! The files of a run.

use std::path::{Path, PathBuf};

use crate::proof;
use crate::report::html::why;
use crate::report::text::csv::{TABLES, tables};
use crate::report::text::{json, junit, markdown};
use crate::report::{Dossier, folder, html, vtu};

/// Why a report was not written.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// The output folder is something else.
    #[error("{path}, where the output folder should be, is not a folder; remove it, or choose another with --out")]
    NotAFolder {
        /// The folder.
        path: PathBuf,
    },
    /// The output folder cannot be made.
    #[error("the output folder {path} cannot be made: {source}; choose another with --out")]
    Create {
        /// The folder.
        path: PathBuf,
        /// The error of the system.
        source: std::io::Error,
    },
    /// A file cannot be written.
    #[error("{path} cannot be written: {source}; free the place, or choose another folder with --out")]
    Write {
        /// The file.
        path: PathBuf,
        /// The error of the system.
        source: std::io::Error,
    },
    /// Another run holds the folder.
    #[error("another run is writing into {path} and does not end; wait for it, or choose another folder with --out")]
    Busy {
        /// The folder.
        path: PathBuf,
    },
    /// A report cannot be read.
    #[error("{path} cannot be read: {reason}")]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// The files of a folder are not one run's.
    #[error("{path} is not of the run {run} that report.json in the same folder is of; run the scene again")]
    Mixed {
        /// The file.
        path: PathBuf,
        /// The run of `report.json`.
        run: String,
    },
    /// A file could not be put together.
    #[error("{file} could not be put together: {reason}")]
    Render {
        /// Its name.
        file: &'static str,
        /// Why.
        reason: String,
    },
}

impl ReportError {
    /// True if there can be no output at the place that was named.
    pub fn is_of_the_place(&self) -> bool {
        matches!(self, ReportError::NotAFolder { .. } | ReportError::Create { .. })
    }
}

/// The names of the files that every run leaves.
pub const NAMES: [&str; 5] = ["report.json", "report.html", "junit.xml", "summary.md", "fields.vtu"];

/// Writes `report.json`, `report.html`, `junit.xml`, `summary.md` and `fields.vtu` into `dir`, which is made if need be, and
/// `checks.csv`, `contacts.csv` and `quantities.csv` where they have rows, and `proof.npz` and `why.html` where there is a proof; those of an earlier run go where they have none.
///
/// All are rendered before the first is written, and they take the place of an earlier run's at once (see
/// [`folder`]): a reader sees neither half a file nor the files of two runs.
///
/// # Errors
/// [`ReportError`]; an earlier report is then still there.
pub fn write(dossier: &Dossier, dir: &Path) -> Result<(), ReportError> {
    let headers = TABLES.map(|table| table.header());
    let tables = TABLES.iter().zip(&headers);
    let passing: Vec<folder::Passing> = tables
        .map(|(table, header)| folder::Passing { name: table.name, begins: header.as_bytes() })
        .chain([
            folder::Passing { name: proof::NAME, begins: proof::BEGINS },
            folder::Passing { name: why::NAME, begins: why::BEGINS.as_bytes() },
        ])
        .collect();
    folder::replace(dir, &render(dossier)?, &passing)
}

/// The files by name.
pub(in crate::report) fn render(dossier: &Dossier) -> Result<Vec<(&'static str, Vec<u8>)>, ReportError> {
    let report = &dossier.report;
    let fail = |file, reason: String| ReportError::Render { file, reason };
    let mut files = vec![
        ("report.json", json::json(report).map_err(|e| fail("report.json", e.to_string()))?.into_bytes()),
        ("report.html", html::page(dossier).into_bytes()),
        ("junit.xml", junit::junit(report).map_err(|e| fail("junit.xml", e.to_string()))?.into_bytes()),
        ("summary.md", markdown::summary(report).into_bytes()),
        ("fields.vtu", vtu::vtu(dossier).map_err(|e| fail("fields.vtu", e.to_string()))?),
    ];
    files.extend(tables(report).into_iter().map(|(name, text)| (name, text.into_bytes())));
    if let Some(proof) = &dossier.proof {
        files.push((proof::NAME, proof.clone()));
        files.extend(why::why(report).map(|page| (why::NAME, page.into_bytes())));
    }
    Ok(files)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample::{Sample, Verdict};

    fn listing(dir: &Path) -> Vec<String> {
        let mut names: Vec<String> =
            std::fs::read_dir(dir).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn its_files_and_nothing_else_twice_the_same() {
        let dir = tempfile::tempdir().unwrap();
        let sample = Sample::new(3, Verdict::Disagree);
        let out = dir.path().join("deep/er");
        write(&sample.dossier(), &out).unwrap();
        let mut expected: Vec<String> =
            NAMES.into_iter().chain(TABLES.map(|table| table.name)).map(String::from).collect();
        expected.sort();
        assert_eq!(listing(&out), expected);
        let read = || -> Vec<_> { expected.iter().map(|n| std::fs::read(out.join(n)).unwrap()).collect() };
        let first = read();
        write(&Sample::new(3, Verdict::Disagree).dossier(), &out).unwrap();
        assert_eq!(listing(&out), expected);
        assert!(first == read(), "same input, other bytes");
        let mut without = sample.dossier();
        without.report.quantities.clear();
        write(&without, &out).unwrap();
        expected.retain(|name| name != "quantities.csv");
        assert_eq!(listing(&out), expected);
    }

    #[test]
    fn a_file_in_the_place_of_the_folder_is_said() {
        let dir = tempfile::tempdir().unwrap();
        let file = dir.path().join("out");
        std::fs::write(&file, "x").unwrap();
        let sample = Sample::new(1, Verdict::Agree);
        let error = write(&sample.dossier(), &file).unwrap_err();
        assert!(matches!(&error, ReportError::NotAFolder { path } if *path == file), "{error}");
        let error = write(&sample.dossier(), &file.join("below")).unwrap_err();
        assert!(error.to_string().contains("--out"), "{error}");
    }

    #[test]
    fn a_folder_in_the_place_of_a_file_leaves_nothing_behind() {
        let dir = tempfile::tempdir().unwrap();
        std::fs::create_dir(dir.path().join("junit.xml")).unwrap();
        let error = write(&Sample::new(1, Verdict::Agree).dossier(), dir.path()).unwrap_err();
        assert!(error.to_string().contains("junit.xml"), "{error}");
        assert_eq!(listing(dir.path()), ["junit.xml"]);
    }

    #[test]
    fn every_output_names_the_failing_checks() {
        let sample = Sample::new(2, Verdict::Disagree);
        let dossier = sample.dossier();
        let files = render(&dossier).unwrap();
        let failing = crate::report::text::words::failing(&dossier.report);
        assert!(!failing.is_empty());
        for (name, bytes) in
            files.iter().filter(|(name, _)| *name != "fields.vtu" && (*name == "checks.csv" || !name.ends_with(".csv")))
        {
            let text = String::from_utf8(bytes.clone()).unwrap();
            let text = text.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&").replace("\\|", "|");
            for check in &failing {
                assert!(text.contains(&check.name), "{name} does not name {}", check.name);
            }
        }
    }

    #[test]
    fn every_verdict_renders_with_the_least_there_can_be() {
        for verdict in [Verdict::Agree, Verdict::Disagree, Verdict::Infeasible, Verdict::Failed] {
            let sample = Sample::new(1, verdict);
            let mut dossier = sample.dossier();
            render(&dossier).unwrap();
            dossier.dual = None;
            dossier.displacements.clear();
            dossier.maps.clear();
            dossier.report.energy = None;
            dossier.report.dual = None;
            dossier.report.stress = None;
            dossier.report.primal.clear();
            dossier.report.contact.clear();
            dossier.report.checks.clear();
            render(&dossier).unwrap();
        }
    }

    #[test]
    fn nan_everywhere_is_no_panic() {
        let mut sample = Sample::new(2, Verdict::Disagree);
        sample.spoil();
        let mut dossier = sample.dossier();
        let energy = dossier.report.energy.as_mut().unwrap();
        (energy.lower, energy.upper, energy.gap, energy.relative_error_bound) =
            (f64::NAN, f64::NAN, f64::NAN, f64::NAN);
        for quantity in &mut dossier.report.quantities {
            (quantity.value, quantity.lower, quantity.upper) = (f64::NAN, f64::NAN, f64::NAN);
            quantity.first_order = [f64::NAN; 2];
            quantity.primal[0].value = Some(f64::NAN);
        }
        for contact in &mut dossier.report.contact {
            for profile in &mut contact.profiles {
                profile.points[0] = [f64::NAN, f64::INFINITY];
            }
        }
        for map in &mut dossier.maps {
            map.values.fill(f64::NAN);
        }
        for (name, bytes) in render(&dossier).unwrap() {
            let text = String::from_utf8_lossy(&bytes);
            assert!(name == "fields.vtu" || !text.contains("NaN"), "{name}");
        }
    }
}
