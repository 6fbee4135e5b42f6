//! Displacement fields for many scenes. The interpreter is one that gives the same field whatever it is asked to read.

use std::path::Path;

use super::place::{Place, scene};
use crate::command::{ended, run, script};

#[test]
fn each_scene_is_held_against_the_field_of_its_name() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let place = Place::with(&[]);
    let setting = std::fs::read_to_string(root.join("fuzz/src/setting.toml")).expect("a scene");
    for name in ["one", "two"] {
        place.write(&format!("scenes/{name}.toml"), &setting);
        place.write(&format!("fields/{name}.vtk"), name);
    }
    let field = root.join("fuzz/corpus/field/linear.json");
    let interpreter =
        script(place.path("python3"), &format!("for last; do :; done\ncp '{}' \"$last\"", field.display()));
    let certify = |displacement: &str, options: &[&str]| {
        let arguments = [&["certify", "scenes", "--displacement", displacement], options].concat();
        let mut command = place.command(&arguments);
        command.env("HYPERCIRCLE_PYTHON", &interpreter);
        run(command)
    };
    let output = certify("fields", &[]);
    assert!(matches!(output.status.code(), Some(0 | 1)), "{output:?}");
    for name in ["one", "two"] {
        let report = place.json(&format!("out/{name}/report.json"));
        assert_eq!(report["primal"][0]["name"], format!("{name}.vtk"));
    }
    // Another field of one scene: that one is run again, the other is kept.
    let before = place.json("out/job.json");
    place.write("fields/two.vtk", "changed");
    certify("fields", &["--resume"]);
    let after = place.json("out/job.json");
    let run = |job: &serde_json::Value, name: &str| scene(job, name)["run"].clone();
    assert_eq!(run(&before, "one"), run(&after, "one"));
    assert_ne!(run(&before, "two"), run(&after, "two"));
    // One file for both, and none for one of them.
    let output = certify("fields/one.vtk", &["--out", "same"]);
    assert!(matches!(output.status.code(), Some(0 | 1)), "{output:?}");
    assert_eq!(place.json("same/two/report.json")["primal"][0]["name"], "one.vtk");
    std::fs::remove_file(place.path("fields/two.vtk")).expect("there");
    ended("no field", &certify("fields", &["--out", "none"]), 2, &["fields", "no file named two", "scenes/two.toml"]);
    assert!(!place.path("none").exists());
}
