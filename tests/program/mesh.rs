//! `hypercircle mesh`: what it prints, the page, the scene to start from, refusals.

use std::path::Path;

use crate::command::{ended, hypercircle, run};

const DECK: &str = "*NODE\n1,0,0\n2,1,0\n3,2,0\n4,0,1\n5,1,1\n6,2,1\n*ELEMENT,TYPE=CPS4,ELSET=plate\n1,1,2,5,4\n2,2,3,6,5\n\
    *NSET,NSET=foot\n1,2,3\n";

#[test]
fn the_scene_to_start_from_is_solved_once_it_is_edited() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path();
    std::fs::create_dir(path.join("meshes")).expect("a folder");
    std::fs::write(path.join("meshes/plate.inp"), DECK).expect("a file");
    let line = ["mesh", "meshes/plate.inp", "--scene", "start.toml", "--out", "page"];
    let output = run(hypercircle(path, line));
    ended("a deck", &output, 0, &[]);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    for words in [
        "2 × quadrilateral",
        "[bodies.plate]",
        "foot: 3 nodes, 2 edges",
        "line = [[2.0, 1.0], [0.0, 1.0]]",
        "page/mesh.html",
    ] {
        assert!(said.contains(words), "{words}: {said}");
    }
    let page = std::fs::read_to_string(path.join("page/mesh.html")).expect("a page");
    assert!(page.contains("<svg") && page.contains("foot") && !page.contains("src=") && !page.contains("<script"));
    // As it is, it is read; with the examples taken as they stand, it is solved.
    ended("as it is", &run(hypercircle(path, ["solve", "start.toml"])), 0, &[]);
    let text = std::fs::read_to_string(path.join("start.toml")).expect("a scene");
    let (head, examples) = text.split_once("# Examples of conditions").expect("examples");
    let (examples, _) = examples.split_once("# [[contacts]]").expect("contacts");
    let edited: String = examples.lines().skip(1).map(|line| format!("{}\n", line.trim_start_matches("# "))).collect();
    std::fs::write(path.join("start.toml"), format!("{head}{edited}")).expect("a file");
    ended("edited", &run(hypercircle(path, ["solve", "start.toml", "--out", "out"])), 0, &[]);
    let report: serde_json::Value =
        serde_json::from_slice(&std::fs::read(path.join("out/report.json")).expect("a report")).expect("JSON");
    let lower = report["energy"]["lower"].as_f64().expect("a number");
    assert!(lower < 0.0, "the example loads the plate: {lower}");
    ended("again", &run(hypercircle(path, line)), 2, &["start.toml exists already"]);
}

#[test]
fn what_is_no_plane_mesh_is_refused_with_what_was_found() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path();
    let write = |name: &str, text: &str| std::fs::write(path.join(name), text).expect("a file");
    let gmsh = |nodes: &str, elements: &str| {
        format!("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{nodes}$EndNodes\n$Elements\n{elements}$EndElements\n")
    };
    let nodes = "4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n";
    write("lines.msh", &gmsh(nodes, "1\n1 1 2 0 1 1 2\n"));
    write("solid.msh", &gmsh(nodes, "3\n1 1 2 0 1 1 2\n2 4 2 0 1 1 2 3 4\n3 4 2 0 1 2 1 3 4\n"));
    write("shell.msh", &gmsh(nodes, "3\n1 2 2 0 1 1 2 3\n2 2 2 0 1 1 2 4\n3 2 2 0 1 1 3 4\n"));
    for (file, expected) in [
        ("lines.msh", vec!["no plane cells", "1 × line", "4 nodes"]),
        ("solid.msh", vec!["2 × tetrahedron", "in space"]),
        ("shell.msh", vec!["2 of 3", "z = 0", "1"]),
        ("missing.msh", vec!["missing.msh", "cannot be opened"]),
    ] {
        ended(file, &run(hypercircle(path, ["mesh", file])), 2, &expected);
        assert!(!path.join("out").exists(), "{file}");
    }
    assert!(!Path::new(&path.join("scene.toml")).exists());
}
