//! Statements of a run about its input and its actions: no number is taken for another, and nothing happens without a word.

use std::path::Path;
use std::process::Output;

use crate::command::{case, ended, hypercircle, run};

/// Two blocks that are asked for a displacement, in `folder`.
fn asked(folder: &Path) -> &'static str {
    let text = std::fs::read_to_string(case("two_blocks")).expect("part of the repository");
    let tip = "\n[[quantities]]\nname = \"tip\"\ndisplacement = \"left_load\"\ndirection = [1.0, 0.0]\n";
    std::fs::write(folder.join("asked.toml"), text + tip).expect("writable");
    "asked.toml"
}

fn printed(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

#[test]
fn an_error_above_one_is_no_tolerance() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = asked(folder.path());
    for options in [
        ["solve", scene, "--tolerance", "2"],
        ["solve", scene, "--tolerance-of", "tip=2"],
        ["chart", scene, "--for", "2"],
        ["chart", scene, "--for", "tip=2"],
    ] {
        let output = run(hypercircle(folder.path(), options));
        ended(&options.join(" "), &output, 2, &["200 %", "write 0.02 for 2 %"]);
    }
    assert!(!folder.path().join("out").exists());
}

#[test]
fn a_solver_that_no_method_runs_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let options = ["stability", "--method", "condensed", "--reference", "my-solver {problem} {out}"];
    ended("stability", &run(hypercircle(folder.path(), options)), 2, &["my-solver", "--method leaves FEniCSx out"]);
}

#[test]
fn a_value_is_answered_and_what_is_replaced_or_accepted_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = asked(folder.path());
    let certify = ["certify", scene, "--value", "tip=0.8014", "--baseline", "b.json", "--accept"];
    let output = run(hypercircle(folder.path(), certify));
    ended("certify", &output, 0, &[]);
    let said = printed(&output);
    assert!(said.starts_with("The value given for tip lies in its interval."), "{said}");
    assert!(said.contains("baseline: b.json holds the numbers of this run"), "{said}");
    assert!(!said.contains("in place of the report"), "{said}");

    let solve = ["solve", scene, "--refine", "1"];
    let said = printed(&run(hypercircle(folder.path(), solve)));
    assert!(
        said.starts_with("Both bounds passed every check.") && said.contains("in place of the report of `certify`"),
        "{said}"
    );
    let said = printed(&run(hypercircle(folder.path(), solve)));
    assert!(!said.contains("in place of the report"), "{said}");
}

/// One thing is not called by the plural, on the terminal, in the summary of a scene and in that of a job.
#[test]
fn one_thing_is_one_thing() {
    let folder = tempfile::tempdir().expect("a folder");
    let [gmsh, ring] = ["from_gmsh", "ring"].map(|name| case(name).display().to_string());
    let output = run(hypercircle(folder.path(), ["solve", &gmsh, &ring, "--out", "job"]));
    ended("solve", &output, 0, &[]);
    let file = |name: &str| std::fs::read_to_string(folder.path().join("job").join(name)).expect("written");
    let of_scene = ["from_gmsh", "ring"]
        .map(|name| ["summary.md", "report.html", "report.json"].map(|of| file(&format!("{name}/{of}"))));
    let texts = of_scene.into_iter().flatten().chain([printed(&output), file("summary.md"), file("index.html")]);
    for text in texts {
        for word in
            ["scenes", "checks", "remarks", "notes", "vertices", "edges", "pairs", "nodes", "quantities", "note(s)"]
        {
            let one = format!("1 {word}");
            let wrong = text
                .match_indices(&one)
                .find(|(at, _)| !text[..*at].ends_with(|c: char| c.is_ascii_digit() || ".,".contains(c)));
            let words = wrong.map_or("", |(at, _)| &text[at..]).chars().take(60).collect::<String>();
            assert!(words.is_empty(), "{words}");
        }
    }
}
