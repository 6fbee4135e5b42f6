//! `--proof`: what travels with the report; the checker has tests of its own (`checker/tests`).

use std::fs;

use crate::command::{case, ended, hypercircle, run};

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
    let [ram, bonded] =
        ["between = [\"ram_face\", \"target_face\"]\ngap = 0.01", "between = [\"ram_face\", \"target_face\"]"];
    assert!(text.contains(ram));
    fs::write(folder.path().join("bonded.toml"), text.replace("[[contacts]]", "[[bonds]]").replace(ram, bonded))
        .expect("writable");
    let output = run(hypercircle(folder.path(), ["solve", "bonded.toml", "--proof"]));
    ended("solve", &output, 2, &["a scene with `bonds` has no proof", "leave out --proof"]);
    assert!(!folder.path().join("out").exists());
}
