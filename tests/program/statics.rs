//! `exact_by_statics`, intervals and refusals beside a linear program over all equilibria, which shares nothing with the program.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::command::{PROGRAM, with_reference};

/// As many random scenes as run in some twenty seconds; `ci/statics` tries others.
const SCENES: &str = "40";

#[test]
fn what_is_exact_by_statics_has_one_value_in_every_equilibrium() {
    // SciPy comes with what the reference needs.
    if !with_reference() {
        return;
    }
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/support/statics/one_value.py");
    let python = std::env::var_os("HYPERCIRCLE_PYTHON").map_or("/usr/bin/python3".into(), PathBuf::from);
    let output = Command::new(python).arg(script).args([PROGRAM, "1", SCENES]).output().expect("Python");
    let said = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    println!("{said}");
    let count = |what: &str| {
        let found = said.split(", ").find_map(|part| part.trim().strip_suffix(what)?.trim().parse::<usize>().ok());
        found.unwrap_or_else(|| panic!("no number of '{what}' in {said}"))
    };
    assert!(count("exact") >= 10 && count("quantities") - count("one_value") >= 10, "{said}");
}
