//! `hypercircle diff`: what is told, and the exit code.

use std::path::Path;
use std::process::Output;

use crate::command::{case, ended, hypercircle, run};

fn diff(folder: &Path, arguments: &[&str]) -> Output {
    run(hypercircle(folder, [&["diff"], arguments].concat()))
}

fn told(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

#[test]
fn two_runs_of_a_scene_beside_each_other() {
    let place = tempfile::tempdir().expect("a folder");
    let folder = place.path();
    for (out, options) in [("a", &[][..]), ("b", &[]), ("fine", &["--refine", "1"])] {
        let mut command = hypercircle(folder, ["solve"]);
        command.arg(case("two_blocks")).args(["--quiet", "--out", out]).args(options);
        ended(out, &run(command), 0, &[]);
    }
    let same = diff(folder, &["a", "b/report.json"]);
    ended("the same", &same, 0, &[]);
    assert!(
        told(&same).contains("Nothing decisive differs") && !told(&same).contains("value changed"),
        "{}",
        told(&same)
    );
    let finer = diff(folder, &["a", "fine", "--html", "page.html"]);
    ended("finer", &finer, 0, &[]);
    assert!(
        told(&finer).contains("energy: lower bound") && told(&finer).contains("triangles: 304 → 1216"),
        "{}",
        told(&finer)
    );
    let page = std::fs::read_to_string(folder.join("page.html")).expect("a page");
    assert!(
        page.contains("Two reports") && page.contains("1216") && !page.contains("<script") && !page.contains("http")
    );

    let mut command = hypercircle(folder, ["solve"]);
    command.arg(case("patch")).args(["--quiet", "--out", "patch"]);
    ended("another scene", &run(command), 0, &[]);
    let foreign = diff(folder, &["a", "patch"]);
    ended("another scene", &foreign, 0, &[]);
    for words in ["different content", "No verdict differs; the scenes do"] {
        assert!(told(&foreign).contains(words), "{}", told(&foreign));
    }

    // A bracket that lies elsewhere, and a check that no longer passes.
    let report = std::fs::read_to_string(folder.join("fine/report.json")).expect("a report");
    let mut other: serde_json::Value = serde_json::from_str(&report).expect("JSON");
    other["energy"]["lower"] = (-1.0).into();
    other["energy"]["upper"] = (-0.9).into();
    std::fs::write(folder.join("elsewhere.json"), other.to_string()).expect("writable");
    let apart = diff(folder, &["a", "elsewhere.json"]);
    ended("apart", &apart, 1, &[]);
    assert!(told(&apart).contains("contradiction: energy"), "{}", told(&apart));
    let mut other: serde_json::Value = serde_json::from_str(&report).expect("JSON");
    other["checks"][1]["passed"] = false.into();
    std::fs::write(folder.join("failed.json"), other.to_string()).expect("writable");
    let broken = diff(folder, &["a", "failed.json"]);
    ended("broken", &broken, 1, &[]);
    let first = told(&broken).lines().find(|line| line.starts_with("  ")).map(str::to_string);
    assert!(first.is_some_and(|line| line.contains("passed → failed")), "{}", told(&broken));

    // A mixture of two runs, and what is no report.
    std::fs::copy(folder.join("b/summary.md"), folder.join("fine/summary.md")).expect("writable");
    ended("mixed", &diff(folder, &["a", "fine"]), 2, &["summary.md", "is not of the run"]);
    ended("mixed, by its file", &diff(folder, &["a", "fine/report.json"]), 2, &["summary.md"]);
    std::fs::write(folder.join("list.json"), "[]").expect("writable");
    for wrong in ["nowhere", "list.json", "."] {
        ended(wrong, &diff(folder, &["a", wrong]), 2, &["report.json"]);
    }
}
