//! Meshes that a triangulation accepts, and meshes that it refuses, with the place and the remedy.

use crate::mesh::testing::*;
use crate::mesh::{MeshError, RawMesh, Triangulation};
use crate::scene::Note;
use crate::scene::{Gap, Load, Scene};

const PRESSURE: Load = Load::Pressure(1.0);

fn square() -> RawMesh {
    grid("left", [0.0; 2], [1.0; 2], [2, 2])
}

fn accept(raw: RawMesh, scene: &Scene) -> (Triangulation, Vec<Note>) {
    let (mesh, notes) = Triangulation::new(raw, scene).expect("a good mesh");
    assert_consistent(&mesh);
    (mesh, notes)
}

#[track_caller]
fn refuse(raw: RawMesh, scene: &Scene, fragments: &[&str]) {
    let message = Triangulation::new(raw, scene).expect_err("a bad mesh").to_string();
    for fragment in fragments {
        assert!(message.contains(fragment), "'{fragment}' is not in: {message}");
    }
}

#[test]
fn clockwise_triangles_are_turned_and_unused_vertices_dropped() {
    let mut raw = square();
    raw.triangles[3].0.swap(0, 1);
    raw.points.push([7.0, 7.0]);
    let (mesh, _) = accept(raw, &scene(&["left"]));
    assert_eq!((mesh.points.len(), mesh.triangles.len(), euler(&mesh)), (9, 8, 1));
    assert!((total_area(&mesh) - 1.0).abs() < 1e-15);
    assert_eq!(lengths(&mesh)["left_top"], 1.0);
}

#[test]
fn a_sliver_passes_in_any_unit() {
    for unit in [1e-9, 1.0, 1e9] {
        let raw = RawMesh {
            points: [[0.0, 0.0], [1.0, 0.0], [0.5, 1e-6]].map(|p| p.map(|x| x * unit)).to_vec(),
            triangles: vec![([0, 1, 2], "left".into())],
            ..RawMesh::default()
        };
        accept(raw, &scene(&["left"]));
    }
}

#[test]
fn bodies_that_share_vertices_are_bonded() {
    let mut raw = grid("left", [0.0; 2], [2.0, 1.0], [2, 1]);
    raw.triangles[2].1 = "right".into();
    raw.triangles[3].1 = "right".into();
    let (mesh, _) = accept(raw, &scene(&["left", "right"]));
    assert_eq!((mesh.points.len(), euler(&mesh)), (6, 1));
}

/// Two squares that share the curve x = 1.
fn shared_curve(names: &[&str]) -> RawMesh {
    let mut raw = grid("left", [0.0; 2], [2.0, 2.0], [2, 2]);
    for (t, name) in &mut raw.triangles {
        if t.iter().any(|v| v % 3 == 2) {
            *name = "right".into();
        }
    }
    for name in names {
        raw.segments.extend([([1, 4], name.to_string()), ([7, 4], name.to_string())]);
    }
    raw
}

#[test]
fn a_contact_along_a_shared_curve_separates_the_bodies() {
    // Whatever the order of the names in the file, the first side of the contact goes to the first body of the scene.
    let scene = contact(scene(&["right", "left"]), "a", "b", Gap::Constant(0.0));
    let (mesh, _) = accept(shared_curve(&["b", "a"]), &scene);
    assert_eq!((mesh.points.len(), euler(&mesh)), (12, 2));
    for (name, body) in [("a", 0), ("b", 1)] {
        let edges = mesh.boundary(name);
        assert_eq!(edges.len(), 2);
        assert!(edges.iter().all(|&e| mesh.edges[e].triangles[0].map(|t| mesh.body[t]) == Some(body)));
    }
    assert_eq!(side(&mesh, "a", false), side(&mesh, "b", true));
}

#[test]
fn a_contact_along_part_of_a_shared_curve_keeps_its_tip_bonded() {
    let mut raw = shared_curve(&["a", "b"]);
    raw.segments.retain(|(ends, name)| *ends != [7, 4] || !["a", "b"].contains(&name.as_str()));
    let (mesh, _) = accept(raw, &contact(scene(&["left", "right"]), "a", "b", Gap::Constant(0.0)));
    assert_eq!((mesh.points.len(), euler(&mesh)), (10, 1));
}

#[test]
fn bodies_that_touch_at_a_vertex_are_not_bonded_there() {
    let mut raw = both(square(), grid("right", [1.0; 2], [2.0; 2], [2, 2]));
    raw.triangles.iter_mut().for_each(|(t, _)| t.iter_mut().for_each(|v| *v = if *v == 9 { 8 } else { *v }));
    raw.segments.retain(|(s, _)| !s.contains(&9));
    let (mesh, _) = accept(raw, &scene(&["left", "right"]));
    assert_eq!((mesh.points.len(), euler(&mesh)), (18, 2));
}

#[test]
fn an_idle_curve_makes_a_note() {
    let (_, notes) = accept(square(), &clamp(scene(&["left"]), "left_left"));
    let texts: Vec<&str> = notes.iter().map(|n| n.text.as_str()).collect();
    assert_eq!(texts.len(), 3);
    assert!(texts.iter().all(|t| t.contains("does not mention the physical curve")));
}

#[test]
fn cells_that_are_no_triangles() {
    let scene = scene(&["left"]);
    refuse(RawMesh::default(), &scene, &["test.msh", "no triangle", "physical surfaces"]);
    let mut raw = square();
    raw.points[4] = [0.25, 0.0];
    refuse(raw, &scene, &["triangle", "zero area", "remove degenerate"]);
    let mut raw = square();
    raw.triangles[5].0[1] = raw.triangles[5].0[2];
    refuse(raw, &scene, &["triangle 6", "a vertex twice"]);
    let mut raw = square();
    raw.points[3][1] = f64::NAN;
    refuse(raw, &scene, &["vertex 4", "not finite"]);
    let mut raw = square();
    raw.triangles[0].0[0] = 99;
    refuse(raw, &scene, &["vertex 100", "9 vertices"]);
}

#[test]
fn cells_without_a_body_of_their_own() {
    let mut raw = square();
    raw.triangles[1].1.clear();
    refuse(raw, &scene(&["left"]), &["triangle 2", "untagged", "(left)"]);
    let mut raw = square();
    raw.triangles[1].1 = "lfet".into();
    refuse(raw, &scene(&["left"]), &["'lfet'", "no body of the scene", "[bodies.lfet]", "did you mean 'left'"]);
    let mut raw = square();
    raw.triangles.push((raw.triangles[2].0, "right".into()));
    refuse(raw.clone(), &scene(&["left", "right"]), &["doubly tagged", "'left'", "'right'"]);
    let (_, notes) = accept(raw, &scene(&["left"]));
    assert!(notes[0].text.contains("physical surface right"), "a tag that is no body does not matter");
    refuse(square(), &scene(&["left", "right"]), &["body 'right'", "no triangle"]);
}

#[test]
fn cells_that_overlap() {
    let scene = scene(&["left"]);
    let mut raw = square();
    raw.triangles.push(raw.triangles[2].clone());
    refuse(raw, &scene, &["triangle 9", "duplicate of triangle 3"]);
    let mut raw = square();
    raw.points.push([0.2, 0.9]);
    raw.triangles.push(([0, 4, 9], "left".into()));
    refuse(raw, &scene, &["three triangles"]);
    let mut raw = square();
    raw.points.push([0.3, 0.4]);
    raw.triangles.push(([0, 1, 9], "left".into()));
    refuse(raw, &scene, &["same side of the edge (0, 0) to (0.5, 0)"]);
    // One piece inside the other; one shifted along a common line; one that crosses.
    for (lower, upper) in [([0.3; 2], [0.6; 2]), ([0.5, 0.0], [1.5, 1.0]), ([0.5, 0.5], [1.5, 1.5])] {
        refuse(
            both(square(), grid("left", lower, upper, [1, 1])),
            &scene,
            &["triangles overlap at (", "mesh it again"],
        );
    }
    // A fan that winds twice around its centre.
    let angle = |i: usize| std::f64::consts::TAU * i as f64 / 5.0;
    let mut raw = RawMesh { points: vec![[0.0; 2]], ..RawMesh::default() };
    for i in 0..10 {
        let r = if i < 5 { 1.0 } else { 1.1 };
        raw.points.push([r * angle(i).cos(), r * angle(i).sin()]);
        raw.triangles.push(([0, 1 + i, 1 + (i + 1) % 10], "left".into()));
    }
    refuse(raw, &scene, &["triangles overlap at (0, 0)"]);
}

#[test]
fn parts_of_a_body_that_do_not_fit() {
    let raw = both(square(), grid("left", [1.0, 0.0], [2.0, 1.0], [2, 3]));
    refuse(raw, &scene(&["left"]), &["hanging node", "body 'left'", "conformingly"]);
    let raw = both(square(), grid("left", [1.0, 0.0], [2.0, 1.0], [2, 2]));
    let (_, notes) = accept(raw, &scene(&["left"]));
    assert!(notes.iter().any(|n| n.text.contains("cut open along 2 edges")));
}

#[test]
fn names_that_do_not_fit() {
    refuse(
        square(),
        &clamp(scene(&["left"]), "left_lfet"),
        &["'left_lfet' does not exist", "left_top", "did you mean 'left_left'"],
    );
    let mut raw = square();
    raw.segments.clear();
    refuse(raw, &clamp(scene(&["left"]), "wall"), &["'wall' does not exist", "no boundary has a name"]);
    let mut raw = square();
    raw.segments.push(([0, 8], "wall".into()));
    refuse(raw, &clamp(scene(&["left"]), "wall"), &["'wall'", "(0, 0) to (1, 1)", "no edge of a triangle"]);
    let mut raw = square();
    raw.segments.push(([0, 1], "wall".into()));
    let twice = clamp(clamp(scene(&["left"]), "wall"), "left_bottom");
    refuse(raw.clone(), &twice, &["'left_bottom'", "'wall'", "(0, 0) to (0.5, 0)", "one of the two only"]);
    let (mesh, _) = accept(raw, &clamp(scene(&["left"]), "wall"));
    assert_eq!(lengths(&mesh)["wall"], 0.5);
    let mut raw = square();
    raw.segments.push(([0, 4], "wall".into()));
    refuse(raw, &load(scene(&["left"]), "wall", PRESSURE), &["'wall'", "a triangle on both sides", "outer boundary"]);
}

#[test]
fn contacts_along_shared_curves_that_do_not_fit() {
    let scene_ab = contact(scene(&["left", "right"]), "a", "b", Gap::Constant(0.0));
    refuse(shared_curve(&["a"]), &scene_ab, &["'a'", "share the edge (1, 0) to (1, 1)", "physical curves 'a' and 'b'"]);
    let mut raw = shared_curve(&["a", "b"]);
    raw.triangles.iter_mut().for_each(|(_, name)| *name = "left".into());
    let one = contact(scene(&["left"]), "a", "b", Gap::Constant(0.0));
    let (cut, _) = accept(raw, &one);
    assert_eq!(side(&cut, "a", false), side(&cut, "b", true));
    // The first of the two is on the left.
    let [t, u] = ["a", "b"].map(|name| cut.boundary(name)[0]).map(|e| cut.edges[e].triangles[0].unwrap_or(0));
    let middle = |t: usize| cut.corners(t).iter().map(|p| p[0]).sum::<f64>() / 3.0;
    assert!(middle(t) < 1.0 && middle(u) > 1.0);
}

#[test]
fn every_message_is_a_mesh_error_that_names_the_file() {
    let error = Triangulation::new(RawMesh::default(), &scene(&["left"])).expect_err("empty");
    assert!(matches!(error, MeshError::Cells { .. }));
    assert!(error.to_string().starts_with("mesh file test.msh: "));
}
