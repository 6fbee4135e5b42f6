//! Killed at any moment, and two at a time: a folder has the files of one run, and after the next run nothing else is left.
//!
//! `ci/kills` runs the same with larger numbers, and with FEniCSx and meshio in the place of the stand-in.

use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use hypercircle::report::run_of;

use super::run::{Place, alive, case, expected, names, soon};
use crate::command::script;
use crate::random::Random;

const SIGNALS: [&str; 3] = ["KILL", "TERM", "INT"];

/// Takes the place of the interpreter: tells its number, gives a field to `certify` and no answer to `verify`.
const STAND_IN: &str = "echo $$ >> \"$PIDS\"\nsleep 0.05\nfor last; do :; done\n\
    case $last in *.json) cp \"$FIELD\" \"$last\" ;; *) exit 4 ;; esac";

/// How many, from the environment.
fn number(variable: &str, usual: usize) -> usize {
    std::env::var(variable).ok().map_or(usual, |text| text.parse().expect("a number"))
}

/// A folder with everything that the three commands need, and the numbers of the processes that they started.
struct Trial {
    place: Place,
    pids: PathBuf,
    stand_in: bool,
}

impl Trial {
    fn new() -> Self {
        let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
        let place = Place::with(&case("patch"));
        std::fs::copy(root.join("fuzz/src/setting.toml"), place.path("small.toml")).expect("a scene");
        std::fs::copy(root.join("tests/program/hostile/linear.vtk"), place.path("field.vtk")).expect("a field");
        script(place.path("python3"), STAND_IN);
        let pids = place.path("pids");
        std::fs::write(&pids, "").expect("writable");
        Trial { place, pids, stand_in: std::env::var_os("HYPERCIRCLE_KILL_REFERENCE").is_none() }
    }

    /// Starts command number `which` into `out/both`.
    fn start(&self, which: usize) -> Child {
        let arguments: &[&str] = match which % 3 {
            0 => &["solve", "scene.toml"],
            1 => &["verify", "scene.toml"],
            _ => &["certify", "small.toml", "--displacement", "field.vtk"],
        };
        let mut command = self.place.command(arguments);
        command.args(["--quiet", "--out", "out/both"]).stdout(Stdio::null()).stderr(Stdio::null());
        if self.stand_in {
            let field = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus/field/linear.json");
            command.env("HYPERCIRCLE_PYTHON", self.place.path("python3")).env("PIDS", &self.pids).env("FIELD", field);
        }
        command.spawn().expect("the program starts")
    }

    /// The time of an undisturbed run; its report is written.
    fn whole(&self, which: usize) -> Duration {
        let since = Instant::now();
        let status = self.start(which).wait().expect("ends");
        assert!(matches!(status.code(), Some(0 | 1 | 4)), "{status}");
        since.elapsed()
    }

    /// The report is of one run, whatever else lies beside it.
    fn assert_one_run(&self, what: &str) {
        let folder = self.place.path("out/both");
        run_of(&folder).unwrap_or_else(|error| panic!("{what}: {error}"));
        assert_eq!(self.visible(), expected(), "{what}");
    }

    fn visible(&self) -> Vec<String> {
        names(&self.place.path("out/both")).into_iter().filter(|name| !name.starts_with('.')).collect()
    }

    /// After a run that was left alone: its report, no process, and nothing temporary.
    fn assert_clean(&self, what: &str) {
        assert_eq!(names(&self.place.path("out/both")), expected(), "{what}");
        assert_eq!(names(&self.place.path("out")), ["both"], "{what}");
        assert_eq!(names(self.place.temporary.path()), [""; 0], "{what}");
        let pids = std::fs::read_to_string(&self.pids).expect("there");
        assert!(soon(|| !pids.lines().any(alive)), "{what}: a process lives on");
        std::fs::write(&self.pids, "").expect("writable");
    }
}

fn kill(signal: &str, child: &Child) {
    let mut kill = Command::new("kill");
    let _ = kill.args(["-s", signal, &child.id().to_string()]).stderr(Stdio::null()).status();
}

#[test]
fn a_report_is_one_run_s_whenever_runs_are_killed() {
    let trial = Trial::new();
    let usual: Vec<Duration> = (0..3).map(|which| trial.whole(which).min(trial.whole(which))).collect();
    let mut random = Random::new(number("HYPERCIRCLE_KILL_SEED", 1) as u64);
    let (kills, mut cut) = (number("HYPERCIRCLE_KILLS", 45), 0);
    for i in 0..kills {
        let (which, signal) = (random.below(3), SIGNALS[random.below(3)]);
        // Half of them anywhere, half of them late, when files are written.
        let part = random.between(if i % 2 == 0 { 0.0 } else { 0.7 }, 1.0);
        let mut child = trial.start(which);
        std::thread::sleep(usual[which].mul_f64(part));
        kill(signal, &child);
        let status = child.wait().expect("ends");
        cut += usize::from(status.code().is_none());
        let what = format!("kill {i}, {signal} after {part:.2} of command {which}");
        assert_ne!(status.code(), Some(3), "{what}");
        trial.assert_one_run(&what);
        if i % 5 == 4 || kills < 100 && i % 3 == 2 {
            trial.whole(0);
            trial.assert_clean(&what);
        }
    }
    trial.whole(1);
    trial.assert_clean("the last run");
    println!("{kills} kills, {cut} of them before the run had ended");
    assert!(cut > kills / 4, "{cut} of {kills} runs were killed before their end");
}

#[test]
fn a_report_is_one_run_s_whoever_writes_beside_it() {
    let trial = Trial::new();
    let usual = trial.whole(0);
    let mut random = Random::new(number("HYPERCIRCLE_KILL_SEED", 1) as u64 + 1_000_000);
    let pairs = number("HYPERCIRCLE_PAIRS", 15);
    for i in 0..pairs {
        let which = [random.below(3), random.below(3)];
        let mut children = [trial.start(which[0]), trial.start(which[1])];
        let mut signal = "none";
        if random.chance(0.5) {
            signal = SIGNALS[random.below(3)];
            std::thread::sleep(usual.mul_f64(random.between(0.0, 1.5)));
            kill(signal, &children[0]);
        }
        let codes = children.each_mut().map(|child| child.wait().expect("ends").code());
        let what = format!("pair {i}, commands {which:?}, {signal}, {codes:?}");
        assert!(matches!(codes[1], Some(0 | 1 | 4)), "{what}");
        assert!(signal != "none" || matches!(codes[0], Some(0 | 1 | 4)), "{what}");
        trial.assert_one_run(&what);
        if signal == "none" {
            trial.assert_clean(&what);
        }
    }
    trial.whole(0);
    trial.assert_clean("the last run");
    println!("{pairs} pairs");
}
