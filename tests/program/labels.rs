//! Labels of quantities and contacts beside their numbers: exact by statics, inside, open, free, and why a value is missing.

use std::path::Path;

use serde_json::Value;

use crate::command::{case, ended, hypercircle, run, with_reference};

/// Calls the program with `arguments` on the scene `name` of `tests/program/labels`; its report.
fn report(name: &str, arguments: &[&str], out: &Path) -> Value {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/program/labels").join(format!("{name}.toml"));
    reported(&scene, arguments, out)
}

fn reported(scene: &Path, arguments: &[&str], out: &Path) -> Value {
    let mut command = hypercircle(out, arguments);
    command.arg(scene).arg("--out").arg(out.join("out"));
    ended(&scene.display().to_string(), &run(command), 0, &[]);
    serde_json::from_str(&written(out, "report.json")).expect("JSON")
}

fn written(out: &Path, name: &str) -> String {
    std::fs::read_to_string(out.join("out").join(name)).expect("written")
}

fn list<'a>(value: &'a Value, key: &str) -> &'a [Value] {
    value[key].as_array().expect("a list")
}

fn named<'a>(report: &'a Value, key: &str, name: &str) -> &'a Value {
    list(report, key).iter().find(|row| row["name"] == name).unwrap_or_else(|| panic!("no {name} in {key}"))
}

fn ends(quantity: &Value) -> [f64; 2] {
    ["lower", "upper"].map(|key| quantity[key].as_f64().unwrap_or_else(|| panic!("no {key} in {quantity}")))
}

/// Three contacts share the load of a wall that leans against two of them: how is no matter of statics.
#[test]
fn what_other_equilibria_have_otherwise_is_not_exact_by_statics() {
    let out = tempfile::tempdir().expect("a folder");
    let wall = report("wall", &["solve"], out.path());
    for (name, exact) in [("toe_force", false), ("crest", false), ("sole", true), ("heel_third", false)] {
        let quantity = named(&wall, "quantities", name);
        assert_eq!(quantity["exact_by_statics"], exact, "{quantity}");
        let [lower, upper] = ends(quantity);
        assert_eq!(upper - lower <= 1e-9 * upper.abs(), exact, "{quantity}");
    }
    // The weight of the wall.
    let [lower, upper] = ends(named(&wall, "quantities", "sole"));
    assert!(lower <= 280.8 && 280.8 <= upper, "{lower} {upper}");
}

/// Pressures of rounding make no contact, and the sides of a clamp that stay apart do not hold it.
#[test]
fn a_contact_that_never_closes_is_open_and_holds_nothing() {
    let out = tempfile::tempdir().expect("a folder");
    let compared = ["verify", "--max-seconds", "1", "--primal-degree", "1"];
    let clamp = report("clamp", if with_reference() { &compared } else { &["solve"] }, out.path());
    let ears = named(&clamp, "contact", "ears|rigid");
    assert_eq!(ears["open_fraction"], 1.0, "{ears}");
    assert_eq!(list(ears, "contact_ends"), &[] as &[Value], "{ears}");
    let notes: Vec<&str> = list(&clamp, "notes").iter().filter_map(|note| note["text"].as_str()).collect();
    let says = |text: &str| notes.iter().any(|note| note.contains(text));
    assert!(says("body `pipe` slides along its rollers in direction (1, 0)"), "{notes:#?}");
    assert!(says("While contact `ears|rigid` stays open") && says("body `clamp` turns"), "{notes:#?}");
    if with_reference() {
        assert_eq!(ears["open_fraction_primal"], 1.0, "{ears}");
        let of_ears =
            |check: &&Value| check["name"].as_str().is_some_and(|name| name.starts_with("contact/ears|rigid/"));
        let said: Vec<&Value> = list(&clamp, "checks").iter().chain(list(&clamp, "remarks")).filter(of_ears).collect();
        assert!(!said.is_empty());
        for check in said {
            assert_eq!(check["passed"], true, "{check}");
            assert!(!check["why"].as_str().expect("words").contains("Supports meet"), "{check}");
        }
    }
}

/// Both models are exact but for rounding, and so is the interval.
#[test]
fn values_that_rounding_puts_beside_an_interval_are_inside() {
    if !with_reference() {
        return;
    }
    for (name, arguments) in [("exact", &["verify", "--refine", "1"][..]), ("dovetail", &["verify"])] {
        let out = tempfile::tempdir().expect("a folder");
        let report = report(name, arguments, out.path());
        for quantity in list(&report, "quantities") {
            assert_eq!(quantity["exact_by_statics"], true, "{quantity}");
            let models = list(quantity, "primal");
            assert!(models.len() == 2 && models.iter().all(|model| model["inside"] == true), "{quantity}");
        }
        let table = written(out.path(), "quantities.csv");
        assert!(table.lines().skip(1).all(|row| row.split(',').nth(5) == Some("true")), "{name}: {table}");
        assert!(!written(out.path(), "report.html").contains("outside by"), "{name}");
    }
}

/// No displacement of the mesh moves one of two contacts with a common vertex alone: reactions tell the value, and it says so.
#[test]
fn contacts_with_a_common_vertex_have_the_values_of_their_reactions() {
    if !with_reference() {
        return;
    }
    let out = tempfile::tempdir().expect("a folder");
    let split = report("split", &["verify"], out.path());
    for (name, contact) in [("FL", "sec_left|pri_left"), ("FR", "sec_right|pri_right")] {
        let quantity = named(&split, "quantities", name);
        let value = |model: &Value| model["value"].as_f64().unwrap_or_else(|| panic!("no value: {quantity}"));
        let [one, two] = list(quantity, "primal") else { panic!("not two models: {quantity}") };
        for model in [one, two] {
            value(model);
            assert!(model["reason"].as_str().expect("words").contains("shares a vertex"), "{quantity}");
        }
        let resultant = named(&split, "contact", contact)["resultant"]["primal"][1].as_f64().expect("a number");
        assert!((value(two) + resultant).abs() <= 1e-12 * resultant.abs(), "{quantity} {resultant}");
    }
    // Another contact meets them, and no support.
    let remark = named(&split, "remarks", "contact/sec_left|pri_left/resultant");
    assert!(remark["why"].as_str().expect("words").contains("Another contact meets this one"), "{remark}");
}

/// `verify` refines the stress side where it cannot tell two models apart, and its intervals are those of the finer stresses.
#[test]
fn intervals_come_from_the_sharpest_stresses_of_a_run() {
    if !with_reference() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let text = std::fs::read_to_string(case("two_blocks")).expect("a scene");
    let quantities = r#"
[[quantities]]
name = "tip"
displacement = "left_load"
direction = [1, 0]
[[quantities]]
name = "core"
stress = "left"
box = [[0.25, 0.25], [0.75, 0.75]]
component = "xx"
"#;
    let scene = folder.path().join("scene.toml");
    std::fs::write(&scene, text.replace("size = 0.125", "size = 0.5") + quantities).expect("writable");
    let [coarse, sharp] = [&["solve"][..], &["verify", "--allow", "bracket/sharpness=0.1"]]
        .map(|arguments| reported(&scene, arguments, folder.path()));
    let notes = sharp["notes"].to_string();
    assert!(notes.contains("refined to"), "{notes}");
    // Known from meshes that are far finer.
    for (name, known) in [("tip", 0.801499), ("core", -0.566502)] {
        let [[a, b], [c, d]] = [&coarse, &sharp].map(|report| ends(named(report, "quantities", name)));
        assert!(a <= c && c <= known && known <= d && d <= b, "{name}: [{a}, {b}] and [{c}, {d}]");
        assert!(d - c < 0.7 * (b - a), "{name}: [{a}, {b}] and [{c}, {d}]");
        assert!(list(&sharp, "checks").iter().any(|check| check["name"] == format!("quantity/{name}/FEniCSx P1")));
    }
    // What each triangle adds is that of the mesh of the report.
    assert!(written(folder.path(), "fields.vtu").contains("quantity_contribution_tip"));
}
