//! Decks in the manner of the manual.

mod assemblies;
mod files;
mod surfaces;

use std::path::Path;

use super::parse;
use crate::mesh::RawMesh;

/// Two quadrilaterals on (0, 2) × (0, 1): nodes 1 to 3 below, 4 to 6 above.
const NODES: &str = "*NODE\n1, 0, 0\n2, 1, 0\n3, 2, 0\n4, 0, 1\n5, 1, 1\n6, 2, 1\n";
const CELLS: &str = "1, 1, 2, 5, 4\n2, 2, 3, 6, 5\n";

fn read(text: &str) -> RawMesh {
    read_with_notes(text).0
}

/// The mesh, and the notes on what was left out.
fn read_with_notes(text: &str) -> (RawMesh, Vec<String>) {
    let (raw, notes) = parse(text.as_bytes(), Path::new("deck.inp")).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let notes = notes.into_iter().map(|note| note.text).filter(|text| !text.contains("cut into triangles"));
    (raw, notes.collect())
}

/// A deck of one part of two cells: of elements `kind`, with `sets` behind them.
fn plate(kind: &str, sets: &str) -> String {
    format!("{NODES}*ELEMENT, TYPE={kind}, ELSET=E\n{CELLS}{sets}")
}

/// The points of a node set, in order of their numbers.
#[track_caller]
fn points(raw: &RawMesh, set: &str) -> Vec<[f64; 2]> {
    let (_, nodes) = raw.sets.nodes.iter().find(|(name, _)| name == set).unwrap_or_else(|| panic!("no set {set}"));
    nodes.iter().map(|&v| raw.points[v]).collect()
}

/// The ends of the sides of a surface.
#[track_caller]
fn sides(raw: &RawMesh, surface: &str) -> Vec<[[f64; 2]; 2]> {
    let found = raw.sets.surfaces.iter().find(|(name, _)| name == surface);
    let (_, sides) = found.unwrap_or_else(|| panic!("no surface {surface}"));
    sides.iter().map(|side| side.map(|v| raw.points[v])).collect()
}

/// The heights of the centres of the triangles of a name.
fn heights(raw: &RawMesh, name: &str) -> Vec<f64> {
    let height = |t: &[usize; 3]| t.iter().map(|&v| raw.points[v][1]).sum::<f64>() / 3.0;
    let own = raw.triangles.iter().filter(|(_, of)| of == name).map(|(t, _)| height(t));
    let lists = raw.shared.iter().filter(|list| list.names.iter().any(|of| of == name));
    own.chain(lists.flat_map(|list| list.triangles.iter().map(height))).collect()
}

#[track_caller]
fn refused(text: &str, fragments: &[&str]) {
    let message = parse(text.as_bytes(), Path::new("deck.inp")).expect_err("a bad deck").to_string();
    for fragment in fragments {
        assert!(message.contains(fragment), "'{fragment}' is not in: {message}");
    }
}

const SQUARES: &str = "*HEADING\na deck\n** a comment\n*Node, nset=ALL\n1, 0., 0.\n2, 1., 0.\n3, 1., 1.\n4, 0., 1.D0, 0.\n7, 2, 0\n8, 2, 1\n\
    *ELEMENT, TYPE=CPE4R, ELSET=Left\n11, 1, 2,\n3, 4\n*ELEMENT, TYPE=CPE3\n12, 2, 7, 8\n13, 2, 8, 3\n\
    *ELSET, ELSET=Right, GENERATE\n12, 13, 1\n*NSET, NSET=bottom\n1, 2, 7\n*NSET, NSET=both\nBOTTOM, 8\n\
    *SURFACE, NAME=side\nLeft, S4\n*SURFACE, NAME=top, TYPE=ELEMENT\n11, S3\n13, S2\n*STEP\n*NODE\n99, x\n";

#[test]
fn nodes_elements_sets_and_surfaces_are_read() {
    let raw = read(SQUARES);
    assert_eq!(raw.points.len(), 6);
    assert_eq!(raw.points[3], [0.0, 1.0]);
    let count = |name: &str| raw.triangles.iter().filter(|(_, n)| n == name).count();
    assert_eq!((count("Left"), count("Right")), (2, 2));
    let set = |name: &str| &raw.sets.nodes.iter().find(|(n, _)| n == name).expect("a set").1;
    assert_eq!((set("ALL").len(), set("bottom"), set("both").len()), (6, &vec![0, 1, 4], 4));
    let surface = |name: &str| &raw.sets.surfaces.iter().find(|(n, _)| n == name).expect("a surface").1;
    assert_eq!((surface("side"), surface("top")), (&vec![[3, 0]], &vec![[2, 3], [5, 2]]));
}

#[test]
fn instances_put_parts_in_their_places() {
    let raw = read(
        "*PART, NAME=P\n*NODE\n1, 0, 0\n2, 1, 0\n3, 0, 1\n*ELEMENT, TYPE=CPS3, ELSET=E\n1, 1, 2, 3\n*NSET, NSET=N\n1, 2\n*END PART\n\
         *ASSEMBLY, NAME=A\n*INSTANCE, NAME=one, PART=P\n*END INSTANCE\n*INSTANCE, NAME=two, PART=p\n0, 0, 0\n0, 0, 0, 0, 0, 1, 90.\n\
         *END INSTANCE\n*NSET, NSET=base, INSTANCE=TWO\n1, 2\n*ELSET, ELSET=_s_S1, INSTANCE=two, INTERNAL\n1\n\
         *SURFACE, TYPE=ELEMENT, NAME=s\n_s_S1, S1\n*END ASSEMBLY\n",
    );
    let at = |v: usize| raw.points[v];
    let base = &raw.sets.nodes.iter().find(|(n, _)| n == "base").expect("a set").1;
    assert!(at(base[1])[0].abs() < 1e-12 && (at(base[1])[1] - 1.0).abs() < 1e-12, "{:?}", at(base[1]));
    assert_eq!(raw.sets.surfaces[0].1, [[base[0], base[1]]]);
    assert_eq!(raw.points.len(), 6);
    let near = |p: [f64; 2]| raw.points.iter().any(|q| (p[0] - q[0]).hypot(p[1] - q[1]) < 1e-12);
    assert!(near([0.0, 1.0]) && near([-1.0, 0.0]), "{:?}", raw.points);
    let names: Vec<_> = raw.shared.iter().map(|list| list.names.join(" ")).collect();
    assert_eq!(names, ["E one", "E two _s_S1"]);
}

#[test]
fn what_is_wrong_is_told_with_its_line() {
    refused("", &["no keyword"]);
    refused("1, 2\n*NODE\n", &["line 1", "before the first keyword"]);
    refused("*NODE\n1, a, 0\n", &["line 2", "'a'", "number"]);
    refused("*NODE\n1, 0, 0\n*ELEMENT, TYPE=C3D8\n1, 1\n", &["line 3", "C3D8", "in space"]);
    let solids = "*NODE\n1, 0, 0\n*ELEMENT, TYPE=C3D4\n1, 1, 1, 1, 1\n2, 1, 1, 1, 1\n";
    refused(solids, &["line 3", "C3D4", "2 of them here"]);
    refused("*NODE\n1, 0, 0\n*ELEMENT, TYPE=XY3\n1, 1\n", &["line 3", "XY3", "not known"]);
    refused("*NODE\n1, 0, 0\n*ELEMENT, TYPE=CPE4\n1, 1, 1, 1\n", &["line 4", "3 nodes, not 4"]);
    refused("*NODE\n1, 0, 0\n2, 1, 0\n*ELEMENT, TYPE=CPE3\n1, 1, 2, 5\n", &["element 1", "node 5"]);
    refused("*INCLUDE, INPUT=none.inp\n", &["line 1", "none.inp", "not there"]);
    refused("*NODE\n1, 0, 0\n*NGEN\n1, 2\n", &["line 3", "NGEN"]);
    refused("*NODE\n1, 0, 0\n", &["no plane element"]);
}
