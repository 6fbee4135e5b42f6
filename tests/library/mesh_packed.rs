//! Files packed with gzip, files in other planes than that of x and y, and displacements in arrays of their own.

use std::io::Write;

use flate2::Compression;
use flate2::write::GzEncoder;

use crate::mesh_formats::{Folder, LIMIT, POINTS, check, rows, scene, unv, unv_groups, vtu};
use hypercircle::mesh::inventory::Inventory;
use hypercircle::problem::Problem;
use hypercircle::study::ForeignField;

fn packed(text: &str) -> Vec<u8> {
    let mut packed = GzEncoder::new(Vec::new(), Compression::default());
    packed.write_all(text.as_bytes()).expect("room");
    packed.finish().expect("room")
}

fn deck(nodes: &str) -> String {
    format!(
        "*NODE\n{nodes}*ELEMENT, TYPE=CPE4, ELSET=plate\n1, 1, 2, 5, 4\n*ELEMENT, TYPE=CPE3, ELSET=plate\n2, 2, 3, 6\n3, 2, 6, 5\n\
         *NSET, NSET=wall\n1, 4\n*NSET, NSET=load\n3, 6\n"
    )
}

fn flat() -> String {
    deck(&rows(|n, [x, y]| format!("{n}, {x}, {y}\n")))
}

fn gmsh() -> String {
    format!(
        "$NOD\n6\n{}$ENDNOD\n$ELM\n5\n1 3 7 1 4 1 2 5 4\n2 2 7 2 3 2 3 6\n3 2 7 2 3 2 6 5\n4 1 8 3 2 4 1\n5 1 9 4 2 3 6\n$ENDELM\n",
        rows(|n, [x, y]| format!("{n} {x} {y} 0\n"))
    )
}

#[test]
fn packed_files_are_read_as_what_was_packed() {
    let folder = Folder::new();
    check(&folder.write("plate.inp.gz", packed(&flat())), &["plate"], ["wall", "load"]);
    check(&folder.write("plate.msh.gz", packed(&gmsh())), &["7"], ["8", "9"]);
    check(&folder.write("plate.unv.GZ", packed(&unv(&unv_groups("2467")))), &["PLATE"], ["wall side", "LOAD"]);
    let freefem = format!(
        "6 4 6\n{}1 2 5 1\n1 5 4 1\n2 3 6 1\n2 6 5 1\n1 2 1\n2 3 1\n3 6 2\n6 5 3\n5 4 3\n4 1 4\n",
        rows(|_, [x, y]| format!("{x} {y} 1\n"))
    );
    check(&folder.write("Th.msh.gz", packed(&freefem)), &["1"], ["4", "2"]);
    let whole = packed(&unv(""));
    for (name, bytes) in [
        ("words.unv.gz", b"some words".to_vec()),
        ("words.msh.gz", b"some words".to_vec()),
        ("cut.unv.gz", whole[..whole.len() / 2].to_vec()),
        ("cut.inp.gz", whole[..whole.len() / 2].to_vec()),
    ] {
        let error = Inventory::read(&folder.write(name, bytes), LIMIT).expect_err("no mesh").to_string();
        assert!(error.contains(name) && error.contains("cannot be unpacked with gzip"), "{error}");
    }
}

#[test]
fn meshes_in_other_planes_are_turned_into_that_of_x_and_y() {
    let folder = Folder::new();
    for (told, nodes) in [
        ("the plane y = 0.5: x and z of the file", rows(|n, [x, y]| format!("{n}, {x}, 0.5, {y}\n"))),
        ("the plane x = -3: y and z of the file", rows(|n, [x, y]| format!("{n}, -3.0, {x}, {y}\n"))),
    ] {
        let path = folder.write("plate.inp", deck(&nodes));
        check(&path, &["plate"], ["wall", "load"]);
        let notes = Inventory::read(&path, LIMIT).expect("a mesh").notes;
        assert!(notes.iter().any(|note| note.text.contains(told)), "{notes:?}");
    }
    let aslant = deck(&rows(|n, [x, y]| format!("{n}, {x}, {y}, {y}\n")));
    let error = Inventory::read(&folder.write("aslant.inp", aslant), LIMIT).expect_err("no plane").to_string();
    assert!(error.contains("outside the plane"), "{error}");
}

/// u = (x y, −x), whole and in two arrays by the names that programs give these.
#[test]
fn displacements_may_be_two_arrays() {
    let folder = Folder::new();
    let problem = Problem::load(scene(folder.write("plate.inp", flat()), &["plate"], ["wall", "load"])).expect("fits");
    let at = |[x, y]: [f64; 2]| [x * y, -x];
    let array = |name: &str, components: &[usize]| {
        let numbers: String =
            POINTS.iter().flat_map(|p| components.iter().map(|c| format!("{} ", at(*p)[*c]))).collect();
        format!(
            "<DataArray type=\"Float64\" Name=\"{name}\" NumberOfComponents=\"{}\" format=\"ascii\">\n{numbers}\n</DataArray>\n",
            components.len()
        )
    };
    let file = |arrays: &str| vtu("").replace("<CellData>", &format!("<PointData>{arrays}</PointData>\n<CellData>"));
    let read = |arrays: String, field: Option<&str>| {
        let path = folder.write("field.vtu", file(&arrays));
        ForeignField::read(&path, field, LIMIT).map_err(|e| e.to_string())
    };
    let displaced = |arrays: String, field| {
        read(arrays, field).expect("a field").candidate(&problem, 0.0).expect("on the mesh").vertex
    };
    let whole = displaced(array("displacement", &[0, 1]), None);
    assert!(!whole.is_empty());
    for [x, y] in
        [["disp_x", "disp_y"], ["ux", "uy"], ["u_x", "u_y"], ["Ux", "Uy"], ["displacement_x", "displacement_y"]]
    {
        // Their order says nothing, and other arrays are others.
        let arrays = array(y, &[1]) + &array("flux_x", &[1]) + &array(x, &[0]) + &array("p", &[0]);
        assert_eq!(displaced(arrays, None), whole, "{x}");
    }
    assert_eq!(displaced(array("ux", &[0]) + &array("uy", &[1]) + &array("v", &[1, 0]), Some("u")), whole);
    let alone = read(array("ux", &[0]) + &array("vy", &[1]), None).expect_err("half a field");
    assert!(alone.contains("no vector field on points"), "{alone}");
    let two = array("ux", &[0]) + &array("uy", &[1]);
    let doubt = read(two.clone() + &array("disp_x", &[0]) + &array("disp_y", &[1]), None).expect_err("two fields");
    assert!(doubt.contains("several fields may be the displacement: disp, u"), "{doubt}");
    let doubt = read(two + &array("u_x", &[1]), None).expect_err("two first components");
    assert!(doubt.contains("several arrays may be the x component of 'u': ux, uy, u_x"), "{doubt}");
}
