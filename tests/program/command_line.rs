//! The program as a user meets it: exit codes, one message, nothing written on an error.

use std::path::{Path, PathBuf};
use std::process::Output;

use crate::command::{self, run};
use crate::malformed::MALFORMED;

fn scenes() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/malformed/scenes")
}

fn hypercircle(folder: &Path, arguments: &[&str]) -> Output {
    run(command::hypercircle(folder, arguments))
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// A fresh folder, and the proof afterwards that nothing was written there.
fn in_empty_folder(test: impl FnOnce(&Path)) {
    let folder = tempfile::tempdir().expect("a folder");
    test(folder.path());
    let left: Vec<_> = std::fs::read_dir(folder.path()).expect("readable").collect();
    assert!(left.is_empty(), "written: {left:?}");
}

#[test]
fn every_malformed_scene_exits_with_2_and_one_message() {
    in_empty_folder(|folder| {
        for case in MALFORMED {
            let path = scenes().join(case.file);
            let output = hypercircle(folder, &["solve", path.to_str().expect("plain path")]);
            let message = text(&output.stderr);
            assert_eq!(output.status.code(), Some(2), "{}: {message}", case.file);
            assert!(output.stdout.is_empty(), "{}: {}", case.file, text(&output.stdout));
            let place = case.line.map_or_else(|| case.file.to_owned(), |line| format!("{}:{line}:", case.file));
            for fragment in std::iter::once(place.as_str()).chain(case.fragments.iter().copied()) {
                assert!(message.contains(fragment), "{}: no `{fragment}` in\n{message}", case.file);
            }
            assert_eq!(message.matches("help: ").count(), 1, "{}: not one message\n{message}", case.file);
            assert!(!message.contains("panicked") && !message.contains("internal error"), "{message}");
            assert!(!message.contains('\u{1b}'), "colours without a terminal:\n{message}");
        }
    });
}

#[test]
fn every_command_that_takes_a_scene_refuses_a_bad_one() {
    let path = scenes().join("poisson_half.toml");
    let scene = path.to_str().expect("plain path");
    in_empty_folder(|folder| {
        for arguments in [
            vec!["verify", scene],
            vec!["verify", scene, "--baseline", "b.json", "--accept"],
            vec!["solve", scene, "--out", "results"],
            vec!["certify", scene, "--displacement", "u.vtu"],
            vec!["chart", scene],
        ] {
            let output = hypercircle(folder, &arguments);
            assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", text(&output.stderr));
            assert!(text(&output.stderr).contains("incompressible"), "{arguments:?}");
        }
    });
}

#[test]
fn a_missing_scene_and_a_folder_are_bad_input() {
    in_empty_folder(|folder| {
        let output = hypercircle(folder, &["solve", "nowhere.toml"]);
        assert_eq!(output.status.code(), Some(2));
        assert!(text(&output.stderr).contains("nowhere.toml: there is no such scene file"));
        let output = hypercircle(folder, &["solve", "."]);
        assert_eq!(output.status.code(), Some(2));
        assert!(text(&output.stderr).contains("is a directory without a scene"));
    });
}

#[test]
fn bad_usage_exits_with_2_and_help_with_0() {
    in_empty_folder(|folder| {
        for arguments in [&[][..], &["sovle"], &["solve"], &["solve", "a.toml", "--threads", "0"], &["solve", "--frob"]]
        {
            let output = hypercircle(folder, arguments);
            assert_eq!(output.status.code(), Some(2), "{arguments:?}");
            assert!(output.stdout.is_empty() && !output.stderr.is_empty(), "{arguments:?}");
        }
        for arguments in [&["--help"][..], &["--version"], &["help", "solve"], &["verify", "--help"]] {
            let output = hypercircle(folder, arguments);
            assert_eq!(output.status.code(), Some(0), "{arguments:?}");
            assert!(!output.stdout.is_empty() && output.stderr.is_empty(), "{arguments:?}");
        }
    });
}

#[test]
fn version_manual_and_completions_come_from_the_command_line_itself() {
    in_empty_folder(|folder| {
        let version = text(&hypercircle(folder, &["--version"]).stdout);
        for line in ["hypercircle ", "commit: ", "build: ", "faer: ", "clarabel: ", "nalgebra: ", "interpreter: "] {
            assert!(version.lines().any(|l| l.starts_with(line)), "{line} in\n{version}");
        }
        assert_eq!(text(&hypercircle(folder, &["-V"]).stdout).lines().count(), 1);
        let page = text(&hypercircle(folder, &["man"]).stdout);
        assert!(page.starts_with(".ie") && page.contains("verify") && page.contains("Exit codes"), "{page}");
        for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
            let script = text(&hypercircle(folder, &["completions", shell]).stdout);
            assert!(script.contains("verify") && script.contains("scene-seconds"), "{shell}");
        }
    });
    let folder = tempfile::tempdir().expect("a folder");
    let output = hypercircle(folder.path(), &["man", "--out", "man"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let page = std::fs::read_to_string(folder.path().join("man/hypercircle-verify.1")).expect("a page");
    assert!(page.contains("scene\\-seconds") && !page.contains("part\\-name"), "{page}");
}

#[test]
fn the_schema_of_a_job_names_its_keys() {
    in_empty_folder(|folder| {
        let output = hypercircle(folder, &["schema", "job"]);
        let schema: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
        for key in ["schema_version", "command", "scenes", "counts", "exit"] {
            assert!(schema["properties"][key].is_object(), "{key}");
        }
        assert!(schema["$defs"]["SceneStatus"].to_string().contains("timed-out"));
    });
}

#[test]
fn the_scene_schema_names_every_table_and_forbids_others() {
    in_empty_folder(|folder| {
        let output = hypercircle(folder, &["schema", "scene"]);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        let schema: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
        assert_eq!(schema["additionalProperties"], false);
        for table in ["title", "model", "mesh", "geometry", "bodies", "supports", "tractions", "contacts", "quantities"]
        {
            assert!(schema["properties"][table].is_object(), "{table}");
        }
        assert_eq!(schema["required"], serde_json::json!(["model", "bodies"]));
        let support = &schema["$defs"]["Support"]["properties"];
        assert_eq!(support["type"]["enum"], serde_json::json!(["clamped", "roller", "spring"]));
        let point = &schema["$defs"]["Polygon"]["properties"]["points"]["items"];
        assert_eq!((&point["minItems"], &point["maxItems"]), (&2.into(), &2.into()));
        assert_eq!(schema["$defs"]["Body"]["properties"]["poisson"]["exclusiveMaximum"], 0.5);
    });
}

#[test]
fn errors_are_numbers_where_nothing_is_strained() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["moved_rigidly", "nothing_is_loaded", "open_and_not_loaded"] {
        let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/scenes/{name}.toml"));
        let output = hypercircle(folder.path(), &["solve", scene.to_str().expect("plain path"), "--out", name]);
        assert_eq!(output.status.code(), Some(0), "{name}: {}", text(&output.stderr));
        let report = std::fs::read(folder.path().join(name).join("report.json")).expect("a report");
        let report: serde_json::Value = serde_json::from_slice(&report).expect("JSON");
        for key in ["relative_error_bound", "mid_error_bound", "gap", "complementary"] {
            assert!(report["energy"][key].is_number(), "{name}, {key}: {}", report["energy"]);
        }
        assert_eq!(report["energy"]["relative_error_bound"], 0.0, "{name}");
    }
}
