//! Sides by their labels, and surfaces without sides.

use super::{plate, points, read, read_with_notes, refused, sides};

const BELOW: [[[f64; 2]; 2]; 2] = [[[0.0, 0.0], [1.0, 0.0]], [[1.0, 0.0], [2.0, 0.0]]];
const ABOVE: [[[f64; 2]; 2]; 2] = [[[1.0, 1.0], [0.0, 1.0]], [[2.0, 1.0], [1.0, 1.0]]];

#[test]
fn sides_of_shells_are_counted_behind_their_faces() {
    for kind in ["S4", "S4R", "M3D4"] {
        for labels in [["S3", "S4", "S5", "S6"], ["E1", "E2", "E3", "E4"]] {
            let surfaces: String =
                (1..).zip(labels).map(|(n, label)| format!("*SURFACE, NAME=s{n}\nE, {label}\n")).collect();
            let raw = read(&plate(kind, &surfaces));
            assert_eq!((sides(&raw, "s1"), sides(&raw, "s3")), (BELOW.to_vec(), ABOVE.to_vec()), "{kind}");
            assert_eq!(sides(&raw, "s2"), [[[1.0, 0.0], [1.0, 1.0]], [[2.0, 0.0], [2.0, 1.0]]], "{kind}");
            assert_eq!(sides(&raw, "s4"), [[[0.0, 1.0], [0.0, 0.0]], [[1.0, 1.0], [1.0, 0.0]]], "{kind}");
        }
    }
    let triangle =
        "*NODE\n1, 0, 0\n2, 1, 0\n3, 0, 1\n*ELEMENT, TYPE=S3, ELSET=E\n1, 1, 2, 3\n*SURFACE, NAME=s\nE, S5\n";
    assert_eq!(sides(&read(triangle), "s"), [[[0.0, 1.0], [0.0, 0.0]]]);
    refused(&triangle.replace("S5", "S6"), &["line 8", "element 1 is a triangular shell", "no such side"]);
}

#[test]
fn sides_of_plane_elements_are_counted_from_one() {
    let raw = read(&plate(
        "CPE4",
        "*SURFACE, NAME=s\nE, S1\n*SURFACE, NAME=t\nE, S3\n*SURFACE, NAME=all\n1\n*SURFACE, NAME=any\n,\n",
    ));
    assert_eq!((sides(&raw, "s"), sides(&raw, "t")), (BELOW.to_vec(), ABOVE.to_vec()));
    assert_eq!((sides(&raw, "all").len(), sides(&raw, "any").len()), (4, 8));
    refused(&plate("CPE4", "*SURFACE, NAME=s\nE, S5\n"), &["line 12", "element 1 is a quadrilateral"]);
}

#[test]
fn a_face_is_no_edge_and_an_unknown_label_an_error() {
    for (kind, label) in [("CPS4", "SP"), ("CPS4", "SNEG"), ("S4", "SPOS"), ("S4", "S1"), ("S4R", "s2")] {
        let (raw, notes) = read_with_notes(&plate(kind, &format!("*SURFACE, NAME=Flat\nE, {label}\n")));
        assert_eq!(sides(&raw, "Flat"), [[[0.0; 2]; 2]; 0], "{kind} {label}");
        assert!(notes.len() == 1 && notes[0].contains("Flat"), "{kind} {label}: {notes:?}");
    }
    for label in ["S7", "S0", "E5", "TOP", "X1", "3"] {
        let deck = plate("S4", &format!("*SURFACE, NAME=s\nE, {label}\n"));
        refused(&deck, &["line 12", &format!("'{label}'"), "E1 to E4"]);
    }
}

#[test]
fn a_surface_of_lines_is_these_lines() {
    let lines = "*ELEMENT, TYPE=T2D2, ELSET=B\n11, 1, 2\n12, 2, 3\n*SURFACE, NAME=s\nB\n*SURFACE, NAME=t\nB, SPOS\n*SURFACE, NAME=u\nB, END1\n";
    let raw = read(&plate("CPE4", lines));
    assert_eq!((sides(&raw, "s"), sides(&raw, "t")), (BELOW.to_vec(), BELOW.to_vec()));
    assert!(sides(&raw, "u").is_empty());
}

#[test]
fn surfaces_are_combined() {
    let one = "*SURFACE, NAME=all\nE,\n*SURFACE, NAME=low\nE, S1\n*SURFACE, NAME=high\nE, S3\n";
    let more = "*SURFACE, NAME=u, COMBINE=UNION\nlow, HIGH\n*SURFACE, NAME=i, COMBINE=Intersection\nall, low\n\
                *SURFACE, NAME=d, COMBINE=DIFFERENCE\nu, low\n*SURFACE, NAME=one, COMBINE=UNION\nall\n";
    let raw = read(&plate("CPE4", &format!("{more}{one}")));
    assert_eq!(sides(&raw, "u"), [BELOW, ABOVE].concat());
    assert_eq!((sides(&raw, "i"), sides(&raw, "d")), (BELOW.to_vec(), ABOVE.to_vec()));
    assert_eq!(sides(&raw, "one").len(), 8);
    refused(&plate("CPE4", "*SURFACE, NAME=u, COMBINE=SUM\nlow\n"), &["line 11", "COMBINE=SUM"]);
    refused(&plate("CPE4", "*SURFACE, NAME=u, TYPE=NONE\nlow\n"), &["line 11", "TYPE=NONE"]);
}

#[test]
fn rigid_surfaces_without_elements_are_left_out_with_a_note() {
    for (kind, data) in [
        ("SEGMENTS", "START, 5., 0.\n LINE, -5., 0.\n"),
        ("segments", "START, 0., 0.\nCIRCL, 1., 1., 0., 1.\n"),
        ("CYLINDER", "0., 0., 1.\nSTART, 5., 0.\n"),
        ("REVOLUTION", "0., 0., 1., 0., 0., 2.\nSTART, 5., 0.\n"),
    ] {
        let (raw, notes) =
            read_with_notes(&plate("CPE4", &format!("*SURFACE, TYPE={kind}, NAME=Rig\n{data}*NSET, NSET=N\n1\n")));
        assert!(raw.sets.surfaces.is_empty());
        assert_eq!(points(&raw, "N"), [[0.0, 0.0]]);
        assert!(notes.len() == 1 && notes[0].contains("Rig"), "{notes:?}");
    }
}

#[test]
fn rigid_cells_beside_elastic_ones_are_left_out_with_a_note() {
    let (raw, notes) = read_with_notes(&plate("CPE4", "*ELEMENT, TYPE=R3D3, ELSET=Tool\n7, 1, 2, 4\n"));
    assert_eq!(raw.triangles.len() + raw.shared.iter().map(|list| list.triangles.len()).sum::<usize>(), 4);
    assert!(notes.len() == 1 && notes[0].contains("R3D3"), "{notes:?}");
}

#[test]
fn a_surface_of_nodes_beside_a_set_of_its_name_does_not_add_to_it() {
    let (raw, notes) = read_with_notes(&plate("CPE4", "*NSET, NSET=N\n1, 2\n*SURFACE, TYPE=NODE, NAME=N\n3\n"));
    assert_eq!(points(&raw, "N"), [[0.0, 0.0], [1.0, 0.0]]);
    assert!(notes.len() == 1 && notes[0].contains('N'), "{notes:?}");
}
