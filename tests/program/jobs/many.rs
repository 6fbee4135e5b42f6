//! A dozen scenes, some of them broken in different ways.

use super::junit::assert_valid_for_jenkins;
use super::place::{LOOSE, Place, lasting, patch, scene};
use crate::command::{ended, run};

const SOUND: [&str; 8] = ["a", "b", "c", "d", "e", "f", "g", "h"];

/// Eight sound scenes; one that is malformed, one without equilibrium, one whose process hangs, one that crashes.
fn dozen() -> (Place, std::path::PathBuf) {
    let place = Place::with(&SOUND);
    place.write("scenes/b_malformed.toml", &patch().replacen("young =", "jung =", 1));
    place.write("scenes/loose.toml", LOOSE);
    place.write("scenes/pyproject.toml", "[project]\nname = \"x\"\n");
    let interpreter = place.stand_in();
    (place, interpreter)
}

#[test]
fn a_dozen_scenes_with_four_broken_ones_are_one_page() {
    let (place, interpreter) = dozen();
    // What an earlier run left in the folder of a scene that now crashes is not this job's.
    ended("before", &place.run(&["solve", "scenes/a.toml", "--out", "out/crashes"]), 0, &[]);
    ended("before", &place.run(&["solve", "scenes/a.toml", "--out", "out/b_malformed"]), 0, &[]);
    let stale = place.read("out/crashes/report.json");
    let mut command = place.command(&["solve", "scenes", "--jobs", "2", "--scene-seconds", "3"]);
    command.env("HYPERCIRCLE_PYTHON", &interpreter);
    let output = run(command);
    ended("a dozen", &output, 3, &[]);
    let job = place.json("out/job.json");
    let names: Vec<&str> =
        job["scenes"].as_array().expect("scenes").iter().filter_map(|s| s["name"].as_str()).collect();
    let expected = ["a", "b", "b_malformed", "c", "crashes", "d", "e", "f", "g", "h", "hangs", "loose"];
    assert_eq!(names, expected, "the order in which they were found");
    for name in SOUND {
        let entry = scene(&job, name);
        assert_eq!((&entry["exit"], &entry["status"], &entry["folder"]), (&0.into(), &"agree".into(), &name.into()));
        let report = place.json(&format!("out/{name}/report.json"));
        assert_eq!(report["run"], entry["run"], "{name}");
        assert_eq!(report["energy"]["lower"], entry["energy"]["lower"], "{name}");
    }
    for (name, exit, status, said) in [
        ("b_malformed", 2, "bad-input", "jung"),
        ("crashes", 3, "crashed", "signal 9"),
        ("hangs", 3, "timed-out", "longer than a scene may"),
        ("loose", 5, "infeasible", "moves"),
    ] {
        let entry = scene(&job, name);
        assert_eq!((&entry["exit"], &entry["status"]), (&exit.into(), &status.into()), "{entry}");
        assert!(entry["verdict"].as_str().is_some_and(|verdict| verdict.contains(said)), "{entry}");
        assert_eq!(entry["folder"].is_null(), name != "loose", "{entry}");
    }
    assert!(scene(&job, "b_malformed")["line"].as_u64().is_some_and(|line| line > 1));
    assert_eq!(job["exit"], 3);
    assert_eq!(job["counts"]["agree"], 8);
    assert_eq!(job["left_out"], serde_json::json!(["scenes/pyproject.toml"]));
    assert_eq!(place.read("out/crashes/report.json"), stale, "what others left is left alone");
    // The worst first: 3, 2, 5, then the sound ones, each group in the order of the scenes.
    let page = place.read("out/index.html");
    let number = |text: &str| text.split('"').next().and_then(|n| n.parse::<usize>().ok()).expect("a number");
    let rows: Vec<&str> =
        page.split("<tr").filter_map(|row| Some(names[number(row.split_once("id=\"scene-")?.1) - 1])).collect();
    assert_eq!(rows[..4], ["crashes", "hangs", "b_malformed", "loose"]);
    assert_eq!(rows[4..], SOUND);
    assert!(!page.contains("crashes/report.html") && !page.contains("b_malformed/report.html"));
    assert!(page.contains("a/report.html") && page.contains("pyproject.toml"));
    for outside in ["<script", "<link", "src=", "http:", "https:"] {
        assert!(!page.contains(outside), "{outside}");
    }
    assert_valid_for_jenkins(&place.read("out/junit.xml"));
    assert!(place.read("out/junit.xml").contains("errors=\"3\""));
    let summary = place.read("out/summary.md");
    assert!(
        summary.contains("12 scenes: 8 passed") && summary.contains("### ⚠ `scenes/b_malformed.toml:"),
        "{summary}"
    );
    assert_eq!(place.json("out/badge.json")["message"], "8 of 12 passed");
    assert!(place.read("out/badge.svg").contains("8 of 12 passed"));
}

#[test]
fn the_same_job_twice_is_the_same_but_for_times() {
    let place = Place::with(&["a", "b"]);
    place.write("scenes/loose.toml", LOOSE);
    for (out, jobs) in [("one", "1"), ("two", "3")] {
        ended(out, &place.run(&["solve", "scenes", "--out", out, "--jobs", jobs, "--quiet"]), 5, &[]);
    }
    assert_eq!(lasting(&place.json("one/job.json")), lasting(&place.json("two/job.json")));
}

#[test]
fn scenes_of_one_name_have_folders_of_their_own() {
    let place = Place::with(&["x"]);
    place.write("other/x.toml", &patch().replacen("value = [", "value = [0.5, 0.0] #", 1));
    place.write("other/parts.toml", &patch());
    let output = place.run(&["solve", "scenes", "other", "scenes/x.toml", "--out", "results"]);
    ended("two of one name", &output, 0, &[]);
    let job = place.json("results/job.json");
    let names: Vec<&str> =
        job["scenes"].as_array().expect("scenes").iter().filter_map(|s| s["name"].as_str()).collect();
    assert_eq!(names, ["scenes-x", "other-parts", "other-x"]);
    for name in names {
        let entry = scene(&job, name);
        let report = place.json(&format!("results/{name}/report.json"));
        assert_eq!((&report["run"], &report["energy"]["lower"]), (&entry["run"], &entry["energy"]["lower"]));
    }
}

#[test]
fn one_scene_is_no_job_and_a_folder_is_one() {
    let place = Place::with(&["x"]);
    ended("one", &place.run(&["solve", "scenes/x.toml", "--out", "one", "--jobs", "2"]), 0, &[]);
    let mut left = std::fs::read_dir(place.path("one")).expect("there").count();
    assert_eq!(left, 7);
    ended("a folder", &place.run(&["solve", "scenes", "--out", "folder"]), 0, &[]);
    left = std::fs::read_dir(place.path("folder/x")).expect("there").count();
    assert_eq!(left, 7);
    place.write("empty/notes.txt", "");
    ended("nothing", &place.run(&["solve", "empty"]), 2, &["empty", "directory without a scene"]);
    ended("both", &place.run(&["solve", "scenes", "empty"]), 2, &["empty"]);
    assert!(!place.path("out").exists());
    // A scene that is not there is one that failed.
    ended("missing", &place.run(&["solve", "scenes", "nowhere.toml", "--out", "missing"]), 2, &[]);
    assert_eq!(place.json("missing/job.json")["counts"]["agree"], 1);
}

#[test]
fn options_reach_every_scene_and_memory_is_shared() {
    let place = Place::with(&["a", "b"]);
    ended("refined", &place.run(&["solve", "scenes", "--refine", "1", "--degree=2", "--out", "fine"]), 0, &[]);
    ended("plain", &place.run(&["solve", "scenes", "--out", "plain"]), 0, &[]);
    let triangles =
        |out: &str| place.json(&format!("{out}/job.json"))["scenes"][1]["triangles"].as_u64().expect("a number");
    assert_eq!(triangles("fine"), 4 * triangles("plain"));
    assert_eq!(place.json("fine/b/report.json")["dual"]["degree_max"], 2);
    // Too little for a single scene, shared by two: each says so with its own share.
    let output = place.run(&["solve", "scenes", "--max-memory", "30M", "--jobs", "2", "--out", "little"]);
    ended("little", &output, 3, &[]);
    let said = scene(&place.json("little/job.json"), "a")["verdict"].to_string();
    assert!(said.contains("15 MB may be used"), "{said}");
}

#[test]
fn a_ci_service_is_told_once_and_in_its_own_way() {
    let place = Place::with(&["a"]);
    place.write("scenes/bad.toml", &patch().replacen("young =", "jung =", 1));
    place.write("scenes/loose.toml", LOOSE);
    let told = |arguments: &[&str], exit: i32| {
        let _ = std::fs::remove_file(place.path("step.md"));
        let mut command = place.command(arguments);
        command.env("GITHUB_ACTIONS", "true").env("GITHUB_STEP_SUMMARY", place.path("step.md"));
        command.env("GITHUB_WORKSPACE", place.folder());
        let output = run(command);
        ended(&arguments.join(" "), &output, exit, &[]);
        let lines = String::from_utf8_lossy(&output.stdout).into_owned();
        lines.lines().filter(|line| line.starts_with("::")).map(str::to_string).collect::<Vec<_>>()
    };
    let marks = told(&["solve", "scenes"], 2);
    assert_eq!(marks.len(), 2, "{marks:?}");
    assert!(marks[0].starts_with("::error file=scenes/bad.toml,line=") && marks[0].contains("jung"), "{marks:?}");
    assert!(marks[1].starts_with("::error file=scenes/loose.toml,title="), "{marks:?}");
    assert_eq!(place.read("step.md").trim_end(), place.read("out/summary.md").trim_end());
    // The same for one scene.
    let marks = told(&["solve", "scenes/bad.toml"], 2);
    assert!(marks.len() == 1 && marks[0].starts_with("::error file=scenes/bad.toml,line="), "{marks:?}");
    let marks = told(&["solve", "scenes/loose.toml", "--out", "one"], 5);
    assert!(marks.len() == 1 && marks[0].starts_with("::error file=scenes/loose.toml"), "{marks:?}");
    assert_eq!(place.read("step.md").trim_end(), place.read("one/summary.md").trim_end());
    assert!(told(&["solve", "scenes/a.toml"], 0).is_empty());
}
