//! No certificate for what is no solution: fields made at random from solutions of a displacement method of its own,
//! `tests/support/displacement/spoiled.py`, which also measures how far each is from the solution.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;

use crate::command::{hypercircle, run, said};
use hypercircle::primal::exchange::write_problem;
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;
use serde_json::Value;

/// Two blocks, one pressed and lifted off the other.
const PRESSED: &str = r#"
[model]
kinematics = "plane-strain"
[geometry]
size = 0.25
[[geometry.polygons]]
body = "left"
points = [[0, 0], [1, 0], [1, 1], [0, 1]]
edges = ["below", "face", "", "load"]
[[geometry.polygons]]
body = "right"
points = [[1, 0], [2, 0], [2, 1], [1, 1]]
edges = ["below_right", "wall", "", "facing"]
[bodies.left]
young = 3e4
poisson = 0.3
[bodies.right]
young = 1e4
poisson = 0.2
[[supports]]
on = "below"
type = "roller"
[[supports]]
on = "wall"
type = "clamped"
[[tractions]]
on = "load"
value = [40.0, 0.0]
gradient = [[0.0, -70.0], [0.0, 0.0]]
[[contacts]]
between = ["face", "facing"]
"#;

/// A block that a support moves against an obstacle.
const MOVED: &str = r#"
[model]
kinematics = "plane-stress"
thickness = 0.5
[geometry]
size = 0.25
[[geometry.polygons]]
body = "block"
points = [[0, 0], [1, 0], [1, 1], [0, 1]]
edges = ["below", "", "above", "side"]
[bodies.block]
young = 2e5
poisson = 0.3
[[supports]]
on = "below"
type = "clamped"
displacement = [0.0, 0.01]
[[supports]]
on = "side"
type = "roller"
[[contacts]]
on = "above"
gap = 0.002
"#;

/// A block held at one side and loaded at the other, without contact.
const HELD: &str = r#"
[model]
kinematics = "plane-strain"
[geometry]
size = 0.25
[[geometry.polygons]]
body = "block"
points = [[0, 0], [1.5, 0], [1.5, 1], [0, 1]]
edges = ["", "side", "above", "wall"]
[bodies.block]
young = 7e4
poisson = 0.25
body_force = [0.0, -3.0]
[[supports]]
on = "wall"
type = "clamped"
[[tractions]]
on = "side"
value = [5.0, 2.0]
"#;

/// Of every scene, so many fields that are none beside those that are.
const FIELDS: usize = 6;
/// A field may be this far from the solution in energy norm, and in displacements relative to the largest, and pass.
const NEAR: f64 = 0.03;

fn python() -> PathBuf {
    std::env::var_os("HYPERCIRCLE_PYTHON").map_or("/usr/bin/python3".into(), PathBuf::from)
}

/// Writes a scene and its fields.
fn prepared(folder: &Path, scene: &str, seed: u64) {
    std::fs::write(folder.join("scene.toml"), scene).expect("writable");
    let problem = Problem::load(Scene::read(&folder.join("scene.toml")).expect("a scene")).expect("a mesh");
    write_problem(&problem, &[], folder).expect("writable");
    let program = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/support/displacement/spoiled.py");
    let mut command = Command::new(python());
    command.arg(&program).arg(folder.join("problem.json")).arg(folder);
    let output = command.args([seed.to_string(), FIELDS.to_string()]).output().expect("an interpreter");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

/// Certifies one field and holds the verdict against what is known of it.
fn judge(folder: &Path, number: &str, known: &Value) {
    let (field, out) = (format!("{number}.vtk"), format!("out/{number}"));
    let arguments = ["certify", "scene.toml", "--displacement", &field, "--solution", "--quiet", "--out", &out];
    let output = run(hypercircle(folder, arguments));
    let name = &known["name"];
    let code = output.status.code();
    assert!(matches!(code, Some(0 | 1)), "{name}: {}", said(&output));
    if known["required"] == true {
        assert_eq!(code, Some(0), "{name}: {}", said(&output));
    }
    if code == Some(1) {
        return;
    }
    let text = std::fs::read_to_string(folder.join(&out).join("report.json")).expect("a report");
    let report: Value = serde_json::from_str(&text).expect("JSON");
    for measure in ["energy", "supports", "jumps"] {
        let off = known[measure].as_f64().expect("a number");
        assert!(off <= NEAR, "{name} passes, {measure} off by {off}");
    }
    let error = &report["checks"].as_array().expect("checks").iter().find(|c| c["name"] == "solution/guaranteed-error");
    let error = error.and_then(|check| check["value"].as_f64()).expect("a guaranteed error");
    assert!(error < 1.0, "{name} passes with a guaranteed error of {error}");
}

#[test]
fn what_is_no_solution_is_never_certified_as_one() {
    let has = Command::new(python()).args(["-c", "import numpy, scipy.sparse"]).output();
    if !has.is_ok_and(|output| output.status.success()) {
        eprintln!("skipped: {} has no numpy and scipy", python().display());
        return;
    }
    let mixed = include_str!("rounded/mix.toml");
    let folder = tempfile::tempdir().expect("a folder");
    let mut queue = Vec::new();
    for (seed, scene) in (1..).zip([PRESSED, MOVED, HELD, mixed]) {
        let folder = folder.path().join(seed.to_string());
        std::fs::create_dir(&folder).expect("writable");
        prepared(&folder, scene, seed);
        let text = std::fs::read_to_string(folder.join("spoiled.json")).expect("a list");
        let Value::Object(list) = serde_json::from_str(&text).expect("JSON") else { panic!("no list: {text}") };
        queue.extend(list.into_iter().map(|(number, known)| (folder.clone(), number, known)));
    }
    let queue = Mutex::new(queue);
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                loop {
                    let next = queue.lock().expect("unpoisoned").pop();
                    let Some((folder, number, known)) = next else { break };
                    judge(&folder, &number, &known);
                }
            });
        }
    });
}
