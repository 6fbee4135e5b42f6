//! Mesh files no bounds can be computed on, through the program: exit code 2, one message that names file and remedy,
//! nothing written.

use std::path::Path;
use std::process::Output;

use crate::command::{ended, hypercircle, run};

/// Two bodies of `blocks.msh`, one pressed against the other.
pub const SCENE: &str = r#"
[model]
kinematics = "plane-strain"
[mesh]
file = "blocks.msh"
[bodies.left]
young = 1.0
poisson = 0.3
[bodies.right]
young = 1.0
poisson = 0.3
[[supports]]
on = "wall"
type = "clamped"
[[tractions]]
on = "load"
pressure = 1.0
[[contacts]]
between = ["left_face", "right_face"]
"#;

/// Two unit squares that meet on x = 1, two triangles each, in MSH 2.2.
pub const BLOCKS: &str = r#"$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
6
2 1 "left"
2 2 "right"
1 3 "load"
1 4 "left_face"
1 5 "right_face"
1 6 "wall"
$EndPhysicalNames
$Nodes
8
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
5 1 0 0
6 2 0 0
7 2 1 0
8 1 1 0
$EndNodes
$Elements
8
1 1 2 3 1 4 1
2 1 2 4 2 2 3
3 1 2 5 3 8 5
4 1 2 6 4 6 7
5 2 2 1 1 1 2 3
6 2 2 1 1 1 3 4
7 2 2 2 2 5 6 7
8 2 2 2 2 5 7 8
$EndElements
"#;

/// Runs `solve` on SCENE beside a mesh that `mesh` puts into place.
fn solve(mesh: impl FnOnce(&Path)) -> (Output, Vec<String>) {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("scene.toml"), SCENE).expect("writes");
    mesh(&folder.path().join("blocks.msh"));
    let output = run(hypercircle(folder.path(), ["solve", "scene.toml", "--refine", "3"]));
    let entries = std::fs::read_dir(folder.path()).expect("readable");
    let names = entries.map(|e| e.expect("readable").file_name().to_string_lossy().into_owned());
    (output, names.filter(|n| n != "scene.toml" && n != "blocks.msh").collect())
}

#[track_caller]
fn refused(what: &str, mesh: impl FnOnce(&Path), fragments: &[&str]) {
    let (output, written) = solve(mesh);
    let message = ended(what, &output, 2, fragments);
    assert!(output.stdout.is_empty(), "{what}: {}", String::from_utf8_lossy(&output.stdout));
    assert!(written.is_empty(), "{what}: wrote {written:?}");
    println!("{what}: {message}");
}

#[track_caller]
fn refused_text(what: &str, text: &str, fragments: &[&str]) {
    assert_ne!(text, BLOCKS, "{what} changes nothing");
    refused(what, |path| std::fs::write(path, text).expect("writes"), fragments);
}

#[track_caller]
fn refused_edit(what: &str, from: &str, to: &str, fragments: &[&str]) {
    refused_text(what, &BLOCKS.replacen(from, to, 1), fragments);
}

#[test]
fn the_mesh_itself_is_fine_and_clockwise_triangles_too() {
    for text in [BLOCKS.to_string(), BLOCKS.replace("1 1 2 3\n6", "1 1 3 2\n6").replace("2 2 5 7 8", "2 2 8 7 5")] {
        let (output, written) = solve(|path| std::fs::write(path, &text).expect("writes"));
        ended("the mesh", &output, 0, &[]);
        assert_eq!(written, ["out"]);
    }
}

#[test]
fn no_mesh_at_all() {
    refused("no file", |_| {}, &["blocks.msh", "cannot be opened", "relative to the scene"]);
    refused("directory", |path| std::fs::create_dir(path).expect("makes"), &["blocks.msh", "directory"]);
    refused_text("empty", "", &["blocks.msh", "is empty"]);
    refused_text("prose", "A mesh is a mesh.\n", &["blocks.msh", "no Gmsh file"]);
    refused_edit("version 3", "2.2 0 8", "3.0 0 8", &["blocks.msh", "3"]);
    refused_text(
        "no triangles",
        &lines_without(&["5 2 ", "6 2 ", "7 2 ", "8 2 "], "$Elements\n8", "$Elements\n4"),
        &["blocks.msh"],
    );
}

/// BLOCKS without the elements that begin so, and with another count.
fn lines_without(starts: &[&str], from: &str, to: &str) -> String {
    let (head, elements) = BLOCKS.split_once("$Elements").expect("a section");
    let kept: Vec<&str> = elements.lines().filter(|line| !starts.iter().any(|s| line.starts_with(s))).collect();
    format!("{head}$Elements{}\n", kept.join("\n")).replacen(from, to, 1)
}

#[test]
fn broken_off_or_garbled() {
    let fixture = |name: &str| {
        std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/meshes").join(name)).expect("a fixture")
    };
    for name in ["two_blocks_41_binary.msh", "two_blocks_22_binary.msh"] {
        let whole = fixture(name);
        for part in [10, 60, whole.len() / 3, whole.len() - 100] {
            let what = format!("{name} cut at {part}");
            refused(&what, |path| std::fs::write(path, &whole[..part]).expect("writes"), &["blocks.msh"]);
        }
        let mut turned = whole.clone();
        let header = turned.windows(2).position(|w| w == b"8\n").expect("the format line") + 2;
        turned[header..header + 4].reverse();
        refused(
            &format!("{name} of other byte order"),
            |path| std::fs::write(path, &turned).expect("writes"),
            &["blocks.msh"],
        );
    }
    refused_text("cut text", &BLOCKS[..BLOCKS.len() - 60], &["blocks.msh"]);
    refused_edit("more nodes than lines", "$Nodes\n8", "$Nodes\n9", &["blocks.msh"]);
    refused_edit("a huge count", "$Nodes\n8", "$Nodes\n99999999999999999", &["blocks.msh"]);
    refused_edit("a negative count", "$Elements\n8", "$Elements\n-8", &["blocks.msh"]);
    refused_edit("a word for a number", "3 1 1 0", "3 one 1 0", &["blocks.msh"]);
    refused_edit("NaN", "3 1 1 0", "3 nan 1 0", &["blocks.msh"]);
    refused_edit("infinity", "3 1 1 0", "3 1e999 1 0", &["blocks.msh"]);
    refused_edit("a node that does not exist", "1 1 1 2 3", "1 1 1 2 33", &["blocks.msh", "33"]);
    refused_edit("a node twice", "4 0 1 0", "3 0 1 0", &["blocks.msh"]);
}

#[test]
fn cells_that_carry_no_stress() {
    refused_edit("three nodes on a line", "3 1 1 0", "3 0.5 0 0", &["blocks.msh"]);
    refused_edit("a corner twice", "1 1 1 2 3", "1 1 1 2 2", &["blocks.msh"]);
    refused_edit("out of the plane", "3 1 1 0", "3 1 1 0.5", &["blocks.msh"]);
    refused_edit("untagged", "6 2 2 1 1 1 3 4", "6 2 2 0 1 1 3 4", &["blocks.msh", "untagged"]);
    refused_edit("a tag without a name", "6 2 2 1 1 1 3 4", "6 2 2 9 1 1 3 4", &["blocks.msh"]);
    refused_edit("in two bodies", "$Elements\n8", "$Elements\n9\n9 2 2 2 1 1 3 4", &["blocks.msh"]);
    refused_edit("a quadrangle", "6 2 2 1 1 1 3 4", "6 3 2 1 1 1 2 3 4", &["blocks.msh"]);
    refused_edit("overlapping triangles", "6 2 2 1 1 1 3 4", "6 2 2 1 1 1 2 4", &["blocks.msh"]);
}

#[test]
fn boundaries_that_do_not_fit() {
    refused_edit("sides apart", "5 1 0 0", "5 1.1 0 0", &["left_face|right_face"]);
    refused_edit("one side longer", "8 1 1 0", "8 1 1.25 0", &["left_face|right_face"]);
    refused_edit("a name that is missing", "\"load\"", "\"lode\"", &["'load'", "lode"]);
    refused_edit("a body that is missing", "\"right\"", "\"rihgt\"", &["rihgt"]);
    refused_edit("a condition inside the body", "1 1 2 3 1 4 1", "1 1 2 3 1 3 1", &["load"]);
    refused_edit("two conditions on an edge", "4 1 2 6 4 6 7", "4 1 2 6 4 4 1", &["wall"]);
}
