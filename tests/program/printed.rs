//! What README and docs show of the program's output, compared with what it prints, digit by digit.

use std::path::Path;

use crate::command::{case, hypercircle, run, said};

/// The page `name` of the repository.
fn page(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
    std::fs::read_to_string(path).expect("part of the repository")
}

/// What stands in the first block in `language` of `text`, and the text behind it.
fn block<'a>(text: &'a str, language: &str) -> (&'a str, &'a str) {
    let (_, rest) = text.split_once(&format!("```{language}\n")).expect("a block");
    rest.split_once("```").expect("an end of the block")
}

/// Solves `scene` and asserts that the program prints every line of `shown`, in this order.
#[track_caller]
fn prints(scene: &str, shown: &str) {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("scene.toml"), scene).expect("writable");
    let output = run(hypercircle(folder.path(), ["solve", "scene.toml"]));
    assert!(output.status.success(), "{}", said(&output));
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(
        !shown.trim().is_empty() && printed.contains(shown),
        "the page has\n{shown}\nthe program prints\n{printed}"
    );
}

#[test]
fn the_quantities_of_the_readme_are_those_of_the_program() {
    let readme = page("README.md");
    let (_, section) = readme.split_once("## Answers, not energies").expect("a section");
    let (quantities, rest) = block(section, "toml");
    let blocks = std::fs::read_to_string(case("two_blocks")).expect("part of the repository");
    prints(&format!("{blocks}\n{quantities}"), block(rest, "text").0);
}

#[test]
fn the_verdict_of_the_python_page_is_that_of_the_program() {
    let python = page("docs/python.md");
    let (_, section) = python.split_once("## A scene and its bounds").expect("a section");
    let (program, rest) = block(section, "python");
    let scene = program.split("\"\"\"").nth(1).expect("a scene in the program");
    prints(scene, block(rest, "text").0);
}
