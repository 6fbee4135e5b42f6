//! The plate of `mesh_formats` in what newer versions of the programs write, with fields that are optional, and with what is not read.

use crate::mesh_formats::{Folder, LIMIT, POINTS, Variable, check, netcdf, rows, scene, unv, unv_groups, vtu};
use hypercircle::mesh::inventory::Inventory;
use hypercircle::problem::Problem;

#[track_caller]
fn refused(folder: &Folder, name: &str, bytes: impl AsRef<[u8]>, fragments: &[&str]) {
    let scene = scene(folder.write(name, bytes), &["a"], ["b", "c"]);
    let error = Problem::load(scene).expect_err("no mesh").to_string();
    for fragment in [&[name][..], fragments].concat() {
        assert!(error.contains(fragment), "'{fragment}' is not in: {error}");
    }
}

/// Segments with a descriptor, which has the name.
#[test]
fn edge_descriptors_of_netgen() {
    let points = rows(|_, [x, y]| format!("    {x:.16}    {y:.16}    0.0000000000000000\n"));
    let text = format!(
        "mesh3d\ndimension\n2\ngeomtype\n0\n\nsurfaceelements\n3\n2 1 0 0 4 1 2 5 4\n2 1 0 0 3 2 3 6\n2 1 0 0 3 2 6 5\n\nvolumeelements\n0\n\n\
         # p1 p2 trig1 trig2 dist1 dist2 edsi\nedgesegmentsgi3\n2\n       4       1       -1       -1            0          0.5        0\n\
         \u{20}      3       6       -1       -1          0.5            1        1\n\npoints\n6\n{points}\n\nmaterials\n1\n1 plate\n\nbcnames\n2\n1\twall\n2\tload\n\n\
         edgedescriptors\n2\n1 1 0 0.0000000000000000 0.0000000000000000 -1 1 0 wall\n2 1 0 0.0000000000000000 0.0000000000000000 -1 1 0 load\n\nendmesh\n"
    );
    let folder = Folder::new();
    check(&folder.write("plate.vol", &text), &["plate"], ["wall", "load"]);
    refused(&folder, "none.vol", text.replace("0.5        0\n", "0.5        7\n"), &["descriptor 7", "there are 2"]);
    refused(&folder, "new.vol", text.replace("gi3\n", "gi4\n"), &["edgesegmentsgi4", "does not know"]);
}

/// Shells have two faces before their edges, and an empty block or set has a number and no variable.
#[test]
fn shells_and_empty_sets_of_exodus() {
    let ints = |list: &[i32]| list.iter().flat_map(|n| n.to_be_bytes()).collect::<Vec<u8>>();
    let reals = |c: usize| POINTS.iter().flat_map(|p| p[c].to_be_bytes()).collect::<Vec<u8>>();
    let texts = |list: &[&str]| list.iter().flat_map(|s| format!("{s:\0<8}").into_bytes()).collect::<Vec<u8>>();
    let dimensions = [("len", 8), ("num_nodes", 6), ("one", 1), ("two", 2), ("three", 3), ("four", 4)];
    let variables: Vec<Variable> = vec![
        ("coordx", &[1], "", 6, reals(0)),
        ("coordy", &[1], "", 6, reals(1)),
        ("coordz", &[1], "", 6, vec![0; 48]),
        ("eb_names", &[4, 0], "", 2, texts(&["none", "left", "right"])),
        ("eb_prop1", &[4], "", 4, ints(&[5, 10, 20])),
        ("eb_status", &[4], "", 4, ints(&[0, 1, 1])),
        ("connect2", &[2, 5], "SHELL4", 4, ints(&[1, 2, 5, 4])),
        ("connect3", &[3, 4], "TRI3", 4, ints(&[2, 3, 6, 2, 6, 5])),
        ("ss_names", &[4, 0], "", 2, texts(&["none", "wall", "load"])),
        ("ss_prop1", &[4], "", 4, ints(&[1, 4, 6])),
        ("elem_ss2", &[2], "", 4, ints(&[1])),
        ("side_ss2", &[2], "", 4, ints(&[6])),
        ("elem_ss3", &[2], "", 4, ints(&[2])),
        ("side_ss3", &[2], "", 4, ints(&[4])),
        ("ns_names", &[3, 0], "", 2, texts(&["none", "end"])),
        ("ns_prop1", &[3], "", 4, ints(&[1, 2])),
        ("node_ns2", &[3], "", 4, ints(&[3, 6])),
    ];
    let folder = Folder::new();
    let path = folder.write("plate.e", netcdf(&dimensions, &variables));
    check(&path, &["left", "right"], ["wall", "load"]);
    check(&path, &["left", "right"], ["wall", "end"]);
}

#[test]
fn byte_order_marks_are_skipped_and_utf_16_is_named() {
    let folder = Folder::new();
    let marked = |text: &str| [&b"\xef\xbb\xbf"[..], text.as_bytes()].concat();
    let wide = |text: &str| {
        b"\xff\xfe".iter().copied().chain(text.encode_utf16().flat_map(u16::to_le_bytes)).collect::<Vec<u8>>()
    };
    let deck = unv(&unv_groups("2467"));
    check(&folder.write("plate.unv", marked(&deck)), &["PLATE"], ["wall side", "LOAD"]);
    check(&folder.write("plate.mesh", marked(&medit(""))), &["1"], ["3", "4"]);
    check(&folder.write("plate.bdf", marked(&nastran())), &["1"], ["7", "8"]);
    for (name, text) in [("wide.unv", deck), ("wide.mesh", medit("")), ("wide.bdf", nastran())] {
        refused(&folder, name, wide(&text), &["UTF-16", "save it in UTF-8"]);
    }
}

fn medit(more: &str) -> String {
    let points = rows(|_, [x, y]| format!("{x:e} {y:e} 0\n"));
    format!(
        "MeshVersionFormatted 2\n\nDimension 2\n\nVertices 6\n{points}\n{more}Edges\n2\n1 4 3\n3 6 4\n\nQuadrilaterals\n1\n1 2 5 4 1\n\n\
         Triangles\n2\n2 3 6 1\n2 6 5 1\n\nEnd\n"
    )
}

#[test]
fn keywords_of_medit_without_cells_are_passed_over() {
    let folder = Folder::new();
    for more in [
        "",
        "RequiredEdges\n1\n1\n\n",
        "Normals\n1\n0 0 1\n\n",
        "SubDomainFromGeom\n1\n2 1 1 1\n\n",
        "Ridges\n1\n2\n\n",
    ] {
        check(&folder.write("plate.mesh", medit(more)), &["1"], ["3", "4"]);
    }
    refused(
        &folder,
        "cut.mesh",
        medit("").replace("Vertices 6", "Vertices 7"),
        &["announces 7 vertices", "18 numbers instead of 21"],
    );
    refused(&folder, "third.mesh", medit("").replace("Triangles", "TrianglesP3"), &["trianglesp3", "second order"]);
}

fn nastran() -> String {
    let points = rows(|n, [x, y]| format!("GRID,{n},,{x:?},{y:?},0.0\n"));
    let cells =
        "CQUAD4,1,1,1,2,5,4\nCTRIA3,2,1,2,3,6\nCTRIA3,3,1,2,6,5\nCBAR,4,7,1,4,0.,0.,1.\nCBAR,5,8,3,6,0.,0.,1.\n";
    format!("SOL 101\nCEND\nBEGIN BULK\n{points}{cells}ENDDATA\n")
}

#[test]
fn bulk_data_of_nastran() {
    let folder = Folder::new();
    let plain = nastran();
    let named =
        |quadrilateral: &str, triangle: &str| plain.replace("CQUAD4", quadrilateral).replace("CTRIA3", triangle);
    let points = |line: &dyn Fn(usize, [f64; 2]) -> String| {
        let (head, rest) = plain.split_once("GRID").expect("points");
        let (_, cells) = rest.split_once("CQUAD4").expect("cells");
        format!("{head}{}CQUAD4{cells}", rows(line))
    };
    folder.write("points.inc", rows(|n, [x, y]| format!("GRID    {n:<16}{x:<8.1}{y:<8.1}\n")));
    for (what, text) in [
        ("angles of the material", plain.replace("2,5,4\n", "2,5,4,30.0,0.1\n").replace("2,3,6\n", "2,3,6,12\n")),
        ("small letters", plain.to_lowercase()),
        ("no end", plain.replace("ENDDATA\n", "")),
        ("comments", plain.replace("BEGIN BULK\n", "BEGIN BULK\n$HMNAME COMP 1 \"x, y\"\nPSHELL,1,1,1. $ steel\n")),
        ("plane strain", named("CPLSTN4", "CPLSTN3")),
        ("plane stress", named("CPLSTS4", "CPLSTS3")),
        ("axial symmetry", named("CQUADX4", "CTRAX3")),
        ("no nodes in the middle", plain.replace("CTRIA3,2,1,2,3,6", "CTRIA6,2,1,2,3,6,,")),
        ("nodes that go around", plain.replace("CTRIA3,2,1,2,3,6", "CTRIAX6,2,1,2,,3,,6,")),
        ("exponents without a letter", points(&|n, [x, y]| format!("GRID,{n},,{:?}+1,{:?}-1\n", x / 10.0, y * 10.0))),
        ("fields of 16 columns", points(&|n, [x, y]| format!("GRID*   {n:<32}{x:<16.6}{y:<16.6}*\n*       0.0\n"))),
        ("long fields with commas", points(&|n, [x, y]| format!("GRID*,{n},,{x:?},{y:?},*\n*,0.0\n"))),
        (
            "a file that is included",
            points(&|n, _| if n == 1 { "INCLUDE 'points.inc'\n".into() } else { String::new() }),
        ),
        (
            "a cylindrical system",
            points(&|n, [x, y]| {
                let system = if n == 1 { "CORD2C,1,,1.,0.,0.,1.,0.,1.\n,2.,0.,0.\n" } else { "" };
                format!("{system}GRID,{n},1,{:?},{:?}\n", (x - 1.0).hypot(y), y.atan2(x - 1.0).to_degrees())
            }),
        ),
    ] {
        println!("{what}");
        check(&folder.write("plate.bdf", text), &["1"], ["7", "8"]);
    }
    for (name, text, fragment) in [
        ("word.bdf", "GRID,1,,0.,0.\nCQUAD4,1,1,1,2,x,4\n", "line 2: a field of CQUAD4"),
        ("corner.bdf", "CQUAD4,1,1,1,2,3\n", "line 1: CQUAD4 1 has no node at corner 4"),
        ("shear.bdf", "GRID,1,,0.,0.\nCSHEAR,1,1,1,2,3,4\n", "no plane element, but CSHEAR (first at line 2)"),
        ("lost.bdf", "INCLUDE 'none.inc'\n", "line 1 includes 'none.inc'"),
        ("system.bdf", "GRID,1,7,0.,0.\nCTRIA3,1,1,1,1,1\n", "coordinate system 7"),
        ("middle.bdf", "GRID,1,,0.,0.\nCTRIA3,1,1,1,9,1\n", "node 9"),
    ] {
        refused(&folder, name, text, &[fragment]);
    }
}

fn array(kind: &str, name: &str, values: &str) -> String {
    format!("<DataArray type=\"{kind}\" Name=\"{name}\" format=\"ascii\">\n{values}\n</DataArray>\n")
}

#[test]
fn versions_cells_and_numbers_of_vtu() {
    let folder = Folder::new();
    let text = vtu(&array("Int32", "CellEntityIds", "1 2 2 3 4"));
    check(&folder.write("newer.vtu", text.replace("version=\"0.1\"", "version=\"2.2\"")), &["1", "2"], ["3", "4"]);
    // A pixel goes row by row; Lagrange's triangles and curves of first order are others' too.
    let pixel = text.replace("0 1 4 3 1 2 5", "0 1 3 4 1 2 5").replace("9 5 5 3 3", "8 69 69 68 68");
    check(&folder.write("pixel.vtu", pixel), &["1", "2"], ["3", "4"]);
    // Numbers that are all different are those of the cells, and zero is a number beside others.
    let numbered = array("Int32", "ElementId", "1 2 3 4 5") + &array("Int32", "Colour", "1 1 1 2 3");
    check(&folder.write("numbered.vtu", vtu(&numbered)), &["1"], ["2", "3"]);
    check(&folder.write("zero.vtu", vtu(&array("Int32", "ObjectId", "0 1 1 2 3"))), &["0", "1"], ["2", "3"]);
    let packed = text.replace("byte_order", "compressor=\"vtkLZ4DataCompressor\" byte_order");
    check(&folder.write("named.vtu", &packed), &["1", "2"], ["3", "4"]);
    refused(&folder, "packed.vtu", packed.replacen("\"ascii\"", "\"binary\"", 1), &["LZ4", "zlib"]);
    let grid =
        "# vtk DataFile Version 5.1\nplate\nBINARY\nDATASET STRUCTURED_GRID\nDIMENSIONS 3 2 1\nPOINTS 6 double\n";
    refused(&folder, "grid.vtk", grid, &["meshio cannot read it", "5.1, BINARY, STRUCTURED_GRID", "VTU"]);
}

/// DOLFINx writes a grid for the mesh, and one for every set of tags and every function.
#[test]
fn grids_of_xdmf() {
    let item = |kind: &str, size: &str, values: &str| {
        format!("<DataItem Dimensions=\"{size}\" NumberType=\"{kind}\" Format=\"XML\">{values}</DataItem>")
    };
    let topology = |kind: &str, size: &str, values: &str| {
        format!("<Topology TopologyType=\"{kind}\">{}</Topology>", item("Int", size, values))
    };
    let tags = |values: &str, size: &str| {
        format!(
            "<Attribute Name=\"tags\" AttributeType=\"Scalar\" Center=\"Cell\">{}</Attribute>",
            item("Int", size, values)
        )
    };
    let grid = |inner: String| format!("<Grid Name=\"grid\" GridType=\"Uniform\">{inner}</Grid>");
    let geometry = format!(
        "<Geometry GeometryType=\"XY\">{}</Geometry>",
        item("Float", "6 2", &rows(|_, [x, y]| format!("{x} {y}\n")))
    );
    let cells = "0 1 4 0 4 3 1 2 5 1 5 4";
    let mesh = grid(topology("Triangle", "4 3", cells) + &geometry);
    let of_cells = grid(topology("Triangle", "4 3", "4 1 0 0 4 3 1 2 5 1 5 4") + &tags("1 1 2 2", "4 1"));
    let of_sides = grid(topology("PolyLine", "2 2", "0 3 5 2") + &tags("7 8", "2 1"));
    let step = format!(
        "<Grid Name=\"u\" GridType=\"Collection\" CollectionType=\"Temporal\">{}</Grid>",
        grid(format!(
            "<Time Value=\"0\" /><Attribute Name=\"u\" AttributeType=\"Scalar\" Center=\"Node\">{}</Attribute>",
            item("Float", "6 1", "0 0 0 0 0 0")
        ))
    );
    let whole =
        |grids: &str| format!("<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\"><Domain>{grids}</Domain></Xdmf>\n");
    let folder = Folder::new();
    check(
        &folder.write("plate.xdmf", whole(&[mesh.as_str(), &of_cells, &of_sides, &step].concat())),
        &["1", "2"],
        ["7", "8"],
    );
    check(&folder.write("sides.xdmf", whole(&[mesh.as_str(), &of_sides].concat())), &["plate"], ["7", "8"]);
    // Kinds of cells in one topology: quadrilaterals, triangles and sides, here of first order.
    let mixed = "5 0 1 4 3 4 1 2 5 4 1 5 4 2 2 3 0 2 2 5 2";
    check(
        &folder
            .write("mixed.xdmf", whole(&grid(topology("Mixed", "21", mixed) + &geometry + &tags("1 2 2 7 8", "5 1")))),
        &["1", "2"],
        ["7", "8"],
    );
    let eight = "<Geometry GeometryType=\"XY\">".to_owned()
        + &item("Float", "8 2", "0 0 2 0 2 1 0 1 1 0 2 .5 1 1 0 .5")
        + "</Geometry>";
    let second = grid(topology("Mixed", "13", "37 0 1 2 3 4 5 6 7 34 3 0 7") + &eight + &tags("1 7", "2 1"));
    let found = Inventory::read(&folder.write("second.xdmf", whole(&second)), LIMIT).expect("an inventory");
    assert_eq!((found.bodies.len(), found.boundaries.len()), (1, 1));
    let polygon = grid(topology("Mixed", "7", "3 4 0 1 2 3 1") + &eight);
    refused(&folder, "polygon.xdmf", whole(&polygon), &["cell of kind 3"]);
    let moved = grid(topology("Triangle", "4 3", cells) + &geometry.replace("2 1\n", "3 1\n"));
    refused(&folder, "two.xdmf", whole(&(mesh.clone() + &moved)), &["points of its own"]);
    refused(
        &folder,
        "odd.xdmf",
        whole(&(mesh.clone() + &of_sides.replace("PolyLine", "Spline"))),
        &["'Spline'", "one grid"],
    );
}
