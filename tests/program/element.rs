//! `hypercircle element`: lists, reports, exit codes, refusals.

use std::path::Path;
use std::process::Output;

use quick_junit::Report as JunitReport;
use serde_json::Value;

use crate::command::{ended, hypercircle, run};

/// Four times the constant strain triangle of the textbooks: plane stress, E = 1, ν = 0, right triangle with legs of one.
const TEXTBOOK: [[i32; 6]; 6] = [
    [3, 1, -2, -1, -1, 0],
    [1, 3, 0, -1, -1, -2],
    [-2, 0, 2, 0, 0, 0],
    [-1, -1, 0, 1, 1, 0],
    [-1, -1, 0, 1, 1, 0],
    [0, -2, 0, 0, 0, 2],
];
const NODES: &str = "0, 0\n1, 0\n0, 1\n";

/// Writes a matrix in MatrixMarket's format, and the nodes.
fn write(folder: &Path, k: impl Fn(usize, usize) -> f64) {
    let mut text = String::from("%%MatrixMarket matrix array real general\n6 6\n");
    for (i, j) in (0..6).flat_map(|j| (0..6).map(move |i| (i, j))) {
        text += &format!("{}\n", k(i, j));
    }
    std::fs::write(folder.join("K.mtx"), text).expect("writable");
    std::fs::write(folder.join("nodes.csv"), NODES).expect("writable");
}

fn element(folder: &Path, arguments: &[&str]) -> Output {
    run(hypercircle(folder, [&["element"], arguments].concat()))
}

const MATRIX: [&str; 10] =
    ["--matrix", "K.mtx", "--nodes", "nodes.csv", "--young", "1", "--poisson", "0", "--kinematics", "plane-stress"];

/// That an object has the keys of its schema, no others, and all those that the schema requires.
#[track_caller]
fn has_keys_of(value: &Value, schema: &Value) {
    let keys: Vec<&String> = value.as_object().expect("an object").keys().collect();
    let known = schema["properties"].as_object().expect("properties");
    assert!(keys.iter().all(|key| known.contains_key(*key)), "{keys:?} of {:?}", known.keys());
    let required = schema["required"].as_array().expect("required");
    assert!(required.iter().all(|name| keys.iter().any(|key| *key == name)), "{required:?} in {keys:?}");
}

#[test]
fn the_schema_of_a_report_on_an_element_fits_it() {
    let folder = tempfile::tempdir().expect("a folder");
    write(folder.path(), |i, j| f64::from(TEXTBOOK[i][j]) / 2.0);
    ended("a matrix", &element(folder.path(), &[&MATRIX[..], &["--out", "out"]].concat()), 1, &[]);
    let text = std::fs::read(folder.path().join("out/report.json")).expect("a report");
    let report: Value = serde_json::from_slice(&text).expect("JSON");
    let output = run(hypercircle(folder.path(), ["schema", "element"]));
    let schema: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    has_keys_of(&report, &schema);
    has_keys_of(&report["material"], &schema["$defs"]["Material"]);
    has_keys_of(&report["diagnosis"], &schema["$defs"]["Diagnosis"]);
    for finding in report["findings"].as_array().expect("findings") {
        has_keys_of(finding, &schema["$defs"]["Finding"]);
    }
}

#[test]
fn without_a_name_the_elements_are_listed() {
    let folder = tempfile::tempdir().expect("a folder");
    let output = element(folder.path(), &[]);
    ended("the list", &output, 0, &[]);
    let text = String::from_utf8_lossy(&output.stdout);
    for name in ["block-1", "block-4", "single-triangle", "johnson-mercier", "p1", "p2", "q4", "q4-reduced", "claims"] {
        assert!(text.contains(name), "{name} in\n{text}");
    }
    assert!(!folder.path().join("out").exists());
}

#[test]
fn a_shipped_element_leaves_a_page_that_stands_alone() {
    let folder = tempfile::tempdir().expect("a folder");
    let output = element(folder.path(), &["q4-reduced"]);
    ended("q4-reduced", &output, 0, &[]);
    assert!(String::from_utf8_lossy(&output.stdout).contains("2 hourglass motions"));
    let out = folder.path().join("out/element-q4-reduced");
    let page = std::fs::read_to_string(out.join("report.html")).expect("there");
    let bare = page.replace("http://www.w3.org/2000/svg", "");
    assert!(["http", "<script", "<link", "src="].iter().all(|word| !bare.contains(word)));
    assert!(page.contains("hourglass motions") && page.contains("Flexibility of a square"));
    let report: Value = serde_json::from_slice(&std::fs::read(out.join("report.json")).expect("there")).expect("JSON");
    assert_eq!((&report["passed"], &report["kind"]), (&Value::Bool(true), &Value::from("displacement")));
    // A property that it does not claim fails no pipeline; claimed, it does.
    let output = element(folder.path(), &["q4-reduced", "--claim", "rank"]);
    ended("rank claimed", &output, 1, &[]);
}

#[test]
fn a_matrix_of_the_textbook_passes_and_a_wrong_one_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let right = |i: usize, j: usize| f64::from(TEXTBOOK[i][j]) / 4.0;
    write(folder.path(), right);
    ended("the textbook", &element(folder.path(), &MATRIX), 0, &[]);
    // Without a material it is whatever constant strains show.
    ended("no material", &element(folder.path(), &MATRIX[..4]), 0, &[]);
    write(folder.path(), |i, j| 2.0 * right(i, j));
    let output = element(folder.path(), &MATRIX);
    ended("twice", &output, 1, &[]);
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(text.contains("K is 2 times what it must be") && text.contains("patch-energy (MISSING)"), "{text}");
    let junit = std::fs::read_to_string(folder.path().join("out/element-K/junit.xml")).expect("there");
    let junit = JunitReport::deserialize_from_str(&junit).expect("JUnit");
    assert_eq!((junit.failures, junit.errors), (2, 0));
    // What was not made is skipped, not passed.
    let cases = &junit.test_suites[0].test_cases;
    let of = |name: &str| cases.iter().find(|c| c.name.as_str() == name).map(|c| &c.status);
    assert!(matches!(of("convergence"), Some(quick_junit::TestCaseStatus::Skipped { .. })));
    let waived = [&MATRIX[..], &["--waive", "patch-energy", "--waive", "patch-forces"]].concat();
    ended("waived", &element(folder.path(), &waived), 0, &[]);
}

#[test]
fn bad_input_is_refused_with_what_to_do() {
    let folder = tempfile::tempdir().expect("a folder");
    write(folder.path(), |i, j| f64::from(TEXTBOOK[i][j]));
    std::fs::write(folder.path().join("two.csv"), "0 0\n1 0\n").expect("writable");
    std::fs::write(folder.path().join("text.mtx"), "no matrix").expect("writable");
    std::fs::write(folder.path().join("broken.npz"), "PK\x05\x06").expect("writable");
    let refusals: [(&[&str], &str); 10] = [
        (&["q5"], "choose from block-1"),
        (&["p1", "--matrix", "K.mtx"], "cannot be used with"),
        (&["--matrix", "none.mtx"], "none.mtx: cannot be opened"),
        (&["--matrix", "K.mtx"], "--nodes FILE"),
        (&["--matrix", "K.mtx", "--nodes", "two.csv"], "2 nodes"),
        (&["--matrix", "text.mtx", "--nodes", "nodes.csv"], "%%MatrixMarket"),
        (&["--matrix", "broken.npz"], "numpy.savez"),
        (&["--matrix", "K.mtx", "--nodes", "nodes.csv", "--young", "1"], "without ν"),
        (
            &[
                "--matrix",
                "K.mtx",
                "--nodes",
                "nodes.csv",
                "--young",
                "1",
                "--poisson",
                "0.5",
                "--kinematics",
                "plane-strain",
            ],
            "below 1/2",
        ),
        (&["p1", "--waive", "beauty"], "no property has this name"),
    ];
    for (arguments, fragment) in refusals {
        ended(&arguments.join(" "), &element(folder.path(), arguments), 2, &[fragment]);
        assert!(!folder.path().join("out").exists());
    }
}

/// Entries that are too large by what a unit is, and by far more, are no thin element.
#[test]
fn a_matrix_in_other_units_is_not_passed() {
    let folder = tempfile::tempdir().expect("a folder");
    write(folder.path(), |i, j| f64::from(TEXTBOOK[i][j]) / 4.0);
    let others = MATRIX.iter().filter(|word| !["--young", "1"].contains(word)).copied();
    let matrix: Vec<&str> = others.chain(["--out", "out", "-q", "--young"]).collect();
    let exits = [("1", 0), ("1e-3", 1), ("1e-9", 1), ("1e-15", 1), ("1e-60", 1), ("1e9", 1), ("1e60", 1)];
    // No units have these, and squares of them are no numbers.
    for (young, exit) in exits.into_iter().chain([("1e154", 2), ("1e-200", 2)]) {
        ended(young, &element(folder.path(), &[&matrix[..], &[young]].concat()), exit, &[]);
    }
}
