//! `certify` on fields of scikit-fem and CalculiX on quadrilaterals and six-node triangles, distorted at random: right ones, also on contact, and
//! with one mistake each.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;

use crate::command::{PROGRAM, hypercircle, run, said};
use serde_json::Value;

/// Cells, and of their fields the names with what explains them.
type Fields = (&'static str, &'static [(&'static str, Option<(&'static str, Option<f64>)>)]);

const FIELDS: [Fields; 4] = [
    (
        "Q4",
        &[
            ("clamped", None),
            ("foot", None),
            ("foot:exact", None),
            ("foot:young", Some(("loads", Some(1.0 / 1.05)))),
            ("foot:weight", Some(("body/block/body_force", None))),
            ("foot:value", Some(("value", None))),
            ("foot:selective", Some(("integration/selective", None))),
            ("foot:bbar", Some(("integration/b-bar", None))),
            ("foot:incompatible", Some(("integration/incompatible", None))),
            ("foot:hourglass", Some(("integration/hourglass", Some(0.2)))),
            ("clamped:CPE4", None),
            ("clamped:CPE4R", Some(("integration/hourglass", None))),
        ],
    ),
    (
        "Q8",
        &[
            ("clamped", None),
            ("foot", None),
            ("foot:exact", None),
            ("foot:load", Some(("load/top", Some(1.1)))),
            ("foot:lumped", Some(("boundary/top/forces", None))),
            ("foot:reduced", Some(("integration/reduced", None))),
            ("foot:axes", Some(("displacement/axes", None))),
            ("foot:young", Some(("loads", Some(1.0 / 1.05)))),
            ("clamped:CPE8", None),
            ("clamped:CPE8R", Some(("integration/reduced", None))),
        ],
    ),
    (
        "Q9",
        &[
            ("clamped", None),
            ("foot", None),
            ("clamped:reduced", Some(("integration/reduced", None))),
            ("foot:selective", Some(("integration/selective", None))),
            ("foot:poisson", Some(("body/block/poisson", Some(0.35)))),
            ("foot:value", Some(("value", None))),
            ("foot:load", Some(("load/top", Some(1.1)))),
        ],
    ),
    (
        "T6",
        &[
            ("clamped", None),
            ("foot", None),
            ("foot:poisson", Some(("body/block/poisson", Some(0.35)))),
            ("foot:lumped", Some(("boundary/top/forces", None))),
            ("foot:value", Some(("value", None))),
            ("foot:load", Some(("load/top", Some(1.1)))),
            ("foot:axes", Some(("displacement/axes", None))),
            ("clamped:CPE6", None),
        ],
    ),
];

/// The scene of the script.
fn scene(name: &str) -> String {
    let (support, contact) = match name {
        "clamped" => ("clamped", ""),
        _ => ("roller", "[[contacts]]\non = \"foot\"\n"),
    };
    let line = |name: &str, ends: &str| format!("[[boundaries]]\nname = \"{name}\"\nline = {ends}\n");
    let boundaries =
        line("left", "[[0, 0], [0, 1]]") + &line("top", "[[0, 1], [2, 1]]") + &line("foot", "[[0, 0], [2, 0]]");
    format!(
        "[model]\nkinematics = \"plane-strain\"\n[mesh]\nfile = \"mesh.msh\"\n[bodies.block]\nyoung = 1.0\npoisson = 0.3\n\
         body_force = [0.02, -0.05]\n{boundaries}[[tractions]]\non = \"top\"\nvalue = [0.03, -0.10]\n\
         gradient = [[0.01, 0.0], [0.12, 0.0]]\n[[supports]]\non = \"left\"\ntype = \"{support}\"\n{contact}"
    )
}

/// The output of a script of `tests/support/displacement`, or `None` where scikit-fem is missing.
pub fn by_scikit_fem(script: &str, folder: &Path, args: &[&str]) -> Option<Vec<u8>> {
    let python = std::env::var_os("HYPERCIRCLE_PYTHON").map_or("/usr/bin/python3".into(), PathBuf::from);
    let site = Path::new(PROGRAM).ancestors().nth(2).expect("a folder of the build").join("python");
    let has = Command::new(&python).args(["-c", "import skfem, meshio"]).env("PYTHONPATH", &site).output();
    if !has.is_ok_and(|output| output.status.success()) {
        eprintln!("skipped: {} has no scikit-fem", python.display());
        return None;
    }
    let program = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/support/displacement").join(script);
    let output = Command::new(python).arg(program).arg(folder).args(args).env("PYTHONPATH", site).output();
    let output = output.expect("an interpreter");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(output.stdout)
}

/// Writes scenes and fields into a folder; their energies, or nothing where scikit-fem is missing.
fn made(folder: &Path, cells: &str, seed: u64, names: &[&str]) -> Option<Value> {
    for name in ["clamped", "foot"] {
        std::fs::write(folder.join(format!("{name}.toml")), scene(name)).expect("writable");
    }
    let seed = seed.to_string();
    let args: Vec<&str> = [seed.as_str(), cells].iter().chain(names).copied().collect();
    let printed = by_scikit_fem("quadrilaterals.py", folder, &args)?;
    Some(serde_json::from_slice(&printed).expect("JSON"))
}

fn certified(folder: &Path, name: &str, more: &[&str]) -> (i32, Value) {
    let (scene, field) = (name.split(':').next().unwrap_or(name), name.replace(':', "_"));
    let (file, out) = (format!("{field}.vtu"), format!("out/{field}-{}", more.len()));
    let usual = ["certify", &format!("{scene}.toml"), "--displacement", &file, "--quiet", "--out", &out];
    let output = run(hypercircle(folder, usual.iter().chain(more)));
    let text =
        std::fs::read(folder.join(&out).join("report.json")).unwrap_or_else(|_| panic!("{name}: {}", said(&output)));
    (output.status.code().expect("a code"), serde_json::from_slice(&text).expect("JSON"))
}

#[test]
fn solutions_on_quadrilaterals_pass_and_every_mistake_is_named() {
    std::thread::scope(|scope| {
        for (cells, fields) in FIELDS {
            scope.spawn(move || {
                let folder = tempfile::tempdir().expect("a folder");
                let has_calculix = Command::new("ccx").arg("-v").output().is_ok();
                let fields = fields.iter().filter(|(name, _)| has_calculix || !name.contains(":CP"));
                let names: Vec<&str> = fields.clone().map(|(name, _)| *name).collect();
                if made(folder.path(), cells, 7, &names).is_none() {
                    return;
                }
                for (name, expected) in fields {
                    let (code, report) = certified(folder.path(), name, &["--solution"]);
                    let diagnosis = &report["diagnosis"];
                    let Some((finding, number)) = expected else {
                        assert_eq!(code, 0, "{cells} {name}: {}", report["verdict"]);
                        assert!(diagnosis.as_array().expect("a list").is_empty());
                        continue;
                    };
                    assert_eq!(code, 1, "{cells} {name}");
                    let found = diagnosis[0]["findings"].as_array().expect("findings");
                    assert_eq!(found.len(), 1, "{cells} {name}: {diagnosis}");
                    assert_eq!(found[0]["name"], *finding, "{cells} {name}: {diagnosis}");
                    if let Some(number) = number {
                        let value = found[0]["value"].as_f64().expect("a number");
                        assert!((value - number).abs() < 5e-3 * number.abs(), "{cells} {name}: {value} for {number}");
                    }
                    assert!(diagnosis[0]["explained"].as_f64().expect("a number") > 0.9999, "{cells} {name}");
                }
            });
        }
    });
}

/// Against energies by scikit-fem's rules of high order, and of a finer mesh.
#[test]
fn energies_are_those_of_other_quadrature_and_certificates_no_less_than_errors() {
    let finer = Mutex::new(None);
    for (cells, seed) in [("Q8", 3), ("Q4", 4), ("Q9", 5), ("T6", 6)] {
        let folder = tempfile::tempdir().expect("a folder");
        let mut names = vec!["clamped"];
        let mut finer = finer.lock().expect("unpoisoned");
        if finer.is_none() {
            names.push("clamped:finer");
        }
        let Some(energies) = made(folder.path(), cells, seed, &names) else { return };
        let own = energies["clamped"].as_f64().expect("a number");
        let finer = *finer.get_or_insert_with(|| energies["clamped:finer"].as_f64().expect("a number"));
        let (code, report) = certified(folder.path(), "clamped", &[]);
        assert_eq!(code, 0, "{}", report["verdict"]);
        let found = report["primal"][0]["energy"].as_f64().expect("a number");
        assert!((found - own).abs() < 1e-12 * own.abs(), "{cells}: {found} for {own}");
        assert_eq!(report["energy"]["guaranteed"], true);
        let lower = report["energy"]["lower"].as_f64().expect("a number");
        assert!(lower < finer && finer < own, "{cells}: {lower} {finer} {own}");
        let checks = report["checks"]
            .as_array()
            .expect("checks")
            .iter()
            .chain(report["remarks"].as_array().into_iter().flatten());
        let error = checks.clone().find(|c| c["name"] == "certified/clamped.vtu/energy-error").expect("a remark");
        let error = error["value"].as_f64().expect("a number");
        let strain = report["energy"]["complementary"].as_f64().expect("a number");
        assert!(error * error * strain >= own - finer, "{cells}: {error}");
    }
}
