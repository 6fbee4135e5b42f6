//! Both models on files of many programs.

use crate::command::{hypercircle, run, said};
use crate::plates::{scene, written};

#[test]
fn both_models_agree_on_the_cells_of_many_programs() {
    let folder = tempfile::tempdir().expect("a folder");
    let Some(decks) = written(folder.path()) else { return };
    let mut scenes = Vec::new();
    for file in ["text.vtu", "medit.mesh", "skfem_quad.json", "getfem_triangle6.mesh", "CPE8_space.frd", "CPE4.inp"] {
        let Some(deck) = decks.iter().find(|deck| deck["file"] == file) else { continue };
        scenes.push(format!("{}.toml", file.replace('.', "_")));
        std::fs::write(folder.path().join(scenes.last().expect("one")), scene(deck)).expect("writable");
    }
    assert!(scenes.len() >= 3, "{scenes:?}");
    let args: Vec<&str> = ["verify", "--quiet"].into_iter().chain(scenes.iter().map(String::as_str)).collect();
    let output = run(hypercircle(folder.path(), &args));
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
}
