//! Quantities of a scene: what the commands print and write of them, and how they judge values from elsewhere.

use std::path::Path;
use std::process::Output;

use serde_json::Value;

use crate::command::{case, ended, hypercircle, run, with_reference};

/// A displacement, a force and a stress of two blocks.
const QUANTITIES: &str = r#"
[[quantities]]
name = "tip"
displacement = "left_load"
direction = [1, 0]
[[quantities]]
name = "seat"
force = "left_face|right_face"
window = [0.125, 0.25, 0.375, 0.5]
[[quantities]]
name = "core"
stress = "left"
box = [[0.25, 0.25], [0.75, 0.75]]
component = "xx"
"#;
/// Their values, from meshes that are far finer.
const KNOWN: [f64; 3] = [0.801499, 0.233537, -0.566502];

fn folder_with(more: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let text = std::fs::read_to_string(case("two_blocks")).expect("a scene");
    std::fs::write(folder.path().join("scene.toml"), text + more).expect("writable");
    folder
}

fn call(folder: &Path, arguments: &[&str]) -> Output {
    run(hypercircle(folder, [arguments, &["--out", "out"]].concat()))
}

fn written(folder: &Path, name: &str) -> String {
    std::fs::read_to_string(folder.join("out").join(name)).expect(name)
}

fn report(folder: &Path) -> Value {
    serde_json::from_str(&written(folder, "report.json")).expect("JSON")
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

#[test]
fn solve_prints_and_writes_intervals_that_hold_the_values() {
    let folder = folder_with(QUANTITIES);
    let output = call(folder.path(), &["solve", "scene.toml"]);
    ended("solve", &output, 0, &[]);
    let said = String::from_utf8(output.stdout).expect("text");
    let report = report(folder.path());
    let csv = written(folder.path(), "quantities.csv");
    let [page, junit, summary] = ["report.html", "junit.xml", "summary.md"].map(|name| written(folder.path(), name));
    for (quantity, (name, known)) in
        report["quantities"].as_array().expect("a list").iter().zip(["tip", "seat", "core"].into_iter().zip(KNOWN))
    {
        assert_eq!(quantity["name"], name);
        let [lower, upper] = ["lower", "upper"].map(|key| number(&quantity[key]));
        assert!(lower < known && known < upper, "{quantity}");
        assert!(upper - lower < 0.07 * known.abs(), "{quantity}");
        let line = said.lines().find(|line| line.trim_start().starts_with(&format!("{name} ("))).expect("a line");
        // What is printed is rounded away from the interval.
        let printed = line.split("within ").nth(1).expect("an interval").replace('−', "-");
        let ends: Vec<f64> = printed.split(" … ").map(|end| end.trim().parse().expect("a number")).collect();
        assert!(ends[0] <= lower && upper <= ends[1], "{line}: {quantity}");
        let row = csv.lines().find(|row| row.starts_with(&format!("{name},"))).expect("a row");
        let cells: Vec<&str> = row.split(',').collect();
        assert_eq!((cells[2], cells[7].parse(), cells[8].parse()), ("hypercircle", Ok(lower), Ok(upper)));
        assert!(page.contains(&format!("<code>{name}</code>")) && summary.contains(&format!("| `{name}` |")));
        assert!(junit.contains(&format!("name=\"quantity/{name}\"")), "{junit}");
    }
    assert_eq!(csv.lines().count(), 4);
    assert!(written(folder.path(), "fields.vtu").contains("quantity_contribution"));
    // The next run without quantities takes the file along.
    std::fs::copy(case("two_blocks"), folder.path().join("scene.toml")).expect("writable");
    ended("solve", &call(folder.path(), &["solve", "scene.toml"]), 0, &[]);
    assert!(!folder.path().join("out/quantities.csv").exists());
}

#[test]
fn a_tolerance_of_a_quantity_is_reached_or_the_reason_is_told() {
    let folder = folder_with(QUANTITIES);
    ended("reached", &call(folder.path(), &["solve", "scene.toml", "--tolerance-of", "tip=1e-2"]), 0, &[]);
    let reached = report(folder.path());
    let tip = &reached["quantities"][0];
    let half = 0.5 * (number(&tip["upper"]) - number(&tip["lower"]));
    assert!(half <= 1e-2 * number(&tip["value"]).abs(), "{tip}");
    assert!(number(&tip["lower"]) < KNOWN[0] && KNOWN[0] < number(&tip["upper"]), "{tip}");
    let few = ["solve", "scene.toml", "--tolerance-of", "tip=1e-9", "--max-triangles", "100"];
    let output = call(folder.path(), &few);
    ended("not reached", &output, 1, &[]);
    assert!(String::from_utf8_lossy(&output.stdout).contains("failed: quantity/tip/tolerance"));
    let stopped = report(folder.path());
    let notes = stopped["notes"].as_array().expect("a list").iter().filter_map(|note| note["text"].as_str());
    assert!(notes.into_iter().any(|note| note.contains("100")), "{}", stopped["notes"]);
}

#[test]
fn unknown_names_and_broken_numbers_are_refused_before_anything_is_solved() {
    let folder = folder_with(QUANTITIES);
    let files = [
        ("cut.toml", "tip = "),
        ("cut.json", "{\"tip\": "),
        ("word.toml", "tip = \"a\""),
        ("nested.json", "{\"tip\": {\"x\": 1}}"),
        ("infinite.toml", "tip = inf"),
        ("foreign.toml", "tap = 1"),
        ("empty.json", "{}"),
    ];
    for (name, text) in files {
        std::fs::write(folder.path().join(name), text).expect("writable");
        let output = call(folder.path(), &["certify", "scene.toml", "--values", name]);
        ended(name, &output, 2, &[if name == "foreign.toml" { "tip, seat, core" } else { name }, "help: "]);
    }
    for (arguments, fragments) in [
        (&["solve", "scene.toml", "--tolerance-of", "tap=1e-2"][..], &["no quantity 'tap'", "tip, seat, core"][..]),
        (&["solve", "scene.toml", "--tolerance-of", "tip=0"], &["above zero"]),
        (&["solve", "scene.toml", "--tolerance-of", "tip"], &["NAME=X"]),
        (&["certify", "scene.toml", "--value", "tap=1"], &["no quantity 'tap'"]),
        (&["certify", "scene.toml", "--value", "tip=x"], &["not a number"]),
        (&["certify", "scene.toml", "--values", "nowhere.toml"], &["nowhere.toml"]),
        (&["certify", "scene.toml", "--values", "."], &["regular file"]),
        (&["certify", "scene.toml"], &["--value"]),
    ] {
        ended(&arguments.join(" "), &call(folder.path(), arguments), 2, fragments);
    }
    assert!(!folder.path().join("out").exists());
}

#[test]
fn values_from_elsewhere_are_held_against_the_intervals() {
    let folder = folder_with(QUANTITIES);
    let [tip, seat, core] = KNOWN;
    std::fs::write(folder.path().join("good.toml"), format!("tip = {tip}\ncore = {core}\n")).expect("writable");
    std::fs::write(folder.path().join("good.json"), format!("{{\"seat\": {seat}, \"tip\": {tip}}}")).expect("writable");
    std::fs::write(folder.path().join("bad.json"), r#"{"seat": 0.9, "tip": 0.8014}"#).expect("writable");
    let [inside, outside] = [tip, 1.05 * tip].map(|value| format!("tip={value}"));
    for (arguments, wrong) in [
        (["--value", inside.as_str()], None),
        (["--values", "good.toml"], None),
        (["--values", "good.json"], None),
        (["--value", outside.as_str()], Some("tip")),
        (["--values", "bad.json"], Some("seat")),
    ] {
        let output = call(folder.path(), &[&["certify", "scene.toml"], &arguments[..]].concat());
        let said = String::from_utf8_lossy(&output.stdout).into_owned();
        assert_eq!(output.status.code(), Some(i32::from(wrong.is_some())), "{arguments:?}: {said}");
        let report = report(folder.path());
        let checks = report["checks"].as_array().expect("a list");
        let failed: Vec<&str> =
            checks.iter().filter(|check| check["passed"] == false).filter_map(|check| check["name"].as_str()).collect();
        let expected: Vec<String> = wrong.iter().map(|name| format!("quantity/{name}/given")).collect();
        assert_eq!(failed, expected, "{arguments:?}");
        if let Some(name) = wrong {
            assert!(said.contains(&format!(" of {name} (given) is ")) && said.contains("beyond the end"), "{said}");
            let rows = written(folder.path(), "quantities.csv");
            let row = rows.lines().find(|row| row.starts_with(&format!("{name},")) && row.contains(",given,"));
            assert_eq!(row.expect("a row").split(',').nth(5), Some("false"));
            assert!(written(folder.path(), "report.html").contains("outside by"));
        }
    }
}

#[test]
fn verify_holds_both_models_against_the_intervals() {
    if !with_reference() {
        return;
    }
    let folder = folder_with(QUANTITIES);
    ended("verify", &call(folder.path(), &["verify", "scene.toml"]), 0, &[]);
    let report = report(folder.path());
    for quantity in report["quantities"].as_array().expect("a list") {
        let models = quantity["primal"].as_array().expect("a list");
        let degrees: Vec<u64> = models.iter().filter_map(|model| model["degree"].as_u64()).collect();
        assert_eq!(degrees, [1, 2], "{quantity}");
        for model in models {
            let value = number(&model["value"]);
            let inside = number(&quantity["lower"]) <= value && value <= number(&quantity["upper"]);
            assert_eq!(model["inside"], inside, "{quantity}");
        }
    }
    assert_eq!(written(folder.path(), "quantities.csv").lines().count(), 1 + 3 * 3);
}

/// A value counts with half a unit of its last digit, where three digits are there; fewer digits tell nothing.
#[test]
fn a_value_that_is_rounded_is_no_wrong_one() {
    let scene = "[model]\nkinematics = \"plane-stress\"\n[geometry]\nsize = 0.5\n[[geometry.polygons]]\nbody = \"block\"\n\
                 points = [[0, 0], [1, 0], [1, 1], [0, 1]]\nedges = [\"foot\", \"right\", \"top\", \"left\"]\n[bodies.block]\nyoung = 1.0\npoisson = 0.3\n\
                 [[supports]]\non = \"left\"\ntype = \"roller\"\n[[tractions]]\non = \"top\"\npressure = 0.3333333\n[[contacts]]\non = \"foot\"\n\
                 [[quantities]]\nname = \"foot\"\nforce = \"foot\"\n";
    let folder = folder_with("");
    std::fs::write(folder.path().join("scene.toml"), scene).expect("writable");
    for (value, code, said) in [
        ("0.3333333", 0, "lies in its interval."),
        ("0.333", 0, "but for the digits that it lacks"),
        ("333e-3", 0, "but for the digits that it lacks"),
        ("0.334", 1, "beyond the end"),
        ("0.3330", 1, "beyond the end"),
        ("0.3", 1, "may be it with fewer digits"),
        ("0.2", 1, "beyond the end"),
    ] {
        let output = call(folder.path(), &["certify", "scene.toml", "--value", &format!("foot={value}")]);
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        assert_eq!((output.status.code(), text.contains(said)), (Some(code), true), "{value}: {text}");
    }
}

/// −2𝓛 is the work of the loads where nothing else works: a bar of E = 1 under a traction of 1 does 1, and what heat adds is no part of it.
#[test]
fn the_compliance_is_told_where_loads_alone_do_work() {
    let bar = |young: &str, heat: &str| {
        format!(
            "[model]\nkinematics = \"plane-stress\"\n[geometry]\nsize = 0.5\n[[geometry.polygons]]\nbody = \"bar\"\n\
             points = [[0, 0], [1, 0], [1, 1], [0, 1]]\nedges = [\"foot\", \"right\", \"\", \"left\"]\n[bodies.bar]\nyoung = {young}\npoisson = 0.0\n{heat}\
             [[supports]]\non = \"left\"\ntype = \"roller\"\n[[supports]]\non = \"foot\"\ntype = \"roller\"\n[[tractions]]\non = \"right\"\nvalue = [1, 0]\n"
        )
    };
    let folder = tempfile::tempdir().expect("a folder");
    let heat = "expansion = 0.1\ntemperature = 5.0\n";
    for (young, heat, told) in [("1.0", "", true), ("1.0", heat, false), ("[0.99, 1.01]", heat, false)] {
        std::fs::write(folder.path().join("scene.toml"), bar(young, heat)).expect("writable");
        ended(heat, &call(folder.path(), &["solve", "scene.toml"]), 0, &[]);
        let report = report(folder.path());
        let ends = [&report["energy"]["compliance"], &report["data_range"]["compliance"]];
        assert_eq!(ends[0].is_array(), told, "{}", report["energy"]);
        assert!(!ends[1].is_array(), "{}", report["data_range"]);
        if told {
            assert!(number(&ends[0][0]) <= 1.0 + 1e-12 && 1.0 - 1e-12 <= number(&ends[0][1]), "{}", ends[0]);
        }
    }
}

/// What no mesh gives an interval is refused before any is made, also where the first mesh is too coarse to tell more.
#[test]
fn refinement_towards_what_has_no_interval_does_not_begin() {
    let folder = tempfile::tempdir().expect("a folder");
    let crack = |size: &str, body: &str| {
        format!(
            r#"
[model]
kinematics = "plane-strain"
[geometry]
size = {size}
[[geometry.polygons]]
body = "plate"
points = [[0, 0], [0.5, 0], [1, 0], [1, 3], [0, 3]]
edges = ["crack", "ahead", "", "top", ""]
[bodies.plate]
{body}
[[supports]]
on = "ahead"
type = "roller"
[[tractions]]
on = "top"
value = [0, 1]
[[quantities]]
name = "K"
stress_intensity = "KI"
tip = [0.5, 0]
"#
        )
    };
    for size in ["0.2", "1.0"] {
        for (body, words) in [
            ("young = 1.0\npoisson = 0.3\ninitial_stress = [0.1, 0.5, 0]", "a temperature or an initial stress"),
            ("orthotropic = { young = [2, 1, 1], poisson = [0.3, 0.3, 0.3], shear = 0.5 }", "not isotropic"),
        ] {
            std::fs::write(folder.path().join("crack.toml"), crack(size, body)).expect("writable");
            let output = call(folder.path(), &["solve", "crack.toml", "--tolerance-of", "K=0.01"]);
            ended(words, &output, 2, &["quantity 'K'", words]);
        }
    }
    std::fs::write(folder.path().join("crack.toml"), crack("0.2", "young = 1.0\npoisson = 0.3")).expect("writable");
    ended("an isotropic plate", &call(folder.path(), &["solve", "crack.toml", "--tolerance-of", "K=0.1"]), 0, &[]);
}
