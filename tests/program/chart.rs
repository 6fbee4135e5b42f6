//! `hypercircle chart`: what is saved, kept, marked and printed.

use std::path::Path;
use std::process::Output;

use serde_json::Value;

use crate::command::{case, ended, hypercircle, run};

fn chart(folder: &Path, options: &[&str]) -> Output {
    chart_of(folder, "two_blocks", options)
}

fn chart_of(folder: &Path, scene: &str, options: &[&str]) -> Output {
    let mut command = hypercircle(folder, ["chart"]);
    command.arg(case(scene)).args(options).arg("--out").arg(folder);
    let output = run(command);
    ended("chart", &output, 0, &[]);
    output
}

fn json(folder: &Path) -> Value {
    let text = std::fs::read_to_string(folder.join("chart.json")).expect("chart.json is there");
    serde_json::from_str(&text).expect("chart.json is JSON")
}

/// Records of a CSV text after RFC 4180.
fn records(text: &str) -> Vec<Vec<String>> {
    let (mut all, mut record, mut cell, mut quoted) = (Vec::new(), Vec::new(), String::new(), false);
    let mut letters = text.chars().peekable();
    while let Some(c) = letters.next() {
        match (c, quoted) {
            ('"', true) if letters.peek() == Some(&'"') => cell.push(letters.next().unwrap_or('"')),
            ('"', _) => quoted = !quoted,
            (',', false) => record.push(std::mem::take(&mut cell)),
            ('\r', false) => {}
            ('\n', false) => {
                record.push(std::mem::take(&mut cell));
                all.push(std::mem::take(&mut record));
            }
            (other, _) => cell.push(other),
        }
    }
    assert!(!quoted && cell.is_empty() && record.is_empty(), "the file ends inside a record");
    all
}

const QUICK: [&str; 10] = [
    "--reduced",
    "--method",
    "condensed",
    "--method",
    "adaptive",
    "--method",
    "adaptive-hp",
    "--refine",
    "1",
    "--quiet",
];

#[test]
fn errors_fall_bounds_hold_and_phases_add_up() {
    let folder = tempfile::tempdir().expect("a folder");
    chart(folder.path(), &QUICK);
    let chart = json(folder.path());
    let scene = &chart["scenes"][0];
    let reference = &scene["reference"]["Ok"];
    let [lower, upper] = ["lower", "upper"].map(|key| reference[key].as_f64().expect("a number"));
    // The exact energy of this scene, from meshes ten times finer: between −1.79642 and −1.79640.
    assert!(lower < -1.79640 && -1.79642 < upper, "{lower} … {upper}");
    let runs = scene["runs"].as_array().expect("runs");
    assert_eq!(runs.len(), 6);
    for run in runs {
        let plot = &run["plot"];
        let number = |key: &str| plot[key].as_f64().unwrap_or_else(|| panic!("{key} of {run}"));
        assert!(number("lower") <= upper && number("upper") >= lower);
        assert!(number("true_error") <= number("guaranteed") * 1.001 + 1e-3);
        assert!(number("peak_memory") > 1e6);
        let whole = plot["whole"]["median"].as_f64().expect("seconds");
        let phases = plot["phases"].as_array().expect("phases");
        let sum: f64 = phases.iter().map(|p| p[1].as_f64().expect("seconds")).sum();
        assert!((sum - whole).abs() < 0.02 * whole + 1e-3, "phases of {sum} s in a run of {whole} s");
        assert!(plot["solve"]["median"].as_f64().expect("seconds") <= whole);
    }
    let guaranteed = |i: usize| runs[i]["plot"]["guaranteed"].as_f64().expect("a number");
    assert!(guaranteed(1) < 0.6 * guaranteed(0));
    // Degrees pay where both methods have the same tolerance.
    let unknowns = |method: &str| {
        let finest = runs.iter().rfind(|run| run["method"] == method).expect("a run");
        assert!(finest["plot"]["guaranteed"].as_f64() <= finest["tolerance"].as_f64(), "{finest}");
        finest["plot"]["unknowns"].as_u64().expect("a number")
    };
    assert!(unknowns("adaptive-hp") < unknowns("adaptive"));
    for name in ["chart.html", "chart.csv", "figures/chart-two_blocks-error-whole.svg"] {
        assert!(folder.path().join(name).is_file(), "{name}");
    }
    let text = std::fs::read_to_string(folder.path().join("chart.md")).expect("readable");
    // Every table has as many cells in each line as in its head, and a line for each run.
    let tables: Vec<&str> = text.lines().filter(|line| line.starts_with('|')).collect();
    let cells = |line: &str| line.split(" | ").count();
    assert_eq!(tables.iter().filter(|line| cells(line) == 10).count(), 1 + runs.len(), "{text}");
    assert_eq!(tables.iter().filter(|line| cells(line) == 3).count(), 1 + 5, "{text}");
    // The command stands under each figure, and every figure is there.
    let lines: Vec<&str> = text.lines().collect();
    let figures: Vec<usize> = (0..lines.len()).filter(|&i| lines[i].starts_with("![")).collect();
    assert_eq!(figures.len(), 4);
    for i in figures {
        assert!(lines[i + 2].starts_with("`hypercircle chart ") && lines[i + 2].contains("--method adaptive"));
        let file = lines[i].split(['(', ')']).nth(1).expect("a link");
        assert!(folder.path().join(file).is_file(), "{file}");
    }
    let page = std::fs::read_to_string(folder.path().join("chart.html")).expect("readable");
    assert!(!page.contains("<script") && !page.contains("src=\"http") && page.contains("<svg"));
}

#[test]
fn the_table_is_well_formed_and_agrees_with_the_json() {
    let folder = tempfile::tempdir().expect("a folder");
    chart(folder.path(), &QUICK);
    let text = std::fs::read_to_string(folder.path().join("chart.csv")).expect("readable");
    let records = records(&text);
    let width = records[0].len();
    assert!(records.iter().all(|r| r.len() == width));
    let column = |name: &str| records[0].iter().position(|c| c == name).unwrap_or_else(|| panic!("no column {name}"));
    let chart = json(folder.path());
    let runs = chart["scenes"][0]["runs"].as_array().expect("runs");
    assert_eq!(records.len(), runs.len() + 1);
    for (record, run) in records[1..].iter().zip(runs) {
        assert_eq!(record[column("method")], run["method"].as_str().expect("a name"));
        let value: f64 = record[column("lower")].parse().expect("a number");
        assert_eq!(value, run["plot"]["lower"].as_f64().expect("a number"));
    }
}

#[test]
fn a_resumed_chart_makes_only_the_runs_that_are_missing() {
    let folder = tempfile::tempdir().expect("a folder");
    chart(folder.path(), &QUICK);
    let mut saved = json(folder.path());
    let runs = saved["scenes"][0]["runs"].as_array_mut().expect("runs");
    // A value that no run can have shows that this one was kept, and the last one is forgotten.
    runs[0]["plot"]["whole"]["median"] = Value::from(12345.0);
    let forgotten = runs.pop().expect("a run");
    std::fs::write(folder.path().join("chart.json"), saved.to_string()).expect("writable");

    let mut again = QUICK.to_vec();
    again.push("--resume");
    chart(folder.path(), &again);
    let resumed = json(folder.path());
    let runs = resumed["scenes"][0]["runs"].as_array().expect("runs");
    assert_eq!(runs[0]["plot"]["whole"]["median"].as_f64(), Some(12345.0));
    assert_eq!(runs.len(), 6);
    assert_eq!(runs[5]["plot"]["lower"], forgotten["plot"]["lower"]);

    chart(folder.path(), &QUICK);
    assert_ne!(json(folder.path())["scenes"][0]["runs"][0]["plot"]["whole"]["median"].as_f64(), Some(12345.0));
}

#[test]
fn a_file_that_is_no_chart_is_not_resumed() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("chart.json"), "{\"schema_version\": 1}").expect("writable");
    let mut command = hypercircle(folder.path(), ["chart", "--resume", "--out", "."]);
    command.arg(case("two_blocks"));
    ended("a folder with another file", &run(command), 3, &["--resume"]);
}

#[test]
fn a_method_over_the_budget_is_marked_and_its_finer_runs_skipped() {
    let folder = tempfile::tempdir().expect("a folder");
    chart(folder.path(), &["--method", "uzawa", "--refine", "2", "--repeats", "1", "--budget", "0.002", "--quiet"]);
    let chart = json(folder.path());
    let runs = chart["scenes"][0]["runs"].as_array().expect("runs");
    let kinds: Vec<&str> = runs.iter().filter_map(|r| r["status"]["kind"].as_str()).collect();
    assert_eq!(kinds, ["over-budget", "skipped", "skipped"]);
    let page = std::fs::read_to_string(folder.path().join("chart.html")).expect("readable");
    assert!(page.contains("over the budget") && page.contains("skipped"));
}

#[test]
fn the_fastest_choice_for_an_accuracy_is_printed() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut options = QUICK.to_vec();
    options.extend(["--for", "0.05"]);
    let output = chart(folder.path(), &options);
    let text = String::from_utf8(output.stdout).expect("text");
    let line = text.lines().find(|l| l.contains("guaranteed error")).unwrap_or_else(|| panic!("{text}"));
    assert!(
        line.starts_with("two_blocks: ")
            && (line.contains("--refine") || line.contains("--adapt h") && line.contains(" --tolerance "))
    );
    let percent: f64 = line
        .split("guaranteed error ")
        .nth(1)
        .and_then(|rest| rest.split(' ').next())
        .and_then(|number| number.parse().ok())
        .unwrap_or_else(|| panic!("{line}"));
    assert!(percent <= 5.0);
}

/// The exact mean displacement of the loaded edge, known to 1e-6 from meshes far finer.
const TIP: f64 = 0.801499;

#[test]
fn a_quantity_is_charted_with_its_interval() {
    let folder = tempfile::tempdir().expect("a folder");
    let tip = "\n[[quantities]]\nname = \"tip\"\ndisplacement = \"left_load\"\ndirection = [1.0, 0.0]\n";
    let scene = std::fs::read_to_string(case("two_blocks")).expect("readable") + tip;
    std::fs::write(folder.path().join("asked.toml"), scene).expect("writable");
    let asked = |name: &str| {
        let mut command = hypercircle(folder.path(), ["chart", "asked.toml", "--out", "out", "--for"]);
        command.arg(format!("{name}=0.03")).args(QUICK);
        run(command)
    };
    let output = asked("tip");
    ended("chart", &output, 0, &[]);
    let chart = json(&folder.path().join("out"));
    let mut widths = Vec::new();
    for run in chart["scenes"][0]["runs"].as_array().expect("runs") {
        let tip = &run["plot"]["quantities"][0];
        let [value, lower, upper] = ["value", "lower", "upper"].map(|key| tip[key].as_f64().expect("a number"));
        assert!(lower <= TIP + 2e-6 && TIP - 2e-6 <= upper && lower <= value && value <= upper, "{run}");
        let half = 0.5 * (upper - lower) / value;
        if let Some(tolerance) = run["tolerance"].as_f64() {
            assert!(half <= tolerance, "{half} where {tolerance} is wanted");
        }
        widths.push(half);
    }
    assert!(widths.len() == 6 && widths[1] < 0.6 * widths[0], "{widths:?}");
    let text = String::from_utf8(output.stdout).expect("text");
    for kind in ["guaranteed", "true"] {
        let line = text.lines().find(|line| line.contains(&format!("{kind} error of tip")));
        let line = line.unwrap_or_else(|| panic!("{text}"));
        let after = line.split("of tip ").nth(1).and_then(|rest| rest.split(' ').next()).expect(line);
        let percent: f64 = after.parse().expect(line);
        assert!(percent <= 3.0, "{line}");
    }
    let page = std::fs::read_to_string(folder.path().join("out/chart.html")).expect("readable");
    assert!(page.contains("relative error of tip") && page.contains("wanted of tip"));
    assert!(folder.path().join("out/figures/chart-asked-quantity-1-whole.svg").is_file());
    ended("a name that is none", &asked("top"), 2, &["asked.toml", "'top'", "tip"]);
}

#[test]
fn bodies_of_revolution_and_friction_with_a_given_bound_are_charted() {
    // Lamé's press fit: ½ p δ times the area of the seat, and δ < 0.
    let (b, c, [shaft, hub], [nu_shaft, nu_hub], delta) = (10.0, 20.0, [210e3, 70e3], [0.3, 0.33], 0.01_f64);
    let soft = b / hub * ((c * c + b * b) / (c * c - b * b) + nu_hub) + b / shaft * (1.0 - nu_shaft);
    let energy = 0.5 * delta * delta / soft * std::f64::consts::TAU * b * 10.0;
    for (scene, exact) in [("press_fit", Some(energy)), ("pushed_partly", None)] {
        let folder = tempfile::tempdir().expect("a folder");
        let options = ["--reduced", "--method", "condensed-p2", "--method", "FEniCSx P2", "--refine", "0", "--quiet"];
        chart_of(folder.path(), scene, &options);
        let chart = json(folder.path());
        let scene = &chart["scenes"][0];
        let bracket = ["lower", "upper"].map(|key| scene["reference"]["Ok"][key].as_f64().expect("a number"));
        if let Some(exact) = exact {
            assert!(bracket[0] <= exact && exact <= bracket[1], "{bracket:?} and {exact}");
        }
        let runs = scene["runs"].as_array().expect("runs");
        assert_eq!(runs.len(), 2);
        for run in runs {
            // No stress is above and no displacement below what holds the exact energy.
            let [lower, upper] = ["lower", "upper"].map(|key| run["plot"][key].as_f64());
            assert!(lower.is_none_or(|lower| lower <= bracket[1]) && upper.expect("a bound") >= bracket[0], "{run}");
        }
    }
}

#[test]
fn coulomb_friction_has_no_chart() {
    let folder = tempfile::tempdir().expect("a folder");
    let text =
        std::fs::read_to_string(case("pushed_partly")).expect("a case").replace("bound = 0.15", "coefficient = 0.3");
    let scene = folder.path().join("coulomb.toml");
    std::fs::write(&scene, text).expect("writable");
    let mut command = hypercircle(folder.path(), ["chart"]);
    let output = run({
        command.arg(&scene).args(["--reduced", "--quiet"]);
        command
    });
    ended("chart", &output, 2, &["coulomb.toml", "Coulomb", "bound"]);
}
