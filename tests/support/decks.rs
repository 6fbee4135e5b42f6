//! One plate as the files of many programs, written by `decks.py`.

use std::path::Path;
use std::process::Command;

use serde_json::Value;

use crate::command::PROGRAM;

/// The decks that `decks.py` has written into a folder, or `None` where meshio is missing.
pub fn written(folder: &Path) -> Option<Vec<Value>> {
    let python = std::env::var_os("HYPERCIRCLE_PYTHON").unwrap_or("/usr/bin/python3".into());
    let site = Path::new(PROGRAM).ancestors().nth(2).expect("a folder of the build").join("python");
    let has = Command::new(&python).args(["-c", "import meshio"]).output();
    if !has.is_ok_and(|output| output.status.success()) {
        eprintln!("skipped: {} has no meshio", python.display());
        return None;
    }
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/support/decks.py");
    let output = Command::new(python).arg(script).arg(folder).env("PYTHONPATH", site).output().expect("an interpreter");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(serde_json::from_slice(&output.stdout).expect("JSON"))
}

/// The scene of a deck, its ends clamped and pulled down.
pub fn scene(deck: &Value) -> String {
    let place = |name: &str, x: f64| format!("[[boundaries]]\nname = \"{name}\"\nline = [[{x}, 0], [{x}, 1]]\n");
    let (ends, boundaries) = match deck["ends"].as_array() {
        Some(ends) => (ends.iter().map(|end| end.as_str().expect("a name")).collect(), String::new()),
        None => (vec!["wall", "load"], place("wall", 0.0) + &place("load", 2.0)),
    };
    format!(
        "[model]\nkinematics = \"plane-strain\"\n[mesh]\nfile = {}\n[bodies.{:?}]\nyoung = 1.0\npoisson = 0.3\n{boundaries}\
         [[supports]]\non = {:?}\ntype = \"clamped\"\n[[tractions]]\non = {:?}\nvalue = [0.0, -0.1]\n",
        deck["file"],
        deck["body"].as_str().unwrap_or("plate"),
        ends[0],
        ends[1]
    )
}
