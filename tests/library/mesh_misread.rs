//! What another program wrote is read whole, by the names that it has, or refused: nothing of it is missing without a word.

use crate::mesh_formats::{Folder, LIMIT, POINTS, check, refused, rows, scene, vtu};
use hypercircle::mesh::inventory::{Inventory, starting_scene};
use hypercircle::problem::Problem;
use hypercircle::scene::{Kinematics, Scene};

#[track_caller]
fn read(folder: &Folder, name: &str, bytes: impl AsRef<[u8]>) -> Inventory {
    Inventory::read(&folder.write(name, bytes), LIMIT).unwrap_or_else(|e| panic!("{name}: {e}"))
}

fn notes(inventory: &Inventory) -> String {
    inventory.notes.iter().map(|note| format!("{}\n", note.text)).collect()
}

fn array(name: &str, values: &str) -> String {
    format!("<DataArray type=\"Int32\" Name=\"{name}\" format=\"ascii\">\n{values}\n</DataArray>\n")
}

/// meshio reads the last piece of VTK's XML and the first zone of Tecplot.
#[test]
fn pieces_and_zones_are_all_of_a_file_or_none() {
    let folder = Folder::new();
    let text = vtu(&array("CellEntityIds", "1 2 2 3 4"));
    let (start, end) = (text.find("<Piece").expect("one"), text.find("</UnstructuredGrid>").expect("an end"));
    let twice = [&text[..end], &text[start..end], &text[end..]].concat();
    refused(&folder, "pieces.vtu", twice, &["2 pieces", "save it as one piece"]);
    let nothing = "<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\"></DataArray>";
    let empty = format!("<Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"><Points>{nothing}</Points></Piece>\n");
    for place in [start, end] {
        let path = folder.write("empty.vtu", [&text[..place], &empty, &text[place..]].concat());
        check(&path, &["1", "2"], ["3", "4"]);
    }
    let zone = "ZONE N=3, E=1, DATAPACKING=POINT, ZONETYPE=FETRIANGLE\n0 0\n1 0\n0 1\n1 2 3\n";
    let one = format!("VARIABLES = \"X\", \"Y\"\n{zone}");
    assert_eq!(read(&folder, "one.tec", &one).triangles.len(), 1);
    refused(&folder, "two.tec", one + zone, &["2 zones", "mesh.parts"]);
}

#[test]
fn cells_of_nastran_that_are_not_known_are_not_left_out() {
    let deck = |more: &str| {
        let points = rows(|n, [x, y]| format!("GRID,{n},,{x:?},{y:?},0.0\n"));
        format!(
            "BEGIN BULK\n{points}CTRIA3,2,1,2,3,6\nCTRIA3,3,1,2,6,5\nCBAR,4,7,1,4,0.,0.,1.\nCBAR,5,8,3,6,0.,0.,1.\n{more}ENDDATA\n"
        )
    };
    let folder = Folder::new();
    for (name, card) in [("shear.bdf", "CSHEAR"), ("membrane.bdf", "CQDMEM1"), ("new.bdf", "CNEW4")] {
        let line = format!("{card},1,1,1,2,5,4\n");
        refused(&folder, name, deck(&line), &[&format!("{card} (first at line 12)"), "CQUAD4"]);
    }
    refused(&folder, "again.bdf", deck("=,*1,=,*1,*1,*1,*1\n"), &["line 12", "repeated"]);
    let whole = deck("CQUAD4,1,1,1,2,5,4\nCELAS2,9,1.0,1,1\nCONM2,10,1,0,1.\nCORD2R,3,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n");
    for name in ["springs.bdf", "springs.dat", "springs.blk"] {
        check(&folder.write(name, &whole), &["1"], ["7", "8"]);
    }
    assert!(notes(&read(&folder, "springs.bdf", &whole)).contains("left out: 1 CELAS2, 1 CONM2"));
    // Seven digits put a node between two corners beside their side; farther off, the side is curved.
    for (off, straight) in [("5.-7", true), ("1.-3", false)] {
        let middle = format!("GRID,7,,1.5,{off}\nGRID,8,,2.0,0.5\nGRID,9,,1.5,0.5\n");
        let text = deck(&(middle + "CQUAD4,1,1,1,2,5,4\n")).replace("CTRIA3,2,1,2,3,6\n", "CTRIA6,2,1,2,3,6,7,8,9\n");
        let read = read(&folder, "middle.bdf", text);
        assert_eq!(notes(&read).contains("represented by its chord"), !straight, "{off}: {}", notes(&read));
    }
}

#[test]
fn elements_without_a_shape_are_told_or_refused() {
    let nodes = rows(|n, [x, y]| format!("{n}, {x}, {y}\n"));
    let deck = |kind: &str, cells: &str| {
        format!(
            "*NODE\n{nodes}*USER ELEMENT, NODES=4, TYPE=U1, COORDINATES=2\n1, 2\n*ELEMENT, TYPE={kind}, ELSET=own\n11, 1, 2, 5,\n 4\n\
             *ELEMENT, TYPE=CPS3, ELSET=plate\n2, 2, 3, 6\n3, 2, 6, 5\n{cells}"
        )
    };
    let folder = Folder::new();
    for kind in ["U1", "SFM3D4"] {
        refused(&folder, "own.inp", deck(kind, ""), &["line 11", kind, "no shape that is known"]);
        let covered = read(&folder, "covered.inp", deck(kind, "*ELEMENT, TYPE=CPS4, ELSET=plate\n1, 1, 2, 5, 4\n"));
        let area: f64 = covered.bodies.iter().map(|body| body.area).sum();
        assert!((area - 2.0).abs() < 1e-12 && notes(&covered).contains(&format!("left out: {kind}")));
    }
}

/// The names of elements say what they are made for: a scene to start from takes it, and one that says otherwise is told.
#[test]
fn kinematics_of_elements_are_heard() {
    let nodes = rows(|n, [x, y]| format!("{n}, {x}, {y}\n"));
    let folder = Folder::new();
    for (names, kinematics) in [
        (["CAX4R", "CAX3"], Kinematics::Axisymmetric),
        (["CPS4", "CPS3"], Kinematics::PlaneStress),
        (["CPE4H", "CPE3"], Kinematics::PlaneStrain),
    ] {
        let text = format!(
            "*NODE\n{nodes}*ELEMENT, TYPE={}, ELSET=plate\n1, 1, 2, 5, 4\n*ELEMENT, TYPE={}, ELSET=plate\n2, 2, 3, 6\n3, 2, 6, 5\n\
             *NSET, NSET=wall\n1, 4\n*NSET, NSET=load\n3, 6\n",
            names[0], names[1]
        );
        let path = folder.write("plate.inp", &text);
        let inventory = Inventory::read(&path, LIMIT).expect("a mesh");
        let started = starting_scene(&inventory, "plate.inp", "plate");
        let started = Scene::parse(&started, &folder.0.path().join("s.toml")).expect("a scene");
        assert_eq!(started.kinematics, kinematics, "{started:?}");
        let problem = Problem::load(scene(path, &["plate"], ["wall", "load"])).expect("a problem");
        let told = problem.notes.iter().any(|note| note.text.contains("are made for"));
        assert_eq!(told, kinematics != Kinematics::PlaneStrain, "{:?}", problem.notes);
    }
}

#[test]
fn bodies_are_the_materials_and_not_the_ranks() {
    let folder = Folder::new();
    let two = |arrays: [(&str, &str); 2]| vtu(&arrays.map(|(name, values)| array(name, values)).concat());
    for (other, own) in [
        ("PartitionId", "MaterialIds"),
        ("Stage", "mat"),
        ("PARTITION", "regions"),
        ("procId", "cellTags"),
        ("zone_of_heat", "material"),
    ] {
        let (ranks, materials) = ((other, "0 1 1 0 0"), (own, "1 2 2 3 4"));
        for arrays in [[ranks, materials], [materials, ranks]] {
            check(&folder.write("plate.vtu", two(arrays)), &["1", "2"], ["3", "4"]);
        }
    }
    let told = notes(&read(&folder, "plate.vtu", two([("Stage", "0 1 1 0 0"), ("mat", "1 2 2 3 4")])));
    assert!(told.contains("the array 'mat'") && told.contains("Stage"), "{told}");
    let markers = format!(
        "NDIME= 2\nNELEM= 3\n9 0 1 4 3 0\n5 1 2 5 1\n5 1 5 4 2\nNPOIN= 6\n{}NMARK= 2\nMARKER_TAG= side left\nMARKER_ELEMS= 1\n3 0 3\n\
         MARKER_TAG= side right\nMARKER_ELEMS= 1\n3 2 5\n",
        rows(|n, [x, y]| format!("{x} {y} {}\n", n - 1))
    );
    check(&folder.write("plate.su2", markers), &["plate"], ["side left", "side right"]);
    // The name of one group is the number of the other.
    let crossed = format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 1 \"2\"\n2 2 \"1\"\n$EndPhysicalNames\n$Nodes\n6\n{}$EndNodes\n$Elements\n3\n\
         1 3 2 1 1 1 2 5 4\n2 2 2 2 2 2 3 6\n3 2 2 2 2 2 6 5\n$EndElements\n",
        rows(|n, [x, y]| format!("{n} {x} {y} 0\n"))
    );
    let inventory = read(&folder, "crossed.msh", crossed);
    let started = starting_scene(&inventory, "crossed.msh", "crossed");
    let problem =
        Problem::load(Scene::parse(&started, &folder.0.path().join("s.toml")).expect("a scene")).expect("fits");
    for region in &inventory.bodies {
        let body = problem.scene.bodies.iter().position(|body| body.name == region.body).expect("there");
        let own = (0..problem.mesh.triangles.len()).filter(|t| problem.mesh.body[*t] == body);
        let middle: f64 =
            own.clone().map(|t| problem.mesh.corners(t).iter().map(|p| p[0] / 3.0).sum::<f64>()).sum::<f64>()
                / own.count() as f64;
        assert_eq!(middle > 1.0, region.extent[1][0] > 1.5, "{started}");
    }
}

/// Endings are called by habit: the content tells.
#[test]
fn formats_are_told_by_what_is_in_the_file() {
    let folder = Folder::new();
    let points = rows(|n, [x, y]| format!("{n} {x} {y} 0\n"));
    let ucd = format!(
        "# by deal.II\n6 5 0 0 0\n{points}1 1 quad 1 2 5 4\n2 1 tri 2 3 6\n3 1 tri 2 6 5\n4 3 line 1 4\n5 4 line 3 6\n"
    );
    for name in ["plate.inp", "plate.avs"] {
        let inventory = read(&folder, name, &ucd);
        let area: f64 = inventory.bodies.iter().map(|body| body.area).sum();
        assert!((area - 2.0).abs() < 1e-12, "{name}: {area}");
    }
    let vertices = rows(|_, [x, y]| format!("{x} {y}\n"));
    let mfem = format!(
        "MFEM mesh v1.0\n\n# comment\n\ndimension\n2\n\nelements\n3\n1 3 0 1 4 3\n2 2 1 2 5\n2 2 1 5 4\n\nboundary\n2\n7 1 3 0\n8 1 2 5\n\nvertices\n6\n2\n{vertices}"
    );
    check(&folder.write("plate.mesh", &mfem), &["1", "2"], ["7", "8"]);
    refused(&folder, "curved.mesh", mfem.replace("6\n2\n", "6\nnodes\n"), &["straight sides"]);
    refused(&folder, "short.mesh", mfem.replace("1 3 0 1 4 3", "1 3 0 1 4"), &["3 vertices instead of 4"]);
    for (name, fragment) in [
        ("plate.stp", "files .stp are in no format that is read"),
        ("plate.dxf", "export the mesh as"),
        ("plate.rst", "write the archive (CDWRITE,DB: .cdb)"),
        ("plate.pvtu", "give one of these"),
        ("plate.vts", "no list of cells"),
        ("plate.ele", "Triangle"),
        ("plate", "no ending"),
    ] {
        refused(&folder, name, "some words\n", &[fragment]);
    }
}

/// Files have seven digits: what is out of the plane by less is none, and what is apart by less touches.
#[test]
fn seven_digits_are_enough() {
    let folder = Folder::new();
    let nodes = |height: f64| rows(|n, [x, y]| format!("{n}, {x}, {y}, {:e}\n", if n % 2 == 0 { height } else { 0.0 }));
    let cells =
        "*ELEMENT, TYPE=CPS4, ELSET=plate\n1, 1, 2, 5, 4\n*ELEMENT, TYPE=CPS3, ELSET=plate\n2, 2, 3, 6\n3, 2, 6, 5\n";
    assert_eq!(read(&folder, "flat.inp", format!("*NODE\n{}{cells}", nodes(1e-7))).triangles.len(), 4);
    refused(&folder, "high.inp", format!("*NODE\n{}{cells}", nodes(1e-4)), &["outside the plane"]);
    for (apart, touches) in [(0.0, true), (1e-7, true), (1e-3, false)] {
        let nodes = rows(|n, [x, y]| format!("{n}, {x}, {y}\n"));
        let text = format!(
            "*NODE\n{nodes}7, {:?}, 0.0\n8, {:?}, 1.0\n*ELEMENT, TYPE=CPS4, ELSET=left\n1, 1, 2, 5, 4\n*ELEMENT, TYPE=CPS4, ELSET=right\n2, 7, 3, 6, 8\n",
            1.0 + apart,
            1.0 + apart
        );
        let told = notes(&read(&folder, "two.inp", text));
        assert_eq!(told.contains("touch along 1 edge"), touches, "{apart}: {told}");
    }
}

/// As VTK 9 writes them: binary, with 64-bit offsets, arrays in fields, and what it says of them in words.
#[test]
fn older_files_of_vtk_in_all_their_forms() {
    let folder = Folder::new();
    let points: Vec<f64> = POINTS.iter().flat_map(|[x, y]| [*x, *y, 0.0]).collect();
    let nodes: [i64; 14] = [0, 1, 4, 3, 1, 2, 5, 1, 5, 4, 0, 3, 2, 5];
    let offsets: [i64; 6] = [0, 4, 7, 10, 12, 14];
    let (types, groups) = ([9, 5, 5, 3, 3], [1, 2, 2, 3, 4]);
    for binary in [false, true] {
        let (mut bytes, form) = (Vec::new(), if binary { "BINARY" } else { "ASCII" });
        let text = |bytes: &mut Vec<u8>, line: &str| bytes.extend(line.as_bytes());
        let numbers = |bytes: &mut Vec<u8>, all: Vec<(String, Vec<u8>)>| {
            bytes.extend(
                all.into_iter().flat_map(|(word, raw)| if binary { raw } else { format!("{word} ").into_bytes() }),
            );
            bytes.push(b'\n');
        };
        let of = |bytes: &mut Vec<u8>, all: &[f64]| {
            numbers(bytes, all.iter().map(|x| (x.to_string(), x.to_be_bytes().to_vec())).collect());
        };
        let longs = |bytes: &mut Vec<u8>, all: &[i64]| {
            numbers(bytes, all.iter().map(|x| (x.to_string(), x.to_be_bytes().to_vec())).collect());
        };
        let ints = |bytes: &mut Vec<u8>, all: &[i32]| {
            numbers(bytes, all.iter().map(|x| (x.to_string(), x.to_be_bytes().to_vec())).collect());
        };
        text(&mut bytes, &format!("# vtk DataFile Version 5.1\nplate\n{form}\nDATASET UNSTRUCTURED_GRID\n"));
        text(&mut bytes, "FIELD FieldData 1\nTIME 1 1 double\n");
        of(&mut bytes, &[0.5]);
        text(&mut bytes, "POINTS 6 double\n");
        of(&mut bytes, &points);
        text(
            &mut bytes,
            "METADATA\nINFORMATION 1\nNAME L2_NORM_RANGE LOCATION vtkDataArray\nDATA 2 0 2\n\nCELLS 6 14\nOFFSETS vtktypeint64\n",
        );
        longs(&mut bytes, &offsets);
        text(&mut bytes, "CONNECTIVITY vtktypeint64\n");
        longs(&mut bytes, &nodes);
        text(&mut bytes, "\nCELL_TYPES 5\n");
        ints(&mut bytes, &types);
        text(&mut bytes, "\nCELL_DATA 5\nSCALARS stress double\nLOOKUP_TABLE default\n");
        of(&mut bytes, &[0.5; 5]);
        text(&mut bytes, "FIELD FieldData 1\nmaterial%20id 1 5 int\n");
        ints(&mut bytes, &groups);
        text(&mut bytes, "METADATA\nINFORMATION 0\n\nPOINT_DATA 6\nVECTORS u double\n");
        of(&mut bytes, &[0.0; 18]);
        check(&folder.write("plate.vtk", &bytes), &["1", "2"], ["3", "4"]);
        refused(&folder, "cut.vtk", &bytes[..bytes.len() - 20], &["cut off"]);
    }
    let polygons = format!(
        "# vtk DataFile Version 3.0\nplate\nASCII\nDATASET POLYDATA\nPOINTS 6 float\n{}POLYGONS 3 13\n4 0 1 4 3\n3 1 2 5\n3 1 5 4\nLINES 2 6\n2 0 3\n2 2 5\n\
         CELL_DATA 5\nSCALARS material int 1\nLOOKUP_TABLE default\n3 4 1 2 2\n",
        rows(|_, [x, y]| format!("{x} {y} 0\n"))
    );
    check(&folder.write("polygons.vtk", &polygons), &["1", "2"], ["3", "4"]);
    let pentagon = polygons.replace("POLYGONS 3 13\n4 0 1 4 3\n", "POLYGONS 3 14\n5 0 1 2 4 3\n");
    refused(&folder, "five.vtk", pentagon, &["kind 7 with 5 nodes"]);
}
