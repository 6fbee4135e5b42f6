//! Unusable input is refused before there is anything to solve, with the place and the remedy.

use std::os::unix::fs::FileTypeExt;
use std::path::Path;

use super::run::{Place, case};
use crate::command::{PROGRAM, ended, run};

/// An interpreter that is not there: a run that gets as far as FEniCSx ends with code 4, not 2.
const NOWHERE: (&str, &str) = ("HYPERCIRCLE_PYTHON", "/nonexistent/python3");

#[test]
fn outputs_and_baselines_are_checked_first() {
    let place = Place::with(&case("patch"));
    place.write("file", "mine");
    place.write("bad.json", "{");
    std::fs::create_dir_all(place.path("taken/junit.xml")).expect("writable");
    std::fs::create_dir(place.path("folder")).expect("writable");
    let fifo = place.path("fifo");
    assert!(std::process::Command::new("mkfifo").arg(&fifo).status().expect("mkfifo").success());
    for (arguments, fragments) in [
        (vec!["--out", "file"], vec!["file", "is not a folder", "--out"]),
        (vec!["--out", "file/below"], vec!["file", "is not a folder"]),
        (vec!["--out", "taken"], vec!["junit.xml", "--out"]),
        (vec!["--baseline", "none.json"], vec!["none.json", "--accept"]),
        (vec!["--baseline", "bad.json"], vec!["bad.json", "--accept"]),
        (vec!["--baseline", "/dev/zero"], vec!["/dev/zero", "regular file"]),
        (vec!["--baseline", "fifo"], vec!["fifo", "regular file"]),
        (vec!["--baseline", "fifo", "--accept"], vec!["fifo", "regular file"]),
        (vec!["--baseline", "/dev/null", "--accept"], vec!["/dev/null", "regular file"]),
        (vec!["--baseline", "folder", "--accept"], vec!["folder", "regular file"]),
        (vec!["--baseline", "no/such.json", "--accept"], vec!["no/such.json", "folder"]),
        (vec!["--allow", "nonsense=1"], vec!["nonsense", "dual/equilibrium"]),
        (vec!["--allow", "contact/no|where/resultant=1"], vec!["no|where"]),
    ] {
        let mut command = place.command(&[&["verify", "scene.toml"], &arguments[..]].concat());
        command.env(NOWHERE.0, NOWHERE.1);
        ended(&arguments.join(" "), &run(command), 2, &fragments);
        assert!(!place.path("out").exists(), "{arguments:?} was solved first");
    }
    assert!(std::fs::metadata(&fifo).expect("there").file_type().is_fifo());
    assert!(std::fs::metadata("/dev/null").expect("there").file_type().is_char_device());
    assert_eq!(std::fs::read_to_string(place.path("file")).expect("there"), "mine");
}

#[test]
fn numbers_that_overflow_are_named() {
    let scene = case("two_blocks");
    for (old, new, number) in [
        ("kinematics = \"plane-strain\"", "kinematics = \"plane-strain\"\nthickness = 1e300", "1e300"),
        ("kinematics = \"plane-strain\"", "kinematics = \"plane-strain\"\nthickness = 1e-300", "1e-300"),
        ("young = 1.0", "young = 1e300", "1e300"),
        ("young = 1.0", "young = 1e-300", "1e-300"),
        ("value = [4.0, 0.0]", "value = [4e300, 0.0]", "4e300"),
        ("gradient = [[0.0, -7.0], [0.0, 0.0]]", "gradient = [[0.0, -7e200], [0.0, 0.0]]", "-7e200"),
        ("poisson = 0.3", "poisson = 0.3\nbody_force = [0.0, 1e200]", "1e200"),
    ] {
        assert!(scene.contains(old));
        let place = Place::with(&scene.replacen(old, new, 1));
        for command in ["solve", "verify"] {
            place.refuses(&[command, "scene.toml"], &["scene.toml:", number, "choose units"]);
        }
    }
    let largest =
        scene.replace("young = 1.0", "young = 1e30").replace("\"plane-strain\"", "\"plane-strain\"\nthickness = 1e-30");
    let place = Place::with(&largest);
    assert_eq!(place.run(&["solve", "scene.toml"]).status.code(), Some(0));
}

const SUPPORTED: &str = r#"
[model]
kinematics = "plane-strain"
[geometry]
size = 0.5
[[geometry.polygons]]
body = "b"
points = [[0, 0], [1, 0], [1, 1], [0, 1]]
edges = ["bottom", "right", "top", ""]
[bodies.b]
young = 1.0
poisson = 0.3
[[supports]]
on = "bottom"
type = "clamped"
displacement = [0.1, 0.0]
"#;

#[test]
fn supports_that_contradict_each_other_are_bad_input() {
    let clamped = "[[supports]]\non = \"right\"\ntype = \"clamped\"\n";
    let roller = "[[supports]]\non = \"right\"\ntype = \"roller\"\n";
    for more in [clamped, roller] {
        let place = Place::with(&format!("{SUPPORTED}{more}"));
        for command in
            [&["solve", "scene.toml"][..], &["verify", "scene.toml"], &["solve", "scene.toml", "--tolerance", "0.1"]]
        {
            place.refuses(command, &["(1, 0)", "different displacements", "fit together"]);
        }
    }
    // Pushed by its supports into an obstacle.
    let pushed =
        "[[supports]]\non = \"top\"\ntype = \"clamped\"\ndisplacement = [0.1, 0.01]\n[[contacts]]\non = \"right\"\n";
    let place = Place::with(&format!("{SUPPORTED}{pushed}"));
    place.refuses(&["solve", "scene.toml"], &["force a penetration", "(1, "]);
    let room = Place::with(&format!("{SUPPORTED}{pushed}gap = 0.2\n"));
    assert_eq!(room.run(&["solve", "scene.toml"]).status.code(), Some(0));
}

/// The sides of a contact that come together in one point, at the tip of a crack or where a rigid bond begins, leave no room there.
#[test]
fn an_interference_up_to_where_bodies_are_one_is_bad_input() {
    let crack = case("open_crack");
    let gap = |g: &str| crack.replacen("[[contacts]]", &format!("[[contacts]]\ngap = {g}"), 1);
    let place = Place::with(&gap("-0.01"));
    for command in [&["solve", "scene.toml"][..], &["verify", "scene.toml"]] {
        place.refuses(command, &["interference of 1.000e-2", "the tip of a crack", "leave out"]);
    }
    // An elastic contact yields.
    for possible in ["-0.01\nstiffness = 50.0", "-0.01\nstiffness = 0.5"] {
        let place = Place::with(&gap(possible));
        let output = place.run(&["solve", "scene.toml"]);
        assert_eq!(output.status.code(), Some(0), "{possible}: {}", String::from_utf8_lossy(&output.stderr));
    }
    let bonded = case("bonded")
        .replace("\"right_face\", \"right_face\", \"right_face\"", "\"right_face\", \"apart\", \"apart\"");
    let bonded = bonded.replace("\"left_face\", \"left_face\"", "\"left_apart\", \"left_face\"");
    let bonded = bonded.replace("[1.04, 0.7], [0.98, 0.4]", "[1.0, 0.5], [0.96, 0.3]");
    let place = Place::with(&format!("{bonded}\n[[contacts]]\nbetween = [\"left_apart\", \"apart\"]\ngap = -0.001\n"));
    place.refuses(&["solve", "scene.toml"], &["(1, 0.5)", "the end of a bond"]);
}

#[test]
fn rows_of_a_gap_that_no_mesh_can_tell_apart_are_refused() {
    let scene = case("two_blocks");
    let gap = |s: &str| format!("{scene}gap = [[0, 0], [0.5, 0.0], [{s}, 0.1]]\n");
    let place = Place::with(&gap("0.5000000001"));
    place.refuses(&["solve", "scene.toml"], &["scene.toml:", "gap[2]", "move the two apart"]);
    let place = Place::with(&gap("0.5000001"));
    assert_eq!(place.run(&["solve", "scene.toml"]).status.code(), Some(0));
}

#[test]
fn names_neither_act_on_a_terminal_nor_flood_it() {
    let long = "x".repeat(1_000_000);
    for name in ["\\u001b[31mred\\u009b", long.as_str()] {
        let place = Place::with(&format!("{SUPPORTED}[[supports]]\non = \"{name}\"\ntype = \"roller\"\n"));
        let said = place.refuses(&["solve", "scene.toml"], &["no edge of this name"]);
        assert!(!said.contains('\u{1b}') && !said.contains('\u{9b}') && said.len() < 10_000, "{} bytes", said.len());
    }
    // In a name that is right, and told on standard output.
    let place = Place::with(&SUPPORTED.replace("\"bottom\"", "\"\\u001b[31mbottom\""));
    let output = place.run(&["solve", "scene.toml"]);
    assert!(!output.stdout.contains(&0x1b) && !output.stderr.contains(&0x1b));
    // In the text itself.
    let place = Place::with("title = \"\u{1b}[31m\"\n");
    let said = place.refuses(&["solve", "scene.toml"], &["scene.toml:1"]);
    assert!(!said.contains('\u{1b}'), "{said}");
}

#[test]
fn a_scene_whose_name_is_all_dots_stays_in_its_folder() {
    let place = Place::new();
    place.write("...toml", &case("patch"));
    assert_eq!(place.run(&["solve", "...toml"]).status.code(), Some(0));
    assert!(place.path("out/scene/report.json").is_file());
    assert_eq!(super::run::names(place.folder.path()), ["...toml", "out"]);
    assert_eq!(super::run::names(Path::new(&place.path("out"))), ["scene"]);
}

#[test]
fn a_pipe_is_read_and_one_that_nobody_writes_to_is_empty() {
    let place = Place::with(&case("patch"));
    assert!(std::process::Command::new("mkfifo").arg(place.path("pipe.toml")).status().expect("mkfifo").success());
    place.refuses(&["solve", "pipe.toml"], &["pipe.toml", "empty"]);
    let line = "(sleep 0.3; cat scene.toml) | \"$0\" solve /dev/stdin --out out/piped";
    let mut shell = std::process::Command::new("/bin/sh");
    let output = shell.args(["-c", line, PROGRAM]).current_dir(place.folder.path()).output().expect("a shell");
    ended("a pipe", &output, 0, &[]);
}
