//! Files that gmsh wrote, and what becomes of them when they are damaged.

use std::path::Path;

use proptest::prelude::*;

use super::parse;
use crate::mesh::RawMesh;

fn fixture(name: &str) -> Vec<u8> {
    std::fs::read(crate::in_repository("tests/meshes").join(name)).expect("a fixture")
}

fn read(name: &str) -> RawMesh {
    let (raw, notes) = parse(&fixture(name), Path::new(name)).expect("a good file");
    assert!(notes.is_empty());
    raw
}

#[track_caller]
fn refuse(bytes: &[u8], fragments: &[&str]) {
    let message = parse(bytes, Path::new("bad.msh")).expect_err("a bad file").to_string();
    for fragment in ["mesh file bad.msh"].iter().chain(fragments) {
        assert!(message.contains(fragment), "'{fragment}' is not in: {message}");
    }
}

/// Every segment under every name of its own.
fn segments(raw: &RawMesh) -> Vec<([usize; 2], &str)> {
    let shared = raw.shared.iter().flat_map(|list| {
        list.segments.iter().flat_map(|segment| list.names.iter().map(|name| (*segment, name.as_str())))
    });
    raw.segments.iter().map(|(segment, name)| (*segment, name.as_str())).chain(shared).collect()
}

/// Cells by their coordinates, so that numbering does not matter.
fn shape(raw: &RawMesh) -> (Vec<String>, Vec<String>) {
    let text = |vertices: &[usize], name: &str| {
        let points: Vec<String> =
            vertices.iter().map(|&v| raw.points[v].map(|x| format!("{x:.9}")).join(" ")).collect();
        format!("{name}: {}", points.join(", "))
    };
    let mut triangles: Vec<String> = raw.triangles.iter().map(|(t, name)| text(t, name)).collect();
    let mut segments: Vec<String> = segments(raw).iter().map(|(s, name)| text(s, name)).collect();
    triangles.sort();
    segments.sort();
    (triangles, segments)
}

const BLOCKS: [&str; 5] = [
    "two_blocks_41.msh",
    "two_blocks_41_binary.msh",
    "two_blocks_22.msh",
    "two_blocks_22_binary.msh",
    "two_blocks_40.msh",
];
const SHARED: [&str; 5] = [
    "shared_curve_41.msh",
    "shared_curve_41_binary.msh",
    "shared_curve_22.msh",
    "shared_curve_22_binary.msh",
    "shared_curve_40.msh",
];

#[test]
fn every_version_gives_the_same_mesh() {
    for files in [BLOCKS, SHARED] {
        let first = shape(&read(files[0]));
        for other in &files[1..] {
            assert_eq!(shape(&read(other)), first, "{other}");
        }
    }
    let raw = read(BLOCKS[0]);
    let area = |body: &str| -> f64 {
        let cells = raw.triangles.iter().filter(|(_, name)| name == body);
        cells
            .map(|(t, _)| {
                let [a, b, c] = t.map(|v| raw.points[v]);
                0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
            })
            .sum()
    };
    assert!((area("left") - 1.0).abs() < 1e-12 && (area("right") - 1.0).abs() < 1e-12);
    let count = |name: &str| raw.segments.iter().filter(|(_, n)| n == name).count();
    assert_eq!((count("left_face"), count("right face"), count("77"), count("wall")), (2, 3, 2, 3));
    let shared = read(SHARED[0]);
    let on = |name: &str| segments(&shared).iter().filter(|(_, n)| *n == name).count();
    assert_eq!((on("face"), on("opposite")), (2, 2), "a curve in two groups has both names");
}

#[test]
fn straight_quadratic_triangles_lose_their_mid_nodes() {
    let name = "shared_curve_quadratic_41.msh";
    let (raw, notes) = parse(&fixture(name), Path::new(name)).expect("a good file");
    assert_eq!(shape(&raw), shape(&read(SHARED[0])));
    assert!(notes[0].text.contains("mid-nodes"));
    let text = String::from_utf8(fixture(name)).expect("text");
    let curved = text.replacen("\n0.2499999999994194 0 0\n", "\n0.25 0.01 0\n", 1);
    assert_ne!(curved, text);
    let (raw, notes) = parse(curved.as_bytes(), Path::new(name)).expect("a good file");
    assert_eq!(shape(&raw), shape(&read(SHARED[0])));
    assert!(notes[1].weakens_guarantee && notes[1].text.contains("1 curved side") && notes[1].text.contains("1.00e-2"));
}

/// A binary file turned into the other byte order.
fn turned(bytes: &[u8]) -> Vec<u8> {
    // Only MSH 2.2 is simple enough to turn by its fixed layout: 4-byte numbers but for the coordinates.
    let find =
        |text: &str| bytes.windows(text.len()).position(|w| w == text.as_bytes()).expect("a section") + text.len();
    let mut out = bytes.to_vec();
    let mark = find("2.2 1 8\n");
    out[mark..mark + 4].reverse();
    let line_end = |from: usize| from + bytes[from..].iter().position(|b| *b == b'\n').expect("a line") + 1;
    let count = |from: usize| -> usize {
        String::from_utf8_lossy(&bytes[from..line_end(from)]).trim().parse().expect("a count")
    };
    let nodes = find("$Nodes\n");
    let mut at = line_end(nodes);
    for _ in 0..count(nodes) {
        for width in [4, 8, 8, 8] {
            out[at..at + width].reverse();
            at += width;
        }
    }
    let elements = find("$Elements\n");
    let mut at = line_end(elements);
    while !bytes[at..].starts_with(b"\n$End") && !bytes[at..].starts_with(b"$End") {
        out[at..at + 4].reverse();
        at += 4;
    }
    out
}

#[test]
fn big_endian_files_read_the_same() {
    let other = turned(&fixture(BLOCKS[3]));
    assert_ne!(other, fixture(BLOCKS[3]));
    let (raw, _) = parse(&other, Path::new("big.msh")).expect("a good file");
    assert_eq!(raw, read(BLOCKS[3]));
}

#[test]
fn files_that_are_refused() {
    let v4 = String::from_utf8(fixture(BLOCKS[0])).expect("text");
    let v2 = String::from_utf8(fixture(BLOCKS[2])).expect("text");
    let edit = |text: &str, from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        text.replacen(from, to, 1).into_bytes()
    };
    refuse(b"", &["empty", "save it as MSH 4.1"]);
    refuse(b" \n\n", &["empty"]);
    refuse(b"$NOD\n1\n1 0 0 0\n$ENDNOD\n", &["the section $ELM is missing", "truncated"]);
    refuse(&edit(&v4, "4.1 0 8", "5 0 8"), &["$MeshFormat, line 2", "MSH version 5;", "save it as"]);
    refuse(&edit(&v4, "4.1 0 8", "3.0 0 8"), &["MSH version 3.0"]);
    refuse(&edit(&v4, "4.1 0 8", "4.0 0 8"), &["$Entities, line", "write it again"]);
    refuse(&edit(&v4, "4.1 0 8", "4.1 0 16"), &["data size is '16'"]);
    refuse(&edit(&v4, "4.1 0 8", "four"), &["found 'four'"]);
    refuse(b"(0 \"GAMBIT\")", &["no Gmsh file"]);
    refuse(&edit(&v4, "\n18 32 1 32", "\n18 33 1 32"), &["$Nodes", "announces 33 nodes", "have 32"]);
    refuse(&edit(&v4, "\n18 32 1 32", "\n17 32 1 32"), &["$Nodes", "announces 32 nodes"]);
    refuse(&edit(&v4, "\n18 32 1 32", "\n99999999999999999 32 1 32"), &["$Nodes, line", "whole number"]);
    refuse(&edit(&v4, "\n2 1 0 0 0", "\n2 one 0 0 0"), &["$Entities, line 17", "'one' where a number should be"]);
    refuse(&edit(&v4, "$EndNodes", "$EndNode"), &["'$EndNode' where $EndNodes should be"]);
    refuse(&edit(&v4, "1 3 \"left_bottom\"", "1 3 left_bottom"), &["$PhysicalNames", "\"name\" should be"]);
    let nodes = v2.find("$Elements").expect("a section");
    refuse(&v2.as_bytes()[..nodes], &["section $Elements is missing", "truncated"]);
    refuse(&edit(&v2, "\n1 0 0 0\n", "\n1 0 0 0.5\n"), &["(0, 0, 0.5)", "plane z = 0"]);
    refuse(&edit(&v2, "\n2 1 0 0\n", "\n1 1 0 0\n"), &["$Nodes, line", "node 1 is there twice"]);
    refuse(&edit(&v2, "\n2 1 0 0\n", "\n99 1 0 0\n"), &["uses node 2, which is not among its nodes"]);
    refuse(&edit(&v2, "\n2 1 0 0\n", "\n2 inf 0 0\n"), &["node 2", "not finite"]);
    refuse(&edit(&v2, "\n2 1 0 0\n", "\n2 1 0\n"), &["$Nodes, line", "node 1 is there twice"]);
    let quads =
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n0\n$EndNodes\n$Elements\n1\n1 3 2 1 1 1 2 3 4\n$EndElements\n";
    refuse(
        quads.replace("1 3 2", "1 21 2").as_bytes(),
        &["$Elements, line 9", "third or higher order", "first or second"],
    );
    refuse(quads.replace("1 3 2", "1 4 2").as_bytes(), &["cells in space: 1 × tetrahedron", "save the surfaces"]);
    let binary = fixture(BLOCKS[1]);
    refuse(&binary[..binary.len() / 2], &["byte ", "truncated"]);
    refuse(&fixture(BLOCKS[3])[..1500], &["byte ", "truncated"]);
    let old = fixture(BLOCKS[3]);
    let section = old.windows(10).position(|w| w == b"$Elements\n").expect("a section") + 10;
    // After the line with the count: element type, length of the run, number of tags.
    let run = section + old[section..].iter().position(|b| *b == b'\n').expect("a line") + 1 + 4;
    for wrong in [0_i32, -1, 1_000_000] {
        let mut bytes = old.clone();
        bytes[run..run + 4].copy_from_slice(&wrong.to_le_bytes());
        refuse(&bytes, &["$Elements, byte", "a run of", "write it again"]);
    }
    let mark = b"4.1 1 8\n".len() + b"$MeshFormat\n".len();
    let mut marked = binary;
    marked[mark] = 7;
    refuse(&marked, &["byte order mark", "write it again"]);
}

#[test]
fn a_byte_order_mark_is_skipped_and_a_deck_is_read() {
    for name in [BLOCKS[2], BLOCKS[0]] {
        let bytes = [&[0xEF, 0xBB, 0xBF], fixture(name).as_slice()].concat();
        assert_eq!(parse(&bytes, Path::new(name)).expect("a mark").0, read(name));
    }
    let wide: Vec<u8> = "\u{feff}$MeshFormat\n".encode_utf16().flat_map(u16::to_le_bytes).collect();
    refuse(&wide, &["UTF-16", "UTF-8"]);
    // CalculiX GraphiX: send all abq.
    let deck = "*NODE, NSET=Nall\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n*ELEMENT, TYPE=CPS4, ELSET=Eall\n1,1,2,3,4\n";
    for text in [deck.to_owned(), format!("** written by cgx\n{deck}"), format!("\u{feff}\n{deck}")] {
        let raw = parse(text.as_bytes(), Path::new("all.msh")).expect("a deck").0;
        assert_eq!((raw.points.len(), raw.triangles.len()), (4, 2));
        assert!(raw.triangles.iter().all(|(_, name)| name == "Eall"));
    }
    refuse(deck.replace("1,1,2,3,4", "1,1,2,3").as_bytes(), &["line 7", "3 nodes, not 4"]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    #[test]
    fn a_truncated_file_is_refused_without_panic(file in prop::sample::select([BLOCKS, SHARED].concat()), part in 0.0..1.0f64) {
        let bytes = fixture(file);
        // The last line may lose its end of line and still be whole.
        let length = (part * (bytes.len() - 2) as f64) as usize;
        prop_assert!(parse(&bytes[..length], Path::new("cut.msh")).is_err());
    }

    #[test]
    fn damaged_bytes_never_panic(
        file in prop::sample::select([BLOCKS, SHARED].concat()),
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
    ) {
        let mut bytes = fixture(file);
        for (place, value) in damage {
            let at = place.index(bytes.len());
            bytes[at] = value;
        }
        // Either outcome is right: what matters is that there is one.
        if let Ok((raw, _)) = parse(&bytes, Path::new("damaged.msh")) {
            let highest = raw.triangles.iter().flat_map(|(t, _)| t).max();
            prop_assert!(highest.is_none_or(|v| *v < raw.points.len()));
        }
    }
}

/// The unit square beside another, a triangle in each half, by version 1: the number of nodes stands in the rows, and names are numbers.
#[test]
fn the_oldest_version_has_numbers_for_names() {
    let rows =
        "1 1 21 4 2 1 4\n2 15 30 1 1 1\n3 3 11 1 4 1 2 5 4\n4 2 -12 2 3 2 3 6\n5 9 12 2 6 2 6 5 7 8 9\n6 2 0 3 3 2 5 1";
    let nodes = "1 0 0 0\n2 1 0 0\n3 2 0 0\n4 0 1 0\n5 1 1 0\n6 2 1 0\n7 1.5 0.5 0\n8 1.5 1 0\n9 1 0.5 0";
    let text = format!("$NOD\n9\n{nodes}\n$ENDNOD\n$ELM\n6\n{rows}\n$ENDELM\n");
    let (raw, _) = parse(text.as_bytes(), Path::new("old.msh")).expect("a mesh");
    let names: Vec<&str> = raw.triangles.iter().map(|(_, name)| name.as_str()).collect();
    assert_eq!(names, ["11", "11", "12", "12", ""]);
    assert_eq!(raw.segments, [([0, 3], "21".to_string())]);
    assert!(raw.sets.entities.iter().any(|entity| (entity.dimension, entity.tag) == (2, 3)));
    for (from, to, fragments) in [
        ("4 2 -12 2 3 2 3 6", "4 2 -12 2 4 2 3 6 5", ["$ELM, line 18", "type 2, which has 3 nodes, and has 4"]),
        ("$ENDELM\n", "", ["$ELM", "the file ends here"]),
        ("\n6 2 0 3 3 2 5 1", "", ["$ELM", "'$ENDELM' where a count should be"]),
        ("2 1 0 0\n", "2 1 q 0\n", ["$NOD, line 4", "'q'"]),
        ("4 2 -12", "4 77 -12", ["element type 77", "unknown"]),
        ("$NOD\n", "$PARA\n1\n$ENDPARA\n$NOD\n", ["this is no Gmsh file", "$PARA"]),
    ] {
        refuse(text.replace(from, to).as_bytes(), &fragments);
    }
    refuse(&text.as_bytes()[..text.find("$ELM").expect("elements")], &["the section $ELM is missing"]);
}

/// Two triangles of one surface in two partitions, and the line between these.
fn partitioned(parts: &str, elements: &str) -> String {
    format!(
        "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n1 21 \"wall\"\n2 3000000000 \"plate\"\n$EndPhysicalNames\n\
         $Entities\n0 1 1 0\n4 0 0 0 0 1 0 1 21 0\n4000000000 0 0 0 1 1 0 1 3000000000 0\n$EndEntities\n$PartitionedEntities\n2\n1\n9 1\n{parts}$EndPartitionedEntities\n\
         $Nodes\n1 4 1 4\n2 7 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n$EndNodes\n$Elements\n{elements}$EndElements\n$GhostElements\n1\n1 1 1 2\n$EndGhostElements\n"
    )
}

#[test]
fn parts_of_an_entity_are_in_the_groups_of_their_parent() {
    let parts = "0 2 2 0\n6 1 4 1 1 0 0 0 0 1 0 0 0\n8 2 4000000000 2 1 2 0 0 0 1 1 0 0 0\n7 2 4000000000 1 1 0 0 0 1 1 0 0 0\n8 2 4000000000 1 2 0 0 0 1 1 0 0 0\n";
    let elements = "4 4 1 4\n1 6 1 1\n1 4 1\n1 8 1 1\n2 1 3\n2 7 2 1\n3 1 2 3\n2 8 2 1\n4 1 3 4\n";
    let text = partitioned(parts, elements);
    let (raw, _) = parse(text.as_bytes(), Path::new("parts.msh")).expect("a mesh");
    assert!(raw.triangles.iter().all(|(_, name)| name == "plate") && raw.triangles.len() == 2, "{:?}", raw.triangles);
    assert_eq!(raw.segments, [([3, 0], "wall".to_string())]);
    // Tags with ten digits are names, and no tags of a scene.
    let tags: Vec<(i32, i32)> = raw.sets.entities.iter().map(|entity| (entity.dimension, entity.tag)).collect();
    assert_eq!(tags, [(1, 4)]);
    assert_eq!(raw.sets.numbers.keys().collect::<Vec<_>>(), [&(1, 21)]);
    let nameless = text.replace("2\n1 21 \"wall\"\n2 3000000000 \"plate\"", "1\n1 21 \"wall\"");
    let (raw, _) = parse(nameless.as_bytes(), Path::new("parts.msh")).expect("a mesh");
    assert!(raw.triangles.iter().all(|(_, name)| name == "3000000000"), "{:?}", raw.triangles);
    // A file for each partition has the others' entities without their elements.
    let split = partitioned(parts, "3 3 1 4\n1 6 1 1\n1 4 1\n1 8 1 1\n2 1 3\n2 7 2 1\n3 1 2 3\n");
    refuse(split.as_bytes(), &["no elements of 1 of the 2 parts", "PartitionSplitMeshFiles"]);
    refuse(
        text.replace("\n8 2 4000000000 1 2", "\n7 2 4000000000 1 2").as_bytes(),
        &["$PartitionedEntities", "the part 7 of dimension 2"],
    );
    refuse(
        text.replace("0 2 2 0\n6 1", "0 2 3 0\n6 1").as_bytes(),
        &["$PartitionedEntities, line 23", "'$EndPartitionedEntities'"],
    );
}
