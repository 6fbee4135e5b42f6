//! The first sentence about a failure names its cause and its place, in every file and on the terminal.

use std::path::{Path, PathBuf};

use super::run::{Run, case, with_reference};

/// The scene, how it is spoilt (a sabotage, or a planted bug), and what the first sentence has to say of cause and place.
const FAULTS: [(&str, &str, &[&str]); 7] = [
    ("two_blocks", "--sabotage drop-row", &["contact left_face|right_face does not act", "at (1, 0.125)"]),
    ("two_blocks", "--sabotage flip-sign", &["Lamé's λ of every body", "1 + 2ν stood in place of 1 − 2ν", "at (0, "]),
    ("gap", "gap_ignored", &["contact ram_face|target_face closes 0.01000 too early", "at (1, "]),
    ("silo", "rollers_missing", &["the support on lower_left is not applied", "at (0, "]),
    ("patch", "thickness_ignored", &["the thickness is 2.000 times", "in the whole scene"]),
    ("stack", "materials_swapped", &["the materials of base and plate are exchanged", " in "]),
    ("two_blocks", "contact_at_one_node", &["contact left_face|right_face does not act at 16 of 17 nodes", "at (1, "]),
];

fn spoilt(scene: &str, how: &str) -> Run {
    if let Some(sabotage) = how.strip_prefix("--sabotage ") {
        return Run::new("verify", &case(scene), &["--sabotage", sabotage]);
    }
    let stand_in = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/support/planted/stand_in.py");
    let python = std::env::var_os("HYPERCIRCLE_PYTHON").map_or("/usr/bin/python3".into(), PathBuf::from);
    let bug = format!("{how} 0");
    let environment = [
        ("HYPERCIRCLE_PYTHON", stand_in.as_path()),
        ("HYPERCIRCLE_PLANT_PYTHON", &python),
        ("HYPERCIRCLE_PLANT", Path::new(&bug)),
    ];
    Run::with("verify", &case(scene), &[], &environment)
}

/// The text of a page or a summary as a reader sees it.
fn read(text: &str) -> String {
    let plain = text.replace("\\|", "|").replace("\\_", "_").replace("&quot;", "\"");
    plain.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&")
}

#[test]
fn the_first_sentence_names_cause_and_place() {
    for (scene, how, said) in FAULTS.iter().filter(|_| with_reference()) {
        let run = spoilt(scene, how);
        assert_eq!(run.code, Some(1), "{how} in {scene}: {}{}", run.stdout, run.stderr);
        let report = run.report().0;
        let causes = report["causes"].as_array().expect("a list");
        assert_eq!(causes.len(), 1, "{how} in {scene} has one cause: {}", report["causes"]);
        let sentence = causes[0]["sentence"].as_str().expect("a sentence");
        for words in *said {
            assert!(sentence.contains(words), "{words} is not in the first sentence on {how}: {sentence}");
        }
        // It is the first that is said, and explains every check that failed.
        assert!(report["verdict"].as_str().is_some_and(|verdict| verdict.starts_with(sentence)), "{report}");
        assert!(run.stdout.starts_with(sentence), "{}", run.stdout);
        for file in ["report.html", "summary.md"] {
            let text = read(&run.file(file));
            let first = text.find(sentence).unwrap_or_else(|| panic!("{file} does not say: {sentence}"));
            let check = report["checks"].as_array().into_iter().flatten().find(|c| c["passed"] == false).expect("one");
            let check = check["name"].as_str().expect("a name");
            assert!(
                text.find(&format!("{check}<")).is_none_or(|at| first < at),
                "{file} lists {check} before it says why"
            );
        }
        let explained = causes[0]["checks"].as_array().map_or(0, Vec::len);
        let failed = report["checks"].as_array().into_iter().flatten().filter(|c| c["passed"] == false).count();
        assert_eq!(explained, failed, "{how} in {scene}");
        // A place that has coordinates is marked in the picture of the scene.
        let marked = run.file("report.html").contains("data-cause=\"1\"");
        assert_eq!(marked, !causes[0]["place"].is_null(), "{how} in {scene}");
        // Nothing that failed is told in the words of what passed.
        let junit = read(&run.file("junit.xml"));
        for check in report["checks"].as_array().into_iter().flatten().filter(|c| c["passed"] == false) {
            let why = check["why"].as_str().expect("a sentence");
            // What a wrong field keeps from being decided says so.
            if check["difference"].is_null() {
                assert!(why.contains("could not be decided"), "{why}");
                continue;
            }
            assert!(!run.stdout.contains(why) && !junit.contains(&format!("message=\"{why}")), "{why}");
        }
    }
}
