//! A solver of somebody's own in the place of FEniCSx: the example in scikit-fem, whole and spoilt, and what is no solver.

use std::path::{Path, PathBuf};

use serde_json::Value;

use super::run::{Run, case};
use crate::command::{ended, hypercircle, run};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Where `ci/setup tests` puts scikit-fem.
fn packages() -> PathBuf {
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or("target".into(), PathBuf::from);
    root().join(target).join("python")
}

/// The command that runs the solver in the file `path`.
fn solver(path: &Path) -> String {
    let python = std::env::var("HYPERCIRCLE_PYTHON").unwrap_or_else(|_| "/usr/bin/python3".to_string());
    format!("{python} '{}' {{problem}} {{out}}", path.display())
}

fn verify(scene: &str, reference: &str) -> Run {
    // Had it to run FEniCSx it would fail.
    let environment = [("PYTHONPATH", packages()), ("HYPERCIRCLE_PYTHON", "/nonexistent/python3".into())];
    let environment: Vec<(&str, &Path)> = environment.iter().map(|(name, path)| (*name, path.as_path())).collect();
    Run::with("verify", &case(scene), &["--reference", reference], &environment)
}

fn example() -> PathBuf {
    root().join("examples/scikit_fem_solver.py")
}

/// The example with loads 2 % too large, in `folder`.
fn spoilt(folder: &Path) -> PathBuf {
    let text = std::fs::read_to_string(example()).expect("the example");
    let whole = "self.length[edge] / 6 * share";
    assert_eq!(text.matches(whole).count(), 1);
    let path = folder.join("spoilt.py");
    std::fs::write(&path, text.replace(whole, &format!("1.02 * {whole}"))).expect("writable");
    path
}

#[test]
fn a_correct_solver_agrees_under_its_own_name() {
    // Without contact to speak of, with contact that opens, with one whose direction turns, with three bodies.
    for scene in ["patch", "two_blocks", "ring", "stack"] {
        let run = verify(scene, &solver(&example()));
        assert_eq!(run.code, Some(0), "{scene}: {}{}", run.stdout, run.stderr);
        let report = run.report();
        assert!(report.failed().is_empty(), "{scene}: {:?}", report.failed());
        let models = report.0["primal"].as_array().expect("models");
        let names: Vec<&str> = models.iter().filter_map(|model| model["name"].as_str()).collect();
        assert_eq!(names, ["scikit-fem P1", "scikit-fem P2"], "{scene}");
        assert!(models.iter().all(|m| m["solver"] == "scikit-fem" && m["version"] == "12.0.2"), "{models:?}");
        let text = report.0.to_string();
        assert!(text.contains("\"primal/equilibrium/scikit-fem P2\"") && !text.contains("FEniCSx"), "{scene}");
        assert!(run.file("report.html").contains("scikit-fem P2") && !run.file("report.html").contains("FEniCSx"));
        assert!(run.file("fields.vtu").contains("stress_scikit_fem_P2"));
    }
}

#[test]
fn a_mistake_of_the_solver_is_found_and_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = verify("two_blocks", &solver(&spoilt(folder.path())));
    assert_eq!(run.code, Some(1), "{}{}", run.stdout, run.stderr);
    let report = run.report();
    for name in ["primal/equilibrium/scikit-fem P1", "primal/equilibrium/scikit-fem P2"] {
        assert!(report.failed().contains(&name), "{:?}", report.failed());
    }
    for diagnosis in report.0["diagnosis"].as_array().expect("a list") {
        assert!(
            diagnosis["findings"][0]["name"].as_str().is_some_and(|name| name.ends_with("load/left_load")),
            "{diagnosis}"
        );
        assert!(diagnosis.to_string().contains("1.02"), "{diagnosis}");
    }
    assert!(report.0["verdict"].as_str().is_some_and(|v| v.contains("scikit-fem")), "{}", report.0["verdict"]);
}

#[test]
fn what_is_no_solver_is_told_with_its_code() {
    for (reference, code, said) in [
        ("no-such-solver {problem} {out}", 4, "the displacement solver no-such-solver is not found"),
        ("/bin/sh -c 'echo out of memory >&2; exit 9' {problem} {out}", 3, "sh failed (exit code 9)"),
        ("/bin/true {problem} {out}", 3, "wrote no primal-P1.json"),
        ("/bin/sh -c 'echo {} > $1/primal-P1.json' {problem} {problem} {out}", 3, "primal-P1.json"),
    ] {
        let run = verify("patch", reference);
        assert_eq!(run.code, Some(code), "{reference}: {}{}", run.stdout, run.stderr);
        let line = run.stderr.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(line.contains(said), "{reference}: {line}");
        let report = run.report();
        assert_eq!((&report.0["status"], report.0["primal"].as_array().map(Vec::len)), (&"failed".into(), Some(0)));
    }
    for (options, said) in [
        (vec!["--reference", "my-solver {problem}"], "{out} is missing"),
        (vec!["--reference", "'my-solver {problem} {out}"], "is not closed"),
        (vec!["--reference", "my-solver {problem} {out}", "--ranks", "2"], "--ranks alone is for FEniCSx"),
        (vec!["--primal-degree", "1,10"], "10"),
    ] {
        let run = Run::new("verify", &case("patch"), &options);
        assert_eq!(run.code, Some(2), "{options:?}: {}{}", run.stdout, run.stderr);
        assert!(run.stderr.split_whitespace().collect::<Vec<_>>().join(" ").contains(said), "{}", run.stderr);
    }
}

#[test]
fn a_chart_has_a_column_for_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut command = hypercircle(folder.path(), ["chart"]);
    command.arg(case("two_blocks")).env("PYTHONPATH", packages()).env("HYPERCIRCLE_PYTHON", "/nonexistent/python3");
    command.args(["--reduced", "--refine", "0", "--method", "condensed", "--method", "FEniCSx P2", "--quiet"]);
    command.args(["--reference", &solver(&example()), "--out", "out"]);
    ended("chart", &run(command), 0, &[]);
    let read = |name: &str| std::fs::read_to_string(folder.path().join("out").join(name)).expect("written");
    let chart: Value = serde_json::from_str(&read("chart.json")).expect("JSON");
    let runs = chart["scenes"][0]["runs"].as_array().expect("runs");
    let own = runs.iter().find(|run| run["solver"] == "scikit-fem").unwrap_or_else(|| panic!("{runs:?}"));
    assert_eq!(own["status"]["kind"], "done");
    // P2 on the mesh of the scene, as FEniCSx has it.
    assert!((own["plot"]["upper"].as_f64().expect("a number") + 1.79590394773).abs() < 1e-9, "{own}");
    assert!(own["plot"]["whole"]["median"].as_f64().is_some_and(|seconds| seconds > 0.05), "{own}");
    assert!(read("chart.html").contains("scikit-fem P2") && read("chart.csv").contains("scikit-fem P2"));
}

/// A right solver has the closed solution, which is quadratic; one whose loads are wrong is no witness against the stresses.
#[test]
fn a_stability_matrix_has_a_column_for_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let sweep = |file: &Path, out: &str, code: i32| -> (Value, String) {
        let mut command =
            hypercircle(folder.path(), ["stability", "--reduced", "--quiet", "--regime", "poisson-exact"]);
        command.args(["--method", "condensed", "--method", "FEniCSx P2", "--reference", &solver(file), "--out", out]);
        command.env("PYTHONPATH", packages()).env("HYPERCIRCLE_PYTHON", "/nonexistent/python3");
        let said = run(command);
        ended("stability", &said, code, &[]);
        let read = |name: &str| std::fs::read_to_string(folder.path().join(out).join(name)).expect("written");
        assert!(read("stability.html").contains("scikit-fem P2") && read("stability.md").contains("scikit-fem P2"));
        assert!(!read("stability.html").contains("FEniCSx"));
        (
            serde_json::from_str(&read("stability.json")).expect("JSON"),
            String::from_utf8_lossy(&said.stderr).into_owned(),
        )
    };
    let (right, _) = sweep(&example(), "right", 0);
    let [stresses, own] = [0, 1].map(|i| &right["rows"][0]["cells"][i]);
    assert_eq!((&stresses["worst"], &own["worst"]), (&"correct".into(), &"correct".into()), "{right}");
    assert_eq!(own["solver"], "scikit-fem");
    let (wrong, said) = sweep(&spoilt(folder.path()), "wrong", 1);
    assert!(said.contains("scikit-fem P2 in poisson-exact"), "{said}");
    let [stresses, own] = [0, 1].map(|i| &wrong["rows"][0]["cells"][i]["worst"]);
    assert_eq!((stresses, own), (&"correct".into(), &"wrong".into()), "{wrong}");
}
