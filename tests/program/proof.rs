//! `--proof`: what travels with the report; the checker has tests of its own (`checker/tests`).

use std::fs;

use serde_json::Value;

use crate::command::{case, ended, hypercircle, run, script};

#[test]
fn a_proof_comes_and_goes_with_its_run() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = case("gap");
    let solve = |more: &[&str]| {
        let line = [&["solve", scene.to_str().expect("text"), "--out", "out"], more].concat();
        ended("solve", &run(hypercircle(folder.path(), line)), 0, &[]);
        fs::read(folder.path().join("out/proof.npz"))
    };
    let first = solve(&["--proof"]).expect("a proof");
    assert!(first.starts_with(b"PK\x03\x04"));
    // What it holds is a function of scene and program alone.
    assert!(first == solve(&["--proof"]).expect("a proof"), "the same scene, another proof");
    assert!(solve(&[]).is_err(), "the proof of an earlier run is still there");
}

#[test]
fn scenes_beyond_the_checker_are_refused_before_they_are_solved() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = fs::read_to_string(case("gap")).expect("a scene");
    let refused = |text: &str, why: &str| {
        fs::write(folder.path().join("scene.toml"), text).expect("writable");
        let output = run(hypercircle(folder.path(), ["solve", "scene.toml", "--proof"]));
        ended("solve", &output, 2, &[why, "leave out --proof"]);
    };
    assert!(text.contains("gap = 0.01"));
    refused(
        &text.replace("gap = 0.01", "gap = [0.01, 0.02]"),
        "a scene with a range of `gap` in `contacts` has no proof",
    );
    let turned = fs::read_to_string(case("tube")).expect("a scene");
    refused(&turned, "a scene with `kinematics = \"axisymmetric\"` in `model` has no proof");
    let wedged = fs::read_to_string(case("wedge")).expect("a scene");
    refused(&wedged, "a scene with `coefficient` in `contacts.friction` has no proof");
    let pushed = fs::read_to_string(case("pushed_partly")).expect("a scene");
    let pushed = pushed.replace("bound = 0.15", "bound = [0.1, 0.15]");
    refused(&pushed, "a scene with a range of `bound` in `contacts.friction` has no proof");
    assert!(!folder.path().join("out").exists());
}

#[test]
fn the_report_says_on_whose_word_the_bracket_holds() {
    let folder = tempfile::tempdir().expect("a folder");
    let here = folder.path();
    fs::create_dir(here.join("bin")).expect("writable");
    let scene = case("gap");
    let guarantee = |checker: Option<&str>| {
        let path = here.join("bin/hypercircle-check");
        match checker {
            Some(body) => drop(script(path, body)),
            None => fs::remove_file(path).unwrap_or_default(),
        }
        let mut command = hypercircle(here, ["solve", scene.to_str().expect("text"), "--out", "out", "--proof"]);
        ended(
            "solve",
            &run({
                command.env("PATH", here.join("bin"));
                command
            }),
            0,
            &[],
        );
        let report = fs::read_to_string(here.join("out/report.json")).expect("a report");
        let report: Value = serde_json::from_str(&report).expect("JSON");
        let [level, words] =
            ["level", "words"].map(|key| report["energy"]["guarantee"][key].as_str().map(str::to_string));
        let page = fs::read_to_string(here.join("out/report.html")).expect("a page");
        assert!(page.contains(words.as_deref().expect("words")), "the page does not say it");
        (level.expect("a level"), words.expect("words"))
    };
    let (level, words) = guarantee(None);
    assert_eq!(level, "guaranteed");
    assert!(words.contains("hypercircle-check, which is not installed here, can verify proof.npz"), "{words}");
    // It is given the proof, and the page names who verified it.
    let (level, words) = guarantee(Some("[ -s \"$1\" ] && echo 'proved: all of it' && echo '  by stub 7'"));
    assert_eq!((level.as_str(), words.as_str()), ("proved", "proved (verified in exact arithmetic by stub 7)"));
    let (level, words) = guarantee(Some("echo 'not proved: nothing holds.'; exit 1"));
    assert_eq!(
        (level.as_str(), words.as_str()),
        ("guaranteed", "guaranteed (rounding enclosed), but not proved: nothing holds")
    );
}
