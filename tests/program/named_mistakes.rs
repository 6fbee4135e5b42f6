//! Fields of other programs in `tests/program/named`, with what a diagnosis has to say of each.

use std::path::Path;

use crate::claimed::{certified, prepared_on};
use crate::command::{hypercircle, run, said};
use serde_json::Value;

/// Exit code and report of a field in the folder of the fields.
fn claimed(scene: &str, field: &str) -> (i32, Value) {
    let folder = tempfile::tempdir().expect("a folder");
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/program/named");
    let out = folder.path().join("out");
    let scene = own.join(scene);
    let [scene, field, out] =
        [&scene, &own.join(field), &out].map(|path| path.to_str().expect("plain text").to_string());
    let arguments = ["certify", &scene, "--displacement", &field, "--solution", "--quiet", "--out", &out];
    let output = run(hypercircle(folder.path(), arguments));
    let text = std::fs::read(Path::new(&out).join("report.json")).unwrap_or_else(|_| panic!("{}", said(&output)));
    (output.status.code().expect("a code"), serde_json::from_slice(&text).expect("JSON"))
}

fn names(report: &Value) -> Vec<&str> {
    let findings = report["diagnosis"].as_array().into_iter().flatten().flat_map(|d| d["findings"].as_array());
    findings.flatten().filter_map(|finding| finding["name"].as_str()).collect()
}

/// The advice of the first cause.
fn advice(report: &Value) -> String {
    let cause = &report["causes"][0];
    format!("{} {}", cause["suggests"].as_str().unwrap_or(""), cause["remedy"].as_str().unwrap_or(""))
}

#[test]
fn a_mesh_that_has_moved_is_named() {
    let (code, report) = claimed("moved.toml", "moved.vtu");
    assert_eq!((code, names(&report)), (1, vec!["points/displaced"]), "{}", report["verdict"]);
    assert!(report["verdict"].as_str().expect("a sentence").contains("x + u"));
    assert!(advice(&report).contains("as it was before"), "{}", advice(&report));
}

#[test]
fn points_that_have_moved_off_the_mesh_of_the_scene_are_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/program/named");
    // The displacement is 1e-4 of the mesh: it takes a larger one for its points to be others.
    let mesh = std::fs::read_to_string(own.join("m.msh")).expect("a mesh");
    let (before, rest) = mesh.split_once("$Nodes\n").expect("nodes");
    let (nodes, after) = rest.split_once("$EndNodes").expect("their end");
    let mut lines = nodes.lines();
    let count = lines.next().expect("a count");
    let points: Vec<[f64; 2]> = lines
        .map(|line| line.split(' ').skip(1).map(|x| x.parse().expect("a number")).collect::<Vec<f64>>())
        .map(|p| [p[0], p[1]])
        .collect();
    let triangles: Vec<Vec<usize>> = after
        .lines()
        .map(|line| line.split(' ').map(|x| x.parse().unwrap_or(0)).collect::<Vec<usize>>())
        .filter(|line| line.get(1) == Some(&2) && line.len() > 7)
        .map(|line| line[line.len() - 3..].iter().map(|v| v - 1).collect())
        .collect();
    std::fs::write(
        folder.path().join("m.msh"),
        format!("{before}$Nodes\n{count}\n{}$EndNodes{after}", nodes.split_once('\n').expect("lines").1),
    )
    .expect("writable");
    std::fs::copy(own.join("m.toml"), folder.path().join("m.toml")).expect("a scene");
    let u = |[x, y]: [f64; 2]| [0.1 * x * y, -0.05 * y];
    let mut text = "# vtk DataFile Version 3.0\nfield\nASCII\nDATASET UNSTRUCTURED_GRID\n".to_string();
    text += &format!("POINTS {} double\n", points.len());
    points.iter().for_each(|p| text += &format!("{} {} 0\n", p[0] + u(*p)[0], p[1] + u(*p)[1]));
    text += &format!("CELLS {} {}\n", triangles.len(), 4 * triangles.len());
    triangles.iter().for_each(|t| text += &format!("3 {} {} {}\n", t[0], t[1], t[2]));
    text += &format!("CELL_TYPES {}\n{}", triangles.len(), "5\n".repeat(triangles.len()));
    text += &format!("POINT_DATA {}\nVECTORS displacement double\n", points.len());
    points.iter().for_each(|p| text += &format!("{} {} 0\n", u(*p)[0], u(*p)[1]));
    std::fs::write(folder.path().join("f.vtk"), text).expect("writable");
    let output = run(hypercircle(folder.path(), ["certify", "m.toml", "--displacement", "f.vtk"]));
    // Taken from where they were, with a note.
    assert!(matches!(output.status.code(), Some(0 | 1)), "{}", said(&output));
    let report = std::fs::read_to_string(folder.path().join("out/m/report.json")).expect("a report");
    assert!(report.contains("are displaced: less the displacement they are the vertices"), "{report}");
}

#[test]
fn noise_is_named_nothing() {
    let (code, report) = claimed("m.toml", "noise.vtu");
    assert_eq!((code, names(&report)), (1, vec![]), "{}", report["diagnosis"]);
    assert!(!report["diagnosis"][0]["sentence"].as_str().expect("a sentence").contains("nearest"));
}

#[test]
fn a_layer_of_solid_elements_is_named_and_plane_strain_is_a_solution() {
    for degree in ["CPS3", "CPS6"] {
        let (code, report) = claimed(&format!("{degree}.toml"), &format!("{degree}.vtu"));
        assert_eq!(
            (code, names(&report)),
            (1, vec!["kinematics/thickness-strain"]),
            "{degree}: {}",
            report["diagnosis"]
        );
        assert!(advice(&report).contains("plane strain"), "{}", advice(&report));
    }
    let (code, report) = claimed("CPE3.toml", "CPE3.vtu");
    assert_eq!(code, 0, "{}", report["verdict"]);
}

/// A rigid parabola pressed into a quarter of a block.
const CURVED: &str = r#"
[model]
kinematics = "plane-strain"
[geometry]
size = 0.05
[[geometry.polygons]]
body = "block"
points = [[0, 0], [0.5, 0], [0.5, 0.5], [0, 0.5]]
edges = ["bottom", "", "top", "axis"]
[bodies.block]
young = 10.0
poisson = 0.3
[[supports]]
on = "bottom"
type = "clamped"
displacement = [0.0, 0.02]
[[supports]]
on = "axis"
type = "roller"
[[contacts]]
on = "top"
gap = { parabola = 0.5, at = 0.0 }
"#;

#[test]
fn a_penalty_against_a_curve_is_named_with_its_stiffness() {
    let folder = tempfile::tempdir().expect("a folder");
    if !prepared_on(folder.path(), CURVED, &["penalty_on_a_parabola", "lumped"]) {
        return;
    }
    for degree in ["P1", "P2"] {
        let (code, report) = certified(folder.path(), &format!("{degree}/penalty_on_a_parabola"), &[]);
        assert_eq!((code, names(&report)), (1, vec!["contact/top|rigid/penalty"]), "{degree}: {}", report["diagnosis"]);
        let stiffness = report["diagnosis"][0]["findings"][0]["value"].as_f64().expect("a number");
        assert!((stiffness - 1e4).abs() < 200.0, "{degree}: {stiffness}");
        assert!(advice(&report).contains("Raise the stiffness"), "{}", advice(&report));
    }
}

/// Two loaded edges, so that nodes of more than one boundary are wrong.
const LOADED: &str = r#"
[model]
kinematics = "plane-strain"
[geometry]
size = 0.25
[[geometry.polygons]]
body = "block"
points = [[0, 0], [1, 0], [1, 1], [0, 1]]
edges = ["bottom", "side", "top", ""]
[bodies.block]
young = 10.0
poisson = 0.3
[[supports]]
on = "bottom"
type = "clamped"
[[tractions]]
on = "side"
value = [0.2, 0.0]
gradient = [[0.0, 1.0], [0.0, 0.0]]
[[tractions]]
on = "top"
value = [0.0, -1.0]
gradient = [[0.0, 0.0], [0.7, 0.0]]
"#;

#[test]
fn lumped_loads_on_several_edges_and_single_precision_are_named() {
    let folder = tempfile::tempdir().expect("a folder");
    if !prepared_on(folder.path(), LOADED, &["lumped", "single_precision"]) {
        return;
    }
    for degree in ["P1", "P2"] {
        let (code, report) = certified(folder.path(), &format!("{degree}/lumped"), &[]);
        assert_eq!((code, names(&report)), (1, vec!["loads/lumped-edges"]), "{degree}: {}", report["diagnosis"]);
        assert!(advice(&report).contains("shape functions"), "{}", advice(&report));
        // Either the digits of the file are told to explain it, or what solved the equations.
        let (code, report) = certified(folder.path(), &format!("{degree}/single_precision"), &[]);
        assert!(code == 0 || names(&report) == ["precision/single"], "{degree}: {}", report["verdict"]);
    }
}
