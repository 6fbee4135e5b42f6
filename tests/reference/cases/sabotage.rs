//! A displacement model that is wrong on purpose must not pass for agreement.

use super::run::{Run, case, with_reference};

/// Every file of the report names what caught the bug.
#[track_caller]
fn caught(scene: &str, bug: &str, expected: &str) {
    if !with_reference() {
        return;
    }
    let run = Run::new("verify", &case(scene), &["--sabotage", bug]);
    assert_eq!(run.code, Some(1), "{}{}", run.stdout, run.stderr);
    let report = run.report();
    assert_eq!(report.0["status"], "disagree");
    let failed = report.failed();
    assert!(failed.contains(&expected), "{bug} caught by {failed:?}");
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
    caught("two_blocks", "flip-sign", "energy/recomputed/FEniCSx P2");
    caught("hertz_rigid", "flip-sign", "primal/equilibrium/FEniCSx P2");
}

#[test]
fn a_contact_row_that_is_missing() {
    caught("two_blocks", "drop-row", "admissible/FEniCSx P2");
    caught("punch", "drop-row", "admissible/FEniCSx P2");
}
