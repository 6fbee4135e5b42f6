//! Bugs planted in the displacement model and lies told about its results, and whether `verify` notices.
//!
//! `stand_in.py` takes the place of the interpreter and makes one thing wrong, a bug of `bugs.py` or a lie of `lies.py`.
//! Its results are compared with those of the honest model: only a fault that changes an energy, a force or
//! a displacement can be noticed at all, and one that changes less than the guarantee leaves open need not be noticed.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use serde_json::Value;

use super::trial::{Ended, Program, Way};

/// A fault that can be planted.
#[derive(Clone)]
pub struct Kind {
    /// True if the model is wrong, false if only its report is.
    pub in_model: bool,
    pub name: String,
}

fn stand_in() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/support/planted/stand_in.py")
}

fn python() -> OsString {
    std::env::var_os("HYPERCIRCLE_PYTHON").unwrap_or_else(|| "/usr/bin/python3".into())
}

/// All faults there are.
pub fn kinds() -> Vec<Kind> {
    let output = Command::new(python()).arg(stand_in()).arg("--list").output().expect("an interpreter");
    let text = String::from_utf8(output.stdout).expect("plain text");
    let kind = |line: &str| {
        let (place, name) = line.split_once(' ').expect("a place and a name");
        Kind { in_model: place == "model", name: name.to_owned() }
    };
    text.lines().map(kind).collect()
}

/// How much larger than rounding a change must be to be one.
const ROUNDING: f64 = 1e-9;

/// Changes against the honest model, each relative to the largest honest value.
#[derive(Debug, Clone, Copy, Default)]
pub struct Effect {
    pub energy: f64,
    pub force: f64,
    pub displacement: f64,
}

impl Effect {
    /// The largest of the three.
    fn most(self) -> f64 {
        self.energy.max(self.force).max(self.displacement)
    }
}

/// The outcome of a planted fault.
#[derive(Debug, Clone, PartialEq)]
pub enum Fate {
    /// By the checks of those names, or by a refusal to use the result.
    Caught(Vec<String>),
    /// Nothing was noticed, and nothing had changed.
    WithoutEffect,
    /// Nothing was noticed; energy, forces and displacements are within what the bracket leaves open.
    WithinBracket,
    /// Nothing was noticed, but something changed by more than the guarantee leaves open.
    Missed,
    /// The scene has no place for it.
    NoPlace,
}

/// A planted fault.
pub struct Planted {
    pub kind: Kind,
    pub seed: u64,
    /// `None` where nothing was handed over that could be compared.
    pub effect: Option<Effect>,
    pub fate: Fate,
    /// Names of what the diagnosis found.
    pub findings: Vec<String>,
}

/// A scene solved honestly, into which faults can be planted.
pub struct Soil<'a> {
    binary: &'a Path,
    scene: &'a Path,
    folder: &'a Path,
    /// Relative width of the honest bracket, and its root.
    pub open: [f64; 2],
}

impl<'a> Soil<'a> {
    /// Verifies `scene` honestly; everything is written to `folder`.
    ///
    /// # Errors
    /// The message of the honest model where it does not agree.
    pub fn new(binary: &'a Path, scene: &'a Path, folder: &'a Path) -> Result<Self, String> {
        let mut soil = Soil { binary, scene, folder, open: [0.0; 2] };
        let honest = soil.run("nothing", 0, None);
        if honest.code != 0 {
            return Err(format!("exit {}: {}", honest.code, honest.message()));
        }
        let error = honest.number("/energy/relative_error_bound").unwrap_or(0.0);
        soil.open = [error * error, error];
        Ok(soil)
    }

    /// Where what the model handed over in a run is kept.
    pub fn kept(&self, name: &str, seed: u64) -> PathBuf {
        self.folder.join(format!("{name}-{seed}"))
    }

    fn run(&self, name: &str, seed: u64, other: Option<&Path>) -> Ended {
        let mut environment: Vec<(&'static str, OsString)> = vec![
            ("HYPERCIRCLE_PYTHON", stand_in().into()),
            ("HYPERCIRCLE_PLANT_PYTHON", python()),
            ("HYPERCIRCLE_PLANT", format!("{name} {seed}").into()),
            ("HYPERCIRCLE_PLANT_KEEP", self.kept(name, seed).into()),
        ];
        environment.extend(other.map(|folder| ("HYPERCIRCLE_PLANT_OTHER", folder.into())));
        let program = Program { binary: self.binary.to_owned(), limit: Duration::from_secs(300), environment };
        program.run(Way::Verify, self.scene, &self.kept(name, seed))
    }

    /// Plants a fault; `other` is a folder with what was handed over for another scene.
    pub fn plant(&self, kind: &Kind, seed: u64, other: Option<&Path>) -> Planted {
        let ended = self.run(&kind.name, seed, other);
        let effect = self.effect(&kind.name, seed);
        let fate = match ended.code {
            3 if ended.words.contains("exit code 9") => Fate::NoPlace,
            3 if ended.words.contains("exit code 8") => panic!("{} is wrong itself: {}", kind.name, ended.words),
            3 => Fate::Caught(vec!["refused".to_owned()]),
            1 => Fate::Caught(ended.failed_checks().iter().map(|c| c["name"].to_string().replace('"', "")).collect()),
            0 => match effect {
                Some(effect) if effect.most() <= ROUNDING => Fate::WithoutEffect,
                Some(Effect { energy, force, displacement })
                    if energy <= self.open[0] && force.max(displacement) <= self.open[1] =>
                {
                    Fate::WithinBracket
                }
                _ => Fate::Missed,
            },
            code => Fate::Caught(vec![format!("exit {code}: {}", ended.message())]),
        };
        let diagnoses = ended.report.iter().filter_map(|r| r["diagnosis"].as_array()).flatten();
        let findings = diagnoses.filter_map(|d| d["findings"].as_array()).flatten();
        let findings = findings.filter_map(|f| f["name"].as_str().map(String::from)).collect();
        Planted { kind: kind.clone(), seed, effect, fate, findings }
    }

    /// The larger effect of the two degrees; `None` where lengths differ or a file is missing.
    fn effect(&self, name: &str, seed: u64) -> Option<Effect> {
        let mut most = Effect::default();
        for degree in [1, 2] {
            let read = |name: &str, seed: u64| -> Option<Value> {
                let path = self.kept(name, seed).join(format!("primal-P{degree}.json"));
                serde_json::from_str(&std::fs::read_to_string(path).ok()?).ok()
            };
            let (honest, planted) = (read("nothing", 0)?, read(name, seed)?);
            let scale = honest["strain_energy"].as_f64()?.abs().max(honest["energy"].as_f64()?.abs());
            let of = |key: &str| Some((planted[key].as_f64()? - honest[key].as_f64()?).abs() / scale);
            most.energy = most.energy.max(of("energy")?).max(of("strain_energy")?);
            for key in ["vertex_displacement", "edge_displacement"] {
                most.displacement = most.displacement.max(change(&honest[key], &planted[key])?);
            }
            let forces = |result: &Value| {
                let parts = |c: &Value| ["vertex_reaction", "edge_reaction", "resultant"].map(|key| c[key].clone());
                Value::from_iter(result["contacts"].as_array().into_iter().flatten().flat_map(parts))
            };
            most.force = most.force.max(change(&forces(&honest), &forces(&planted))?);
        }
        Some(most)
    }
}

/// Largest change of a number, relative to the largest number; `None` where the two are not of one shape.
fn change(honest: &Value, planted: &Value) -> Option<f64> {
    fn numbers(value: &Value, found: &mut Vec<f64>) {
        match value {
            Value::Array(list) => list.iter().for_each(|v| numbers(v, found)),
            Value::Number(n) => found.extend(n.as_f64()),
            _ => {}
        }
    }
    let (mut a, mut b) = (Vec::new(), Vec::new());
    numbers(honest, &mut a);
    numbers(planted, &mut b);
    let largest = a.iter().chain(&b).fold(0.0_f64, |m, x| m.max(x.abs()));
    let most = a.iter().zip(&b).fold(0.0_f64, |m, (x, y)| m.max((x - y).abs()));
    (a.len() == b.len()).then(|| if largest > 0.0 { most / largest } else { 0.0 })
}
