//! Every scene of the repository and every JSON file that the program writes, held against the schemas that it prints by
//! Python's jsonschema.

use std::path::{Path, PathBuf};

use crate::command::{case, hypercircle, run, said};
use crate::validate::misfits;

/// The files of `folder` in the repository that end with `.toml`.
fn scenes(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let entries = std::fs::read_dir(folder).expect("part of the repository");
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.expect("readable").path()).collect();
    files.retain(|file| file.extension().is_some_and(|ending| ending == "toml"));
    files.sort();
    files
}

#[test]
fn all_scenes_fit_their_schema() {
    let folder = tempfile::tempdir().expect("a folder");
    let files: Vec<PathBuf> = ["cases", "tests/scenes", "tests/malformed/valid"].into_iter().flat_map(scenes).collect();
    assert!(files.len() > 30, "{files:?}");
    assert_eq!(misfits(folder.path(), "scene", &files), "");
}

#[test]
fn a_misspelt_key_does_not_fit() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = std::fs::read_to_string(case("ring")).expect("part of the repository");
    assert!(text.contains("young"));
    let scene = folder.path().join("ring.toml");
    std::fs::write(&scene, text.replace("young", "yuong")).expect("writable");
    let found = misfits(folder.path(), "scene", &[scene]);
    assert!(found.contains("ring.toml: $.bodies") && found.contains("yuong"), "{found}");
}

#[test]
fn written_reports_fit_their_schemas() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    let blocks = case("two_blocks").display().to_string();
    let ring = case("ring").display().to_string();
    let quantities = format!("{}/tests/malformed/valid/quantities.toml", env!("CARGO_MANIFEST_DIR"));
    let unheld = path("unheld.toml");
    let text = std::fs::read_to_string(&blocks).expect("part of the repository");
    std::fs::write(&unheld, text.replace("value = [4.0, 0.0]", "value = [-4.0, 0.0]")).expect("writable");
    let unheld = unheld.display().to_string();
    let runs: [(&[&str], &str); 7] = [
        (&["solve", &blocks], "plain"),
        (&["solve", &ring, "--tolerance", "0.05"], "adaptive"),
        (&["solve", &quantities], "quantities"),
        (&["solve", &unheld], "unheld"),
        (&["certify", &quantities, "--value", "drift=1", "--baseline", "b.toml", "--accept"], "accepted"),
        (&["certify", &quantities, "--value", "drift=1", "--baseline", "b.toml"], "compared"),
        (&["solve", &blocks, &ring], "job"),
    ];
    let mut reports = Vec::new();
    for (words, out) in runs {
        let output = run(hypercircle(folder.path(), words.iter().copied().chain(["--quiet", "--out", out])));
        let report = path(out).join(if out == "job" { "job.json" } else { "report.json" });
        assert!(report.is_file(), "{words:?}: {}", said(&output));
        reports.push(report);
    }
    let job = reports.pop().expect("the last one");
    reports.push(path("job/two_blocks/report.json"));
    assert_eq!(misfits(folder.path(), "report", &reports), "");
    assert_eq!(misfits(folder.path(), "job", &[job]), "");

    let output = run(hypercircle(folder.path(), ["element", "p1", "--quiet", "--out", "element"]));
    let element = path("element/report.json");
    assert!(element.is_file(), "{}", said(&output));
    assert_eq!(misfits(folder.path(), "element", &[element]), "");
}

/// A solver that tells nothing but displacements: zeros, which are no solution.
const ZEROS: &str = r#"
import json, sys
points = json.load(open(sys.argv[1]))["points"]
answer = {"format": "hypercircle-primal", "version": 1, "degree": 1, "vertex_displacement": [[0, 0]] * len(points)}
json.dump(answer, open(sys.argv[2] + "/primal-P1.json", "w"))
"#;

#[test]
fn what_a_solver_does_not_tell_is_missing_and_not_zero() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("zeros.py"), ZEROS).expect("writable");
    let blocks = case("two_blocks").display().to_string();
    let solver = format!("/usr/bin/python3 {}/zeros.py {{problem}} {{out}}", folder.path().display());
    let words = ["verify", &blocks, "--reference", &solver, "--quiet", "--out", "out"];
    let output = run(hypercircle(folder.path(), words));
    assert_eq!(output.status.code(), Some(1), "{}", said(&output));
    let file = |name: &str| std::fs::read_to_string(folder.path().join("out").join(name)).expect("written");
    let report: serde_json::Value = serde_json::from_str(&file("report.json")).expect("JSON");
    let model = &report["primal"][0];
    assert!(model["unknowns"].is_null() && model["iterations"].is_null(), "{model}");
    let summary = file("summary.md");
    let row = summary.lines().find(|line| line.contains(" P1 |")).unwrap_or_else(|| panic!("{summary}"));
    assert!(row.ends_with("| – |"), "{row}");
    assert_eq!(misfits(folder.path(), "report", &[folder.path().join("out/report.json")]), "");
}
