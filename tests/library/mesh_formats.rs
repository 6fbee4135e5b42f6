//! One plate in the formats of many programs, by hand in the manner of their manuals: each goes in as it is.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use hypercircle::mesh::inventory::Inventory;
use hypercircle::problem::{Condition, Problem};
use hypercircle::scene::{Body, Draft, Kinematics, Load, MeshSource, Scene, Support, SupportKind, Traction};

pub const LIMIT: std::time::Duration = std::time::Duration::from_secs(60);

/// The plate (0, 2) × (0, 1): a quadrilateral on the left, two triangles on the right, numbered from one.
pub const POINTS: [[f64; 2]; 6] = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [0.0, 1.0], [1.0, 1.0], [2.0, 1.0]];

pub fn scene(mesh: PathBuf, bodies: &[&str], [wall, load]: [&str; 2]) -> Scene {
    let body = |name: &&str| Body::isotropic(*name, 1.0, 0.3);
    let draft = Draft {
        bodies: bodies.iter().map(body).collect(),
        supports: vec![Support { on: wall.into(), kind: SupportKind::CLAMPED }],
        tractions: vec![Traction { on: load.into(), load: Load::Pressure(1.0), terms: Vec::new() }],
        ..Draft::new("plate", Kinematics::PlaneStrain, MeshSource::File(mesh))
    };
    Scene::new(draft).expect("a valid scene")
}

/// Checks area, the wall at x = 0 and the load at x = 2.
#[track_caller]
pub fn check(path: &Path, bodies: &[&str], names: [&str; 2]) {
    let problem =
        Problem::load(scene(path.into(), bodies, names)).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let area: f64 = (0..problem.mesh.triangles.len()).map(|t| problem.mesh.area(t)).sum();
    assert!((area - 2.0).abs() < 1e-9, "{}: area {area}", path.display());
    let at = |wanted: &dyn Fn(&Condition) -> bool| {
        let edges = (0..problem.mesh.edges.len()).filter(|&e| wanted(&problem.conditions[e]));
        edges.map(|e| problem.mesh.edges[e].vertices.map(|v| problem.mesh.points[v])).collect::<Vec<_>>()
    };
    for (what, x, edges) in [
        ("wall", 0.0, at(&|c| matches!(c, Condition::Clamped(_)))),
        ("load", 2.0, at(&|c| matches!(c, Condition::Traction(p) if *p != [[0.0; 2]; 2]))),
    ] {
        assert!(
            edges.len() == 1 && edges[0].iter().all(|p| (p[0] - x).abs() < 1e-9),
            "{}: {what} {edges:?}",
            path.display()
        );
    }
}

pub struct Folder(pub tempfile::TempDir);

impl Folder {
    pub fn new() -> Folder {
        Folder(tempfile::tempdir().expect("a folder"))
    }

    pub fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.path().join(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        std::fs::write(&path, bytes).expect("a file");
        path
    }
}

/// Reads a file that is refused, in words that have its name and all `fragments`.
#[track_caller]
pub fn refused(folder: &Folder, name: &str, bytes: impl AsRef<[u8]>, fragments: &[&str]) {
    let error = Inventory::read(&folder.write(name, bytes), LIMIT).expect_err("no mesh").to_string();
    for fragment in [&[name][..], fragments].concat() {
        assert!(error.contains(fragment), "'{fragment}' is not in: {error}");
    }
}

pub fn rows(line: impl Fn(usize, [f64; 2]) -> String) -> String {
    POINTS.iter().enumerate().map(|(i, p)| line(i + 1, *p)).collect()
}

pub fn unv(groups: &str) -> String {
    let nodes = rows(|n, [x, y]| format!("{n:10}         1         1        11\n{x:25.16E}{y:25.16E}{:25.16E}\n", 0.0));
    let nodes = nodes.replace('E', "D+0");
    let beam = |n: usize, a: usize, b: usize| {
        format!(
            "{n:10}        21         2         1         7         2\n         0         1         1\n{a:10}{b:10}\n"
        )
    };
    format!(
        "    -1\n   164\n         1  SI: Meter (newton)         2\n    1.0D0    1.0D0    1.0D0\n    273.15D0\n    -1\n    -1\n  2411\n{nodes}    -1\n    -1\n  2412\n\
         {}{}         1        94         1         1         7         4\n         1         2         5         4\n         2        91         1         1         7         3\n\
         \u{20}        2         3         6\n         3        91         1         1         7         3\n         2         6         5\n    -1\n{groups}",
        beam(11, 1, 4),
        beam(12, 3, 6)
    )
}

/// Quadrilaterals of nine nodes, which UNV does not have: Gmsh writes corners first, others go around.
#[test]
fn nine_nodes_of_unv_are_told_by_where_they_lie() {
    let folder = Folder::new();
    let corners = [[0.0, 0.0], [2.0, 0.2], [1.8, 1.0], [0.1, 1.1]];
    let middle = |i: usize| [0, 1].map(|c| 0.5 * (corners[i][c] + corners[(i + 1) % 4][c]));
    let points: Vec<[f64; 2]> = corners.into_iter().chain((0..4).map(middle)).chain([[1.0, 0.6]]).collect();
    let area: f64 =
        (0..4).map(|i| (corners[i], corners[(i + 1) % 4])).map(|(p, q)| 0.5 * (p[0] * q[1] - p[1] * q[0])).sum();
    for (name, order) in [("gmsh", [1, 2, 3, 4, 5, 6, 7, 8, 9]), ("around", [1, 5, 2, 6, 3, 7, 4, 8, 9])] {
        let mut text = "    -1\n  2411\n".to_string();
        for (n, [x, y]) in (1..).zip(&points) {
            let _ = write!(text, "{n:10}         1         1        11\n{x:25.16}{y:25.16}{:25.16}\n", 0.0);
        }
        text += "    -1\n    -1\n  2412\n         1        94         1         1         7         9\n";
        order.iter().for_each(|n: &usize| text += &format!("{n:10}"));
        text += "\n    -1\n";
        let path = folder.write(&format!("{name}.unv"), text);
        let draft = Draft {
            bodies: vec![Body::isotropic("plate", 1.0, 0.3)],
            ..Draft::new("plate", Kinematics::PlaneStrain, MeshSource::File(path))
        };
        let problem =
            Problem::load(Scene::new(draft).expect("a valid scene")).unwrap_or_else(|e| panic!("{name}: {e}"));
        let found: f64 = (0..problem.mesh.triangles.len()).map(|t| problem.mesh.area(t)).sum();
        assert!((found - area).abs() < 1e-12, "{name}: {found} and {area}");
    }
}

pub fn unv_groups(dataset: &str) -> String {
    let rest = if ["2417", "2429"].contains(&dataset) { "" } else { "         0         0" };
    let member = |kind: usize, tag: usize| format!("{kind:10}{tag:10}{rest}");
    let group = |number: usize, name: &str, count: usize| {
        format!("{number:10}         0         0         0         0         0         0{count:10}\n{name}\n")
    };
    format!(
        "    -1\n  {dataset}\n{}{}{}\n{}\n{}{}\n{}{}\n    -1\n",
        group(1, "PLATE", 3),
        member(8, 1),
        member(8, 2),
        member(8, 3),
        group(2, "wall side", 1),
        member(8, 11),
        group(3, "LOAD", 2) + &member(7, 3),
        member(7, 6)
    )
}

#[test]
fn ideas_universal_files() {
    let folder = Folder::new();
    for dataset in ["2467", "2477", "2435", "2452", "2417", "2429"] {
        let path = folder.write(&format!("{dataset}.unv"), unv(&unv_groups(dataset)));
        check(&path, &["PLATE"], ["wall side", "LOAD"]);
    }
}

#[test]
fn freefem_meshes() {
    let text = format!(
        "6 4 6\n{}1 2 5 1\n1 5 4 1\n2 3 6 2\n2 6 5 2\n1 2 1\n2 3 1\n3 6 2\n6 5 3\n5 4 3\n4 1 4\n",
        rows(|_, [x, y]| format!("{x} {y} 1\n"))
    );
    let folder = Folder::new();
    check(&folder.write("Th.msh", &text), &["1", "2"], ["4", "2"]);
    check(&folder.write("Th.freefem", &text), &["plate"], ["4", "2"]);
}

#[test]
fn getfem_meshes() {
    let folder = Folder::new();
    let points = rows(|n, [x, y]| format!("  POINT  {}  {x}  {y}\n", n - 1));
    for quadrilateral in ["GT_LINEAR_PRODUCT(GT_PK(1,1),GT_PK(1,1))", "GT_QK(2,1)"] {
        let text = format!(
            "% GETFEM MESH FILE \n% GETFEM VERSION 5.4.2\n\n\nBEGIN POINTS LIST\n\n  POINT COUNT 6\n{points}\nEND POINTS LIST\n\nBEGIN MESH STRUCTURE DESCRIPTION\n\n  \
             CONVEX COUNT 3\n  CONVEX 0    '{quadrilateral}'      0  1  3  4\n  CONVEX 1    'GT_PK(2,1)'      1  2  5\n  CONVEX 2    'GT_PK(2,1)'      1  5  4\n\n\
             END MESH STRUCTURE DESCRIPTION\nBEGIN REGION 3\n0/1 \nEND REGION 3\nBEGIN REGION 7\n1/0 \nEND REGION 7\nBEGIN REGION 9\n0 1 2 \nEND REGION 9\n"
        );
        check(&folder.write("m.mesh", &text), &["9"], ["3", "7"]);
        check(&folder.write("m.msh", &text), &["plate"], ["3", "7"]);
    }
}

#[test]
fn gid_meshes() {
    let points = rows(|n, [x, y]| format!("{n} {x} {y} 0\n"));
    let text = format!(
        "MESH \"quads\" dimension 2 ElemType Quadrilateral Nnode 4\nCoordinates\n{points}End Coordinates\nElements\n1 1 2 5 4 1\nEnd Elements\n\
         MESH dimension 2 ElemType Triangle Nnode 3\nCoordinates\nEnd Coordinates\nElements\n2 2 3 6 1\n3 2 6 5 1\nEnd Elements\n\
         MESH dimension 2 ElemType Linear Nnode 2\nCoordinates\nEnd Coordinates\nElements\n4 1 4 5\n5 3 6 6\nEnd Elements\n"
    );
    check(&Folder::new().write("plate.post.msh", text), &["plate"], ["5", "6"]);
}

#[test]
fn ngsolve_meshes() {
    let points = rows(|_, [x, y]| format!("    {x:.16}    {y:.16}    0.0000000000000000\n"));
    let text = format!(
        "mesh3d\ndimension\n2\ngeomtype\n0\n\n# surfnr    bcnr   domin  domout      np      p1      p2      p3\nsurfaceelements\n3\n\
         2       1       0       0       4       1       2       5       4\n2       1       0       0       3       2       3       6\n\
         2       1       0       0       3       2       6       5\n\n\n#  matnr      np      p1      p2      p3      p4\nvolumeelements\n0\n\n\n\
         # surfid  0   p1   p2   trignum1    trignum2   domin/surfnr1    domout/surfnr2   ednr1   dist1   ednr2   dist2 \nedgesegmentsgi2\n2\n\
         1       0       4       1      -1      -1       1       0       1       0       1       1\n\
         2       0       3       6      -1      -1       1       0       2       0       2       1\n\n\n\
         #          X             Y             Z\npoints\n6\n{points}\n\n#          pnum             index\npointelements\n0\nmaterials\n1\n1 plate\n\n\n\
         bcnames\n2\n1\twall\n2\tload\n\n\nendmesh\n"
    );
    check(&Folder::new().write("plate.vol", text), &["plate"], ["wall", "load"]);
}

#[test]
fn meshes_of_scikit_fem() {
    // Sides in the order of their vertices: (0,1) (0,3) (0,4) (1,2) (1,4) (1,5) (2,5) (3,4) (4,5).
    let points = rows(|_, [x, y]| format!("[{x:?}, {y:?}], "));
    let text = format!(
        r#"{{"p": [{}], "t": [[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4]], "boundaries": {{"wall": [1], "load": [6]}}, "subdomains": {{"plate": [0, 1, 2, 3]}}}}"#,
        points.trim_end_matches(", ")
    );
    check(&Folder::new().write("plate.json", text), &["plate"], ["wall", "load"]);
}

#[test]
fn folders_of_elmer() {
    let folder = Folder::new();
    folder.write("plate/mesh.header", "6 3 2\n3\n202 2\n303 2\n404 1\n");
    folder.write("plate/mesh.nodes", rows(|n, [x, y]| format!("{n} -1 {x} {y} 0.0\n")));
    folder.write("plate/mesh.elements", "1 1 404 1 2 5 4\n2 1 303 2 3 6\n3 1 303 2 6 5\n");
    folder.write("plate/mesh.boundary", "1 1 1 0 202 4 1\n2 2 2 0 202 3 6\n");
    check(&folder.0.path().join("plate"), &["plate"], ["1", "2"]);
    folder.write(
        "plate/mesh.names",
        "! ----- names for bodies -----\n$ block = 1\n! ----- names for boundaries -----\n$ wall = 1\n$ load = 2\n",
    );
    check(&folder.0.path().join("plate"), &["block"], ["wall", "load"]);
    check(&folder.0.path().join("plate/mesh.header"), &["block"], ["wall", "load"]);
}

/// Name, dimensions, name of a set, type and bytes of a variable.
pub type Variable<'a> = (&'a str, &'a [u32], &'a str, u32, Vec<u8>);

/// A classic netCDF file: dimensions, and variables with their dimensions, an attribute, the type, and the bytes.
pub fn netcdf(dimensions: &[(&str, u32)], variables: &[Variable]) -> Vec<u8> {
    let padded = |bytes: &[u8]| [bytes, &[0; 3][..(4 - bytes.len() % 4) % 4]].concat();
    let word = |n: u32| n.to_be_bytes().to_vec();
    let name = |s: &str| [word(s.len() as u32), padded(s.as_bytes())].concat();
    let head = |offsets: &[u32]| {
        let mut out = [b"CDF\x01".to_vec(), word(0), word(10), word(dimensions.len() as u32)].concat();
        dimensions.iter().for_each(|(n, size)| out.extend([name(n), word(*size)].concat()));
        out.extend([word(0), word(0), word(11), word(variables.len() as u32)].concat());
        for ((n, axes, kind, number, data), at) in variables.iter().zip(offsets) {
            out.extend([name(n), word(axes.len() as u32)].concat());
            axes.iter().for_each(|a| out.extend(word(*a)));
            match kind.is_empty() {
                true => out.extend([word(0), word(0)].concat()),
                false => out.extend([word(12), word(1), name("elem_type"), word(2), name(kind)].concat()),
            }
            out.extend([word(*number), word(padded(data).len() as u32), word(*at)].concat());
        }
        out
    };
    let mut at = head(&vec![0; variables.len()]).len() as u32;
    let offset = |v: &(&str, &[u32], &str, u32, Vec<u8>)| {
        let begin = at;
        at += padded(&v.4).len() as u32;
        begin
    };
    let offsets: Vec<u32> = variables.iter().map(offset).collect();
    variables.iter().fold(head(&offsets), |mut out, v| {
        out.extend(padded(&v.4));
        out
    })
}

#[test]
fn exodus_files() {
    let ints = |list: &[i32]| list.iter().flat_map(|n| n.to_be_bytes()).collect::<Vec<u8>>();
    let reals = |c: usize| POINTS.iter().flat_map(|p| p[c].to_be_bytes()).collect::<Vec<u8>>();
    let texts = |list: &[&str]| list.iter().flat_map(|s| format!("{s:\0<8}").into_bytes()).collect::<Vec<u8>>();
    let dimensions = [("len", 8), ("num_nodes", 6), ("one", 1), ("two", 2), ("three", 3), ("four", 4)];
    let variables: Vec<Variable> = vec![
        ("coordx", &[1], "", 6, reals(0)),
        ("coordy", &[1], "", 6, reals(1)),
        ("eb_names", &[3, 0], "", 2, texts(&["left", "right"])),
        ("eb_prop1", &[3], "", 4, ints(&[10, 20])),
        ("connect1", &[2, 5], "QUAD4", 4, ints(&[1, 2, 5, 4])),
        ("connect2", &[3, 4], "TRI3", 4, ints(&[2, 3, 6, 2, 6, 5])),
        ("ss_names", &[2, 0], "", 2, texts(&["wall"])),
        ("ss_prop1", &[2], "", 4, ints(&[4])),
        ("elem_ss1", &[2], "", 4, ints(&[1])),
        ("side_ss1", &[2], "", 4, ints(&[4])),
        ("ns_names", &[2, 0], "", 2, texts(&["load"])),
        ("node_ns1", &[3], "", 4, ints(&[3, 6])),
    ];
    let folder = Folder::new();
    for suffix in ["e", "exo", "ex2"] {
        check(
            &folder.write(&format!("plate.{suffix}"), netcdf(&dimensions, &variables)),
            &["left", "right"],
            ["wall", "load"],
        );
    }
    let whole = netcdf(&dimensions, &variables);
    for length in (4..whole.len()).step_by(61) {
        let path = folder.write("cut.e", &whole[..length]);
        let error =
            Problem::load(scene(path, &["left", "right"], ["wall", "load"])).expect_err("a file cut off").to_string();
        assert!(error.contains("cut.e") && error.contains("check the file"), "{error}");
    }
}

pub fn vtu(cell_data: &str) -> String {
    let points = rows(|_, [x, y]| format!("{x} {y} 0 "));
    format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"6\" \
         NumberOfCells=\"5\">\n<Points>\n<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">\n{points}\n</DataArray>\n</Points>\n<Cells>\n\
         <DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">\n0 1 4 3 1 2 5 1 5 4 0 3 2 5\n</DataArray>\n\
         <DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">\n4 7 10 12 14\n</DataArray>\n\
         <DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">\n9 5 5 3 3\n</DataArray>\n</Cells>\n<CellData>\n{cell_data}</CellData>\n</Piece>\n\
         </UnstructuredGrid>\n</VTKFile>\n"
    )
}

#[test]
fn numbers_of_vtk_files() {
    let folder = Folder::new();
    let array = |kind: &str, name: &str, values: &str| {
        format!("<DataArray type=\"{kind}\" Name=\"{name}\" format=\"ascii\">\n{values}\n</DataArray>\n")
    };
    for data in [
        array("Int32", "CellEntityIds", "1 2 2 3 4"),
        array("Int32", "GeometryIds", "1 2 2 3 4") + &array("Int32", "rank", "0 0 0 0 0"),
        array("Float64", "MaterialIDs", "1 2 2 3 4") + &array("Float64", "stress", "0.5 0.5 0.2 0 0"),
    ] {
        let path = folder.write("plate.vtu", vtu(&data));
        check(&path, &["1", "2"], ["3", "4"]);
        check(&path, &["plate"], ["3", "4"]);
    }
    let points = rows(|_, [x, y]| format!("{x} {y} 0\n"));
    let text = format!(
        "# vtk DataFile Version 3.0\nplate\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 6 double\n{points}\nCELLS 5 19\n4 0 1 4 3\n3 1 2 5\n3 1 5 4\n2 0 3\n2 2 5\n\n\
         CELL_TYPES 5\n9\n5\n5\n3\n3\n\nCELL_DATA 5\nSCALARS CellEntityIds int 1\nLOOKUP_TABLE default\n1\n1\n1\n3\n4\n"
    );
    check(&folder.write("plate.vtk", text), &["plate"], ["3", "4"]);
}

#[test]
fn nastran_decks() {
    let mut text = String::from("SOL 101\nCEND\nBEGIN BULK\n");
    for (i, [x, y]) in POINTS.iter().enumerate() {
        let _ = writeln!(text, "GRID,{},,{x:?},{y:?},0.0", i + 1);
    }
    text += "CQUAD4,1,1,1,2,5,4\nCTRIA3,2,1,2,3,6\nCTRIA3,3,1,2,6,5\nCBAR,4,7,1,4,0.,0.,1.\nCBAR,5,8,3,6,0.,0.,1.\nENDDATA\n";
    let folder = Folder::new();
    check(&folder.write("plate.bdf", &text), &["plate"], ["7", "8"]);
    check(&folder.write("plate.nas", &text), &["1"], ["7", "8"]);
    // As Gmsh writes it: bulk data from the first line on.
    let (_, bulk) = text.split_once("BEGIN BULK\n").expect("bulk data");
    check(&folder.write("gmsh.bdf", format!("$ Created by Gmsh\n{bulk}")), &["plate"], ["7", "8"]);
}

/// Cells of bodies of revolution in the plane of Nastran, in which the axis is along z.
#[test]
fn nastran_s_bodies_of_revolution_lie_in_its_own_plane() {
    let folder = Folder::new();
    let places = [[1.0, 0.0], [2.0, 0.0], [3.0, 0.0], [2.0, 0.5], [1.0, 1.0], [1.0, 0.5]];
    for turned in [true, false] {
        let point = |[r, z]: [f64; 2]| if turned { format!("{r:?},0.0,{z:?}") } else { format!("{r:?},{z:?},0.0") };
        let grid: String = places.iter().enumerate().map(|(i, p)| format!("GRID,{},,{}\n", i + 1, point(*p))).collect();
        let path = folder.write("turned.bdf", format!("BEGIN BULK\n{grid}CTRIAX6,1,1,1,2,3,4,5,6\nENDDATA\n"));
        let found = hypercircle::mesh::inventory::Inventory::read(&path, LIMIT).expect("an inventory");
        assert!((found.bodies[0].area - 1.0).abs() < 1e-12, "{turned}: {:?}", found.bodies);
    }
}
