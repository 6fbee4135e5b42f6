//! A job that is interrupted and goes on, and a job in parts.

use std::process::Stdio;
use std::time::{Duration, Instant};

use super::place::{LOOSE, Place, lasting, scene};
use crate::command::{ended, run};

fn soon(holds: impl Fn() -> bool) -> bool {
    let since = Instant::now();
    while since.elapsed() < Duration::from_secs(60) {
        if holds() {
            return true;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    false
}

#[test]
fn a_job_killed_in_the_middle_goes_on_where_it_was() {
    let place = Place::with(&["a", "b", "m", "y", "z"]);
    place.write("scenes/c.toml", LOOSE);
    let interpreter = place.stand_in();
    std::fs::remove_file(place.path("scenes/crashes.toml")).expect("there");
    let arguments = |out| ["solve", "scenes", "--out", out, "--jobs", "1", "--quiet"];
    let start = |out| {
        let mut command = place.command(&arguments(out));
        command.env("HYPERCIRCLE_PYTHON", &interpreter);
        command
    };
    // Killed while it waits for the scene that hangs, with three finished and three not begun.
    let mut killed = start("killed").stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("starts");
    assert!(soon(|| place.path("killed/parts/c.json").is_file()));
    std::thread::sleep(Duration::from_millis(300));
    assert!(!place.path("killed/parts/hangs.json").exists() && !place.path("killed/index.html").exists());
    killed.kill().expect("ours");
    killed.wait().expect("ends");
    let before = place.json("killed/a/report.json")["run"].clone();

    place.write("go", "");
    let mut again = start("killed");
    again.arg("--resume");
    let resumed = run(again);
    let whole = run(start("whole"));
    let exit = whole.status.code().expect("a code");
    assert!(exit == 2 || exit == 3, "{exit}");
    ended("resumed", &resumed, exit, &[]);
    assert_eq!(lasting(&place.json("killed/job.json")), lasting(&place.json("whole/job.json")));
    assert_eq!(scene(&place.json("killed/job.json"), "a")["run"], before, "a was not run again");

    // Other options, or another scene: another run.
    let finer = run({
        let mut command = start("killed");
        command.args(["--resume", "--refine", "1"]);
        command
    });
    ended("finer", &finer, exit, &[]);
    let finer = scene(&place.json("killed/job.json"), "a").clone();
    assert!(finer["run"] != before && finer["triangles"] == 160, "{finer}");
    let text = place.read("scenes/b.toml");
    place.write("scenes/b.toml", &format!("# changed\n{text}"));
    let mut changed = start("killed");
    changed.args(["--resume", "--refine", "1"]);
    ended("changed", &run(changed), exit, &[]);
    let job = place.json("killed/job.json");
    assert_eq!(scene(&job, "a")["run"], finer["run"]);
    assert_eq!(scene(&job, "b")["run"], place.json("killed/b/report.json")["run"]);
}

#[test]
fn parts_of_a_job_become_one_page() {
    let place = Place::with(&["a", "b", "d", "e", "f"]);
    place.write("scenes/c.toml", LOOSE);
    ended("whole", &place.run(&["solve", "scenes", "--out", "whole", "--quiet"]), 5, &[]);
    // Both at once, into one folder.
    let shard = |number: &str| {
        let mut command = place.command(&["solve", "scenes", "--out", "parts-of-it", "--shard", number, "--jobs", "1"]);
        command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("starts")
    };
    let mut running = [shard("1/2"), shard("2/2")];
    let codes = running.each_mut().map(|child| child.wait().expect("ends").code());
    // a, c, e and b, d, f.
    assert_eq!(codes, [Some(5), Some(0)]);
    assert!(!place.path("parts-of-it/index.html").exists());
    ended("gathered", &place.run(&["gather", "parts-of-it"]), 5, &[]);
    assert_eq!(lasting(&place.json("whole/job.json")), lasting(&place.json("parts-of-it/job.json")));

    // A part that is missing is not passed.
    ended("one part", &place.run(&["solve", "scenes", "--out", "half", "--shard", "2/2"]), 0, &[]);
    ended("half", &place.run(&["gather", "half"]), 3, &[]);
    let job = place.json("half/job.json");
    assert_eq!((&scene(&job, "a")["status"], &scene(&job, "b")["status"]), (&"not-run".into(), &"agree".into()));
    ended("nothing there", &place.run(&["gather", "scenes"]), 2, &["plan.json", "--out"]);
}
