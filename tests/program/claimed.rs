//! `certify --solution`: fields of a displacement method of its own, `tests/support/displacement`, right and with one mistake each.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;

use crate::command::{case, ended, hypercircle, run, said, script};
use crate::fields::{Cells, FieldFile};
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

/// Two blocks, refined once, of two materials, so that exchanging them makes a difference.
fn scene() -> String {
    let text = std::fs::read_to_string(case("two_blocks")).expect("the case").replace("size = 0.125", "size = 0.0625");
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
    ended("as the exact displacement", &run(hypercircle(folder.path(), usual)), 1, &[]);
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
    assert!(sentence.contains(&format!("at ({}, {})", place[0], place[1])), "{sentence} for {line}");
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

/// Two blocks whose contact sides have vertices of their own: one is meshed in halves, the other in thirds.
const UNEQUAL: &str = r#"
[model]
kinematics = "plane-strain"
[mesh]
file = "blocks.msh"
[bodies.left]
young = 1.0
poisson = 0.25
[bodies.right]
young = 2.0
poisson = 0.25
[[supports]]
on = "wall"
type = "clamped"
[[supports]]
on = "bottom"
type = "roller"
[[tractions]]
on = "load"
pressure = 1.0
[[contacts]]
between = ["left_face", "right_face"]
"#;
const BLOCKS: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n7\n1 1 \"load\"\n1 2 \"bottom\"\n1 3 \"left_face\"\n\
1 4 \"right_face\"\n1 5 \"wall\"\n2 6 \"left\"\n2 7 \"right\"\n$EndPhysicalNames\n$Nodes\n13\n1 0 0 0\n2 1 0 0\n3 1 0.5 0\n4 1 1 0\n\
5 0 1 0\n6 0 0.5 0\n7 1 0 0\n8 2 0 0\n9 2 0.5 0\n10 2 1 0\n11 1 1 0\n12 1 0.375 0\n13 1 0.75 0\n$EndNodes\n$Elements\n21\n\
1 1 2 1 1 5 6\n2 1 2 1 1 6 1\n3 1 2 2 2 1 2\n4 1 2 3 3 2 3\n5 1 2 3 3 3 4\n6 1 2 4 4 7 12\n7 1 2 4 4 12 13\n8 1 2 4 4 13 11\n\
9 1 2 5 5 8 9\n10 1 2 5 5 9 10\n11 1 2 2 2 7 8\n12 2 2 6 6 1 2 3\n13 2 2 6 6 1 3 6\n14 2 2 6 6 6 3 4\n15 2 2 6 6 6 4 5\n\
16 2 2 7 7 7 8 12\n17 2 2 7 7 8 9 12\n18 2 2 7 7 12 9 13\n19 2 2 7 7 9 10 13\n20 2 2 7 7 13 10 11\n21 1 2 5 5 8 9\n$EndElements\n";

/// The mesh of `BLOCKS` with a quadratic field that closes the contact exactly.
fn unequal() -> FieldFile {
    let mut points: Vec<[f64; 2]> = Vec::new();
    let mut cells = Vec::new();
    let mut section = "";
    for line in BLOCKS.lines() {
        let numbers: Vec<f64> = line.split(' ').filter_map(|w| w.parse().ok()).collect();
        match line {
            "$Nodes" | "$Elements" => section = line,
            _ if section == "$Nodes" && numbers.len() == 4 => points.push([numbers[1], numbers[2]]),
            _ if section == "$Elements" && numbers.len() == 8 => {
                cells.push(numbers[5..].iter().map(|n| *n as usize - 1).collect::<Vec<usize>>());
            }
            _ => {}
        }
    }
    for cell in &mut cells {
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            let [a, b] = [points[cell[i]], points[cell[j]]];
            cell.push(points.len());
            points.push([0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]);
        }
    }
    let values = points.iter().map(|[x, y]| [(2.0 - x) * (0.4 + 0.1 * y), 0.1 * x * y * (2.0 - x)]).collect();
    FieldFile { points, cells, values }
}

#[test]
fn a_field_is_carried_to_vertices_that_contacts_need() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    std::fs::write(folder.join("scene.toml"), UNEQUAL).expect("writable");
    std::fs::write(folder.join("blocks.msh"), BLOCKS).expect("writable");
    std::fs::write(folder.join("field.vtk"), unequal().vtk()).expect("writable");
    let arguments = ["certify", "scene.toml", "--displacement", "field.vtk", "--quiet", "--out", "out"];
    let output = run(hypercircle(folder, arguments));
    ended("certify", &output, 0, &[]);
    let report: Value =
        serde_json::from_slice(&std::fs::read(folder.join("out/report.json")).expect("a report")).expect("JSON");
    assert!(report["notes"].to_string().contains("vertices of the scene's mesh"), "{}", report["notes"]);
    assert_eq!(report["primal"][0]["degree"], 2);
    // The energy of the quadratic field by quadrature of this test, on the triangles of the file.
    let energy = report["primal"][0]["energy"].as_f64().expect("a number");
    assert!((energy - quadratic_energy()).abs() < 1e-12, "{energy} for {}", quadratic_energy());
    let output = run(hypercircle(folder, arguments.iter().chain(&["--solution"])));
    // Held to the equations of its own triangles, which the contact does not cut.
    ended("certify --solution", &output, 1, &[]);
    let report: Value =
        serde_json::from_slice(&std::fs::read(folder.join("out/report.json")).expect("a report")).expect("JSON");
    let residual = report["checks"].as_array().expect("checks").iter().find(|c| c["name"] == "solution/residual");
    assert_eq!(residual.expect("the check")["passed"], false);
}

/// 𝓛 of the field of [`unequal`], interpolated by quadratics, with the pressure 1 on x = 0.
fn quadratic_energy() -> f64 {
    let field = unequal();
    let mut energy = 0.0;
    for cell in &field.cells {
        let p: Vec<[f64; 2]> = cell.iter().map(|n| field.points[*n]).collect();
        let u: Vec<[f64; 2]> = cell.iter().map(|n| field.values[*n]).collect();
        let [ax, ay] = [p[1][0] - p[0][0], p[1][1] - p[0][1]];
        let [bx, by] = [p[2][0] - p[0][0], p[2][1] - p[0][1]];
        let twice = ax * by - ay * bx;
        let young = if p[..3].iter().all(|q| q[0] <= 1.0) { 1.0 } else { 2.0 };
        let (mu, lambda) = (young / 2.5, young * 0.25 / (1.25 * 0.5));
        for middle in 0..3 {
            // Reference gradients of the quadratic shape functions at the midpoint of a side.
            let [s, t] = [[0.5, 0.0], [0.5, 0.5], [0.0, 0.5]][middle];
            let r = 1.0 - s - t;
            let of_s = [1.0 - 4.0 * r, 4.0 * s - 1.0, 0.0, 4.0 * (r - s), 4.0 * t, -4.0 * t];
            let of_t = [1.0 - 4.0 * r, 0.0, 4.0 * t - 1.0, -4.0 * s, 4.0 * s, 4.0 * (r - t)];
            let gradient = |c: usize| {
                let [ds, dt] = [&of_s, &of_t].map(|d| (0..6).map(|i| d[i] * u[i][c]).sum::<f64>());
                [(by * ds - ay * dt) / twice, (ax * dt - bx * ds) / twice]
            };
            let ([xx, xy], [yx, yy]) = (gradient(0), gradient(1));
            let shear = 0.5 * (xy + yx);
            let density = 0.5 * lambda * (xx + yy).powi(2) + mu * (xx * xx + yy * yy + 2.0 * shear * shear);
            energy += twice / 6.0 * density;
        }
    }
    // ∫ u_x over x = 0 of 0.8 + 0.2 y.
    energy - 0.9
}

#[test]
fn each_body_may_have_a_file_of_its_own() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    std::fs::write(folder.join("scene.toml"), scene()).expect("writable");
    let problem = Problem::load(Scene::read(&folder.join("scene.toml")).expect("a scene")).expect("a mesh");
    let whole = FieldFile::new(&problem, Cells::Linear, |body, _| if body == 0 { [0.1, 0.0] } else { [0.0; 2] });
    for body in 0..2 {
        let mut part = whole.clone();
        let mut of = problem.mesh.body.iter();
        part.cells.retain(|_| of.next() == Some(&body));
        std::fs::write(folder.join(format!("{body}.vtk")), part.vtk()).expect("writable");
    }
    let files = ["--displacement", "1.vtk", "--displacement", "0.vtk"];
    let usual = ["certify", "scene.toml", "--quiet", "--out", "out"];
    // The first body is pushed into the second: the contact and a point of its file are named.
    let output = run(hypercircle(folder, usual.iter().chain(&files)));
    ended("two files", &output, 1, &[]);
    let text = std::fs::read_to_string(folder.join("out/report.json")).expect("a report");
    let report: Value = serde_json::from_str(&text).expect("JSON");
    let why = check(&report, "admissible/1.vtk + 0.vtk")["why"].as_str().expect("a sentence").to_string();
    assert!(why.contains("left_face|right_face is penetrated most") && why.contains("of 0.vtk, at (1, "), "{why}");
    ended("one file", &run(hypercircle(folder, usual.iter().chain(&files[..2]))), 2, &["scene's mesh is not in it"]);
}

#[test]
fn a_field_out_of_its_plane_and_a_missing_package_are_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    std::fs::write(folder.join("scene.toml"), scene()).expect("writable");
    let problem = Problem::load(Scene::read(&folder.join("scene.toml")).expect("a scene")).expect("a mesh");
    let field = FieldFile::new(&problem, Cells::Linear, |_, _| [0.0; 2]).vtk();
    let [x, y] = problem.mesh.points[3];
    let tilted = field.replacen(&format!("{x:?} {y:?} 0.0"), &format!("{x:?} {y:?} 0.25"), 1);
    assert!(tilted != field);
    std::fs::write(folder.join("field.vtk"), tilted).expect("writable");
    let arguments = ["certify", "scene.toml", "--displacement", "field.vtk", "--out", "out"];
    ended("tilted", &run(hypercircle(folder, arguments)), 2, &["not in one plane", "0.25", "z = 0"]);
    let mut command = hypercircle(folder, arguments);
    command.env("HYPERCIRCLE_PYTHON", script(folder.join("python"), "echo h5py >&2; exit 45"));
    ended("h5py", &run(command), 2, &["read with the Python package h5py", "pip install h5py", "python3-h5py"]);
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
