//! The baseline of a job. Without FEniCSx every scene ends with code 4, and its numbers in stresses are there all the same.

use std::process::Command;

use super::place::{Place, patch, scene};
use crate::command::ended;

const NONE: [Vec<String>; 3] = [const { Vec::new() }; 3];
const AGAINST: [&str; 4] = ["verify", "scenes", "--baseline", "kept.toml"];

fn changed(place: &Place, name: &str) -> [Vec<String>; 3] {
    let job = place.json("out/job.json");
    let entry = scene(&job, name).clone();
    ["changed", "new", "missing"].map(|key| {
        let list = entry[key].as_array().expect("a list").iter();
        list.map(|name| name.as_str().expect("a name").to_string()).collect()
    })
}

#[test]
fn what_is_accepted_is_held_against_and_a_patch_brings_it_up_to_date() {
    let place = Place::with(&["a", "b", "gone"]);
    let accept = [&AGAINST[..], &["--accept", "--reason", "the first", "--accepted-by", "Jane"]].concat();
    ended("nothing accepted yet", &place.run(&AGAINST), 2, &["kept.toml", "--accept"]);
    ended("accepted", &place.run(&accept), 4, &[]);
    let kept = place.read("kept.toml");
    assert!(
        kept.contains("[scenes.a]") && kept.contains("by = \"Jane\"") && kept.contains("reason = \"the first\""),
        "{kept}"
    );
    ended("unchanged", &place.run(&AGAINST), 4, &[]);
    assert_eq!(changed(&place, "a"), NONE);
    assert!(!place.path("out/baseline.patch").exists());

    // One scene changes, one goes, one comes; somebody edits the file by hand.
    let edited = kept.replace("[scenes.b]\n", "[scenes.b]\n# stays\n\"of old\" = { value = 1.0, allowed = 0.1 }\n");
    place.write("kept.toml", &edited);
    place.write("scenes/a.toml", &patch().replacen("young = ", "young = 1", 1));
    std::fs::rename(place.path("scenes/gone.toml"), place.path("scenes/came.toml")).expect("writable");
    ended("changed", &place.run(&AGAINST), 4, &[]);
    let [moved, new, missing] = changed(&place, "a");
    assert!(moved.contains(&"energy.lower".to_string()) && new.is_empty() && missing.is_empty(), "{moved:?}");
    assert!(!moved.contains(&"triangles".to_string()));
    assert_eq!(changed(&place, "b"), [vec![], vec![], vec!["of old".to_string()]]);
    assert!(changed(&place, "came")[1].contains(&"energy.lower".to_string()));
    assert_eq!(place.json("out/job.json")["not_in_job"], serde_json::json!(["gone"]));
    let report = place.json("out/a/report.json");
    let check = report["checks"].as_array().expect("checks").iter().find(|c| c["name"] == "baseline/energy.lower");
    assert_eq!(check.expect("a check of the scene itself")["passed"], false);
    let [page, summary] = ["index.html", "summary.md"].map(|name| place.read(&format!("out/{name}")));
    assert!(page.contains("baseline.patch") && page.contains("of old") && summary.contains("baseline.patch"));

    // Applied by hand, it is what would have been accepted.
    let git = |arguments: &[&str]| {
        let mut git = Command::new("git");
        git.args(arguments).current_dir(place.folder()).env("GIT_CEILING_DIRECTORIES", place.folder());
        git.output().expect("git")
    };
    let applied = git(&["apply", "out/baseline.patch"]);
    assert!(applied.status.success(), "{}", String::from_utf8_lossy(&applied.stderr));
    assert!(place.read("kept.toml").contains("# stays") && !place.read("kept.toml").contains("of old"));
    ended("up to date", &place.run(&AGAINST), 4, &[]);
    for name in ["a", "b", "came"] {
        assert_eq!(changed(&place, name), NONE, "{name}");
    }
    assert!(!place.path("out/baseline.patch").exists());
}

#[test]
fn one_scene_writes_its_part_and_others_stay() {
    let place = Place::with(&["a", "b"]);
    for name in ["a", "b"] {
        let scene = format!("scenes/{name}.toml");
        ended(name, &place.run(&["verify", &scene, "--baseline", "kept.toml", "--accept", "--reason", name]), 4, &[]);
    }
    let kept = place.read("kept.toml");
    assert!(kept.contains("[scenes.a]") && kept.contains("[scenes.b]"), "{kept}");
    ended("both", &place.run(&AGAINST), 4, &[]);
    assert_eq!(changed(&place, "b"), NONE);
    // The file of one scene is still JSON where its name says so, and no job's.
    ended("json", &place.run(&["verify", "scenes/a.toml", "--baseline", "kept.json", "--accept"]), 4, &[]);
    assert_eq!(place.json("kept.json")["scene"], "a");
    ended("a job", &place.run(&["verify", "scenes", "--baseline", "kept.json"]), 2, &["kept.json", ".toml"]);
    place.write("bad.toml", "version = 1\n[scenes.a]\nx = 1\n");
    ended("malformed", &place.run(&["verify", "scenes", "--baseline", "bad.toml"]), 2, &["bad.toml", "line 3"]);
}

#[test]
fn a_tolerance_may_be_meant_for_one_scene_of_many() {
    let place = Place::with(&["a"]);
    let two_blocks = std::fs::read_to_string(crate::command::case("gravity")).expect("a case");
    place.write("scenes/gravity.toml", &two_blocks);
    let first = place.read("scenes/a.toml");
    let side = first.split("between = [\"").nth(1).and_then(|rest| rest.split('"').next()).expect("a side");
    let second = first.split("between = [").nth(1).and_then(|rest| rest.split('"').nth(3)).expect("a side");
    let name = format!("contact/{side}|{second}/resultant=1");
    ended("known to one", &place.run(&["verify", "scenes", "--allow", &name]), 4, &[]);
    ended(
        "known to none",
        &place.run(&["verify", "scenes", "--allow", "resultent=1", "--out", "none"]),
        2,
        &["resultent"],
    );
    assert!(!place.path("none").exists());
}
