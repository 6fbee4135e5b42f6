//! Runs the program on a scene and reads what it leaves.

use std::path::Path;

use serde_json::Value;
use tempfile::TempDir;

use crate::command;
pub use crate::command::{case, with_reference};

/// The results of a run.
pub struct Run {
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
    pub folder: TempDir,
}

impl Run {
    /// `hypercircle COMMAND SCENE --out FOLDER MORE`, with additional environment.
    pub fn with(command: &str, scene: &Path, more: &[&str], environment: &[(&str, &Path)]) -> Run {
        let folder = tempfile::tempdir().expect("a folder");
        let mut program = command::hypercircle(folder.path(), [command]);
        program.arg(scene).args(["--out", "out"]).args(more).envs(environment.iter().copied());
        let output = command::run(program);
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        Run { code: output.status.code(), stdout: text(&output.stdout), stderr: text(&output.stderr), folder }
    }

    pub fn new(command: &str, scene: &Path, more: &[&str]) -> Run {
        Run::with(command, scene, more, &[])
    }

    /// The text of one of the five files.
    #[track_caller]
    pub fn file(&self, name: &str) -> String {
        let path = self.folder.path().join("out").join(name);
        std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{name}: {e}\n{}{}", self.stdout, self.stderr))
    }

    #[track_caller]
    pub fn report(&self) -> Report {
        Report(serde_json::from_str(&self.file("report.json")).expect("JSON"))
    }
}

/// `report.json`.
pub struct Report(pub Value);

impl Report {
    /// A number by its path, such as `/energy/lower`.
    #[track_caller]
    pub fn number(&self, path: &str) -> f64 {
        let found = self.0.pointer(path).unwrap_or(&Value::Null);
        found.as_f64().unwrap_or_else(|| panic!("{path} is {found}"))
    }

    /// Remarks, joined.
    pub fn notes(&self) -> String {
        self.0["notes"].as_array().into_iter().flatten().filter_map(|n| n["text"].as_str()).collect()
    }

    /// Names of the checks that did not pass.
    pub fn failed(&self) -> Vec<&str> {
        let checks = self.0["checks"].as_array().into_iter().flatten();
        checks.filter(|c| c["passed"] != true).filter_map(|c| c["name"].as_str()).collect()
    }

    /// (arc length, pressure) along contact `index` from the model of that name.
    #[track_caller]
    pub fn profile(&self, index: usize, model: &str) -> Vec<[f64; 2]> {
        let profiles = self.0["contact"][index]["profiles"].as_array().expect("profiles");
        let found = profiles.iter().find(|p| p["model"] == model).unwrap_or_else(|| panic!("no profile of {model}"));
        let points = found["points"].as_array().expect("points");
        points.iter().map(|p| [0, 1].map(|i| p[i].as_f64().expect("a number"))).collect()
    }
}

/// Verifies the case `name` (without FEniCSx: solves it) and asserts what holds for every one of them.
#[track_caller]
pub fn sound(name: &str) -> Report {
    let command = if with_reference() { "verify" } else { "solve" };
    let run = Run::new(command, &case(name), &[]);
    assert_eq!(run.code, Some(0), "{name}: {}{}", run.stdout, run.stderr);
    let report = run.report();
    assert_eq!(report.0["status"], "agree");
    assert_eq!(report.0["energy"]["guaranteed"], true, "{}", report.notes());
    assert!(report.failed().is_empty(), "{:?}", report.failed());
    let checks = report.0["checks"].as_array().into_iter().flatten().filter_map(|c| c["name"].as_str());
    let contacts = report.0["contact"].as_array().into_iter().flatten().filter_map(|c| c["name"].as_str());
    let contacts: Vec<String> = contacts.map(String::from).collect();
    let fields = ["FEniCSx P1", "FEniCSx P2", "FEniCSx Q1", "FEniCSx Q2", "free bound"].map(String::from);
    let known = hypercircle::compare::names_of_checks(&contacts, &fields);
    for check in checks.filter(|name| !name.starts_with("quantity/")) {
        assert!(known.iter().any(|name| name == check), "--allow {check} would be refused before the solve");
    }
    let (lower, upper) = (report.number("/energy/lower"), report.number("/energy/upper"));
    let free = report.number("/energy/free_upper");
    // The energy of springs is among the bounds, not among that of stresses.
    let scale = report.number("/energy/complementary").max(lower.abs());
    assert!(lower <= upper && upper <= free, "{lower} {upper} {free}");
    let local = report.number("/energy/gap_local");
    assert!((free - lower - local).abs() <= 1e-9 * scale, "{} from energies, {local} locally", free - lower);
    assert!(report.number("/dual/equilibrium_residual") < 1e-9);
    if with_reference() {
        assert_eq!(report.0["primal"].as_array().map(Vec::len), Some(2));
        // What a displacement model reports carries no allowance for rounding, the bounds do.
        let rounding = 1e-12 * scale + report.number("/energy/widening");
        for i in 0..2 {
            // Along a curve, linear displacements are bounded at vertices alone.
            let curved = report.notes().contains("stand for a curve");
            assert!(report.0["primal"][i]["admissible"] == true || i == 0 && curved);
            let energy = report.number(&format!("/primal/{i}/energy"));
            assert!(lower <= energy + rounding && upper <= energy + rounding, "{lower} {upper} {energy}");
        }
        assert!(report.number("/primal/1/energy") <= report.number("/primal/0/energy") + rounding);
    }
    report
}

/// The force on the first side of contact `index`, from both models, against statics.
#[track_caller]
pub fn carries(report: &Report, index: usize, force: [f64; 2]) {
    for model in models() {
        let path = format!("/contact/{index}/resultant/{model}");
        let found = [0, 1].map(|c| report.number(&format!("{path}/{c}")));
        let off = (found[0] - force[0]).hypot(found[1] - force[1]);
        assert!(off <= 1e-9 * force[0].hypot(force[1]), "{path}: {found:?} for {force:?}");
    }
}

/// The moment about the origin on the first side of contact `index`, from both models, against statics.
#[track_caller]
pub fn turns(report: &Report, index: usize, moment: f64) {
    for model in models() {
        let found = report.number(&format!("/contact/{index}/moment/{model}"));
        assert!((found - moment).abs() <= 1e-9 * moment.abs(), "{model}: {found} for {moment}");
    }
}

pub fn models() -> &'static [&'static str] {
    if with_reference() { &["dual", "primal"] } else { &["dual"] }
}

#[track_caller]
pub fn close(found: f64, expected: f64, relative: f64) {
    assert!((found - expected).abs() <= relative * expected.abs(), "{found} for {expected}");
}
