//! Children of a run and its temporary folder end with it, by any signal that can be waited for.

use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use super::run::{Place, alive, case, names, soon};
use crate::command::script;

fn kill(signal: &str, process: u32) {
    let _ = Command::new("kill").args(["-s", signal, &process.to_string()]).stderr(Stdio::null()).status();
}

/// An interpreter that waits, told in a file, and ends with what it was started by.
fn waiting(place: &Place) -> std::path::PathBuf {
    script(place.path("python3"), &format!("echo $$ > {}\nexec sleep 300", place.path("pid").display()))
}

#[test]
fn the_exchange_folder_and_the_reference_go_with_the_process() {
    for signal in ["TERM", "INT", "HUP"] {
        let place = Place::with(&case("patch"));
        let mut command = place.heeding(&["verify", "scene.toml"]);
        let mut child = command.env("HYPERCIRCLE_PYTHON", waiting(&place)).spawn().expect("the program starts");
        let note = place.path("pid");
        let pid = || std::fs::read_to_string(&note).unwrap_or_default();
        assert!(soon(|| pid().ends_with('\n')), "the interpreter was not started");
        assert!(!names(place.temporary.path()).is_empty());
        let since = Instant::now();
        kill(signal, child.id());
        let status = child.wait().expect("ends");
        assert!(std::os::unix::process::ExitStatusExt::signal(&status).is_some(), "{signal}: {status}");
        assert!(since.elapsed() < Duration::from_secs(5), "{signal}: {:?}", since.elapsed());
        assert!(soon(|| !alive(&pid())), "{signal}: the interpreter lives on");
        assert_eq!(names(place.temporary.path()), [""; 0], "{signal}");
        assert!(!place.path("out").exists(), "{signal}");
    }
}

#[test]
fn an_ignored_hangup_stays_ignored() {
    let place = Place::with(&case("patch"));
    let mut command = Command::new("nohup");
    command.arg(env!("CARGO_BIN_EXE_hypercircle")).args(["verify", "scene.toml"]).current_dir(place.folder.path());
    command.env("HYPERCIRCLE_PYTHON", waiting(&place)).env("TMPDIR", place.temporary.path());
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("nohup");
    let note = place.path("pid");
    assert!(soon(|| std::fs::read_to_string(&note).is_ok_and(|text| text.ends_with('\n'))));
    kill("HUP", child.id());
    std::thread::sleep(Duration::from_millis(300));
    assert!(child.try_wait().expect("watched").is_none(), "it ended");
    kill("TERM", child.id());
    child.wait().expect("ends");
}

/// Runs that are kept are of use to those who know how to go on from them.
#[test]
fn an_interrupted_sweep_says_how_to_go_on() {
    for (arguments, folder) in [
        (&["stability", "--method", "uzawa", "--threads", "1"][..], "out/stability"),
        (&["chart", "scene.toml", "--method", "condensed", "--repeats", "9", "--refine", "6"], "out/scene"),
    ] {
        let place = Place::with(&case("patch"));
        let mut command = place.heeding(arguments);
        let mut child = command.stderr(Stdio::piped()).spawn().expect("the program starts");
        assert!(soon(|| place.path(folder).exists()), "nothing is kept in {folder}: {:?}", names(&place.path("out")));
        kill("TERM", child.id());
        let status = child.wait().expect("ends");
        assert!(std::os::unix::process::ExitStatusExt::signal(&status).is_some(), "{status}");
        let mut said = String::new();
        std::io::Read::read_to_string(&mut child.stderr.take().expect("a pipe"), &mut said).expect("UTF-8");
        assert!(said.contains(&format!("are kept in {folder}; the same command with --resume")), "{said}");
    }
}
