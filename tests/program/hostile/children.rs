//! Processes that the program starts end with it, in time, and cannot flood it.

use std::time::{Duration, Instant};

use super::run::{MESH, Place, SQUARE, alive, names, soon};
use crate::command::said;

/// A scene whose mesh is read by a meshio that does `body`; the folder to name in PYTHONPATH.
fn with_meshio(body: &str) -> (Place, tempfile::TempDir) {
    let place = Place::with(SQUARE);
    place.write("mesh.vtk", MESH);
    let library = tempfile::tempdir().expect("a folder");
    let text = format!("import os, subprocess, sys, time\nhere = {:?}\n{body}", library.path().display().to_string());
    std::fs::write(library.path().join("meshio.py"), text).expect("writable");
    (place, library)
}

const HANGS: &str = "open(here + '/new', 'w').write(str(os.getpid()))\nos.rename(here + '/new', here + '/pid')\n\
                     time.sleep(300)\n";

#[test]
fn reading_has_a_limit_that_can_be_set() {
    let (place, library) = with_meshio(HANGS);
    let since = Instant::now();
    let mut command = place.command(&["solve", "scene.toml", "--reading-seconds", "2.5"]);
    let output = command.env("PYTHONPATH", library.path()).output().expect("the program starts");
    let said = said(&output);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("did not finish in 2.5 s") && said.contains("--reading-seconds"), "{said}");
    assert!(since.elapsed() < Duration::from_secs(30));
    // A machine that is busy may not have got as far as meshio.
    let pid = std::fs::read_to_string(library.path().join("pid")).unwrap_or_default();
    assert!(pid.is_empty() || soon(|| !alive(&pid)));
    assert_eq!(names(place.temporary.path()), [""; 0]);
}

#[test]
fn meshio_ends_with_its_parent_by_any_signal() {
    for signal in ["KILL", "TERM", "INT", "HUP"] {
        let (place, library) = with_meshio(HANGS);
        let mut command = place.heeding(&["solve", "scene.toml"]);
        let mut child = command.env("PYTHONPATH", library.path()).spawn().expect("the program starts");
        let note = library.path().join("pid");
        assert!(soon(|| note.exists()), "meshio was not started");
        let pid = std::fs::read_to_string(&note).expect("written");
        let kill = std::process::Command::new("kill").args(["-s", signal, &child.id().to_string()]).status();
        assert!(kill.expect("kill").success());
        let status = child.wait().expect("ends");
        assert!(!status.success() && status.code() != Some(3), "{signal}: {status}");
        assert!(soon(|| !alive(&pid)), "{signal}: meshio lives on");
        if signal != "KILL" {
            assert_eq!(names(place.temporary.path()), [""; 0], "{signal}");
        }
        // What no signal handler could remove is gone after the next run.
        std::fs::write(library.path().join("meshio.py"), "raise SystemExit('no')\n").expect("writable");
        let mut next = place.command(&["solve", "scene.toml"]);
        next.env("PYTHONPATH", library.path()).output().expect("the program starts");
        assert_eq!(names(place.temporary.path()), [""; 0], "{signal}");
    }
}

#[test]
fn a_grandchild_and_a_flood_do_not_hold_the_program() {
    let (place, library) = with_meshio(
        "child = subprocess.Popen(['setsid', 'sleep', '100'])\nopen(here + '/pid', 'w').write(str(child.pid))\n\
         line = b'x' * 99999 + b'\\n'\nfor _ in range(10_000):\n    os.write(2, line)\n\
         print('that was all', file=sys.stderr)\nsys.exit(1)\n",
    );
    let since = Instant::now();
    let mut command = place.command(&["solve", "scene.toml"]);
    let output = command.env("PYTHONPATH", library.path()).output().expect("the program starts");
    let _ = std::process::Command::new("kill")
        .arg(std::fs::read_to_string(library.path().join("pid")).expect("it ran").trim())
        .status();
    let said = said(&output);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("that was all") && said.len() < 10_000, "{} bytes", said.len());
    assert!(since.elapsed() < Duration::from_secs(60), "{:?}", since.elapsed());
}
