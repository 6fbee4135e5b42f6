//! Quadrilaterals of a mesh file, with Q1 and Q2 of FEniCSx on them.

use std::path::PathBuf;

use serde_json::Value;
use tempfile::TempDir;

use super::run::{Report, Run, case, sound, with_reference};

const SCENE: &str = "quadrilaterals";

/// The scene with another mesh file, whose elements are `elements` of those of the case, and its vertices where `place` has them.
fn on_another_mesh(elements: impl Fn(&str) -> Vec<String>, place: impl Fn([f64; 2]) -> [f64; 2]) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    let text = std::fs::read_to_string(case(SCENE).with_extension("msh")).expect("the mesh");
    let (mut lines, mut section) = (Vec::new(), String::new());
    for line in text.lines() {
        if let Some(name) = line.strip_prefix('$') {
            section = name.to_owned();
        }
        let words: Vec<&str> = line.split(' ').collect();
        match (section.as_str(), words.as_slice()) {
            ("Nodes", [number, x, y, z]) => {
                let [x, y] = place([x, y].map(|x| x.parse().expect("a number")));
                lines.push(format!("{number} {x:?} {y:?} {z}"));
            }
            ("Elements", [_, "3", ..]) => lines.extend(elements(line)),
            _ => lines.push(line.to_owned()),
        }
    }
    let start = lines.iter().position(|line| line == "$Elements").expect("elements") + 2;
    let count = lines[start..].iter().take_while(|line| !line.starts_with('$')).count();
    lines[start - 1] = count.to_string();
    let path = folder.path().join("moved.toml");
    std::fs::write(folder.path().join("quadrilaterals.msh"), lines.join("\n") + "\n").expect("written");
    std::fs::copy(case(SCENE), &path).expect("copied");
    (folder, path)
}

/// Moves what is inside the two unit squares.
fn shaken([x, y]: [f64; 2]) -> [f64; 2] {
    let size = 0.08 * (std::f64::consts::PI * x).sin() * (std::f64::consts::PI * y).sin();
    let inside = |x: f64| (x - x.round()).abs() > 1e-9;
    if inside(x) && inside(y) { [x + size * (9.0 * y).cos(), y - size * (7.0 * x + 1.0).sin()] } else { [x, y] }
}

fn models(report: &Report) -> Vec<(String, String)> {
    let text = |model: &Value, key: &str| model[key].as_str().unwrap_or_default().to_owned();
    let all = report.0["primal"].as_array().into_iter().flatten();
    all.map(|model| (text(model, "name"), text(model, "cells"))).collect()
}

#[test]
fn quadrilaterals() {
    let report = sound("quadrilaterals");
    let force = report.0["contact"][0]["resultant"]["dual"].as_array().expect("a force").clone();
    assert!((force[0].as_f64().expect("a number") + 0.5).abs() < 1e-9, "{force:?}");
    // The energy of finer meshes, bracketed independently of this program.
    assert!(report.number("/energy/lower") < -1.7964083583 && report.number("/energy/upper") > -1.7964189504);
    if !with_reference() {
        return;
    }
    let on = |name: &str| (format!("FEniCSx {name}"), "quadrilaterals".to_owned());
    assert_eq!(models(&report), [on("Q1"), on("Q2")]);
    assert_eq!(report.0["energy"]["upper_from"], "FEniCSx Q2");
    // On squares Q2 is of degree 4 on the halves, and closer than P2 there.
    let halves = Run::new("verify", &case(SCENE), &["--primal-cells", "triangles"]);
    assert_eq!(halves.code, Some(0), "{}{}", halves.stdout, halves.stderr);
    let halves = halves.report();
    assert!(models(&halves).iter().all(|(_, cells)| cells == "triangles"), "{:?}", models(&halves));
    for k in 0..2 {
        let energy = format!("/primal/{k}/energy");
        assert!(report.number(&energy) < halves.number(&energy));
    }
    assert!(report.notes().contains("Q1 and Q2 on the 200 quadrilaterals"), "{}", report.notes());
    assert!(halves.notes().contains("on the triangles of the stresses: as was asked"), "{}", halves.notes());
}

#[test]
fn refined_quadrilaterals_are_quadrilaterals() {
    if !with_reference() {
        return;
    }
    let run = Run::new("verify", &case(SCENE), &["--refine", "1", "--primal-degree", "1,3"]);
    assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
    let report = run.report();
    assert!(report.notes().contains("Q1 on the 800 quadrilaterals"), "{}", report.notes());
    assert_eq!(models(&report)[1], ("FEniCSx P3".to_owned(), "triangles".to_owned()));
}

#[test]
fn distorted_quadrilaterals_have_an_energy_and_bound_nothing() {
    if !with_reference() {
        return;
    }
    let (_folder, scene) = on_another_mesh(|line| vec![line.to_owned()], shaken);
    let quantities = "\n[[quantities]]\nname = \"seat\"\nforce = \"left_face|right_face\"\n\
        [[quantities]]\nname = \"foot\"\nmoment = \"left_bottom\"\nabout = [0.3, 0.0]\n";
    let text = std::fs::read_to_string(&scene).expect("the scene") + quantities;
    std::fs::write(&scene, text).expect("written");
    let run = Run::new("verify", &scene, &["--allow", "q1-above-q2=1e-9"]);
    assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
    let report = run.report();
    assert!(report.failed().is_empty(), "{:?}", report.failed());
    assert_eq!(report.0["energy"]["upper_from"], "free");
    assert_eq!(report.0["energy"]["guaranteed"], true);
    assert!(report.notes().contains("are no parallelograms"), "{}", report.notes());
    // Forces of a contact are those of the reactions; of a support they come from stresses, and the report says so.
    let values = |k: usize| report.0["quantities"][k]["primal"].as_array().expect("models").clone();
    for model in values(0) {
        assert!((model["value"].as_f64().expect("a value") - 0.5).abs() < 1e-9 && model["inside"] == true, "{model}");
    }
    assert!(values(1).iter().all(|model| model["reason"].as_str().is_some_and(|why| why.contains("of its stresses"))));
    let page = run.file("report.html");
    assert!(page.contains("is that of a quadrature") && !page.contains("admissible: an upper bound"));
    for model in report.0["primal"].as_array().expect("models") {
        assert_eq!((&model["admissible"], &model["relative_error_bound"]), (&Value::Bool(true), &Value::Null));
        // Above the exact energy, within what the coarser one has.
        let energy = model["energy"].as_f64().expect("an energy");
        assert!((-1.7964189504..-1.75).contains(&energy), "{model}");
    }
    // Handed in again they are solutions, and of no other scene.
    let fields = run.folder.path().join("out/fields.vtu");
    let fields = fields.to_str().expect("a path");
    let stiffer = scene.with_file_name("stiffer.toml");
    let text = std::fs::read_to_string(&scene).expect("the scene").replacen("young = 1.0", "young = 1.01", 1);
    std::fs::write(&stiffer, text).expect("written");
    for (scene, code) in [(&scene, 0), (&stiffer, 1)] {
        for model in ["displacement_FEniCSx_Q1", "displacement_FEniCSx_Q2"] {
            let claimed = Run::new("certify", scene, &["--displacement", fields, "--field", model, "--solution"]);
            assert_eq!(claimed.code, Some(code), "{model}: {}{}", claimed.stdout, claimed.stderr);
        }
    }
}

#[test]
fn triangles_beside_quadrilaterals_leave_the_model_on_triangles() {
    let halved = |line: &str| {
        let words: Vec<&str> = line.split(' ').collect();
        let [number, _, tags, body, _, a, b, c, d] = words[..] else { panic!("{line}") };
        if number.ends_with('7') {
            let half = |corners: [&str; 3]| format!("{number} 2 {tags} {body} {body} {}", corners.join(" "));
            return vec![half([a, b, d]), half([b, c, d])];
        }
        vec![line.to_owned()]
    };
    if !with_reference() {
        return;
    }
    let (_folder, scene) = on_another_mesh(halved, |p| p);
    let run = Run::new("verify", &scene, &[]);
    assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
    let report = run.report();
    assert_eq!(models(&report)[0], ("FEniCSx P1".to_owned(), "triangles".to_owned()));
    assert!(report.notes().contains("40 triangles beside its 180 quadrilaterals"), "{}", report.notes());
    let fields = run.file("fields.vtu");
    assert!(fields.contains("nodes_of_quadrilaterals") && fields.contains("Name=\"cell\""));
}

#[test]
fn a_wrong_model_on_quadrilaterals_is_found() {
    if !with_reference() {
        return;
    }
    let (_folder, distorted) = on_another_mesh(|line| vec![line.to_owned()], shaken);
    for scene in [case(SCENE), distorted] {
        for (bug, check) in [("flip-sign", "primal/equilibrium/FEniCSx Q1"), ("drop-row", "admissible/FEniCSx Q2")] {
            let run = Run::new("verify", &scene, &["--sabotage", bug]);
            assert_eq!(run.code, Some(1), "{bug}: {}{}", run.stdout, run.stderr);
            let report = run.report();
            assert!(report.failed().contains(&check), "{bug}: {:?}", report.failed());
        }
    }
}

/// The contact becomes an arc, along which its direction turns.
#[test]
fn quadrilaterals_along_an_arc_agree() {
    if !with_reference() {
        return;
    }
    let bent = |[x, y]: [f64; 2]| {
        let bow = 0.1 - (2.0 - (4.0 - (y - 0.5) * (y - 0.5)).sqrt());
        [if x <= 1.0 { x * (1.0 + bow) } else { x + (2.0 - x) * bow }, y]
    };
    let (_folder, scene) = on_another_mesh(|line| vec![line.to_owned()], bent);
    let text = std::fs::read_to_string(&scene).expect("the scene").replace("-7.0", "-1.0");
    std::fs::write(&scene, text).expect("written");
    let run = Run::new("verify", &scene, &[]);
    assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
    let report = run.report();
    assert!(report.notes().contains("stand for a curve"), "{}", report.notes());
    // Q1 is bounded at the vertices, and what is left of it between them is no Q2 displacement.
    assert_eq!(models(&report).len(), 2);
    assert!(!report.0["checks"].to_string().contains("q1-above-q2"));
    let wrong = Run::new("verify", &scene, &["--sabotage", "drop-row"]);
    assert_eq!(wrong.code, Some(1), "{}{}", wrong.stdout, wrong.stderr);
}

/// A solver of the user's own may have displacements on quadrilaterals too.
#[test]
fn a_solver_of_ones_own_may_use_the_quadrilaterals() {
    if !with_reference() {
        return;
    }
    let python = std::env::var("HYPERCIRCLE_PYTHON").unwrap_or("/usr/bin/python3".to_owned());
    let command = format!("{python} -m hypercircle_reference {{problem}} --out {{out}} --quadrilaterals 1 --degree 1");
    let packages = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("reference");
    let run = Run::with("verify", &case(SCENE), &["--reference", &command], &[("PYTHONPATH", &packages)]);
    assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
    let on = |name: &str, cells: &str| (format!("FEniCSx {name}"), cells.to_owned());
    assert_eq!(models(&run.report()), [on("P1", "triangles"), on("Q1", "quadrilaterals")]);
}
