//! `hypercircle mesh` on files of known content: its findings, and the scene that it writes.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::Duration;

use hypercircle::mesh::inventory::{Inventory, Shape, starting_scene};
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;
use tempfile::TempDir;

const LIMIT: Duration = Duration::from_secs(60);

/// A disc sector with a hole in MSH 2.2: rings of quadrilaterals between two radii, over an angle, around `centre`; entity 4.
fn sector(centre: [f64; 2], [inner, outer]: [f64; 2], angle: f64, steps: usize) -> String {
    let whole = (angle - std::f64::consts::TAU).abs() < 1e-12;
    let columns = if whole { steps } else { steps + 1 };
    let mut text = format!("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n", 3 * columns);
    for i in 0..columns {
        let (sin, cos) = (angle * i as f64 / steps as f64).sin_cos();
        for (j, r) in [inner, 0.5 * (inner + outer), outer].into_iter().enumerate() {
            let _ = writeln!(text, "{} {:?} {:?} 0", 3 * i + j + 1, centre[0] + r * cos, centre[1] + r * sin);
        }
    }
    let _ = writeln!(text, "$EndNodes\n$Elements\n{}", 2 * steps);
    for i in 0..steps {
        let (a, b) = (3 * i + 1, 3 * ((i + 1) % columns) + 1);
        for j in 0..2 {
            let _ = writeln!(text, "{} 3 2 0 4 {} {} {} {}", 2 * i + j + 1, a + j, a + j + 1, b + j + 1, b + j);
        }
    }
    text + "$EndElements\n"
}

fn written(folder: &TempDir, name: &str, text: &str) -> PathBuf {
    let path = folder.path().join(name);
    std::fs::write(&path, text).expect("a file");
    path
}

fn inventory(path: &Path) -> Inventory {
    Inventory::read(path, LIMIT).expect("an inventory")
}

/// The problem of the starting scene of `path` with these changes.
fn problem(path: &Path, change: impl Fn(String) -> String) -> Result<Problem, String> {
    let text = change(starting_scene(&inventory(path), &path.file_name().expect("a name").to_string_lossy(), "start"));
    let scene = Scene::parse(&text, &path.with_file_name("scene.toml")).map_err(|e| format!("{e}\n{text}"))?;
    Problem::load(scene).map_err(|e| format!("{e}\n{text}"))
}

#[test]
fn lines_and_circles_of_a_sector_are_found() {
    let folder = tempfile::tempdir().expect("a folder");
    for (steps, angle) in [(6, 1.0), (9, 2.5), (32, 4.0)] {
        let path = written(&folder, "m.msh", &sector([3.0, -2.0], [1.0, 2.0], angle, steps));
        let found = inventory(&path);
        assert_eq!(found.kinds.clone().into_iter().collect::<Vec<_>>(), [("quadrilateral".to_string(), 2 * steps)]);
        assert_eq!((found.bodies.len(), found.bodies[0].body.as_str()), (1, "body_4"));
        let area = 1.5 * steps as f64 * (angle / steps as f64).sin();
        assert!((found.bodies[0].area - area).abs() < 1e-12, "{} is not {area}", found.bodies[0].area);
        let mut radii: Vec<f64> = Vec::new();
        let mut lines = 0;
        for piece in &found.outline {
            match piece.shape {
                Shape::Circle { centre, radius } => {
                    assert!((centre[0] - 3.0).hypot(centre[1] + 2.0) < 1e-9, "{centre:?}");
                    assert_eq!(piece.edges.len(), steps);
                    radii.push(radius);
                }
                Shape::Line([a, b]) => {
                    assert_eq!(piece.edges.len(), 2);
                    assert!(((a[0] - b[0]).hypot(a[1] - b[1]) - 1.0).abs() < 1e-12);
                    lines += 1;
                }
                Shape::Curve(_) => panic!("{piece:?}"),
            }
        }
        radii.sort_by(f64::total_cmp);
        assert!(lines == 2 && radii.len() == 2, "{steps}: {:?}", found.outline);
        assert!((radii[0] - 1.0).abs() < 1e-9 && (radii[1] - 2.0).abs() < 1e-9, "{radii:?}");
    }
}

#[test]
fn a_ring_has_two_circles_and_a_stadium_no_line_cut_in_two() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = written(&folder, "ring.msh", &sector([0.0; 2], [1.0, 2.0], std::f64::consts::TAU, 24));
    let shapes: Vec<usize> = inventory(&path).outline.iter().map(|piece| piece.edges.len()).collect();
    assert_eq!(shapes, [24, 24]);
    // A fan of triangles around a stadium, which has no corner: two straight sides of four edges, two half circles of eight.
    for first in [0, 2, 7, 15, 20] {
        let mut rim: Vec<[f64; 2]> = (0..4).map(|i| [-1.0 + 0.5 * f64::from(i), -1.0]).collect();
        let half = |i: i32, side: f64| {
            let (sin, cos) = (std::f64::consts::PI * f64::from(i) / 8.0).sin_cos();
            [side * (1.0 + sin), -side * cos]
        };
        rim.extend((0..8).map(|i| half(i, 1.0)));
        rim.extend((0..4).map(|i| [1.0 - 0.5 * f64::from(i), 1.0]));
        rim.extend((0..8).map(|i| half(i, -1.0)));
        rim.rotate_left(first);
        let mut text = String::from("*NODE\n100, 0.1, 0\n");
        rim.iter().enumerate().for_each(|(i, p)| text += &format!("{}, {:?}, {:?}\n", i + 1, p[0], p[1]));
        text += "*ELEMENT, TYPE=CPE3, ELSET=plate\n";
        (0..24).for_each(|i| text += &format!("{}, 100, {}, {}\n", i + 1, i + 1, (i + 1) % 24 + 1));
        let found = inventory(&written(&folder, "stadium.inp", &text));
        let mut counts: Vec<usize> = found.outline.iter().map(|piece| piece.edges.len()).collect();
        counts.sort_unstable();
        assert_eq!(counts, [4, 4, 8, 8], "{first}: {:?}", found.outline);
        assert_eq!(found.bodies[0].body, "plate");
    }
}

/// The proposal for every piece names exactly the edges of the piece, in meshes of all kinds.
#[test]
fn every_proposed_boundary_has_the_edges_that_it_was_made_of() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut files = vec![
        written(&folder, "sector.msh", &sector([3.0, -2.0], [1.0, 2.0], 2.5, 12)),
        written(&folder, "ring.msh", &sector([0.0; 2], [1.0, 2.0], std::f64::consts::TAU, 24)),
    ];
    for name in ["two_blocks_41.msh", "two_blocks_40.msh", "two_blocks_abaqus.inp", "shared_curve_22.msh", "foot.msh"] {
        let copy = folder.path().join(name);
        std::fs::copy(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/meshes").join(name), &copy).expect("a copy");
        files.push(copy);
    }
    for path in files {
        let found = inventory(&path);
        for piece in found.outline.iter().filter(|piece| !piece.named && !piece.shared && piece.others == 0) {
            let support = format!("\n[[supports]]\non = \"{}\"\ntype = \"clamped\"\n", piece.name);
            let problem = problem(&path, |text| text + &support).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
            let ends = |[p, q]: [[f64; 2]; 2]| if p < q { [p, q] } else { [q, p] };
            let mut expected: Vec<_> = piece.edges.iter().map(|e| ends(e.map(|v| found.points[v]))).collect();
            let mesh = &problem.mesh;
            let named = mesh.boundary(&piece.name).into_iter().map(|e| mesh.edges[e].vertices.map(|v| mesh.points[v]));
            let mut named: Vec<_> = named.map(|e| ends(e.map(|p| problem.scene.as_written(p)))).collect();
            expected.sort_by(|a, b| a.partial_cmp(b).expect("finite"));
            named.sort_by(|a, b| a.partial_cmp(b).expect("finite"));
            assert_eq!(named, expected, "{}: {}", path.display(), piece.name);
        }
    }
}

#[test]
fn groups_that_divide_the_mesh_are_bodies_and_the_others_are_listed() {
    let folder = tempfile::tempdir().expect("a folder");
    let deck = "*NODE\n1,0,0\n2,1,0\n3,2,0\n4,0,1\n5,1,1\n6,2,1\n*ELEMENT,TYPE=CPE4,ELSET=EALL\n1,1,2,5,4\n2,2,3,6,5\n\
        *NSET,NSET=foot\n1,2,3\n*NSET,NSET=corner\n1\n*ELSET,ELSET=one\n1\n*ELSET,ELSET=two\n2\n*SURFACE,NAME=top\nEALL,S3\n";
    let path = written(&folder, "m.inp", deck);
    let found = inventory(&path);
    let names = |list: &[hypercircle::mesh::inventory::Region]| list.iter().map(|r| r.name.clone()).collect::<Vec<_>>();
    assert_eq!(
        (names(&found.bodies), names(&found.groups)),
        (vec!["one".into(), "two".into()], vec!["EALL".to_string()])
    );
    let sets: Vec<_> = found.node_sets.iter().map(|s| (s.name.as_str(), s.members, s.on_outline.len())).collect();
    assert!(sets.contains(&("foot", 3, 2)) && sets.contains(&("corner", 1, 0)), "{sets:?}");
    assert_eq!(found.surfaces.iter().map(|s| (s.name.as_str(), s.on_outline.len())).collect::<Vec<_>>(), [("top", 2)]);
    let shared = found.outline.iter().filter(|piece| piece.shared).count();
    assert_eq!(shared, 2, "the edge between the bodies, once for each");
    // Bodies that meet in a contact along the edge that they share, by the names proposed.
    let more =
        "\n[[supports]]\non = \"foot\"\ntype = \"clamped\"\n[[contacts]]\nbetween = [\"one_right\", \"two_left\"]\n";
    let problem = problem(&path, |text| text + more).expect("a problem");
    assert_eq!(problem.mesh.points.len(), 8);
}

/// What a scene would be refused for is told before there is one: a flat cell, cells on each other, a group that no cell has.
#[test]
fn what_makes_a_mesh_unusable_is_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let nodes = "4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 1 1 0\n";
    let of = |nodes: &str, cells: &str| {
        format!("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{nodes}$EndNodes\n$Elements\n{cells}$EndElements\n")
    };
    let flat = nodes.replace("1 1 0", "0.5 0 0");
    for (nodes, cells, told) in [
        (nodes, "2\n1 2 2 1 1 1 2 3\n2 2 2 1 1 2 4 3\n", None),
        (&flat, "2\n1 2 2 1 1 1 2 3\n2 2 2 1 1 1 2 4\n", Some("area")),
        (nodes, "2\n1 2 2 1 1 1 2 3\n2 2 2 1 1 1 2 4\n", Some("overlap")),
    ] {
        let found = inventory(&written(&folder, "m.msh", &of(nodes, cells)));
        let notes: Vec<&str> = found.notes.iter().map(|note| note.text.as_str()).collect();
        match told {
            None => assert!(notes.is_empty(), "{notes:?}"),
            Some(word) => {
                assert!(notes.iter().any(|n| n.contains("refused as it is") && n.contains(word)), "{notes:?}")
            }
        }
    }
}
