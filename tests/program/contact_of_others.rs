//! `certify --solution` with fields of scikit-fem and GetFEM whose contact sides do not match: `tests/support/displacement/contact_of_others.py`.

use std::path::Path;
use std::process::Command;

use crate::claimed::check;
use crate::command::{hypercircle, run, said};
use serde_json::Value;

const CONTACT: &str = "face|facing";

/// Writes the scene and its fields; `None` where one of the two programs is missing.
fn prepared(folder: &Path) -> Option<Vec<String>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let packages = std::env::var_os("CARGO_TARGET_DIR").map_or(root.join("target"), Into::into).join("python");
    let python = std::env::var_os("HYPERCIRCLE_PYTHON").unwrap_or("/usr/bin/python3".into());
    let mut command = Command::new(python);
    command.env("PYTHONPATH", packages).arg(root.join("tests/support/displacement/contact_of_others.py")).arg(folder);
    let output = command.output().expect("an interpreter");
    let text = String::from_utf8_lossy(&output.stderr);
    if text.contains("ModuleNotFoundError") {
        eprintln!("skipped: {text}");
        return None;
    }
    assert!(output.status.success(), "{text}");
    Some(String::from_utf8_lossy(&output.stdout).lines().map(str::to_string).collect())
}

/// The exit code and the report on one of the fields.
fn judged(folder: &Path, name: &str, more: &[&str]) -> (i32, Value) {
    let (field, out) = (format!("{name}.vtu"), format!("out/{name}-{}", more.len()));
    let usual = ["certify", "scene.toml", "--displacement", &field, "--solution", "--quiet", "--out", &out];
    let output = run(hypercircle(folder, usual.iter().chain(more)));
    let text =
        std::fs::read(folder.join(&out).join("report.json")).unwrap_or_else(|_| panic!("{name}: {}", said(&output)));
    (output.status.code().expect("a code"), serde_json::from_slice(&text).expect("JSON"))
}

#[test]
fn methods_of_other_programs_are_recognised_where_sides_do_not_match() {
    let folder = tempfile::tempdir().expect("a folder");
    let Some(names) = prepared(folder.path()) else { return };
    assert_eq!(names.len(), 12, "{names:?}");
    let weak = ["--contact", "weak"];
    for name in names {
        let (plain, report) = judged(folder.path(), &name, &[]);
        let (claimed, with_claim) = judged(folder.path(), &name, &weak);
        let penetration = |report: &Value| {
            let found = check(report, &format!("solution/contact/{CONTACT}/penetration"));
            found["why"].as_str().expect("a sentence").to_string()
        };
        let codes = [plain, claimed];
        if name.contains("modulus") {
            assert_eq!(codes, [1, 1], "{name}: {}", report["verdict"]);
        } else if name.contains("nitsche") {
            assert_eq!(codes, [0, 0], "{name}: {}", report["verdict"]);
            assert!(penetration(&report).contains("Nitsche's method (θ = 1.000"), "{name}: {}", penetration(&report));
        } else if name.contains("mortar") {
            assert_eq!(codes, [0, 0], "{name}: {}", report["verdict"]);
            assert!(penetration(&report).contains("in the mean over the functions of the first side"), "{name}");
        } else if name.contains("integral") {
            // GetFEM's rule counts points of the first side only: the mean is met to what that leaves.
            assert_eq!(codes, [1, 0], "{name}: {}, {}", report["verdict"], with_claim["verdict"]);
        } else {
            assert_eq!(codes, [1, 1], "{name}: a penalty is no contact in the mean: {}", with_claim["verdict"]);
        }
    }
}
