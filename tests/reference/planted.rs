//! Bugs in the displacement model and lies about its results do not pass for agreement. `ci/planted` plants all there are,
//! in more scenes; here are some of each kind.

use std::path::Path;
use std::sync::Mutex;

use crate::command::{PROGRAM, case, with_reference};
use crate::support::planted::{Fate, Soil, kinds};

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
