//! Bad scenes are refused with a message that names place, fault and remedy; good ones pass; no text panics.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::malformed::MALFORMED;
use hypercircle::scene::{Draft, Gap, MeshSource, Scene, SceneError};
use miette::Diagnostic;

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/malformed").join(name)
}

fn files(name: &str) -> BTreeSet<String> {
    let entries = std::fs::read_dir(folder(name)).expect("the corpus is part of the repository");
    entries.map(|entry| entry.expect("readable").file_name().into_string().expect("plain names")).collect()
}

#[test]
fn every_malformed_scene_is_refused_in_the_right_words() {
    let mut wrong = Vec::new();
    for case in MALFORMED {
        let message = match Scene::read(&folder("scenes").join(case.file)) {
            Ok(_) => {
                wrong.push(format!("{}: accepted", case.file));
                continue;
            }
            Err(error) => error.to_string(),
        };
        let place = case.line.map_or_else(|| case.file.to_owned(), |line| format!("{}:{line}:", case.file));
        for fragment in std::iter::once(place.as_str()).chain(case.fragments.iter().copied()) {
            if !message.contains(fragment) {
                wrong.push(format!("{}: no `{fragment}` in: {message}", case.file));
            }
        }
        if message.contains('\n') {
            wrong.push(format!("{}: more than one line: {message}", case.file));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_table_and_the_folder_agree() {
    let listed: BTreeSet<String> = MALFORMED.iter().map(|case| case.file.to_owned()).collect();
    assert_eq!(listed.len(), MALFORMED.len(), "a file is listed twice");
    assert_eq!(listed, files("scenes"));
}

#[test]
fn faults_with_a_line_show_it() {
    for case in MALFORMED.iter().filter(|case| case.line.is_some()) {
        let error = Scene::read(&folder("scenes").join(case.file)).expect_err(case.file);
        let place = error.place().expect(case.file);
        assert!(error.source_code().is_some() && error.labels().is_some(), "{}", case.file);
        let length = std::fs::metadata(place.path()).expect("readable").len();
        assert!(place.span().end as u64 <= length, "{}: the place is outside the file", case.file);
    }
}

#[test]
fn a_missing_file_and_a_directory_are_named() {
    let missing = Scene::read(&folder("scenes").join("nowhere.toml")).expect_err("there is none").to_string();
    assert!(missing.contains("nowhere.toml: there is no such scene file; check the path"), "{missing}");
    let directory = Scene::read(&folder("scenes")).expect_err("a directory").to_string();
    assert!(directory.contains("this is a directory") && directory.contains("the TOML file inside it"), "{directory}");
}

#[test]
fn valid_edge_cases_pass() {
    for file in files("valid") {
        if let Err(error) = Scene::read(&folder("valid").join(&file)) {
            panic!("{file}: {error}");
        }
    }
}

fn valid(file: &str) -> Scene {
    Scene::read(&folder("valid").join(file)).expect(file)
}

#[test]
fn the_scene_is_what_the_file_says() {
    let scene = valid("base.toml");
    assert_eq!((scene.name.as_str(), scene.title.as_str(), scene.thickness), ("base", "Two blocks", 1.0));
    assert_eq!(scene.bodies.iter().map(|b| b.name.as_str()).collect::<Vec<_>>(), ["left", "right"]);
    let names: Vec<_> = scene.boundary_names_used().into_iter().map(|(name, by)| format!("{name}: {by}")).collect();
    let expected = [
        "wall: [[supports]] number 1",
        "left_bottom: [[supports]] number 2",
        "left_load: [[tractions]] number 1",
        "left_face: [[contacts]] number 1",
        "right_face: [[contacts]] number 1",
    ];
    assert_eq!(names, expected);

    let scene = valid("two_polygons_one_body.toml");
    assert_eq!(scene.title, "two_polygons_one_body");
    assert!(matches!(&scene.mesh, MeshSource::Geometry { size: None, polygons } if polygons.len() == 2));
    assert_eq!(scene.contacts[0].gap, Gap::Table(vec![[0.0, 0.125], [1.0, 0.0], [2.0, 0.125]]));
    assert_eq!(scene.contacts[0].gap.at(1.5), 0.0625);

    let scene = valid("mesh_file.toml");
    assert_eq!(scene.mesh, MeshSource::File(folder("valid").join("../meshes/blocks.msh")));
    assert_eq!(scene.bodies.iter().map(|b| b.name.as_str()).collect::<Vec<_>>(), ["upper block", "Ständer"]);
}

#[test]
fn line_endings_and_a_byte_order_mark_change_nothing_but_the_name() {
    let named = |scene: Scene| Draft { name: "base".into(), path: PathBuf::new(), ..(*scene).clone() };
    assert_eq!(named(valid("base_crlf.toml")), named(valid("base.toml")));
    assert_eq!(named(valid("base_bom.toml")), named(valid("base.toml")));
}

mod mutations {
    use proptest::prelude::*;

    use super::*;

    #[derive(Debug, Clone)]
    enum Mutation {
        DeleteBytes(usize, usize),
        DuplicateBytes(usize, usize),
        ReplaceByte(usize, u8),
        Insert(usize, &'static str),
        DeleteLine(usize),
        DuplicateLine(usize, usize),
    }

    const TOKENS: [&str; 16] = [
        "nan",
        "-inf",
        "1e999",
        "[",
        "]",
        "[[",
        "\"",
        "\"\"\"",
        "{",
        "=",
        "é",
        "\u{0}",
        "-0.0",
        "1979-05-27",
        "#",
        "\r",
    ];

    fn mutation() -> impl Strategy<Value = Mutation> {
        prop_oneof![
            (any::<usize>(), 1..20usize).prop_map(|(at, n)| Mutation::DeleteBytes(at, n)),
            (any::<usize>(), 1..20usize).prop_map(|(at, n)| Mutation::DuplicateBytes(at, n)),
            (any::<usize>(), any::<u8>()).prop_map(|(at, byte)| Mutation::ReplaceByte(at, byte)),
            (any::<usize>(), prop::sample::select(TOKENS.to_vec())).prop_map(|(at, word)| Mutation::Insert(at, word)),
            any::<usize>().prop_map(Mutation::DeleteLine),
            (any::<usize>(), any::<usize>()).prop_map(|(from, to)| Mutation::DuplicateLine(from, to)),
        ]
    }

    fn apply(bytes: &mut Vec<u8>, mutation: &Mutation) {
        if bytes.is_empty() {
            return;
        }
        let n = bytes.len();
        let range = |at: usize, length: usize| at % n..(at % n + length).min(n);
        let lines = |bytes: &[u8]| bytes.split_inclusive(|&b| b == b'\n').map(<[u8]>::to_vec).collect::<Vec<_>>();
        match *mutation {
            Mutation::DeleteBytes(at, length) => drop(bytes.drain(range(at, length))),
            Mutation::DuplicateBytes(at, length) => {
                let copy = bytes[range(at, length)].to_vec();
                bytes.splice(at % n..at % n, copy);
            }
            Mutation::ReplaceByte(at, byte) => bytes[at % n] = byte,
            Mutation::Insert(at, word) => drop(bytes.splice(at % n..at % n, word.bytes())),
            Mutation::DeleteLine(line) => {
                let mut all = lines(bytes);
                all.remove(line % all.len());
                *bytes = all.concat();
            }
            Mutation::DuplicateLine(from, to) => {
                let mut all = lines(bytes);
                let copy = all[from % all.len()].clone();
                all.insert(to % all.len(), copy);
                *bytes = all.concat();
            }
        }
    }

    /// Checks any error: it can be told, in one message, with places inside the text.
    fn tell(error: &SceneError, length: usize) -> Result<(), TestCaseError> {
        prop_assert!(!error.found().is_empty() && !error.remedy().is_empty());
        if let Some(place) = error.place() {
            prop_assert!(place.line() >= 1 && place.column() >= 1 && place.span().end <= length);
        }
        let mut report = String::new();
        let told = miette::GraphicalReportHandler::new().render_report(&mut report, error);
        prop_assert!(told.is_ok() && !report.is_empty());
        Ok(())
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(1500))]
        #[test]
        fn never_panic(file in prop::sample::select(files("valid").into_iter().collect::<Vec<_>>()),
                       mutations in prop::collection::vec(mutation(), 1..6)) {
            let path = folder("valid").join(file);
            let mut bytes = std::fs::read(&path).expect("readable");
            for mutation in &mutations {
                apply(&mut bytes, mutation);
            }
            let text = String::from_utf8_lossy(&bytes);
            if let Err(error) = Scene::parse(&text, &path) {
                tell(&error, text.len())?;
            }
        }
    }
}
