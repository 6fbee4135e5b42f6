//! Text meshes of COMSOL by hand, in the manner of its manual: the plate of `mesh_formats` goes in as it is, and what is no plane mesh is refused.

use crate::mesh_formats::{Folder, LIMIT, check, refused, rows};
use hypercircle::mesh::inventory::Inventory;

/// A type of elements: name, nodes, and entities.
fn elements(name: &str, rows: &[&[usize]], entities: &[usize]) -> String {
    let lines = |list: &[usize]| list.iter().map(|n| format!("{n} ")).collect::<String>() + "\n";
    let nodes: String = rows.iter().map(|row| lines(row)).collect();
    let entities: String = entities.iter().map(|n| lines(&[*n])).collect();
    format!(
        "# Type\n\n{} {name} # type name\n\n\n{} # number of vertices per element\n{count} # number of elements\n# Elements\n{nodes}\n{count} # number of geometric entity \
         indices\n# Geometric entity indices\n{entities}\n",
        name.len(),
        rows[0].len(),
        count = rows.len()
    )
}

fn file(dimension: usize, points: &str, types: &[String], objects: &str) -> String {
    format!(
        "# Created by COMSOL Multiphysics.\n\n# Major & minor version\n0 1 \n1 # number of tags\n# Tags\n5 mesh1 \n1 # number of types\n# Types\n3 obj \n\n# --------- Object 0 ----------\n\n\
         0 0 1 \n4 Mesh # class\n4 # version\n{dimension} # sdim\n{} # number of mesh vertices\n0 # lowest mesh vertex index\n\n# Mesh vertex coordinates\n{points}\n\
         {} # number of element types\n\n{}{objects}",
        points.lines().count(),
        types.len(),
        types.concat()
    )
}

fn selection(label: &str, dimension: usize, entities: &[usize]) -> String {
    let list: String = entities.iter().map(|n| format!("{n} \n")).collect();
    format!(
        "# --------- Object ----------\n\n0 0 1 \n9 Selection # class\n0 # Version\n{} {label} # Label\n5 mesh1 # Geometry/mesh tag\n{dimension} # Dimension\n{} # Number of entities\n# Entities\n{list}\n",
        label.chars().count(),
        entities.len()
    )
}

/// Corners of quadrilaterals go row by row; domains count from one, boundaries from zero.
fn plate() -> String {
    let types = [
        elements("vtx", &[&[0], &[2]], &[0, 1]),
        elements("edg", &[&[0, 3], &[2, 5]], &[4, 0]),
        elements("tri", &[&[1, 2, 5], &[1, 5, 4]], &[2, 2]),
        elements("quad", &[&[0, 1, 3, 4]], &[1]),
    ];
    file(2, &rows(|_, [x, y]| format!("{x} {y} \n")), &types, "")
}

#[test]
fn entities_and_selections_are_names() {
    let folder = Folder::new();
    check(&folder.write("plate.mphtxt", plate()), &["1", "2"], ["5", "1"]);
    check(&folder.write("plate.txt", plate().replace('\n', "\r\n")), &["1", "2"], ["5", "1"]);
    // The second letter of the name has a byte that is an end of line in Latin-1.
    let named = plate()
        + &selection("Plåte хх", 2, &[1, 2])
        + &selection("Wall # 1", 1, &[4])
        + &selection("load", 1, &[0])
        + &selection("corner", 0, &[0]);
    check(&folder.write("named.mphtxt", named), &["Plåte хх"], ["Wall # 1", "load"]);
    // An older version, with places of nodes on their entities and domains on both sides.
    let old = plate()
        .replace("4 # version", "1 # version")
        .replace("vertices per element", "nodes per element")
        .replace("1 # number of geometric entity indices", "4 # number of parameter values per element\n1 # number of parameters\n# Parameters\n0 0 1 0.5 7 0 1 1\n\n1 # number of domains")
        .replace("2 # number of geometric entity indices", "2 # number of parameter values per element\n0 # number of parameters\n# Parameters\n\n2 # number of domains");
    let pairs = old.split("# Type\n").map(|part| part.to_string()).collect::<Vec<_>>();
    let old = pairs
        .iter()
        .enumerate()
        .map(|(i, part)| {
            if i == 0 { part.clone() } else { format!("# Type\n{part}1 # number of up/down pairs\n# Up/down\n1 0\n\n") }
        })
        .collect::<String>();
    check(&folder.write("old.mphtxt", old), &["1", "2"], ["5", "1"]);
}

/// A quadrilateral of nine nodes and a triangle of six, each with one side that is curved.
#[test]
fn second_order_meshes() {
    let folder = Folder::new();
    let points = |bow: f64| {
        let list = [
            [0.0, 0.0],
            [1.0, 0.0],
            [0.0, 1.0],
            [1.0, 1.0],
            [0.5, 0.0],
            [0.0 - bow, 0.5],
            [0.5, 0.5],
            [1.0, 0.5],
            [0.5, 1.0],
            [2.0, 0.0],
            [1.5, 0.0],
            [1.5, 0.5 + bow],
        ];
        list.map(|[x, y]: [f64; 2]| format!("{x} {y}\n")).concat()
    };
    let types = [
        elements("edg2", &[&[0, 2, 5]], &[0]),
        elements("tri2", &[&[1, 9, 3, 10, 7, 11]], &[1]),
        elements("quad2", &[&[0, 1, 2, 3, 4, 5, 6, 7, 8]], &[1]),
    ];
    for (bow, curved) in [(0.0, None), (0.1, Some("2 curved sides"))] {
        let found =
            Inventory::read(&folder.write("plate.mphtxt", file(2, &points(bow), &types, "")), LIMIT).expect("a mesh");
        let notes: String = found.notes.iter().map(|note| note.text.clone()).collect();
        assert!((found.bodies[0].area - 1.5).abs() < 1e-12 && found.boundaries.len() == 1, "{:?}", found.bodies);
        assert!(notes.contains("mid-nodes of 2 second-order cells"), "{notes}");
        assert_eq!(notes.contains("curved"), curved.is_some_and(|told| notes.contains(told)), "{bow}: {notes}");
    }
}

#[test]
fn meshes_that_are_not_plane_or_not_whole_are_refused() {
    let folder = Folder::new();
    let good = plate();
    let tetrahedron = file(3, "0 0 0\n1 0 0\n0 1 0\n0 0 1\n", &[elements("tet", &[&[0, 1, 2, 3]], &[1])], "");
    let again = &good[good.find("0 0 1 \n4 Mesh").expect("an object")..];
    for (name, text, fragments) in [
        ("half.mphtxt", good[..good.len() / 2].to_string(), &["cut off"][..]),
        ("end.mphtxt", good[..good.len() - 4].to_string(), &["cut off"]),
        ("letters.mphtxt", good.replace("1 5 4 \n", "1 q 4 \n"), &["line 72", "'q' stands where a whole number"]),
        ("missing.mphtxt", good.replace("1 5 4 \n", "1 5 44 \n"), &["node 44"]),
        (
            "entities.mphtxt",
            good.replace(
                "1 # number of geometric entity indices\n# Geometric entity indices\n1 \n",
                "2 # number of geometric entity indices\n1 \n1\n",
            ),
            &["1 elements 'quad' and geometric entities of 2"],
        ),
        ("cubic.mphtxt", good.replace("4 quad", "5 quad3"), &["elements 'quad3' of 4 nodes"]),
        ("solid.mphtxt", tetrahedron, &["cells in space: 1 × tetrahedron"]),
        ("twice.mphtxt", format!("{good}{again}"), &["several meshes", "mesh.parts"]),
        ("shape.mphtxt", good.replace("4 Mesh # class", "5 Geom2 # class"), &["holds a Geom2 and no mesh"]),
        ("other.mphtxt", "some words\n".into(), &["cut off"]),
    ] {
        refused(&folder, name, &text, fragments);
    }
    refused(&folder, "plate.mphbin", "x", &["export the mesh as text (.mphtxt)"]);
}
