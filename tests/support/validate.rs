//! Files against the schemas that the program prints, by Python's jsonschema.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::command::{hypercircle, run};

/// Validates files against a schema, and says which do not fit: SCHEMA FILE...
const VALIDATE: &str = r#"
import json, sys, tomllib
from jsonschema import Draft202012Validator

schema = json.load(open(sys.argv[1]))
Draft202012Validator.check_schema(schema)
validator = Draft202012Validator(schema)
wrong = 0
for path in sys.argv[2:]:
    with open(path, "rb") as file:
        text = file.read().decode("utf-8-sig")
    content = tomllib.loads(text) if path.endswith(".toml") else json.loads(text)
    for error in validator.iter_errors(content):
        wrong = 1
        print(f"{path}: {error.json_path}: {error.message[:200]}")
sys.exit(wrong)
"#;

/// The errors of files that do not fit the schema called `name`; empty where all `files` do.
pub fn misfits(folder: &Path, name: &str, files: &[PathBuf]) -> String {
    let printed = run(hypercircle(folder, ["schema", name]));
    let schema = folder.join(format!("{name}.schema.json"));
    std::fs::write(&schema, printed.stdout).expect("writable");
    let mut python = Command::new("/usr/bin/python3");
    let output = python.args(["-c", VALIDATE]).arg(schema).args(files).output().expect("Python");
    let lines = String::from_utf8_lossy(&output.stdout).into_owned();
    match output.status.success() {
        true => String::new(),
        false => format!("{lines}{}", String::from_utf8_lossy(&output.stderr)),
    }
}
