//! Files of many programs go in as they are and are solved, to one energy.

use serde_json::Value;

use crate::command::{hypercircle, run, said};
use crate::plates::{scene, written};

#[test]
fn decks_of_many_programs_are_solved_as_they_are() {
    let folder = tempfile::tempdir().expect("a folder");
    let Some(decks) = written(folder.path()) else { return };
    assert!(decks.len() >= 20, "{} decks", decks.len());
    let mut scenes = Vec::new();
    for (i, deck) in decks.iter().enumerate() {
        scenes.push(format!("{i:02}.toml"));
        std::fs::write(folder.path().join(&scenes[i]), scene(deck)).expect("writable");
    }
    let args: Vec<&str> = ["solve", "--quiet"].into_iter().chain(scenes.iter().map(String::as_str)).collect();
    let output = run(hypercircle(folder.path(), &args));
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    let energies: Vec<[f64; 2]> = (0..decks.len())
        .map(|i| {
            let report = std::fs::read(folder.path().join(format!("out/{i:02}/report.json"))).expect("a report");
            let report: Value = serde_json::from_slice(&report).expect("JSON");
            assert_eq!(report["energy"]["guaranteed"], true, "{}", decks[i]);
            ["lower", "upper"].map(|end| report["energy"][end].as_f64().expect("a number"))
        })
        .collect();
    // Two meshes: cells cut along one diagonal, and those of GetFEM's simplices along the other. Files keep six digits at least.
    for (deck, [lower, upper]) in decks.iter().zip(&energies) {
        let known = [[-0.1797504, -0.172019], [-0.1761653, -0.1722733]];
        let is_of = |[l, u]: [f64; 2]| (lower - l).abs() < 2e-6 && (upper - u).abs() < 2e-6;
        assert!(known.into_iter().any(is_of), "{deck}: {lower} {upper}");
    }
}
