//! Mesh files that are damaged, or no plane mesh: each is refused with its place, or goes in with a note of what it lacks.

use crate::mesh_formats::{Folder, LIMIT, scene, unv, unv_groups};
use hypercircle::mesh::inventory::Inventory;
use hypercircle::problem::Problem;

/// A node and an element that are given twice, and a group with an element that is not there.
#[test]
fn numbers_that_are_given_twice_are_refused_and_members_that_are_lost_are_told() {
    let folder = Folder::new();
    let groups = unv_groups("2467");
    let lost = unv(&groups.replacen("         8        11", "         8       999", 1));
    let (_, notes) = Inventory::read(&folder.write("lost.unv", lost), LIMIT)
        .map(|found| (found.bodies.len(), found.notes))
        .expect("an inventory");
    assert!(notes.iter().any(|note| note.text.contains("'wall side' has element 999")), "{notes:?}");
    let again = "         1         1         1        11\n    5.0D0    0.0D0    0.0D0\n";
    let node = unv(&groups).replacen("    -1\n    -1\n  2412", &format!("{again}    -1\n    -1\n  2412"), 1);
    let element = unv(&groups).replacen("        12        21", "        11        21", 1);
    let nan = unv(&groups).replacen("0.0000000000000000D+00", "nan                   ", 1);
    for (name, text, found) in [
        ("node.unv", node, "node 1 is given twice, at (0, 0, 0) and at (5, 0, 0)"),
        ("element.unv", element, "cell 11 is given twice"),
        ("nan.unv", nan, "node 1 has a coordinate that is no finite number"),
    ] {
        let path = folder.write(name, text);
        let error = Problem::load(scene(path, &["PLATE"], ["wall side", "LOAD"])).expect_err("no mesh").to_string();
        assert!(error.contains(found), "{name}: {error}");
    }
}

#[test]
fn cells_in_space_are_told_with_their_place() {
    let folder = Folder::new();
    let text = "# vtk DataFile Version 3.0\nbox\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n0 0 0\n1 0 0\n0 2 0\n0 0 3\nCELLS 1 5\n4 0 1 2 3\n\nCELL_TYPES 1\n10\n";
    let error =
        Problem::load(scene(folder.write("box.vtk", text), &["box"], ["a", "b"])).expect_err("a solid").to_string();
    assert!(error.contains("1 × tetrahedron between (0, 0, 0) and (1, 2, 3)"), "{error}");
}

#[test]
fn files_that_do_not_follow_their_format() {
    let folder = Folder::new();
    for (name, text, found) in [
        ("a.unv", "hello\n", "no dataset"),
        ("b.unv", "    -1\n  2411\n         1         1         1        11\n", "cut off"),
        ("c.unv", "    -1\n  2411\n x\n 0. 0. 0.\n    -1\n", "integers are expected"),
        ("d.msh", "3 1 0\n0 0 1\n1 0 1\n", "3 vertices, 1 triangles"),
        ("e.mesh", "BEGIN POINTS LIST\n POINT 0 0 0\n CONVEX 0 'GT_PK(2,1)' 0 1\n", "convex 0 has 2 nodes"),
        ("f.json", "{\"p\": 3}", "'p' and 't'"),
        ("g.json", "{\"p\": [[0, 0], [1, 0], [0, 1]], \"t\": [[0, 1, 7]]}", "node 7, which is not among its nodes"),
        ("h.vol", "mesh3d\npoints\n5\n0 0 0\n", "points are 1 instead of the 5"),
        ("more.vol", "mesh3d\npoints\n1\n0 0 0\n1 0 0\n", "points are more than the 1"),
        (
            "short.su2",
            "NDIME= 2\nNELEM= 1\n5 0 1 2\n5 0 2 3\nNPOIN= 4\n0 0\n1 0\n1 1\n0 1\n",
            "line 4: '5 0 2 3' stands where a section",
        ),
        ("long.su2", "NDIME= 2\nNELEM= 2\n5 0 1 2\nNPOIN= 3\n0 0\n1 0\n1 1\n", "NELEM= announces 2 rows, and fewer"),
        ("word.su2", "NDIME= 2\nNELEM= 1\n5 0 1 2\nNPOIN= 3\n0 0\n1 q\n1 1\n", "line 6: 'q' stands where a number"),
        ("few.off", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "3 points and 2 cells, and 4 rows"),
        ("few.avs", "3 2 0 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n1 1 tri 1 2 3\n", "3 points and 2 cells and has 3 and 1"),
        (
            "few.xml",
            "<dolfin><mesh celltype=\"triangle\" dim=\"2\"><vertices size=\"3\"><vertex index=\"0\" x=\"0\" y=\"0\"/></vertices></mesh></dolfin>",
            "3 vertices and has 1",
        ),
        ("word.msh", "3 1 0\n0 0 1\n1 x 1\n0 1 1\n1 2 3 0\n", "line 3: 'x' stands where a number"),
        ("word.vol", "mesh3d\npoints\n2\n0 0 0\n1 x 0\n", "line 5: 'x' stands where a number"),
        ("word.frd", "    1C\n    2C    1    1\n -1         1 0.00000E+00 0.0x000E+00 0.00000E+00\n -3\n", "line 3: "),
        (
            "twice.bdf",
            "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,0.,1.,0.\nCTRIA3,1,1,1,2,3\nCTRIA3,1,1,1,3,2\n",
            "line 5: cell 1 is given twice",
        ),
        (
            "one.post.msh",
            "MESH dimension 2 ElemType Triangle Nnode 3\nCoordinates\n1 0 0\n2 1\n",
            "node 2 has 1 coordinates",
        ),
        (
            "open.frd",
            "    1C\n    2C    1    1\n -1         1 0.00000E+00 0.00000E+00 0.00000E+00\n 9999\n",
            "not with -3",
        ),
        ("i.e", "CDF\x01", "i.e"),
        ("j.post.msh", "MESH dimension 2 ElemType Blob Nnode 3\n", "kind of cell"),
    ] {
        let error =
            Problem::load(scene(folder.write(name, text), &["a"], ["b", "c"])).expect_err("no mesh").to_string();
        assert!(error.contains(name) && error.contains(found), "{error}");
    }
}
