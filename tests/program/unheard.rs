//! Options that would do nothing, files that would be lost, and places where nothing can be written: refused before anything is solved.

use std::path::Path;

use crate::command::{ended, hypercircle, run};

/// A folder with two scenes.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases");
    for name in ["two_blocks.toml", "patch.toml"] {
        std::fs::copy(cases.join(name), folder.path().join(name)).expect("writable");
    }
    folder
}

#[track_caller]
fn refused(folder: &Path, arguments: &[&str], words: &[&str]) {
    ended(&arguments.join(" "), &run(hypercircle(folder, arguments)), 2, words);
}

#[test]
fn what_would_not_be_heard_is_refused() {
    let folder = folder();
    let scene = "two_blocks.toml";
    for (arguments, words) in [
        (&["verify", scene, "--reason", "because"][..], ["nothing is accepted", "--accept"]),
        (&["verify", scene, "--baseline", "b.json", "--accept", "--reason", "x"], ["in JSON has no place", ".toml"]),
        (
            &["verify", scene, "--baseline", "b.toml", "--accept", "--reason", "x", "--shard", "1/2"],
            ["a part of a job", "gather"],
        ),
        (&["verify", scene, "patch.toml", "--accepted-by", "me"], ["--accepted-by", "nothing is accepted"]),
        (&["certify", scene, "--value", "force=1", "--solution"], ["--displacement", "required"]),
        (&["certify", scene, "--value", "force=1", "--field", "u"], ["--displacement", "required"]),
        (&["certify", scene, "--value", "force=1", "--value", "force=2"], ["force twice", "one value"]),
        (&["element", "q4", "--young", "5"], ["--young is about a matrix", "leave --young out"]),
        (&["element", "q4", "--order", "blocked"], ["--order is about a matrix", "--matrix"]),
        (&["element", "q4", "--claim", "dimension"], ["cannot be held to dimension", "other elements"]),
        (&["element", "q4", "--claim", "bound", "--waive", "bound"], ["claimed and waived", "one of the two"]),
        (&["element", "--claim", "reference"], ["of what element", "give NAME"]),
    ] {
        refused(folder.path(), arguments, &words);
    }
    assert!(!folder.path().join("out").exists(), "nothing was written");
}

/// What says how to refine, and not how far, is a remark: a script that always gives limits is right to.
#[test]
fn limits_of_a_refinement_that_nobody_asked_for_are_told() {
    let folder = folder();
    for (option, value) in [("--adapt", "h"), ("--max-triangles", "5"), ("--max-seconds", "1e-6")] {
        let arguments = ["solve", "two_blocks.toml", option, value];
        ended(option, &run(hypercircle(folder.path(), arguments)), 0, &[option, "none is given", "Add --tolerance"]);
        let said = ended(option, &run(hypercircle(folder.path(), [&arguments[..], &["-q"]].concat())), 0, &[]);
        assert!(!said.contains(option), "{said}");
    }
    let value = ["certify", "two_blocks.toml", "--value", "force=1", "--max-triangles", "5"];
    let said = run(hypercircle(folder.path(), value));
    assert!(String::from_utf8_lossy(&said.stderr).contains("--max-triangles"), "{said:?}");
}

#[test]
fn what_is_no_baseline_and_no_page_is_not_replaced() {
    let folder = folder();
    let place = folder.path();
    std::fs::write(place.join("notes.md"), "mine").expect("writable");
    ended("a report", &run(hypercircle(place, ["solve", "two_blocks.toml", "--out", "a", "-q"])), 0, &[]);
    let report = std::fs::read(place.join("a/report.json")).expect("there");
    for file in ["notes.md", "a/report.json"] {
        let arguments = ["verify", "two_blocks.toml", "--baseline", file, "--accept"];
        refused(place, &arguments, &[file, "holds no baseline", "another file"]);
    }
    refused(place, &["diff", "a", "a", "--html", "a/report.json"], &["a/report.json", "no page"]);
    assert_eq!(std::fs::read_to_string(place.join("notes.md")).expect("there"), "mine");
    assert_eq!(std::fs::read(place.join("a/report.json")).expect("there"), report);
    // A page, or what is there for the first time, is.
    for _ in 0..2 {
        ended("a page", &run(hypercircle(place, ["diff", "a", "a", "--html", "page.html"])), 0, &[]);
    }
}

#[test]
fn a_place_without_room_for_files_is_bad_input() {
    let folder = folder();
    std::fs::write(folder.path().join("file"), "").expect("writable");
    // A folder of the system, which says that it may be written to, and a file.
    for place in ["/proc/x", "file"] {
        for arguments in [
            &["solve", "two_blocks.toml", "--out", place][..],
            &["solve", "two_blocks.toml", "patch.toml", "--out", place],
            &["element", "q4", "--out", place],
            &["mesh", "two_blocks.toml", "--out", place],
            &["chart", "two_blocks.toml", "--out", place],
            &["stability", "--out", place],
            &["man", "--out", place],
        ] {
            refused(folder.path(), arguments, &[]);
        }
    }
}

#[test]
fn a_summary_that_cannot_be_written_is_told() {
    let folder = folder();
    let mut command = hypercircle(folder.path(), ["solve", "two_blocks.toml", "-q"]);
    command.env("GITHUB_STEP_SUMMARY", folder.path());
    ended("a folder in the place of the summary", &run(command), 0, &["GITHUB_STEP_SUMMARY", "missing"]);
}

/// Where a run ends before it has a report, an old one that agrees is not taken for its own.
#[test]
fn a_report_of_an_earlier_run_is_told_apart() {
    let folder = folder();
    let place = folder.path();
    ended("a report", &run(hypercircle(place, ["solve", "two_blocks.toml", "--out", "a", "-q"])), 0, &[]);
    std::fs::write(place.join("broken.toml"), "[model").expect("writable");
    refused(place, &["solve", "broken.toml", "--out", "a"], &["a/report.json is of an earlier run"]);
    let said = ended("no report", &run(hypercircle(place, ["solve", "broken.toml", "--out", "b"])), 2, &[]);
    assert!(!said.contains("earlier run"), "{said}");
}
