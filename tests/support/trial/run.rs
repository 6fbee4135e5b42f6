//! One run of the program, whatever becomes of it.

use std::ffi::OsString;
use std::fs::{self, File};
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

/// The program, and how long it may take.
pub struct Program {
    pub binary: PathBuf,
    pub limit: Duration,
    /// Variables of the environment that it gets in addition.
    pub environment: Vec<(&'static str, OsString)>,
}

/// How a scene is solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Way {
    /// `solve` by that method.
    Method(&'static str),
    /// `solve` on the mesh refined once.
    Finer,
    /// `solve` to a tolerance, by refining the mesh (`h`) or mesh and degrees (`hp`).
    Adaptive(&'static str),
    /// `verify`.
    Verify,
}

impl Way {
    pub fn name(self) -> &'static str {
        match self {
            Way::Method(name) => name,
            Way::Finer => "finer",
            Way::Adaptive(name) => name,
            Way::Verify => "verify",
        }
    }

    pub fn arguments(self) -> Vec<&'static str> {
        match self {
            Way::Method(name) => vec!["solve", "--method", name],
            Way::Finer => vec!["solve", "--refine", "1"],
            Way::Adaptive(name) => {
                vec!["solve", "--adapt", name, "--tolerance", "0.02", "--max-triangles", "1500", "--max-seconds", "30"]
            }
            Way::Verify => vec!["verify"],
        }
    }
}

/// The results of a run.
pub struct Ended {
    /// The exit code; −1 where it was stopped at the time limit, −N where signal N ended it.
    pub code: i32,
    pub timed_out: bool,
    pub seconds: f64,
    /// `report.json`.
    pub report: Option<Value>,
    /// Standard error.
    pub words: String,
}

impl Ended {
    /// A number of the report by its path.
    pub fn number(&self, path: &str) -> Option<f64> {
        self.report.as_ref()?.pointer(path)?.as_f64()
    }

    /// Lower and upper bound of the energy.
    pub fn bracket(&self) -> Option<[f64; 2]> {
        Some([self.number("/energy/lower")?, self.number("/energy/upper")?])
    }

    /// `agree`, `disagree`, …; what ended it where there is no report.
    pub fn verdict(&self) -> String {
        let status = self.report.as_ref().and_then(|r| r["status"].as_str());
        match (self.code, status) {
            _ if self.timed_out => "timed out".to_owned(),
            (..0, _) => format!("signal {}", -self.code),
            (0 | 1, Some(status)) => status.to_owned(),
            (1, None) => "no report".to_owned(),
            (2, _) => "bad input".to_owned(),
            (3, _) => "failed".to_owned(),
            (4, _) => "not installed".to_owned(),
            (5, _) => "infeasible".to_owned(),
            (code, _) => format!("exit {code}"),
        }
    }

    /// The checks that did not pass, without remarks.
    pub fn failed_checks(&self) -> Vec<&Value> {
        let checks = self.report.iter().filter_map(|r| r["checks"].as_array()).flatten();
        checks.filter(|c| c["passed"] != true && c["basis"] != "chosen").collect()
    }

    /// The message, without frame and line breaks.
    pub fn message(&self) -> String {
        let line: String =
            self.words.lines().map(|l| l.trim().trim_start_matches(['x', '×', '|', '│'])).collect::<Vec<_>>().join(" ");
        line.split_whitespace().collect::<Vec<_>>().join(" ").chars().take(400).collect()
    }
}

impl Program {
    /// Runs it on `scene`; results go to a folder of `results` that has the name of `way`.
    pub fn run(&self, way: Way, scene: &Path, results: &Path) -> Ended {
        let out = results.join(way.name());
        let _ = fs::remove_dir_all(&out);
        fs::create_dir_all(&out).expect("a folder to write to");
        let log = out.join("stderr.txt");
        let started = Instant::now();
        let mut child = Command::new(&self.binary)
            .args(way.arguments())
            .arg(scene)
            .arg("--quiet")
            .arg("--out")
            .arg(&out)
            .envs(self.environment.iter().map(|(name, value)| (name, value)))
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(File::create(&log).expect("a folder to write to"))
            .spawn()
            .unwrap_or_else(|e| panic!("{}: {e}", self.binary.display()));
        let (status, timed_out) = loop {
            if let Some(status) = child.try_wait().expect("a child of this process") {
                break (status, false);
            }
            if started.elapsed() > self.limit {
                let _ = child.kill();
                break (child.wait().expect("a child of this process"), true);
            }
            std::thread::sleep(Duration::from_millis(2));
        };
        let report = fs::read_to_string(out.join("report.json")).ok();
        Ended {
            code: status.code().or(status.signal().map(|s| -s)).unwrap_or(-1),
            timed_out,
            seconds: started.elapsed().as_secs_f64(),
            report: report.and_then(|text| serde_json::from_str(&text).ok()),
            words: String::from_utf8_lossy(&fs::read(&log).unwrap_or_default()).into_owned(),
        }
    }
}
