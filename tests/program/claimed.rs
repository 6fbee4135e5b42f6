//! `certify --solution`: fields of a displacement method of its own, `tests/support/displacement`, right and with one mistake each.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;

use crate::command::{case, ended, hypercircle, run, said};
use hypercircle::primal::exchange::write_problem;
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;
use serde_json::Value;

/// The diagnosis that is expected: the finding, and its number to two digits where it has one.
type Expected = Option<(&'static str, Option<f64>)>;

/// The mistakes of `fields.py` by name, with what explains them.
const MISTAKES: [(&str, Expected); 22] = [
    ("right", None),
    ("digits", None),
    ("coordinates", None),
    ("modulus", Some(("body/left/young", Some(1.05)))),
    ("load_1", Some(("load/left_load", Some(1.01)))),
    ("load_10", Some(("load/left_load", Some(1.1)))),
    ("load_unit", Some(("load/left_load", Some(1e3)))),
    ("plane_stress", Some(("kinematics", None))),
    ("poisson_exchanged", Some(("bodies/left|right/poisson-exchanged", None))),
    ("poisson", Some(("body/right/poisson", Some(0.45)))),
    ("value", Some(("value", None))),
    ("wall_along_x", Some(("support/wall/missing", None))),
    ("roller_clamped", Some(("boundary/left_bottom/clamped", None))),
    ("penalty_stiff", Some(("contact/left_face|right_face/penalty", Some(1e4)))),
    ("penalty_soft", Some(("contact/left_face|right_face/penalty", Some(20.0)))),
    ("tied", Some(("contact/left_face|right_face/tied", None))),
    ("contact_row_missing", Some(("contact/left_face|right_face/in-part", None))),
    ("lambda_sign", Some(("stiffness/lambda", Some(-1.0)))),
    ("triangle", Some(("triangle/material", Some(1.3)))),
    ("sign", Some(("displacement/sign-y", None))),
    ("axes", Some(("displacement/axes", None))),
    ("shifted", Some(("displacement/shifted", Some(1.0)))),
];

fn python() -> PathBuf {
    std::env::var_os("HYPERCIRCLE_PYTHON").map_or("/usr/bin/python3".into(), PathBuf::from)
}

/// Two blocks of two materials, so that exchanging them makes a difference.
pub fn scene() -> String {
    let text = std::fs::read_to_string(case("two_blocks")).expect("the case");
    let (before, after) = text.rsplit_once("poisson = 0.3").expect("two bodies");
    format!("{before}poisson = 0.2{after}")
}

/// Writes the scene and its fields of both degrees; `false` where numpy or scipy is missing.
fn prepared(folder: &Path, names: &[&str]) -> bool {
    prepared_on(folder, &scene(), names)
}

/// As [`prepared`], for any `scene`.
pub fn prepared_on(folder: &Path, scene: &str, names: &[&str]) -> bool {
    let has = Command::new(python()).args(["-c", "import numpy, scipy.sparse"]).output();
    if !has.is_ok_and(|output| output.status.success()) {
        eprintln!("skipped: {} has no numpy and scipy", python().display());
        return false;
    }
    std::fs::write(folder.join("scene.toml"), scene).expect("writable");
    let problem = Problem::load(Scene::read(&folder.join("scene.toml")).expect("a scene")).expect("a mesh");
    write_problem(&problem, &[], folder).expect("writable");
    let program = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/support/displacement/fields.py");
    for degree in ["1", "2"] {
        let target = folder.join(format!("P{degree}"));
        std::fs::create_dir(&target).expect("writable");
        let mut command = Command::new(python());
        command.arg(&program).arg(folder.join("problem.json")).arg(target).arg(degree).args(names);
        let output = command.output().expect("an interpreter");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
    true
}

/// The exit code and the report on a field that is claimed to be a solution.
pub fn certified(folder: &Path, field: &str, more: &[&str]) -> (i32, Value) {
    let out = format!("out/{field}-{}", more.len());
    let file = format!("{field}.vtk");
    let usual = ["certify", "scene.toml", "--displacement", &file, "--solution", "--quiet", "--out", &out];
    let output = run(hypercircle(folder, usual.iter().chain(more)));
    let text =
        std::fs::read(folder.join(&out).join("report.json")).unwrap_or_else(|_| panic!("{field}: {}", said(&output)));
    (output.status.code().expect("a code"), serde_json::from_slice(&text).expect("JSON"))
}

pub fn check<'a>(report: &'a Value, name: &str) -> &'a Value {
    let checks = report["checks"].as_array().expect("checks");
    checks.iter().find(|c| c["name"] == name).unwrap_or_else(|| panic!("no check {name}"))
}

#[test]
fn every_mistake_is_found_and_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let names = MISTAKES.map(|(name, _)| name);
    if !prepared(folder.path(), &names) {
        return;
    }
    let queue = Mutex::new(MISTAKES.iter().zip(["P1", "P2"].iter().cycle()).collect::<Vec<_>>());
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                loop {
                    let Some((&(name, expected), degree)) = queue.lock().expect("unpoisoned").pop() else { break };
                    let (code, report) = certified(folder.path(), &format!("{degree}/{name}"), &[]);
                    let Some((finding, number)) = expected else {
                        assert_eq!(code, 0, "{degree} {name}: {}", report["verdict"]);
                        assert!(report["diagnosis"].as_array().expect("a list").is_empty());
                        continue;
                    };
                    assert_eq!(code, 1, "{degree} {name}");
                    let found = report["diagnosis"][0]["findings"].as_array().expect("findings");
                    assert_eq!(found.len(), 1, "{degree} {name}: {}", report["diagnosis"]);
                    assert_eq!(found[0]["name"], finding, "{degree} {name}: {}", report["diagnosis"]);
                    if let Some(number) = number {
                        let value = found[0]["value"].as_f64().expect("a number");
                        assert!((value - number).abs() < 5e-3 * number.abs(), "{degree} {name}: {value} for {number}");
                    }
                    let residual = &report["diagnosis"][0]["explained"];
                    assert!(residual.is_null() || residual.as_f64().expect("a number") > 0.9999, "{degree} {name}");
                }
            });
        }
    });
}

/// A linear solution on a coarse mesh is off by several per cent, and right as such; as the exact displacement it is wrong.
#[test]
fn a_quantity_of_a_discrete_solution_may_be_off_by_its_own_error() {
    let folder = tempfile::tempdir().expect("a folder");
    if !prepared(folder.path(), &["right"]) {
        return;
    }
    let tip = "\n[[quantities]]\nname = \"tip\"\ndisplacement = \"left_load\"\ndirection = [1.0, 0.0]\n";
    std::fs::write(folder.path().join("scene.toml"), scene() + tip).expect("writable");
    let (code, report) = certified(folder.path(), "P1/right", &["--tolerance-of", "tip=0.01"]);
    let quantity = &report["quantities"][0];
    assert_eq!(quantity["primal"][0]["inside"], false, "{quantity}");
    assert_eq!(code, 0, "{}", report["verdict"]);
    let usual = ["certify", "scene.toml", "--displacement", "P1/right.vtk", "--tolerance-of", "tip=0.01", "--quiet"];
    ended("as any admissible field", &run(hypercircle(folder.path(), usual)), 0, &[]);
    // A value by itself claims to be the exact one.
    let value = quantity["primal"][0]["value"].as_f64().expect("a value");
    let mut given = hypercircle(folder.path(), ["certify", "scene.toml", "--quiet", "--tolerance-of", "tip=0.01"]);
    given.args(["--value", &format!("tip={value:e}")]);
    ended("as the exact value", &run(given), 1, &[]);
}

#[test]
fn the_place_of_a_wrong_value_is_named_as_in_the_file_and_drawn() {
    let folder = tempfile::tempdir().expect("a folder");
    if !prepared(folder.path(), &["value"]) {
        return;
    }
    let (_, report) = certified(folder.path(), "P1/value", &[]);
    // The mesh has a vertex of each body there; which of them is wrong, the program that wrote the file knows.
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).expect("a file");
    let why = check(&report, "solution/residual")["why"].as_str().expect("a sentence").to_string();
    let sentence = report["diagnosis"][0]["sentence"].as_str().expect("a sentence").to_string();
    let number: usize = sentence
        .split("point ")
        .nth(1)
        .and_then(|s| s.split(' ').next())
        .and_then(|s| s.parse().ok())
        .expect("a number");
    let line = read("P1/value.vtk").lines().nth(4 + number).expect("a point").to_string();
    let place: Vec<f64> = line.split(' ').map(|x| x.parse().expect("a number")).collect();
    let said = sentence.split("at (").nth(1).and_then(|s| s.split(')').next()).expect("a place");
    let said: Vec<f64> = said.split(", ").map(|x| x.parse().expect("a number")).collect();
    assert!((0..2).all(|c| (said[c] - place[c]).abs() < 1e-5), "{sentence} for {line}");
    assert!(why.contains(&format!("point {number} of the file")), "{why}");
    assert!(read("out/P1/value-0/report.html").contains("What equilibrium misses at the nodes of each triangle"));
    assert!(read("out/P1/value-0/summary.md").contains("What is wrong with value.vtk"));
}

#[test]
fn what_is_allowed_agrees_and_is_told() {
    let folder = tempfile::tempdir().expect("a folder");
    if !prepared(folder.path(), &["penalty_stiff"]) {
        return;
    }
    let (code, report) = certified(folder.path(), "P2/penalty_stiff", &["--allow", "penetration=1e-4"]);
    assert_eq!(code, 0, "{}", report["verdict"]);
    let verdict = report["verdict"].as_str().expect("a sentence");
    assert!(verdict.contains("allowed for solution/contact/left_face|right_face/penetration"), "{verdict}");
    let page = std::fs::read_to_string(folder.path().join("out/P2/penalty_stiff-2/report.html")).expect("a page");
    assert!(page.contains("WITH ALLOWANCES"), "no word of allowances");
}

#[test]
fn a_soft_contact_is_repaired_for_what_it_is_worth() {
    let folder = tempfile::tempdir().expect("a folder");
    if !prepared(folder.path(), &["right", "penalty_soft"]) {
        return;
    }
    for degree in ["P1", "P2"] {
        let energy = |name: &str| {
            certified(folder.path(), &format!("{degree}/{name}"), &[]).1["primal"][0]["energy"]
                .as_f64()
                .expect("a number")
        };
        let (right, soft) = (energy("right"), energy("penalty_soft"));
        let (_, report) = certified(folder.path(), &format!("{degree}/penalty_soft"), &[]);
        let told = report["diagnosis"][0]["sentence"].as_str().expect("a sentence");
        let between = told.split_once("lowers the energy by ").and_then(|(_, rest)| rest.split_once(" and changes"));
        let ends: Vec<f64> = (between.expect("two ends").0.split(" to "))
            .map(|end| end.replace('−', "-").parse().unwrap_or_else(|_| panic!("{told}")))
            .collect();
        assert!(ends[0] <= 1.001 * (right - soft) && right - soft <= 1.001 * ends[1], "{degree}: {told}");
        assert!(ends[0] < ends[1], "{degree}: nothing is known that exactly: {told}");
        // ½‖u_ε − u‖² ≤ 𝓛(u) − 𝓛(u_ε) for the constrained solution u, and the repair moves by about as much.
        let bound = |report: &Value| report["primal"][0]["relative_error_bound"].as_f64().expect("a number");
        let (_, honest) = certified(folder.path(), &format!("{degree}/right"), &[]);
        let strain = report["energy"]["complementary"].as_f64().expect("a number");
        let worth = ((right - soft) / strain).sqrt();
        assert!(
            bound(&report) <= bound(&honest) + worth,
            "{degree}: {} for {} and {worth}",
            bound(&report),
            bound(&honest)
        );
    }
}

#[test]
fn a_tolerance_refines_the_stresses_and_keeps_the_field() {
    let folder = tempfile::tempdir().expect("a folder");
    if !prepared(folder.path(), &["load_10"]) {
        return;
    }
    let (_, plain) = certified(folder.path(), "P1/load_10", &[]);
    let (_, fine) = certified(folder.path(), "P1/load_10", &["--tolerance", "0.004"]);
    assert_eq!(check(&fine, "bracket/tolerance")["passed"], true, "{}", fine["verdict"]);
    assert_eq!(plain["primal"][0]["energy"], fine["primal"][0]["energy"]);
    let bound = |report: &Value| report["primal"][0]["relative_error_bound"].as_f64().expect("a number");
    assert!(bound(&fine) < bound(&plain) && bound(&fine) > 0.004, "{} from {}", bound(&fine), bound(&plain));
    // The headline is about the field.
    let verdict = fine["verdict"].as_str().expect("a sentence");
    assert!(verdict.contains("relative energy-norm error of load_10.vtk is at most"), "{verdict}");
}

/// A shifted body without stress, whose few digits would excuse any residual, and a modulus 5 % off in four digits.
#[test]
fn digits_that_hide_a_mistake_are_no_excuse() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/program/rounded");
    let out = tempfile::tempdir().expect("a folder");
    for name in ["lift_only", "E5_4"] {
        let target = out.path().join(name);
        let mut command = Command::new(env!("CARGO_BIN_EXE_hypercircle"));
        command.arg("certify").arg(folder.join("mix.toml")).args(["--solution", "--quiet", "--displacement"]);
        command.arg(folder.join(format!("{name}.vtu"))).arg("--out").arg(&target);
        let output = command.output().expect("the program");
        assert_eq!(output.status.code(), Some(1), "{name}: {}", String::from_utf8_lossy(&output.stderr));
        let text = std::fs::read_to_string(target.join("report.json")).expect("a report");
        let report: Value = serde_json::from_str(&text).expect("JSON");
        let residual = check(&report, "solution/residual");
        assert_eq!(residual["passed"], false, "{name}");
        let allowed = residual["allowed"].as_f64().expect("a number");
        assert!(allowed < 0.05, "{name}: {allowed}");
        let why = residual["why"].as_str().expect("a sentence");
        assert!(residual["value"].is_number() || why.contains("needed to tell 5 % of E"), "{name}: {why}");
    }
}
