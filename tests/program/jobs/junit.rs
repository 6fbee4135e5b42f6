//! `junit.xml` against the schema that Jenkins' plugin has for it (junit-10.xsd of jenkinsci/xunit-plugin).

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

use super::place::{LOOSE, Place};
use crate::command::ended;

/// Elements with the attributes they may have, those they must have in front, and the elements they stand in.
const ELEMENTS: [(&str, &[&str], usize, &[&str]); 9] = [
    ("testsuites", &["name", "time", "tests", "failures", "errors"], 0, &[""]),
    (
        "testsuite",
        &["name", "tests", "failures", "errors", "group", "time", "skipped", "timestamp", "hostname", "id", "package"],
        4,
        &["testsuites", "testsuite"],
    ),
    ("properties", &[], 0, &["testsuite"]),
    ("property", &["name", "value"], 2, &["properties"]),
    ("testcase", &["name", "time", "classname", "group"], 1, &["testsuite"]),
    ("failure", &["type", "message"], 0, &["testcase"]),
    ("error", &["type", "message"], 0, &["testcase"]),
    ("system-out", &[], 0, &["testsuite", "testcase"]),
    ("system-err", &[], 0, &["testsuite", "testcase"]),
];

#[track_caller]
fn assert_element(element: &BytesStart<'_>, within: &str) {
    let name = String::from_utf8(element.name().as_ref().to_vec()).expect("Unicode");
    let (_, allowed, required, parents) =
        ELEMENTS.iter().find(|(known, ..)| *known == name).unwrap_or_else(|| panic!("an element {name}"));
    assert!(parents.contains(&within), "{name} in {within}");
    let attributes: Vec<(String, String)> = element
        .attributes()
        .map(|a| {
            let a = a.expect("well-formed");
            let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).expect("Unicode");
            (text(a.key.as_ref()), text(&a.value))
        })
        .collect();
    for (key, value) in &attributes {
        assert!(allowed.contains(&key.as_str()), "attribute {key} of {name}");
        let digits = value.chars().all(|c| c.is_ascii_digit() || c == '.' && key == "time");
        assert!(digits || !["time", "tests", "failures", "errors"].contains(&key.as_str()), "{key}=\"{value}\"");
    }
    for key in &allowed[..*required] {
        assert!(attributes.iter().any(|(k, _)| k == key), "{name} without {key}");
    }
}

#[track_caller]
pub fn assert_valid_for_jenkins(text: &str) {
    let mut reader = Reader::from_str(text);
    let mut open: Vec<String> = vec![String::new()];
    loop {
        let within = open.last().expect("the document").clone();
        match reader.read_event().expect("well-formed") {
            Event::Start(element) => {
                assert_element(&element, &within);
                open.push(String::from_utf8(element.name().as_ref().to_vec()).expect("Unicode"));
            }
            Event::Empty(element) => assert_element(&element, &within),
            Event::End(_) => drop(open.pop()),
            Event::Eof => break,
            _ => {}
        }
    }
    assert_eq!(open.len(), 1, "every element is closed");
}

#[test]
fn the_file_of_one_scene_is_valid_and_has_its_time() {
    let place = Place::with(&["a"]);
    place.write("scenes/loose.toml", LOOSE);
    ended("a", &place.run(&["solve", "scenes/a.toml", "--out", "a"]), 0, &[]);
    ended("loose", &place.run(&["solve", "scenes/loose.toml", "--out", "loose"]), 5, &[]);
    for name in ["a", "loose"] {
        assert_valid_for_jenkins(&place.read(&format!("{name}/junit.xml")));
    }
    let seconds = place.json("a/report.json")["provenance"]["seconds"]["total"].as_f64().expect("a number");
    assert!(place.read("a/junit.xml").contains(&format!("time=\"{seconds:.3}\"")), "the time of the whole scene");
}
