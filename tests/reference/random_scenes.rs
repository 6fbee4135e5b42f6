//! Scenes nobody has tuned: random ones by seed, and some that are hard in one way each (`tests/scenes`), through all four
//! methods, a finer mesh, and both displacement models. `ci/random` runs many more.

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::Duration;

use crate::command::{PROGRAM, with_reference};
use crate::support::scenes::{Sample, sample};
use crate::support::trial::{ADAPTIVE, Ended, Program, Trial, Way, faults};
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;

/// Tries each sample, two at a time, and fails with all that is wrong.
fn try_all(samples: Vec<Sample>) {
    let folder = tempfile::tempdir().expect("a folder");
    let binary = PathBuf::from(PROGRAM);
    let program = Program { binary, limit: Duration::from_secs(300), environment: Vec::new() };
    let (queue, wrong) = (Mutex::new(samples), Mutex::new(String::new()));
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                loop {
                    let Some(sample) = queue.lock().expect("unpoisoned").pop() else { break };
                    // One way of two, by turns.
                    let adaptive = &ADAPTIVE[sample.seed as usize % 2..][..1];
                    let trial = Trial::of(&sample, &program, folder.path(), adaptive, with_reference());
                    for fault in &trial.faults {
                        let text = format!("{} {}: {}: {}\n", sample.family, sample.seed, fault.kind, fault.text);
                        wrong.lock().expect("unpoisoned").push_str(&text);
                    }
                }
            });
        }
    });
    let wrong = wrong.into_inner().expect("unpoisoned");
    assert!(wrong.is_empty(), "\n{wrong}");
}

#[test]
fn random_scenes_get_the_right_verdict() {
    try_all((1..=12).map(sample).collect());
}

#[test]
fn hard_scenes_get_the_right_verdict() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenes");
    let mut samples = Vec::new();
    let mut paths: Vec<_> =
        std::fs::read_dir(folder).expect("the scenes").map(|entry| entry.expect("readable").path()).collect();
    paths.sort();
    for (seed, path) in (1..).zip(paths) {
        let text = std::fs::read_to_string(&path).expect("readable");
        let family = path.file_stem().and_then(|n| n.to_str()).expect("a plain name").to_owned().leak();
        samples.push(Sample { seed, family, text, mesh: None, rounding: 0.0, rounds: false });
    }
    assert!(samples.len() >= 10, "{} scenes", samples.len());
    try_all(samples);
}

#[test]
fn a_seed_is_the_same_scene_every_time_and_another_seed_another_one() {
    for seed in 0..50 {
        assert_eq!(sample(seed).text, sample(seed).text);
        let body = |seed: u64| sample(seed).text.lines().skip(1).collect::<Vec<_>>().join("\n");
        assert_ne!(body(seed), body(seed + 1));
    }
}

/// True if the text of a scene contains `what`.
fn has(text: &str, what: &str) -> bool {
    text.contains(what)
}

#[test]
fn every_random_scene_is_valid_and_every_kind_of_condition_occurs() {
    let samples: Vec<Sample> = (1..=1300).map(sample).collect();
    let folder = tempfile::tempdir().expect("a folder");
    for sample in &samples {
        let (seed, text) = (sample.seed, &sample.text);
        let scene = Scene::read(&sample.write(folder.path())).unwrap_or_else(|e| panic!("{seed}: {e}\n{text}"));
        Problem::load(scene).unwrap_or_else(|e| panic!("{seed}: {e}\n{text}"));
    }
    let words = [
        "plane-strain",
        "plane-stress",
        "clamped",
        "roller",
        "pressure",
        "gradient",
        "between",
        "gap = [[",
        "0.4999",
        "[bodies.b5]",
        "[mesh]",
        "_south",
        "obstacle = { line",
        "obstacle = { circle",
        "side = \"inside\"",
        "move = ",
        "friction = { bound",
        "type = \"spring\"",
        "[[bonds]]",
        "stiffness = [",
        "_low\", \"",
        "temperature",
        "terms = [{ powers = [",
        "# Random scene",
    ];
    for word in words {
        let count = samples.iter().filter(|s| has(&s.text, word)).count();
        assert!(count >= 6, "{word} in {count} scenes");
    }
    for family in ["blocks", "shapes", "stack", "crowd", "mixed"] {
        let count = samples.iter().filter(|s| s.family == family).count();
        assert!(count >= 20, "{count} of {family}");
    }
}

/// A run that ended with `code` and that bracket.
fn ended(code: i32, [lower, upper]: [f64; 2], more: &str) -> Ended {
    let text = format!(
        r#"{{"status": "agree", "energy": {{"lower": {lower:e}, "upper": {upper:e}, "relative_error_bound": 0.1,
           "complementary": 1.0, "widening": 1e-12}}, "checks": [{more}], "primal": []}}"#
    );
    let report = matches!(code, 0 | 1).then(|| serde_json::from_str(&text).expect("JSON"));
    Ended { code, timed_out: false, seconds: 0.0, report, words: String::new() }
}

fn kinds(runs: Vec<(Way, Ended)>) -> Vec<String> {
    faults(&runs, 0.0, false).into_iter().map(|f| f.kind).collect()
}

const FIRST: Way = Way::Method("condensed");
const SECOND: Way = Way::Method("uzawa");

#[test]
fn answers_that_can_all_be_true_are_no_fault() {
    let overlapping = vec![(FIRST, ended(0, [-2.0, -1.0], "")), (SECOND, ended(0, [-1.5, -0.5], ""))];
    assert!(kinds(overlapping).is_empty());
    assert!(kinds(vec![(FIRST, ended(5, [0.0; 2], "")), (SECOND, ended(5, [0.0; 2], ""))]).is_empty());
}

#[test]
fn answers_that_cannot_all_be_true_are_faults() {
    let apart = vec![(FIRST, ended(0, [-2.0, -1.0], "")), (SECOND, ended(0, [-0.9, -0.5], ""))];
    assert_eq!(kinds(apart), ["brackets that exclude each other"]);
    assert_eq!(kinds(vec![(FIRST, ended(0, [-1.0, -2.0], ""))]), ["condensed: bracket upside down"]);
    let divided = vec![(FIRST, ended(5, [0.0; 2], "")), (SECOND, ended(0, [-2.0, -1.0], ""))];
    assert_eq!(kinds(divided), ["infeasible for some"]);
    let falling = vec![(FIRST, ended(0, [-2.0, -1.0], "")), (Way::Finer, ended(0, [-2.1, -1.0], ""))];
    assert_eq!(kinds(falling), ["a lower bound that falls"]);
}

#[test]
fn a_run_that_fails_crashes_or_disagrees_is_a_fault() {
    let check = r#"{"name": "contact/a|b/resultant", "value": 1, "reference": 2, "allowed": 0.1, "passed": false}"#;
    assert_eq!(kinds(vec![(FIRST, ended(1, [-2.0, -1.0], check))]), ["condensed: agree: contact/*/resultant"]);
    assert_eq!(kinds(vec![(FIRST, ended(-6, [0.0; 2], ""))]), ["condensed: signal 6"]);
    assert_eq!(kinds(vec![(FIRST, ended(3, [0.0; 2], ""))]), ["condensed: failed: "]);
    assert_eq!(kinds(vec![(FIRST, ended(101, [0.0; 2], ""))]), ["condensed: exit 101"]);
    let mut stuck = ended(0, [-2.0, -1.0], "");
    stuck.timed_out = true;
    assert_eq!(kinds(vec![(FIRST, stuck)]), ["condensed: timed out"]);
}

#[test]
fn a_displacement_model_below_a_lower_bound_is_a_fault() {
    let mut verified = ended(0, [-2.0, -1.0], "");
    let report = verified.report.as_mut().expect("a report");
    report["primal"] = serde_json::json!([{"name": "P1", "admissible": true, "energy": -2.1}]);
    assert_eq!(kinds(vec![(Way::Verify, verified)]), ["a displacement model below a lower bound"]);
}
