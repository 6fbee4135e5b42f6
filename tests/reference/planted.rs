//! Bugs in the displacement model and lies about its results do not pass for agreement. `ci/planted` plants all there are,
//! in more scenes; here are some of each kind.

use std::path::Path;
use std::sync::Mutex;

use crate::command::{PROGRAM, case, with_reference};
use crate::support::planted::{Fate, Soil, kinds};
use crate::support::toml::Toml;

/// The fate of each fault of `names` in the case `scene`.
fn plant(scene: &str, names: &[&str]) -> Vec<(String, Fate)> {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = case(scene);
    let soil = Soil::new(Path::new(PROGRAM), &scene, folder.path()).expect("agreement");
    let known = kinds();
    let kind =
        |name: &&str| known.iter().find(|k| k.name == **name).unwrap_or_else(|| panic!("no fault {name}")).clone();
    let queue = Mutex::new(names.iter().map(kind).collect::<Vec<_>>());
    let fates = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                loop {
                    let Some(kind) = queue.lock().expect("unpoisoned").pop() else { break };
                    let planted = soil.plant(&kind, 0, None);
                    fates.lock().expect("unpoisoned").push((kind.name, planted.fate));
                }
            });
        }
    });
    fates.into_inner().expect("unpoisoned")
}

#[test]
fn bugs_in_the_displacement_model_are_caught() {
    if with_reference() {
        let bugs = ["modulus", "thickness", "clamp_missing_on_an_edge", "load_larger", "vertex_moved", "kinematics"];
        for (name, fate) in plant("two_blocks", &bugs) {
            assert!(matches!(fate, Fate::Caught(_)), "{name}: {fate:?}");
        }
        for (name, fate) in plant("gap", &["displacement_larger", "gap_larger", "triangle_of_another_body"]) {
            assert!(matches!(fate, Fate::Caught(_)), "{name}: {fate:?}");
        }
        for (name, fate) in plant("gravity", &["weight_missing", "weight_sideways"]) {
            assert!(matches!(fate, Fate::Caught(_)), "{name}: {fate:?}");
        }
    }
}

#[test]
fn lies_about_the_result_are_caught() {
    if with_reference() {
        let lies = [
            "one_displacement",
            "one_midpoint",
            "everything_larger",
            "energy_lower",
            "not_a_number",
            "reaction_at_a_foreign_vertex",
            "reactions_permuted",
            "linear_for_quadratic",
        ];
        for (name, fate) in plant("two_blocks", &lies) {
            assert!(matches!(fate, Fate::Caught(_)), "{name}: {fate:?}");
        }
    }
}

#[test]
fn what_changes_nothing_is_not_held_against_the_model() {
    if with_reference() {
        // The two blocks are of one material, and the contact is open where the gap is widened.
        for (name, fate) in plant("two_blocks", &["triangle_of_another_body", "gap_larger"]) {
            assert_eq!(fate, Fate::WithoutEffect, "{name}");
        }
    }
}

/// A block on springs under a hood that a layer holds, both of them warm, and a lid on an elastic contact that an eccentric load lifts.
fn scene_of_laws() -> String {
    Toml::default()
        .size(0.3)
        .outline("a", &[[0.0, 0.0], [1.0, 0.0], [1.0, 0.6], [0.0, 0.6]], &["foot", "east", "over", "side"])
        .outline("b", &[[0.0, 0.6], [1.0, 0.6], [1.0, 1.2], [0.0, 1.2]], &["under", "wall", "cover", ""])
        .outline("c", &[[0.0, 1.2], [1.0, 1.2], [1.0, 1.7], [0.0, 1.7]], &["sole", "guide", "top", ""])
        .material("a", 5.0, 0.3)
        .matter(
            "b",
            "orthotropic = { young = [6.0, 2.0, 3.0], poisson = [0.2, 0.25, 0.3], shear = 1.1, angle = 25.0 }\n\
             expansion = [0.01, 0.02, 0.01]\ntemperature = { value = 2.0, gradient = [0.5, 1.0] }",
        )
        .loaded("a", "body_force = { value = [0.05, -0.1], gradient = [[0.1, 0.2], [-0.1, 0.05]] }")
        .loaded("b", "body_force = [0.0, 0.0]")
        .material("c", 3.0, 0.2)
        .force("c", [0.0, -0.05])
        .roller("guide")
        .table("[[tractions]]\non = \"top\"\nvalue = [0.0, -0.6]\ngradient = [[0.0, 0.0], [1.0, 0.0]]")
        .table("[[supports]]\non = \"foot\"\ntype = \"spring\"\nstiffness = [4.0, 1.5]")
        .table("[[supports]]\non = \"wall\"\ntype = \"spring\"\nstiffness = 2.0")
        .table("[[bonds]]\nbetween = [\"over\", \"under\"]\nstiffness = [7.0, 3.0]")
        .table("[[contacts]]\nbetween = [\"cover\", \"sole\"]\nstiffness = 5.0")
        .table("[[contacts]]\non = \"east\"\ngap = [[0.0, 0.0], [0.6, 0.02]]\nstiffness = 3.0")
        .text()
}

/// Three mistakes a law: each is caught, and the diagnosis names it.
#[test]
fn mistakes_in_every_law_are_named() {
    if !with_reference() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let scene = folder.path().join("laws.toml");
    std::fs::write(&scene, scene_of_laws()).expect("writable");
    let soil = Soil::new(Path::new(PROGRAM), &scene, folder.path()).expect("agreement");
    let known = kinds();
    let mistakes = [
        ("springs_softer", "support/"),
        ("springs_missing_along", "support/foot/tangential"),
        ("springs_both_ways", "support/wall/tangential"),
        ("layer_stiffer", "bond/over|under/stiffness"),
        ("layer_swapped", "bond/over|under/stiffness"),
        ("layer_slides", "bond/over|under/tangential"),
        ("elastic_contact_stiffer", "contact/cover|sole/stiffness"),
        ("elastic_contact_pulls", "contact/cover|sole/pulling"),
        ("elastic_contact_gap_ignored", "contact/east|rigid/gap"),
        ("temperature_missing", "body/b/temperature"),
        ("temperature_of_other_sign", "body/b/temperature"),
        ("temperature_larger", "body/b/temperature"),
        ("axes_swapped", "body/b/axes"),
        ("law_mirrored", "body/b/angle-sign"),
        ("law_stiffer", "body/b/stiffness"),
        ("slope_missing", "body/a/gradient"),
        ("slope_transposed", "body/a/gradient"),
        ("varying_force_larger", "body/a/body_force"),
    ];
    let (queue, wrong) = (Mutex::new(mistakes.to_vec()), Mutex::new(String::new()));
    let plant_all = || {
        loop {
            let Some((name, named)) = queue.lock().expect("unpoisoned").pop() else { break };
            let kind = known.iter().find(|kind| kind.name == name).unwrap_or_else(|| panic!("no fault {name}"));
            let planted = soil.plant(kind, 0, None);
            let found = planted.findings.iter().any(|finding| finding.starts_with(named));
            if !matches!(planted.fate, Fate::Caught(_)) || !found {
                let text = format!("{name}: {:?}, {:?}\n", planted.fate, planted.findings);
                wrong.lock().expect("unpoisoned").push_str(&text);
            }
        }
    };
    std::thread::scope(|scope| (0..2).for_each(|_| drop(scope.spawn(plant_all))));
    let wrong = wrong.into_inner().expect("unpoisoned");
    assert!(wrong.is_empty(), "\n{wrong}");
}
