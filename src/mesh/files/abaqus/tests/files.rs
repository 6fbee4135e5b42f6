//! Data lines, encodings and included files.

use std::path::Path;

use proptest::prelude::*;

use super::{CELLS, NODES, parse, plate, points, read, refused};

#[test]
fn cylindrical_coordinates_are_converted() {
    let deck =
        "*NODE, SYSTEM=C, NSET=N\n1, 1., 0.\n2, 2., 0.\n3, 2., 90.\n4, 1., 90.\n*ELEMENT, TYPE=CPE4\n1, 1, 2, 3, 4\n";
    let found = points(&read(deck), "N");
    let expected = [[1.0, 0.0], [2.0, 0.0], [0.0, 2.0], [0.0, 1.0]];
    let near = |p: [f64; 2], q: [f64; 2]| (p[0] - q[0]).hypot(p[1] - q[1]) < 1e-12;
    assert!(found.iter().zip(expected).all(|(&p, q)| near(p, q)), "{found:?}");
    assert_eq!(read(&plate("CPE4", "").replace("*NODE", "*NODE, SYSTEM=R")), read(&plate("CPE4", "")));
    refused(&deck.replace("=C", "=S"), &["line 1", "SYSTEM=S", "rectangular"]);
}

#[test]
fn idle_elements_are_left_out_and_may_be_in_sets() {
    for kind in ["D", "COH2D4", "COHAX4", "JOINT2D", "CINPE4", "SPRINGA"] {
        let idle = format!("*ELEMENT, TYPE={kind}, ELSET=Idle\n7, 0, 1, 4,\n2, 9\n*ELSET, ELSET=All\nE, Idle\n");
        let raw = read(&plate("CPE4", &idle));
        assert_eq!(
            raw.triangles.len() + raw.shared.iter().map(|list| list.triangles.len()).sum::<usize>(),
            4,
            "{kind}"
        );
        let named: usize =
            raw.shared.iter().filter(|l| l.names.contains(&"Idle".into())).map(|l| l.triangles.len()).sum();
        assert_eq!(named, 0, "{kind}: the second line is no element of its own");
    }
    refused(
        &format!("{NODES}*ELEMENT, TYPE=SC8R\n1,1,2,5,4,1,2,5,4\n2,2,3,6,5,2,3,6,5\n"),
        &["SC8R", "in space, 2 of them"],
    );
    refused(&format!("{NODES}*ELEMENT, TYPE=SC6R\n1,1,2,5,1,2,5\n"), &["SC6R", "in space, 1 of them"]);
}

#[test]
fn two_elements_in_a_line_and_missing_nodes_are_told_with_their_line() {
    let both = format!("{NODES}*ELEMENT, TYPE=CPE4\n1, 1, 2, 5, 4, 2, 2, 3, 6, 5\n");
    refused(&both, &["line 9", "element 1", "has 4 nodes", "9 numbers"]);
    refused(&plate("CPE4", "").replace("3, 6, 5", "3, 66, 5"), &["line 10", "element 2", "node 66"]);
    // A beam has a node for its direction behind its own.
    assert_eq!(read(&plate("CPE4", "*ELEMENT, TYPE=B31, ELSET=B\n5, 1, 2, 6\n")).segments.len(), 1);
}

#[test]
fn byte_order_marks_and_ends_of_lines_do_not_matter_and_utf_16_is_named() {
    let deck = plate("CPE4", "");
    assert_eq!(read(&format!("\u{feff}{deck}")), read(&deck));
    for ends in ["\r", "\r\n"] {
        assert_eq!(read(&deck.replace('\n', ends)), read(&deck));
    }
    let wide: Vec<u8> = "\u{feff}*NODE\n1, 0, 0\n".encode_utf16().flat_map(u16::to_le_bytes).collect();
    let message = parse(&wide, Path::new("deck.inp")).expect_err("UTF-16").to_string();
    assert!(message.contains("UTF-16") && message.contains("UTF-8"), "{message}");
    refused(">** a comment\n*NODE\n", &["line 1", "before the first keyword", "'>** a comment'"]);
}

#[test]
fn data_in_a_file_of_their_own_are_told_how_to_write() {
    refused(
        &format!("*NODE, INPUT=nodes.txt\n*ELEMENT, TYPE=CPE4\n{CELLS}"),
        &["line 1", "*NODE", "*INCLUDE, INPUT=nodes.txt"],
    );
    refused(
        &format!("{NODES}*ELEMENT, TYPE=CPE4, INPUT=els.txt\n"),
        &["line 8", "*ELEMENT", "*INCLUDE, INPUT=els.txt"],
    );
}

#[test]
fn included_files_are_found_beside_and_from_the_folder_of_the_deck() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::create_dir(folder.path().join("sub")).expect("a folder");
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("a file");
    write("sub/cells.inp", &format!("*ELEMENT, TYPE=CPE4\n{CELLS}"));
    for (deck, mesh) in
        [("*INCLUDE, INPUT=sub\\mesh.inp\n", "sub/cells.inp"), ("*INCLUDE, INPUT=sub/mesh.inp\n", "cells.inp")]
    {
        write("sub/mesh.inp", &format!("{NODES}*INCLUDE, INPUT={mesh}\n"));
        let (raw, _) = parse(deck.as_bytes(), &folder.path().join("deck.inp")).expect("a deck");
        assert_eq!(raw.triangles.len(), 4, "{deck}");
    }
    write("sub/mesh.inp", "\n*INCLUDE, INPUT=none.inp\n");
    let error = parse(b"*INCLUDE, INPUT=sub/mesh.inp\n", &folder.path().join("deck.inp")).expect_err("no such file");
    let message = error.to_string();
    assert!(message.contains("line 2 of") && message.contains("sub/none.inp is not there"), "{message}");
    // What stands behind the first step is no part of the mesh.
    assert_eq!(read(&plate("CPE4", "*STEP\n*INCLUDE, INPUT=loads.inp\n")).triangles.len(), 4);
}

#[test]
fn a_keyword_behind_a_comma_is_read() {
    assert_eq!(read(&plate("CPE4", "").replace("ELSET=E\n", "ELSET=E,\n** a comment\n")).triangles.len(), 4);
    let deck = plate("CPE4", "").replace("*NODE\n", "*HEADING,\n*NODE, NSET=N\n");
    assert_eq!(points(&read(&deck), "N").len(), 6);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    #[test]
    fn damaged_decks_never_panic(damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8)) {
        let sets = "*NSET, NSET=N, GENERATE\n1, 3, 1\n*SURFACE, NAME=S\nE, S1\n*ELEMENT, TYPE=T2D3, ELSET=L\n5, 1, 2, 3\n";
        let instance = "*INSTANCE, NAME=I, PART=P\n1, 2\n0, 0, 0, 0, 0, 1, 90\n*END INSTANCE\n*NODE, SYSTEM=C\n9, 1, 90\n";
        let rest = "*SURFACE, NAME=T, COMBINE=UNION\nI.S\n*NSET, NSET=M, INSTANCE=I\nN, 4\n*ELSET, ELSET=F\nI.2\n";
        let part = plate("S8R", "").replace("1, 1, 2, 5, 4", "1, 1, 2, 5, 4, 1, 2, 5, 4");
        let mut bytes = format!("*PART, NAME=P\n{}*END PART\n{instance}{rest}", part.replace("5\n", "5, 2, 3, 6, 5\n") + sets).into_bytes();
        prop_assert!(parse(&bytes, Path::new("whole.inp")).is_ok());
        for (place, value) in damage {
            let at = place.index(bytes.len());
            bytes[at] = value;
        }
        // Either outcome is right: what matters is that there is one.
        let _ = parse(&bytes, Path::new("damaged.inp"));
    }
}
