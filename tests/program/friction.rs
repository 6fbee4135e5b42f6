//! Contact with a given friction bound: fields of another method, right and with one mistake each, and what a diagnosis names.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::arcs::Arcs;
use crate::claimed::{certified, check};
use crate::command::{ended, hypercircle, run};
use hypercircle::primal::exchange::write_problem;
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;

/// A block pressed against another one and pushed along it: it sticks at one end, and slides elsewhere.
const SCENE: &str = r#"
model = { kinematics = "plane-strain" }
supports = [
    { on = "wall", type = "clamped" },
    { on = "ram", type = "clamped", displacement = [0.1, -0.045] },
]
contacts = [{ between = ["left_face", "right_face"], friction = { bound = [[0, 0.005], [1, 0.015]] } }]
[geometry]
size = 0.125
[[geometry.polygons]]
body = "left"
points = [[0, 0], [1, 0], [1, 1], [0, 1]]
edges = ["", "left_face", "", "ram"]
[[geometry.polygons]]
body = "right"
points = [[1, 0], [2, 0], [2, 1], [1, 1]]
edges = ["", "wall", "", "right_face"]
[bodies]
left = { young = 1.0, poisson = 0.3 }
right = { young = 2.0, poisson = 0.2 }
"#;

/// A finding, and its number.
type Explained = (&'static str, Option<f64>);

/// Names of fields with the finding that explains each.
const FIELDS: [(&str, Option<Explained>); 13] = [
    ("right", None),
    ("frictionless", Some(("frictionless", Some(0.0)))),
    ("sticks", Some(("sticks", None))),
    ("along", Some(("friction-sign", Some(-1.0)))),
    ("bound_unit", Some(("friction-bound", Some(1e-3)))),
    ("bound_half", Some(("friction-bound", Some(0.5)))),
    ("bound_more", Some(("friction-bound", Some(1.3)))),
    ("turned", Some(("friction-turned", None))),
    ("penalty", Some(("tangential-penalty", Some(30.0)))),
    ("tanh", Some(("regularised", Some(2e-3)))),
    ("root", Some(("regularised", Some(2e-3)))),
    ("bound_slightly", Some(("friction-bound", Some(1.0001)))),
    ("at_one_place", Some(("friction-law", None))),
];

/// The same for Coulomb friction with the coefficient [`MU`].
const COULOMB: [(&str, Option<Explained>); 9] = [
    ("right", None),
    ("frictionless", Some(("frictionless", Some(0.0)))),
    ("sticks", Some(("sticks", None))),
    ("along", Some(("friction-sign", Some(-1.0)))),
    ("half", Some(("friction-bound", Some(0.5)))),
    ("more", Some(("friction-bound", Some(1.3)))),
    ("lags", Some(("friction-law", None))),
    ("penalty", Some(("tangential-penalty", Some(30.0)))),
    ("tanh", Some(("regularised", Some(2e-3)))),
];

const MU: &str = "0.15";

/// A block on a rigid floor, pressed and moved along it.
const FLOOR: &str = r#"
model = { kinematics = "plane-strain" }
contacts = [{ on = "foot", friction = { coefficient = 0.4 } }]
supports = [{ on = "top", type = "clamped", displacement = [0.06, -0.05] }]
bodies.b = { young = 3.0, poisson = 0.25 }
geometry.size = 0.25
[[geometry.polygons]]
body = "b"
points = [[0, 0], [2, 0], [2, 1], [0, 1]]
edges = ["foot", "", "top", ""]
"#;

/// Writes the scene and its fields; `false` where numpy or scipy is missing.
fn prepared(folder: &Path, names: &[&str]) -> bool {
    prepared_with(folder, names, None)
}

fn python() -> PathBuf {
    std::env::var_os("HYPERCIRCLE_PYTHON").map_or("/usr/bin/python3".into(), PathBuf::from)
}

/// As [`prepared`], with Coulomb friction of this coefficient.
fn prepared_with(folder: &Path, names: &[&str], mu: Option<&str>) -> bool {
    let coulomb = |mu: &str| {
        SCENE.replace("bound = [[0, 0.005], [1, 0.015]]", &format!("coefficient = {mu}")).replace("0.125", "0.25")
    };
    prepared_on(folder, &mu.map_or(SCENE.to_string(), coulomb), &["1", "2"], names, mu)
}

/// Writes a scene and its fields of these degrees; `false` where numpy or scipy is missing.
fn prepared_on(folder: &Path, scene: &str, degrees: &[&str], names: &[&str], mu: Option<&str>) -> bool {
    let python = python();
    if !Command::new(&python).args(["-c", "import numpy, scipy.sparse"]).output().is_ok_and(|o| o.status.success()) {
        eprintln!("skipped: {} has no numpy and scipy", python.display());
        return false;
    }
    std::fs::write(folder.join("scene.toml"), scene).expect("writable");
    let problem = Problem::load(Scene::read(&folder.join("scene.toml")).expect("a scene")).expect("a mesh");
    write_problem(&problem.where_friction_acts(), &[], folder).expect("writable");
    let program = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/support/displacement/friction.py");
    for degree in degrees {
        let target = folder.join(format!("P{degree}"));
        std::fs::create_dir(&target).expect("writable");
        let mut command = Command::new(&python);
        let output = command
            .arg(&program)
            .arg(folder.join("problem.json"))
            .arg(target)
            .arg(degree)
            .args(mu)
            .args(names)
            .output();
        let output = output.expect("an interpreter");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
    true
}

#[test]
fn every_mistake_of_friction_is_found_and_named() {
    every_mistake_is_named(&FIELDS, None);
}

#[test]
fn every_mistake_of_coulomb_friction_is_found_and_named() {
    every_mistake_is_named(&COULOMB, Some(MU));
}

fn every_mistake_is_named(fields: &[(&str, Option<Explained>)], mu: Option<&str>) {
    let folder = tempfile::tempdir().expect("a folder");
    if !prepared_with(folder.path(), &fields.iter().map(|(name, _)| *name).collect::<Vec<_>>(), mu) {
        return;
    }
    for (&(name, expected), degree) in fields.iter().zip(["P1", "P2"].into_iter().cycle()) {
        let (code, report) = certified(folder.path(), &format!("{degree}/{name}"), &[]);
        let Some((finding, number)) = expected else {
            assert_eq!(code, 0, "{degree} {name}: {}", report["verdict"]);
            assert!(report["diagnosis"].as_array().expect("a list").is_empty());
            assert!(check(&report, "solution/contact/left_face|right_face/friction")["passed"] == true);
            continue;
        };
        assert_eq!(code, 1, "{degree} {name}");
        let found = report["diagnosis"][0]["findings"].as_array().expect("findings");
        assert_eq!(found.len(), 1, "{degree} {name}: {}", report["diagnosis"]);
        assert_eq!(found[0]["name"], format!("contact/left_face|right_face/{finding}"), "{degree} {name}");
        if let Some(number) = number {
            let value = found[0]["value"].as_f64().expect("a number");
            // Of a factor close to one, what is more than one is what was found.
            let found_of = number.abs().min(10.0 * (number - 1.0).abs());
            assert!((value - number).abs() <= 5e-3 * found_of, "{degree} {name}: {value} for {number}");
        }
        if name == "at_one_place" {
            assert_eq!(
                report["causes"][0]["place"]["at"],
                serde_json::json!([1.0, 0.5]),
                "{degree}: {}",
                report["causes"]
            );
        }
        // All other equations of the field are those of a solution.
        for other in ["residual", "supports", "reactions", "energy-identity"] {
            assert!(check(&report, &format!("solution/{other}"))["passed"] == true, "{degree} {name} {other}");
        }
    }
}

#[test]
fn wrong_shares_of_friction_along_a_curve_are_found() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = Arcs { n: 8, ..Arcs::default() }.text() + "friction = { bound = 0.1 }\n";
    if !prepared_on(folder.path(), &scene, &["2"], &["right", "frictionless", "thirds"], None) {
        return;
    }
    for (name, passes) in [("right", true), ("frictionless", false), ("thirds", false)] {
        let (code, report) = certified(folder.path(), &format!("P2/{name}"), &[]);
        assert_eq!(code, i32::from(!passes), "{name}: {}", report["verdict"]);
        assert_eq!(check(&report, "solution/contact/lower|upper/friction")["passed"], passes, "{name}");
        for other in ["residual", "supports", "reactions", "energy-identity"] {
            assert!(check(&report, &format!("solution/{other}"))["passed"] == true, "{name} {other}");
        }
    }
}

#[test]
fn the_energy_of_a_field_with_friction_is_bounded_whatever_its_law() {
    let folder = tempfile::tempdir().expect("a folder");
    if !prepared(folder.path(), &["right", "frictionless", "sticks"]) {
        return;
    }
    for name in ["right", "frictionless", "sticks"] {
        let (_, report) = certified(folder.path(), &format!("P2/{name}"), &[]);
        let energy = |key: &str| report["energy"][key].as_f64().expect("a number");
        assert!(check(&report, &format!("energy/gap-two-ways/{name}.vtk"))["passed"] == true, "{name}");
        let own = report["primal"][0]["energy"].as_f64().expect("a number");
        assert!(own >= energy("lower"), "{name}: {own} below {}", energy("lower"));
        assert!(name == "right" || own > energy("upper"), "{name}: {own} not above {}", energy("upper"));
    }
}

#[test]
fn contact_in_the_mean_is_refused_beside_friction() {
    let folder = tempfile::tempdir().expect("a folder");
    if !prepared(folder.path(), &["right"]) {
        return;
    }
    let arguments = ["certify", "scene.toml", "--displacement", "P1/right.vtk", "--solution", "--contact", "weak"];
    ended("--contact weak", &run(hypercircle(folder.path(), arguments)), 2, &["friction"]);
}

#[test]
fn coulomb_friction_of_getfem_is_a_solution_of_its_own_coefficient_alone() {
    if !Command::new(python()).args(["-c", "import getfem"]).output().is_ok_and(|o| o.status.success()) {
        eprintln!("skipped: {} has no GetFEM", python().display());
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("scene.toml"), FLOOR).expect("writable");
    let problem = Problem::load(Scene::read(&folder.path().join("scene.toml")).expect("a scene")).expect("a mesh");
    write_problem(&problem, &[], folder.path()).expect("writable");
    let program = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/support/displacement/friction_of_getfem.py");
    let mut command = Command::new(python());
    command.arg(program).arg(folder.path().join("problem.json")).arg(folder.path()).args(["0.4", "0.3"]);
    let output = command.output().expect("an interpreter");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let (code, report) = certified(folder.path(), "getfem-0.4", &[]);
    assert_eq!(code, 0, "{}", report["verdict"]);
    let (code, report) = certified(folder.path(), "getfem-0.3", &[]);
    assert_eq!(code, 1, "{}", report["verdict"]);
    let found = &report["diagnosis"][0]["findings"][0];
    assert_eq!(found["name"], "contact/foot|rigid/friction-bound", "{}", report["diagnosis"]);
    assert!((found["value"].as_f64().expect("a number") - 0.75).abs() < 1e-6, "{found}");
}
