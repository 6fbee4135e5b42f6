//! No equilibrium, no FEniCSx, a FEniCSx that breaks: each has its exit code, and nothing passes for agreement.

use std::path::Path;

use super::run::{Run, case, with_reference};
use crate::command::script;

/// A block on a block, pushed sideways: nothing but friction could hold it, and there is none.
const PUSHED_ASIDE: &str = r#"
[model]
kinematics = "plane-strain"
[geometry]
size = 0.5
[[geometry.polygons]]
body = "base"
points = [[0, 0], [1, 0], [1, 1], [0, 1]]
edges = ["ground", "", "base_face", ""]
[[geometry.polygons]]
body = "block"
points = [[0, 1], [1, 1], [1, 2], [0, 2]]
edges = ["block_face", "", "top", ""]
[bodies.base]
young = 1.0
poisson = 0.3
[bodies.block]
young = 1.0
poisson = 0.3
[[supports]]
on = "ground"
type = "clamped"
[[tractions]]
on = "top"
value = [0.5, -1.0]
[[contacts]]
between = ["block_face", "base_face"]
"#;

#[test]
fn without_equilibrium() {
    let folder = tempfile::tempdir().expect("a folder");
    let scenes = [
        ("aside", PUSHED_ASIDE.to_string(), "slides"),
        ("away", PUSHED_ASIDE.replace("[0.5, -1.0]", "[0.0, 1.0]"), "lifts off"),
    ];
    for (name, text, how) in scenes {
        let scene = folder.path().join(format!("{name}.toml"));
        std::fs::write(&scene, text).expect("writes");
        for command in ["solve", "verify"] {
            let run = Run::new(command, &scene, &[]);
            assert_eq!(run.code, Some(5), "{name}: {}{}", run.stdout, run.stderr);
            assert!(run.stderr.contains("`block`") && run.stderr.contains(how), "{}", run.stderr);
            let report = run.report();
            assert_eq!(report.0["status"], "infeasible");
            assert!(report.0["energy"].is_null());
            let verdict = report.0["verdict"].as_str().expect("a sentence");
            assert!(verdict.contains("`block`"), "{verdict}");
            for file in ["report.html", "summary.md", "junit.xml"] {
                assert!(run.file(file).contains("block"), "{file}");
            }
            assert!(run.file("report.html").contains("<svg"), "no picture of the motion");
            assert!(run.file("fields.vtu").contains("motion"), "the motion is not in fields.vtu");
        }
    }
}

#[track_caller]
fn stopped(python: &Path, more: &[&str], code: i32, said: &str) {
    let run = Run::with("verify", &case("patch"), more, &[("HYPERCIRCLE_PYTHON", python)]);
    assert_eq!(run.code, Some(code), "{}{}", run.stdout, run.stderr);
    assert!(run.stderr.contains(said), "no `{said}` in {}", run.stderr);
    // The dual side is reported, but as no agreement.
    let report = run.report();
    assert_eq!(report.0["status"], "failed");
    assert!(report.number("/energy/lower") <= -1.25);
    assert_eq!(report.0["primal"].as_array().map(Vec::len), Some(0));
    let junit = run.file("junit.xml");
    assert!(junit.contains("<error") || junit.contains("<failure"), "{junit}");
}

#[test]
fn without_an_interpreter() {
    stopped(Path::new("/nonexistent/python3"), &[], 4, "/nonexistent/python3 does not exist");
}

#[test]
fn without_dolfinx() {
    if !with_reference() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    // -S leaves out the folder that packages are installed in.
    let python = script(folder.path().join("python3"), "exec /usr/bin/python3 -S \"$@\"");
    stopped(&python, &[], 4, "not installed");
}

#[test]
fn a_reference_that_crashes_or_hangs() {
    let folder = tempfile::tempdir().expect("a folder");
    let python = script(folder.path().join("python3"), "echo 'singular matrix in row 7' >&2; kill -SEGV $$");
    stopped(&python, &[], 3, "singular matrix in row 7");
    let python = script(folder.path().join("python3"), "echo 'waiting for a licence'; sleep 600");
    stopped(&python, &["--primal-seconds", "1"], 3, "waiting for a licence");
    let python = script(folder.path().join("python3"), "exit 0");
    stopped(&python, &[], 3, "primal-P1.json");
}
