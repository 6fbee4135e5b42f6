//! Standard output that cannot be had, two runs at a time, and limits beyond all measure.

use std::process::Command;

use hypercircle::report::run_of;

use super::run::{Place, case, expected, names};
use crate::command::said;

#[test]
fn a_full_or_closed_standard_output_changes_nothing() {
    let place = Place::with(&case("patch"));
    let program = env!("CARGO_BIN_EXE_hypercircle");
    for (redirection, folder) in [(">/dev/full", "a"), (">&-", "b"), (">/dev/full 2>&1", "c"), (">&- 2>&-", "d")] {
        let line = format!("exec \"$0\" solve scene.toml --out out/{folder} {redirection}");
        let mut shell = Command::new("/bin/sh");
        let output = shell.args(["-c", &line, program]).current_dir(place.folder.path()).output().expect("a shell");
        let said = said(&output);
        assert_eq!((output.status.code(), said.as_str()), (Some(0), ""), "{redirection}");
        assert_eq!(names(&place.path("out").join(folder)), expected(), "{redirection}");
    }
}

#[test]
fn seconds_and_threads_beyond_all_measure_are_taken() {
    let place = Place::with(&case("patch"));
    let mut command =
        place.command(&["verify", "scene.toml", "--primal-seconds", "1e300", "--reading-seconds", "1e300"]);
    let output = command.env("HYPERCIRCLE_PYTHON", "/nonexistent/python3").output().expect("the program starts");
    assert_eq!(output.status.code(), Some(4), "{}", said(&output));
    for limit in ["unlimited", "4000000"] {
        let line = format!("ulimit -v {limit}; exec \"$0\" solve scene.toml --threads 1024");
        let mut shell = Command::new("/bin/sh");
        let program = env!("CARGO_BIN_EXE_hypercircle");
        let output = shell.args(["-c", &line, program]).current_dir(place.folder.path()).output().expect("a shell");
        assert_eq!(output.status.code(), Some(0), "{limit}: {}", said(&output));
    }
}

#[test]
fn two_runs_into_one_folder_leave_the_files_of_one() {
    let place = Place::with(&case("patch"));
    for _ in 0..15 {
        let start = || place.command(&["solve", "scene.toml", "-q"]).spawn().expect("the program starts");
        for mut child in [start(), start(), start()] {
            assert!(child.wait().expect("ends").success());
        }
        let folder = place.path("out/scene");
        run_of(&folder).expect("the files of one run");
        assert_eq!((names(&folder), names(&place.path("out"))), (expected(), vec!["scene".to_string()]));
    }
}

#[test]
fn files_of_the_user_in_the_output_folder_stay() {
    let place = Place::with(&case("patch"));
    place.write("notes.txt", "mine");
    for _ in 0..2 {
        assert_eq!(place.run(&["solve", "scene.toml", "--out", "."]).status.code(), Some(0));
    }
    let mut all = expected();
    all.extend(["notes.txt".to_string(), "scene.toml".to_string()]);
    all.sort();
    assert_eq!(names(place.folder.path()), all);
    run_of(place.folder.path()).expect("the files of one run");
}
