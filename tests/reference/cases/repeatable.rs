//! Equal input gives equal bits, and a baseline notices when it does not.

use std::path::Path;

use serde_json::Value;

use super::run::{Run, case, with_reference};
use crate::arcs::disc;

/// Drops times, and the name and command line of the run, which are the only things that may differ.
fn without_seconds(value: &mut Value) {
    match value {
        Value::Object(map) => {
            map.remove("seconds");
            map.remove("run");
            map.remove("command_line");
            map.remove("date");
            map.values_mut().for_each(without_seconds);
        }
        Value::Array(list) => list.iter_mut().for_each(without_seconds),
        _ => {}
    }
}

#[test]
fn solving_twice_gives_the_same_bits() {
    for (name, threads) in [("two_blocks", "1"), ("hertz_elastic", "2")] {
        let report = || {
            let run = Run::new("solve", &case(name), &["--threads", threads]);
            assert_eq!(run.code, Some(0), "{}", run.stderr);
            let mut value: Value = serde_json::from_str(&run.file("report.json")).expect("JSON");
            let name = value["run"].as_str().expect("a name").to_string();
            without_seconds(&mut value);
            (value.to_string(), run.file("fields.vtu").replace(&name, "RUN"))
        };
        assert_eq!(report(), report(), "{name}");
    }
}

#[test]
fn a_baseline_holds_later_runs_to_it() {
    if !with_reference() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("baseline.json");
    let given = ["--baseline", file.to_str().expect("plain path")];
    let scene = case("two_blocks");
    let missing = Run::new("verify", &scene, &given);
    assert_eq!(missing.code, Some(2), "{}", missing.stderr);
    assert!(missing.stderr.contains("--accept"), "{}", missing.stderr);
    let accepted = Run::new("verify", &scene, &[&given[..], &["--accept"]].concat());
    assert_eq!(accepted.code, Some(0), "{}{}", accepted.stdout, accepted.stderr);
    let same = Run::new("verify", &scene, &given);
    assert_eq!(same.code, Some(0), "{}{}", same.stdout, same.stderr);
    let made = same.report().0["checks"].to_string();
    assert!(made.contains("baseline/energy.lower") && made.contains("baseline/energy.FEniCSx P2"), "{made}");

    let mut stored: Value = serde_json::from_str(&std::fs::read_to_string(&file).expect("readable")).expect("JSON");
    let lower = stored["values"]["energy.lower"].as_f64().expect("a number");
    stored["values"]["energy.lower"] = (lower * (1.0 + 1e-6)).into();
    std::fs::write(&file, stored.to_string()).expect("writes");
    let altered = Run::new("verify", &scene, &given);
    assert_eq!(altered.code, Some(1), "{}{}", altered.stdout, altered.stderr);
    assert_eq!(altered.report().failed(), ["baseline/energy.lower"]);
    let allowed = Run::new("verify", &scene, &[&given[..], &["--allow", "baseline/energy.lower=1e-5"]].concat());
    assert_eq!(allowed.code, Some(0), "{}{}", allowed.stdout, allowed.stderr);
}

/// Scenes whose mesh got vertices where the sides of a contact do not match, and where the gap has kinks.
#[test]
fn fields_of_a_report_can_be_handed_in_again() {
    if !with_reference() {
        return;
    }
    for scene in ["two_blocks", "stack", "inclined"] {
        let verified = Run::new("verify", &case(scene), &[]);
        assert_eq!(verified.code, Some(0), "{}{}", verified.stdout, verified.stderr);
        let shown = Run::new("solve", &case(scene), &[]).folder;
        let shown = shown.path().join("out/fields.vtu");
        let refused = Run::new("certify", &case(scene), &["--displacement", shown.to_str().expect("a plain path")]);
        assert_eq!(refused.code, Some(2), "{}", refused.stderr);
        let said = refused.stderr.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(said.contains("keeps no linear or quadratic displacement"), "{said}");
        for model in 0..2 {
            let certified = taken_back(&verified, &case(scene), model);
            let energy = |run: &Run, model: usize| run.report().number(&format!("/primal/{model}/energy"));
            let [before, after] = [energy(&verified, model), energy(&certified, 0)];
            assert!((before - after).abs() < 1e-12 * before.abs(), "{scene} P{}: {before} {after}", model + 1);
        }
    }
}

/// Quadratics that close a contact beside a clamp, which takes a part of their force; friction at a vertex of four contacts.
#[test]
fn fields_whose_contact_forces_others_share_can_be_handed_in_again() {
    if !with_reference() {
        return;
    }
    for (name, models) in [("obstacles_beside_a_clamp", 0..2), ("dragged_off_by_friction", 0..1)] {
        let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/scenes/{name}.toml"));
        let verified = Run::new("verify", &scene, &[]);
        assert_eq!(verified.code, Some(0), "{}{}", verified.stdout, verified.stderr);
        models.for_each(|model| drop(taken_back(&verified, &scene, model)));
    }
}

/// A disc that lies in its bore, where the direction of contact turns: several coefficients share the forces at a node.
#[test]
fn fields_of_contact_that_turns_can_be_handed_in_again() {
    if !with_reference() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let scenes = ["", "friction = { bound = 0.06 }", "friction = { coefficient = 0.3 }"].map(|friction| {
        let normals = "normals = \"smooth\"\n";
        let text = disc(12, "force", "smooth").replace(normals, &format!("{normals}gap = 0.003\n{friction}\n"));
        let path = folder.path().join(format!("disc{}.toml", friction.len()));
        std::fs::write(&path, text).expect("written");
        path
    });
    for scene in &scenes {
        let verified = Run::new("verify", scene, &[]);
        assert_eq!(verified.code, Some(0), "{}{}", verified.stdout, verified.stderr);
        (0..2).for_each(|model| drop(taken_back(&verified, scene, model)));
        // With more or less friction it is no solution.
        for other in scenes.iter().filter(|other| *other != scene) {
            for model in 0..2 {
                let run = handed_in(&verified, other, model);
                assert_eq!(run.code, Some(1), "{} P{}: {}", other.display(), model + 1, run.stdout);
            }
        }
    }
}

/// The run that takes the field of degree `model` + 1 in a report for the solution that it is.
fn taken_back(verified: &Run, scene: &Path, model: usize) -> Run {
    let certified = handed_in(verified, scene, model);
    let said = (&certified.stdout, &certified.stderr);
    assert_eq!(certified.code, Some(0), "{} P{}: {}{}", scene.display(), model + 1, said.0, said.1);
    certified
}

fn handed_in(verified: &Run, scene: &Path, model: usize) -> Run {
    let (fields, name) =
        (verified.folder.path().join("out/fields.vtu"), format!("displacement_FEniCSx_P{}", model + 1));
    let field = fields.to_str().expect("a plain path");
    Run::new("certify", scene, &["--displacement", field, "--field", &name, "--solution"])
}
