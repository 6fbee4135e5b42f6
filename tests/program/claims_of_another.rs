//! Claims of a finite-element program that shares nothing with this one: loads that are small beside heat, prescribed displacements, friction
//! or the loads of another body, and rules of integration. `claims/README.md` says what the fields are.

use std::path::Path;

use serde_json::Value;

use crate::command::{hypercircle, run, said};

/// The exit code of a field that claims to solve a scene of the folder `claims`, and its checks that did not pass.
fn claimed(scene: &str, field: &str) -> (i32, Vec<Value>) {
    let (code, report) = reported(scene, field);
    let checks = report["checks"].as_array().expect("checks").iter();
    (code, checks.filter(|check| check["passed"] == false).cloned().collect())
}

/// The sentence of the diagnosis of such a field.
fn explained(scene: &str, field: &str) -> String {
    let (_, report) = reported(scene, field);
    report["diagnosis"][0]["sentence"].as_str().expect("a sentence").to_string()
}

fn reported(scene: &str, field: &str) -> (i32, Value) {
    let inputs = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/program/claims");
    let folder = tempfile::tempdir().expect("a folder");
    let mut command = hypercircle(folder.path(), ["certify"]);
    let field = if field.contains('.') { field.to_string() } else { format!("{field}.vtu") };
    command.arg(inputs.join(format!("{scene}.toml"))).arg("--displacement").arg(inputs.join(field));
    let output = run({
        command.args(["--solution", "--quiet", "--out", "out"]);
        command
    });
    let text = std::fs::read(folder.path().join("out/report.json")).unwrap_or_else(|_| panic!("{}", said(&output)));
    (output.status.code().expect("a code"), serde_json::from_slice(&text).expect("JSON"))
}

#[test]
fn digits_that_hide_a_small_load_decide_nothing() {
    for scene in ["heated", "moved"] {
        assert_eq!(claimed(scene, scene), (0, Vec::new()), "{scene}");
        let (code, checks) = claimed(scene, &format!("{scene}_unloaded"));
        assert!(code == 1 && !checks.is_empty(), "{scene}: {checks:?}");
        for check in checks {
            assert!(
                check["value"].is_null() && check["why"].as_str().is_some_and(|why| why.contains("digits")),
                "{check}"
            );
        }
    }
}

#[test]
fn work_on_what_a_roller_prescribes_is_that_of_the_roller_alone() {
    assert_eq!(claimed("rubbed", "rubbed"), (0, Vec::new()));
}

#[test]
fn heat_that_works_against_the_load_leaves_a_scale() {
    assert_eq!(claimed("ring", "ring"), (0, Vec::new()));
}

#[test]
fn every_body_carries_its_own_load() {
    let (code, checks) = claimed("uneven", "uneven_at_rest");
    assert!(code == 1 && checks.iter().any(|check| check["name"] == "solution/reactions"), "{checks:?}");
}

/// Of a body on springs of its own, whose load is a millionth of that of another, Young's modulus is 5 % off.
#[test]
fn forces_elsewhere_hide_nothing_of_a_body_that_stands_apart() {
    assert_eq!(claimed("apart", "apart"), (0, Vec::new()));
    let (code, checks) = claimed("apart", "apart_stiffer");
    assert!(code == 1 && checks.iter().any(|check| check["name"] == "solution/residual"), "{checks:?}");
}

#[test]
fn what_the_axis_holds_is_no_matter_of_a_roller_that_meets_it() {
    let said = explained("rod", "rod_off_the_axis");
    assert!(said.contains("across the axis of revolution is not zero") && !said.contains("a_bottom"), "{said}");
}

#[test]
fn the_simplest_mistake_is_named_where_others_would_do() {
    let ring = explained("ring", "ring_unloaded");
    assert!(ring.contains("load is missing"), "{ring}");
    let crossed = explained("crossed", "crossed_axes");
    assert!(crossed.contains("x and y of the load on b0_right are exchanged"), "{crossed}");
}

#[test]
fn any_rule_of_full_integration_will_do_on_bodies_of_revolution() {
    for (scene, field) in
        [("near_axis", "near_axis_5"), ("near_axis", "near_axis_6"), ("mixed", "mixed"), ("mixed", "mixed_quadratic")]
    {
        assert_eq!(claimed(scene, field), (0, Vec::new()), "{field}");
    }
}

/// Contact at nodes that face each other is met there, and not where the gap bends between them.
#[test]
fn a_gap_that_bends_within_an_edge_is_closed_at_the_nodes() {
    for scene in ["kinked", "kinked_quadratic"] {
        assert_eq!(claimed(scene, scene), (0, Vec::new()), "{scene}");
    }
}

#[test]
fn node_data_belong_to_the_nodes_that_they_name() {
    assert_eq!(claimed("tagged", "tagged_rows.msh"), (0, Vec::new()));
    let inputs = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/program/claims");
    let text = std::fs::read_to_string(inputs.join("tagged_rows.msh")).expect("readable");
    let folder = tempfile::tempdir().expect("a folder");
    for (row, found) in
        [("\n99 0.0 0.0 0\n", "node 99, which is not among its nodes"), ("\n11 0.0 0.0 0\n", "two rows for node 11")]
    {
        let wrong = text.replacen("\n12 0.0 0.0 0\n", row, 1);
        assert_ne!(wrong, text);
        std::fs::write(folder.path().join("wrong.msh"), wrong).expect("writable");
        let mut command = hypercircle(folder.path(), ["certify"]);
        command.arg(inputs.join("tagged.toml")).args(["--displacement", "wrong.msh", "--solution"]);
        let output = run(command);
        assert_eq!(output.status.code(), Some(2), "{}", said(&output));
        assert!(said(&output).split_whitespace().collect::<Vec<_>>().join(" ").contains(found), "{}", said(&output));
    }
}

#[test]
fn loads_may_be_integrated_by_the_rule_of_the_stiffness() {
    assert_eq!(claimed("spun", "spun"), (0, Vec::new()));
}

#[test]
fn few_nodes_are_no_excuse_for_another_name() {
    assert!(
        explained("four_nodes", "four_nodes")
            .starts_with("This explains it: plane stress stands in place of plane strain")
    );
    // One of its corners is free: what is wrong there can be the triangle or the node, and no clamped node is off.
    let sentence = explained("soft_triangle", "soft_triangle");
    assert!(sentence.starts_with("This explains it: the equations of point 6 of the file"), "{sentence}");
}

/// Corners of quadratic edges that slide carry what friction may, whatever their middles do.
#[test]
fn corners_that_slide_carry_the_bound() {
    for scene in ["slides_free", "slides_wrongly"] {
        let (code, checks) = claimed(scene, scene);
        assert_eq!(code, 1, "{scene}");
        assert!(checks.iter().any(|check| check["name"] == "solution/contact/foot|rigid/friction"), "{checks:?}");
    }
}

/// The pressures of elastic contact store what goes beyond the gap, and a stiff one multiplies the digits of the file.
#[test]
fn elastic_contact_beyond_a_gap_and_stiff_is_that_of_the_scene() {
    assert_eq!(claimed("beyond_a_gap", "beyond_a_gap"), (0, Vec::new()));
    let (code, checks) = claimed("stiff_contact", "stiff_contact.dat");
    let decisive: Vec<&Value> = checks.iter().filter(|check| check["basis"] != "chosen").collect();
    assert_eq!((code, decisive), (0, Vec::new()));
}

/// The name of the first finding on a field of the scene that a text makes of one of the folder.
fn named(scene: &str, field: &str, change: impl Fn(&str) -> String) -> String {
    let inputs = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/program/claims");
    let folder = tempfile::tempdir().expect("a folder");
    let text = std::fs::read_to_string(inputs.join(format!("{scene}.toml"))).expect("readable");
    let changed = change(&text);
    for file in std::fs::read_dir(&inputs)
        .expect("a folder")
        .flatten()
        .filter(|file| file.path().extension().is_some_and(|end| end == "inp"))
    {
        std::fs::copy(file.path(), folder.path().join(file.file_name())).expect("a copy");
    }
    std::fs::write(folder.path().join("scene.toml"), changed).expect("writable");
    let mut command = hypercircle(folder.path(), ["certify", "scene.toml", "--displacement"]);
    let output = run({
        command.arg(inputs.join(field)).args(["--solution", "--quiet", "--out", "out"]);
        command
    });
    let report = std::fs::read(folder.path().join("out/report.json")).unwrap_or_else(|_| panic!("{}", said(&output)));
    let report: Value = serde_json::from_slice(&report).expect("JSON");
    assert_eq!(output.status.code(), Some(1), "{}", said(&output));
    let findings = report["diagnosis"][0]["findings"].as_array().cloned().unwrap_or_default();
    findings.first().and_then(|finding| finding["name"].as_str()).unwrap_or("none").to_string()
}

/// What the model has and the scene lacks is named with the side that it is on; loads and temperatures by what is wrong with them.
#[test]
fn conditions_that_the_scene_lacks_and_temperatures_are_named() {
    let same = |text: &str| text.to_string();
    let without = |part: &'static str| {
        move |text: &str| {
            let (before, after) = text.split_once(part).unwrap_or_else(|| panic!("no {part}"));
            before.to_string() + after
        }
    };
    let replaced = |old: &'static str, new: &'static str| {
        move |text: &str| {
            assert!(text.contains(old), "{old}");
            text.replace(old, new)
        }
    };
    let pressure = "[[tractions]]\non=\"TOP\"\npressure=5.0\n";
    let springs = "[[supports]]\non=\"BOT\"\ntype=\"spring\"\nstiffness=[3000.0,1000.0]\n";
    let missing = named("two_loads", "two_loads.vtu", without(pressure));
    assert!(missing.starts_with("boundary/") && missing.ends_with("/forces"), "{missing}");
    let sprung = named("on_springs", "on_springs.vtu", without(springs));
    assert!(sprung.starts_with("boundary/") && sprung.ends_with("/springs"), "{sprung}");
    let lifted = |text: &str| text.replace("[0.0,-30.0]", "[0.0,30.0]").replace("[0.0,-10.0]", "[0.0,10.0]");
    assert_eq!(named("two_loads", "two_loads.vtu", lifted), "bodies/body_force");
    let flat = replaced("gradient=[15.0,-10.0]}\n[bodies.RIGHT]", "gradient=[0.0,0.0]}\n[bodies.RIGHT]");
    assert_eq!(named("on_springs", "on_springs.vtu", flat), "body/LEFT/temperature");
    let warmer = replaced("value=20.0", "value=40.0");
    assert_eq!(named("on_springs", "on_springs.vtu", warmer), "bodies/temperature");
    assert_eq!(named("layer", "layer.dat", same), "kinematics/thickness-strain");
    assert_eq!(named("mean_temperature", "mean_temperature.dat", same), "temperature/mean");
}
