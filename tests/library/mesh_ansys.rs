//! Archives of Ansys MAPDL by hand, in the manner of its manual: the plate of `mesh_formats` goes in as it is, and what is no plane mesh is refused.

use crate::mesh_formats::{Folder, LIMIT, check, refused, rows, scene};
use hypercircle::mesh::inventory::{Inventory, starting_scene};
use hypercircle::problem::Problem;
use hypercircle::scene::{Kinematics, Scene};

/// A number in the 21 columns that Fortran gives it.
fn real(x: f64) -> String {
    format!("{:>21}", format!("{x:.13}E+00"))
}

/// A row of NBLOCK.
fn node(n: usize, [x, y]: [f64; 2]) -> String {
    format!("{n:9}{:9}{:9}{}{}\n", 0, 0, real(x), real(y))
}

fn nblock(count: usize, more: &str) -> String {
    let rows = rows(node);
    format!("NBLOCK,6,SOLID,{count:10},{count:10}\n(3i9,6e21.13e3)\n{rows}{more}N,R5.3,LOC,       -1,\n")
}

/// A row of EBLOCK: material, type, number and nodes; what is behind eight nodes stands in the next line.
fn element([material, of, number]: [usize; 3], nodes: &[usize]) -> String {
    let head = [material, of, 1, 1, 0, 0, 0, 0, nodes.len(), 0, number];
    let columns = |list: &[usize]| list.iter().map(|n| format!("{n:9}")).collect::<String>();
    let (first, rest) = nodes.split_at(nodes.len().min(8));
    let more = if rest.is_empty() { String::new() } else { columns(rest) + "\n" };
    format!("{}{}\n{more}", columns(&head), columns(first))
}

fn eblock(elements: &[String]) -> String {
    format!("EBLOCK,19,SOLID,{0:10},{0:10}\n(19i9)\n{1}{2:9}\n", elements.len(), elements.concat(), -1)
}

/// The plate in quadrilaterals, two of them with the last node twice, and lines of surface elements on its ends.
fn archive(types: &str, more: &str) -> String {
    let cells = [
        element([3, 1, 1], &[1, 2, 5, 4]),
        element([3, 1, 2], &[2, 3, 6, 6]),
        element([4, 1, 7], &[2, 6, 5, 5]),
        element([9, 2, 8], &[4, 1]),
        element([9, 2, 9], &[3, 6]),
    ];
    format!(
        "/COM,ANSYS RELEASE 19.4\n/PREP7\n/NOPR\nNUMOFF,NODE,  6\n{types}ET,       2,SURF153\n{}{}CMBLOCK,WALL    ,ELEM,       1  ! users element component definition\n\
         (8i10)\n{:10}\nCMBLOCK,END,NODE,2\n(8i10)\n{:10}{:10}\nCMBLOCK,ALL,ELEM,  4\n(8i10)\n{:10}{:10}{:10}{:10}\nCMBLOCK,AREAS,AREA,1\n(8i10)\n{:10}\n{more}/GO\nFINISH\n",
        nblock(6, ""),
        eblock(&cells),
        8,
        3,
        6,
        1,
        -2,
        7,
        9,
        1
    )
}

#[test]
fn archives_go_in_by_material_and_component() {
    let folder = Folder::new();
    let text = archive("ET,       1,182\nKEYOP,       1, 3,       2\n", "");
    for name in ["plate.cdb", "plate.dat", "plate.inp"] {
        check(&folder.write(name, &text), &["3", "4"], ["WALL", "END"]);
    }
    check(&folder.write("all.cdb", text), &["ALL"], ["WALL", "END"]);
    let parameters = archive("*SET,TID,  1.000000000000\nkey = 3\nET,tid,182\nKEYOPT,tid,key,2\n", "");
    check(&folder.write("parameters.dat", parameters), &["3", "4"], ["WALL", "END"]);
    // Types in a block, and elements without the word SOLID: number, type, constants, material, system, nodes.
    let types =
        "ETBLOCK,        1,        1\n(2i9,19a9)\n        1      182        0        0        2        0\n       -1\n";
    check(&folder.write("block.cdb", archive(types, "")), &["3", "4"], ["WALL", "END"]);
    let row = |list: [usize; 9]| list.map(|n| format!("{n:9}")).concat() + "\n";
    let cells =
        [[1, 1, 1, 3, 0, 1, 2, 5, 4], [2, 1, 1, 3, 0, 2, 3, 6, 6], [7, 1, 1, 4, 0, 2, 6, 5, 5]].map(row).concat();
    let nodes = rows(|n, [x, y]| format!("{n:9}{:>20}{:>20}\n", format!("{x:.9}E+000"), format!("{y:.9}E+000")));
    let short = format!(
        "/batch\n/prep7\nnblock,3\n(1i9,3e20.9e3)\n{nodes}-1\net,1,plane182\neblock,10,,,3\n(15i9)\n{cells}-1\nN,7,9,9 $ CMBLOCK,A,NODE,2\n(8i10)\n         1         4\n\
         CMBLOCK,B,NODE,2\n(8i10)\n         3         6\n"
    );
    check(&folder.write("ds.dat", short), &["3", "4"], ["A", "B"]);
    let single = rows(|n, [x, y]| format!("N,{n},{x},{y}\n"));
    let single = format!(
        "/PREP7\nET,1,42\n{single}MAT,3\nE,1,2,5,4\nE,2,3,6,6\nMAT,4\nEN,9,2,6,5\nCMBLOCK,A,NODE,2\n(8i10)\n{:10}{:10}\nCMBLOCK,B,NODE,2\n(8i10)\n{:10}{:10}\n",
        1, 4, 3, 6
    );
    refused(&folder, "three.cdb", &single, &["line 13", "element 9 has no node at corner 4"]);
    check(&folder.write("single.cdb", single.replace("2,6,5\n", "2,6,5,5\n")), &["3", "4"], ["A", "B"]);
}

/// Eight nodes with the middles of sides, one side of which is a point, and one whose middles are left out.
#[test]
fn middles_of_sides_belong_to_their_sides() {
    let folder = Folder::new();
    let middles: String =
        [(7, 0.5, 0.0), (8, 1.0, 0.5), (9, 0.5, 1.0), (10, 0.0, 0.5), (11, 1.5, 0.0), (12, 2.0, 0.5), (13, 1.5, 0.5)]
            .map(|(n, x, y)| node(n, [x, y]))
            .concat();
    let cells = [
        element([1, 1, 1], &[1, 2, 5, 4, 7, 8, 9, 10]),
        element([1, 1, 2], &[2, 3, 6, 6, 11, 12, 6, 13]),
        element([1, 1, 3], &[2, 6, 5, 5, 13, 0, 5, 8]),
    ];
    let text = format!("/PREP7\nET,1,183,,,1\n{}{}FINISH\n", nblock(13, &middles), eblock(&cells));
    let found = Inventory::read(&folder.write("plate.cdb", &text), LIMIT).expect("a mesh");
    let notes: String = found.notes.iter().map(|note| note.text.clone()).collect();
    assert!(found.bodies.len() == 1 && (found.bodies[0].area - 2.0).abs() < 1e-12, "{:?}", found.bodies);
    assert!(notes.contains("mid-nodes of 2 second-order cells") && !notes.contains("chord"), "{notes}");
    // A middle beside its side is seen.
    let curved = text.replace(&node(11, [1.5, 0.0]), &node(11, [1.5, 0.1]));
    let found = Inventory::read(&folder.write("curved.cdb", curved), LIMIT).expect("a mesh");
    assert!(found.notes.iter().any(|note| note.text.contains("1 curved side")), "{:?}", found.notes);
}

/// KEYOPT(3) says what plane elements are made for.
#[test]
fn key_options_are_kinematics() {
    let folder = Folder::new();
    for (key, kinematics) in [(0, Kinematics::PlaneStress), (1, Kinematics::Axisymmetric), (2, Kinematics::PlaneStrain)]
    {
        let path = folder.write("plate.cdb", archive(&format!("ET,1,PLANE182\nKEYOPT,1,3,{key}\n"), ""));
        let inventory = Inventory::read(&path, LIMIT).expect("a mesh");
        let started = starting_scene(&inventory, "plate.cdb", "plate");
        let started = Scene::parse(&started, &folder.0.path().join("s.toml")).expect("a scene");
        assert_eq!(started.kinematics, kinematics, "{started:?}");
        let problem = Problem::load(scene(path, &["3", "4"], ["WALL", "END"])).expect("a problem");
        let told = problem.notes.iter().any(|note| note.text.contains(&format!("PLANE182 with KEYOPT(3) = {key}")));
        assert_eq!(told, kinematics != Kinematics::PlaneStrain, "{:?}", problem.notes);
    }
}

#[test]
fn what_is_left_out_is_told() {
    let folder = Folder::new();
    let more = "ET,3,COMBIN14\nET,4,175\nTYPE,3 $ MAT,1\nE,1,4\nTYPE,4\nE,1\nESEL,S,MAT,,3\nCM,LEFT,ELEM\nCMBLOCK,LOST,NODE,3\n(8i10)\n         1       -90        99\n";
    let text = archive("ET,1,182\n", more);
    let notes = |text: &str| -> String {
        let found = Inventory::read(&folder.write("plate.cdb", text), LIMIT).expect("a mesh");
        found.notes.into_iter().map(|note| note.text + "\n").collect()
    };
    let told = notes(&text);
    for part in ["1 of type 14, 1 of type 175", "made of a selection (CM) are left out: LEFT", "'LOST' has 85 nodes"] {
        assert!(told.contains(part), "{told}");
    }
    assert!(
        !told.contains("FINISH") && notes(text.trim_end_matches("FINISH\n")).contains("does not end with FINISH"),
        "{told}"
    );
}

#[test]
fn archives_that_are_no_plane_mesh_are_refused() {
    let folder = Folder::new();
    let good = archive("ET,1,182\n", "");
    let half = &good[..good.find("CMBLOCK").expect("a component") - 30];
    for (name, text, fragments) in [
        ("half.cdb", half.to_string(), &["EBLOCK", "cut off"][..]),
        ("nodes.cdb", good[..good.find("N,R5.3").expect("an end") - 60].to_string(), &["NBLOCK", "cut off"]),
        ("fewer.cdb", good.replace("EBLOCK,19,SOLID,         5,         5", "EBLOCK,19,SOLID,         6,         6"), &["announces 6 elements and has 5"]),
        ("letters.cdb", good.replace("        2        5        4", "        2       5q        4"), &["line 18", "'5q' stands where a whole number"]),
        ("form.cdb", good.replace("(19i9)", "(nonsense)"), &["line 17", "where a format such as"]),
        ("columns.cdb", good.replace("(19i9)", "(19i8)"), &["line 18", "of the type 3, which no ET defines"]),
        ("missing.cdb", good.replace("        3        1        1        1        0        0        0        0        4        0        2        2        3        6        6", "        3        1        1        1        0        0        0        0        4        0        2        2        3       77        6"), &["node 77"]),
        ("type.cdb", good.replace("ET,1,182\n", ""), &["element 1 is of the type 1, which no ET defines"]),
        ("name.cdb", good.replace("ET,1,182", "ET,1,141"), &["Ansys's element 141", "PLANE182"]),
        ("parameter.cdb", good.replace("ET,1,182", "ET,plate,182"), &["line 5", "'plate' stands where"]),
        ("makes.cdb", good.replace("/GO", "NGEN,2,6,1,6,1,3"), &["NGEN makes nodes", "CDWRITE"]),
        ("system.cdb", good.replace("/GO", "CSYS,1\nN,9,1,90"), &["coordinate system 1", "CDWRITE"]),
        ("unblocked.cdb", good.replace("/GO", "N,R5.3,LOC,       7,  1.0"), &["not in blocks"]),
        ("empty.cdb", "/PREP7\nFINISH\n".into(), &["no node"]),
        ("cells.cdb", format!("/PREP7\n{}", nblock(6, "")), &["no cell"]),
    ] {
        refused(&folder, name, &text, fragments);
    }
    let solid = good.replace("ET,1,182", "ET,1,185").replace(
        "        4        0        1        1        2        5        4",
        "        8        0        1        1        2        5        4        1        2        6        3",
    );
    refused(&folder, "solid.cdb", &solid, &["this program is plane"]);
}
