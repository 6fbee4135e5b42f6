//! Walls of many blocks: the default method against the conic solver, which shares neither its contact search nor its factor.

use std::path::Path;
use std::process::Command;

use serde_json::Value;

use crate::command::{hypercircle, run};

fn solved(folder: &Path, method: &str) -> Value {
    let out = format!("out-{method}");
    let ended = run(hypercircle(folder, ["solve", "wall.toml", "--method", method, "--out", &out]));
    assert!(ended.status.success(), "{method}: {}", String::from_utf8_lossy(&ended.stderr));
    let text = std::fs::read_to_string(folder.join(out).join("report.json")).expect("a report");
    serde_json::from_str(&text).expect("JSON")
}

#[test]
fn walls_have_the_energy_that_the_conic_solver_finds() {
    let folder = tempfile::tempdir().expect("a folder");
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("ci/wall");
    let made = Command::new("python3").arg(script).args(["60", "0.5"]).output().expect("Python");
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    std::fs::write(folder.path().join("wall.toml"), made.stdout).expect("writable");
    let [own, conic] = ["condensed", "clarabel"].map(|method| solved(folder.path(), method));
    let lower = |report: &Value| report["energy"]["lower"].as_f64().expect("a number");
    assert!((lower(&own) - lower(&conic)).abs() <= 1e-8 * lower(&own).abs(), "{} {}", lower(&own), lower(&conic));
}
