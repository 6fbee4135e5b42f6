//! Mesh files on their way to a problem: what comes out of good ones, what is said about bad ones.

use std::path::{Path, PathBuf};

use hypercircle::problem::{Condition, Problem};
use hypercircle::scene::{
    Body, Contact, ContactSides, Draft, Gap, Kinematics, Load, MeshSource, Scene, Support, SupportKind, Traction,
};

fn meshes() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/meshes")
}

/// Two blocks in contact, pressed against a wall; the boundaries by their names.
fn scene(mesh: PathBuf, bodies: [&str; 2], [first, second, load, wall]: [&str; 4]) -> Scene {
    let body = |name: &str| Body::isotropic(name, 1.0, 0.3);
    let draft = Draft {
        bodies: bodies.map(body).into(),
        supports: vec![Support { on: wall.into(), kind: SupportKind::CLAMPED }],
        tractions: vec![Traction { on: load.into(), load: Load::Pressure(1.0), terms: Vec::new() }],
        contacts: vec![Contact::new(
            ContactSides::Between([first.into(), second.into()]),
            Gap::Table(vec![[0.0, 0.0], [0.25, 0.0], [1.0, 0.1]]),
        )],
        ..Draft::new("blocks", Kinematics::PlaneStrain, MeshSource::File(mesh))
    };
    Scene::new(draft).expect("a valid scene")
}

const NAMES: [&str; 4] = ["left_face", "right face", "load", "wall"];

/// Total length of the edges with a condition.
fn length(problem: &Problem, wanted: impl Fn(&Condition) -> bool) -> f64 {
    let edges = (0..problem.mesh.edges.len()).filter(|&e| wanted(&problem.conditions[e]));
    edges.map(|e| problem.mesh.edge_frame(e).0).sum()
}

fn check_blocks(problem: &Problem, pairs: usize) {
    let area: f64 = (0..problem.mesh.triangles.len()).map(|t| problem.mesh.area(t)).sum();
    assert!((area - 2.0).abs() < 1e-9);
    assert_eq!(problem.interfaces[0].pairs.len(), pairs);
    for (what, found) in [
        ("contact", 0.5 * length(problem, |c| matches!(c, Condition::Contact { .. }))),
        ("wall", length(problem, |c| matches!(c, Condition::Clamped(_)))),
        ("load", length(problem, |c| matches!(c, Condition::Traction(p) if *p != [[0.0; 2]; 2]))),
    ] {
        assert!((found - 1.0).abs() < 1e-9, "{what}: {found}");
    }
    assert!(problem.notes.iter().all(|n| !n.weakens_guarantee), "{:?}", problem.notes);
}

#[test]
fn gmsh_files_become_problems() {
    for version in ["22", "22_binary", "41", "41_binary"] {
        let file = meshes().join(format!("two_blocks_{version}.msh"));
        let problem = Problem::load(scene(file, ["left", "right"], NAMES)).expect("a good file");
        // Halves on the left, thirds on the right, and the break point at a quarter.
        check_blocks(&problem, 5);
        let texts: Vec<&str> = problem.notes.iter().map(|n| n.text.as_str()).collect();
        for fragment in
            ["curve '77'", "curve 'left_bottom'", "vertices of 'right face' inserted", "where the gap bends"]
        {
            assert!(texts.iter().any(|t| t.contains(fragment)), "'{fragment}' is not in {texts:?}");
        }
    }
}

#[test]
fn a_shared_curve_in_two_groups_is_a_contact() {
    for version in ["22", "22_binary", "41", "41_binary", "quadratic_41"] {
        let file = meshes().join(format!("shared_curve_{version}.msh"));
        let scene = scene(file, ["left", "right"], ["face", "opposite", "load", "wall"]);
        let scene = scene.changed(|draft| draft.tractions.clear()).expect("a valid scene");
        let problem = Problem::load(scene).expect("a good file");
        assert_eq!(problem.interfaces[0].pairs.len(), 3);
        assert!((length(&problem, |c| matches!(c, Condition::Contact { .. })) - 2.0).abs() < 1e-9);
    }
}

#[test]
fn blocks_of_medit_and_abaqus() {
    let file = meshes().join("two_blocks_medit.mesh");
    check_blocks(&Problem::load(scene(file, ["1", "2"], ["4", "7", "5", "6"])).expect("a good file"), 5);
    let file = meshes().join("two_blocks_abaqus.inp");
    let names = ["left_face", "right_face", "load", "wall"];
    check_blocks(&Problem::load(scene(file, ["left", "right"], names)).expect("a good file"), 5);
}

#[track_caller]
fn refuse(scene: Scene, fragments: &[&str]) {
    let message = Problem::load(scene).expect_err("a bad mesh").to_string();
    for fragment in fragments {
        assert!(message.contains(fragment), "'{fragment}' is not in: {message}");
    }
}

#[test]
fn files_that_are_no_meshes() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).expect("writes");
        scene(path, ["left", "right"], NAMES)
    };
    let nowhere = folder.path().join("nowhere.msh");
    refuse(scene(nowhere, ["left", "right"], NAMES), &["nowhere.msh", "cannot be opened", "relative to the scene"]);
    refuse(scene(folder.path().into(), ["left", "right"], NAMES), &["this is a directory", "give the path"]);
    refuse(write("empty.msh", b""), &["empty.msh", "is empty", "MSH 4.1 or 2.2"]);
    refuse(write("text.msh", b"hello\n"), &["text.msh", "'hello'", "no Gmsh file"]);
    let binary = std::fs::read(meshes().join("two_blocks_41_binary.msh")).expect("a fixture");
    refuse(write("cut.msh", &binary[..3000]), &["cut.msh", "byte 29", "truncated"]);
    refuse(
        write("mesh.vtk", b"# vtk DataFile Version 3.0\nnothing\n"),
        &["mesh.vtk", "meshio cannot read it", "check the file"],
    );
    refuse(write("mesh.unknown", b"x"), &["mesh.unknown", "meshio cannot read it"]);
    let untagged = b"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n$Elements\n1\n1 2 2 0 1 1 2 3\n$EndElements\n";
    refuse(write("untagged.msh", untagged), &["triangle 1", "(1, 0)", "untagged", "left, right"]);
}

#[test]
fn scenes_that_do_not_fit_their_mesh() {
    let file = || meshes().join("two_blocks_41.msh");
    let names = |first, second, load, wall| scene(file(), ["left", "right"], [first, second, load, wall]);
    refuse(
        names("left_face", "right_face", "load", "wall"),
        &["'right_face' does not exist", "did you mean 'right face'?"],
    );
    refuse(
        names("left_face", "77", "load", "wall"),
        &["contact 'left_face|77'", "the vertex (1, 0) of 'left_face'", "coinciding polylines"],
    );
    refuse(scene(file(), ["left", "rigth"], NAMES), &["'right'", "no body of the scene", "did you mean 'rigth'?"]);
    let shared = meshes().join("shared_curve_41.msh");
    refuse(
        scene(shared, ["left", "right"], ["face", "wall", "opposite", "far wall"]),
        &["'face'", "share the edge (1, 0)", "physical curves 'face' and 'wall'"],
    );
}
