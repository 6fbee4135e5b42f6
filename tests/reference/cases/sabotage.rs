//! A displacement model that is wrong on purpose must not pass for agreement.

use std::path::{Path, PathBuf};

use super::run::{Run, case, with_reference};

/// Every file of the report names what caught the bug, and the diagnosis of both solutions the bug itself.
#[track_caller]
fn caught(scene: &str, bug: &str, expected: &str, named: &str) {
    if !with_reference() {
        return;
    }
    let run = Run::new("verify", &case(scene), &["--sabotage", bug]);
    assert_eq!(run.code, Some(1), "{}{}", run.stdout, run.stderr);
    let report = run.report();
    assert_eq!(report.0["status"], "disagree");
    let failed = report.failed();
    assert!(failed.contains(&expected), "{bug} caught by {failed:?}");
    for diagnosis in report.0["diagnosis"].as_array().expect("a list") {
        let findings = diagnosis["findings"].as_array().expect("a list");
        assert!(findings.len() == 1 && findings[0]["name"].as_str().is_some_and(|n| n.ends_with(named)), "{diagnosis}");
    }
    assert_eq!(report.0["diagnosis"].as_array().map(Vec::len), Some(2), "{}", report.0["diagnosis"]);
    for name in failed {
        let first = name.split(' ').next().unwrap_or(name);
        for file in ["report.json", "report.html", "summary.md", "junit.xml"] {
            let text = run.file(file);
            assert!(text.contains(name) || text.contains(&first.replace('|', "\\|")), "{name} is not in {file}");
        }
        assert!(run.stdout.contains(name), "{name} is not on the terminal:\n{}", run.stdout);
    }
    let junit = run.file("junit.xml");
    assert!(junit.contains("<failure"), "{junit}");
}

#[test]
fn a_wrong_sign_in_the_stiffness() {
    caught("two_blocks", "flip-sign", "energy/recomputed/FEniCSx P2", "stiffness/lambda");
    caught("hertz_rigid", "flip-sign", "primal/equilibrium/FEniCSx P2", "stiffness/lambda");
}

#[test]
fn a_contact_row_that_is_missing() {
    caught("two_blocks", "drop-row", "admissible/FEniCSx P2", "/in-part");
    caught("punch", "drop-row", "admissible/FEniCSx P2", "/in-part");
}

#[test]
fn planted_bugs_are_named() {
    let bugs = [
        ("two_blocks", "modulus 0", "/young"),
        ("two_blocks", "kinematics 0", "kinematics"),
        ("two_blocks", "load_larger 0", "load/left_load"),
        ("two_blocks", "thickness 0", "thickness"),
        ("two_blocks", "clamp_for_roller 0", "boundary/left_bottom/clamped"),
        ("two_blocks", "vertex_moved 0", "vertex/assembled"),
        ("gap", "displacement_larger 0", "support/moving/displacement"),
        ("gravity", "weight_missing 0", "body/block/body_force"),
        ("stack", "poisson 0", "body/plate/poisson"),
        ("stack", "poisson_sign 0", "bodies/poisson-sign"),
    ];
    let stand_in = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/support/planted/stand_in.py");
    let python = std::env::var_os("HYPERCIRCLE_PYTHON").map_or("/usr/bin/python3".into(), PathBuf::from);
    for (scene, bug, named) in bugs.iter().filter(|_| with_reference()) {
        let environment = [
            ("HYPERCIRCLE_PYTHON", stand_in.as_path()),
            ("HYPERCIRCLE_PLANT_PYTHON", &python),
            ("HYPERCIRCLE_PLANT", Path::new(bug)),
        ];
        let run = Run::with("verify", &case(scene), &[], &environment);
        assert_eq!(run.code, Some(1), "{bug} in {scene}: {}{}", run.stdout, run.stderr);
        let report = run.report();
        let diagnoses = report.0["diagnosis"].as_array().expect("a list");
        assert!(!diagnoses.is_empty(), "{bug} in {scene}");
        for diagnosis in diagnoses {
            let findings = diagnosis["findings"].as_array().expect("a list");
            let found = findings.iter().any(|f| f["name"].as_str().is_some_and(|name| name.ends_with(named)));
            assert!(findings.len() == 1 && found, "{bug} in {scene}: {diagnosis}");
        }
    }
}
