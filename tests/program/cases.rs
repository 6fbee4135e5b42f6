//! `hypercircle cases`: the list, runs and verdicts, exit codes, and the table of docs/cases.md.

use std::path::Path;
use std::process::Output;

use crate::command::{ended, hypercircle, run};

fn cases(folder: &Path, arguments: &[&str]) -> Output {
    run(hypercircle(folder, [&["cases"], arguments].concat()))
}

fn told(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// Rows of a table of Markdown that begin with `case`.
fn rows(text: &str, case: &str) -> Vec<Vec<String>> {
    let of_case = |row: &Vec<String>| row.first().is_some_and(|first| first == case);
    let cells = |line: &str| line.trim_matches('|').split(" | ").map(|cell| cell.trim().replace('\\', "")).collect();
    text.lines().filter(|line| line.starts_with('|')).map(cells).filter(of_case).collect()
}

fn ends(interval: &str) -> [f64; 2] {
    let mut ends = interval.split(" … ").map(|end| end.replace('−', "-").parse().expect("a number"));
    std::array::from_fn(|_| ends.next().expect("two ends"))
}

#[test]
fn the_list_names_every_scene_of_the_folder_and_writes_nothing() {
    let place = tempfile::tempdir().expect("a folder");
    let list = cases(place.path(), &[]);
    ended("the list", &list, 0, &[]);
    let told = told(&list);
    for entry in std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/published")).expect("readable") {
        let path = entry.expect("an entry").path();
        let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
        assert!(name == "index" || told.lines().any(|line| line.starts_with(&format!("{name} "))), "{name}\n{told}");
    }
    assert_eq!(std::fs::read_dir(place.path()).expect("readable").count(), 0);
    ended("no such case", &cases(place.path(), &["cooks"]), 2, &["there is no case 'cooks'", "cook, kirsch"]);
    ended("names and all", &cases(place.path(), &["cook", "--all"]), 2, &[]);
}

#[test]
fn numbers_are_judged_and_the_table_of_the_documentation_is_theirs() {
    let place = tempfile::tempdir().expect("a folder");
    let folder = place.path();
    let edge = cases(folder, &["edge_crack", "--out", "edge"]);
    ended("edge_crack", &edge, 0, &[]);
    assert!(told(&edge).contains("2 published numbers judged: all agree within their accuracy."), "{}", told(&edge));
    // 23.96 is none of the values that the middle of the edge can have.
    let cook = cases(folder, &["cook", "--out", "cook", "-q"]);
    ended("cook", &cook, 1, &[]);
    assert!(told(&cook).is_empty());
    let documented =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/cases.md")).expect("a page");
    for (name, out) in [("edge_crack", "edge"), ("cook", "cook")] {
        let table = std::fs::read_to_string(folder.join(out).join("cases.md")).expect("a table");
        let (found, expected) = (rows(&table, name), rows(&documented, name));
        assert!(!found.is_empty() && found.len() == expected.len(), "{name}");
        for (mut found, mut expected) in found.into_iter().zip(expected) {
            // Another processor may round the last digits differently.
            let [a, b] = [&mut found, &mut expected].map(|row| ends(&row.remove(4)));
            assert!(
                (0..2).all(|end| (a[end] - b[end]).abs() < 0.05 * (b[1] - b[0])),
                "{name}: {a:?}, documented {b:?}"
            );
            let [a, b] = [&mut found, &mut expected].map(|row| row.remove(4));
            let kind = |words: &str| words.split(' ').next().map(str::to_string);
            assert_eq!((kind(&a), found), (kind(&b), expected), "{name}");
        }
        // What it leaves can be run again.
        assert!(folder.join(out).join(name).join("report.html").is_file());
        let again = run(hypercircle(&folder.join(out), ["solve", &format!("{name}.toml"), "-q", "--out", "again"]));
        ended(name, &again, 0, &[]);
    }
}

#[test]
fn what_was_not_reached_is_not_passed() {
    let place = tempfile::tempdir().expect("a folder");
    let output = cases(place.path(), &["centre_crack", "--max-seconds", "1e-6"]);
    ended("no time", &output, 1, &[]);
    assert!(told(&output).contains("not decided"), "{}", told(&output));
    assert!(place.path().join("out/cases/centre_crack/report.json").is_file());
}
