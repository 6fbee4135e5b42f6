//! `ci/stale`: which generated pages are older than the code they speak of.

use std::path::Path;
use std::process::Command;

/// The standard output of a command in `folder`, and whether it ended well.
fn printed(folder: &Path, program: &str, words: &[&str]) -> (bool, String) {
    let mut command = Command::new(program);
    let author = [("NAME", "Somebody"), ("EMAIL", "somebody@localhost")];
    for (name, value) in author {
        command.env(format!("GIT_AUTHOR_{name}"), value).env(format!("GIT_COMMITTER_{name}"), value);
    }
    let output = command.args(words).current_dir(folder).output().expect("it starts");
    (output.status.success(), String::from_utf8_lossy(&output.stdout).into_owned())
}

#[test]
fn pages_older_than_their_code_are_told_and_missing_stamps_fail() {
    let folder = tempfile::tempdir().expect("a folder");
    let (root, here) = (Path::new(env!("CARGO_MANIFEST_DIR")), folder.path());
    let git = |words: &[&str]| {
        let (ended, said) = printed(here, "git", words);
        assert!(ended, "git {words:?}: {said}");
        said.trim().to_string()
    };
    let commit = |file: &str, text: &str| {
        std::fs::write(here.join(file), text).expect("writable");
        git(&["add", "--all"]);
        git(&["commit", "--quiet", "--no-gpg-sign", "--message", file]);
        git(&["rev-parse", "--short=7", "HEAD"])
    };
    let stale = || printed(here, "/usr/bin/python3", &["ci/stale"]);

    // A tree with the folders and pages that the script names, and every page of one commit.
    let script = std::fs::read_to_string(root.join("ci/stale")).expect("part of the repository");
    let quoted: Vec<&str> =
        script.split('\'').filter(|word| word.contains('/') && !word.contains([' ', '{', '\n'])).collect();
    for name in quoted.iter().filter(|name| root.join(name).exists()) {
        let made = here.join(name);
        match root.join(name).is_dir() {
            true => std::fs::create_dir_all(&made).expect("a new folder"),
            false => std::fs::create_dir_all(made.parent().expect("a folder")).expect("a new folder"),
        }
        if !made.is_dir() {
            std::fs::copy(root.join(name), made).expect("writable");
        }
    }
    for example in ["adaptive", "hp", "theory"] {
        std::fs::write(here.join(format!("examples/{example}_rates.rs")), "").expect("writable");
    }
    git(&["init", "--quiet"]);
    std::fs::create_dir_all(here.join("ci")).expect("a new folder");
    let first = commit("ci/stale", &script);
    let stamped = |text: String| {
        let words: Vec<&str> = text.split("commit `").collect();
        let others = words[1..].iter().map(|rest| format!("commit `{first}{}", &rest[7..]));
        format!("{}{}", words[0], others.collect::<String>())
    };
    let pages: Vec<&&str> = quoted.iter().filter(|name| name.ends_with(".md")).collect();
    assert!(pages.len() > 5, "{pages:?}");
    for page in &pages {
        let text = std::fs::read_to_string(here.join(page)).expect("just written");
        std::fs::write(here.join(page), stamped(text)).expect("writable");
    }
    commit("notes", "");
    let (ended, said) = stale();
    assert!(ended && said.contains(&format!("docs/chart.md: chart of {first}")), "{said}");
    assert!(!said.contains("has changed"), "{said}");

    commit("src/dual/changed.rs", "// changed");
    let (ended, said) = stale();
    assert!(ended && said.contains("docs/chart.md: chart of") && said.contains("has changed once"), "{said}");

    let cost = std::fs::read_to_string(here.join("docs/cost.md")).expect("a page");
    commit("docs/cost.md", &cost.replace(&first, "0123456"));
    let (ended, said) = stale();
    assert!(!ended && said.contains("docs/cost.md") && said.contains("none of this history"), "{said}");
    commit("docs/cost.md", &cost.replace("Made at", "Thought of at"));
    let (ended, said) = stale();
    assert!(!ended && said.contains("docs/cost.md: `Made at commit"), "{said}");
}
