//! Every scene in `cases/`, end to end: both models, the comparison, the report. What is asserted comes from closed
//! formulas and from statics by hand.

mod causes;
mod curved;
mod degrees;
mod discs;
mod elastic_contact;
mod exact;
mod failures;
mod formulas;
mod half_planes;
mod near_vertices;
mod own_solver;
mod quadrilaterals;
mod repeatable;
mod revolved;
mod run;
mod sabotage;
mod statics;

/// A case nobody asserts would be decoration.
#[test]
fn every_case_is_asserted_and_listed() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("cases");
    let list = std::fs::read_to_string(folder.join("README.md")).expect("the list of cases");
    let tests = [
        include_str!("exact.rs"),
        include_str!("statics.rs"),
        include_str!("half_planes.rs"),
        include_str!("curved.rs"),
        include_str!("quadrilaterals.rs"),
        include_str!("revolved.rs"),
        include_str!("formulas.rs"),
    ]
    .concat();
    let mut count = 0;
    for entry in std::fs::read_dir(folder).expect("readable") {
        let path = entry.expect("readable").path();
        if path.extension().is_some_and(|e| e == "toml") {
            let name = path.file_stem().and_then(|n| n.to_str()).expect("a plain name");
            assert!(list.contains(&format!("`{name}.toml`")), "{name} is not in README.md");
            assert!(tests.contains(&format!("(\"{name}\"")), "{name} is in no test");
            let text = std::fs::read_to_string(&path).expect("readable");
            assert!(text.starts_with("# "), "{name} does not begin by saying what it shows");
            count += 1;
        }
    }
    assert!(count >= 13, "{count} cases");
}
