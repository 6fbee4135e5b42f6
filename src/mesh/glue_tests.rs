//! Contact sides with different vertices, made to match or refused.

use proptest::prelude::*;

use super::glue::{Glued, glue};
use super::testing::*;
use super::{RawMesh, Triangulation};
use crate::problem::{Note, Problem};
use crate::scene::{Contact, ContactSides, Gap, Scene};

fn meet(gap: Gap) -> Scene {
    contact(scene(&["a", "b"]), "a_right", "b_left", gap)
}

/// Rotation by the angle of a 3-4-5 triangle and a shift, which make coordinates inexact.
fn tilted(mut raw: RawMesh) -> RawMesh {
    raw.points.iter_mut().for_each(|p| *p = [0.8 * p[0] - 0.6 * p[1] + 0.1, 0.6 * p[0] + 0.8 * p[1] - 3.0]);
    raw
}

fn glued(raw: RawMesh, scene: &Scene) -> (Triangulation, Vec<Note>) {
    let (mesh, _) = Triangulation::new(raw, scene).expect("a good mesh");
    let (area, topology) = (total_area(&mesh), euler(&mesh));
    let Glued { mesh, notes, .. } = glue(mesh, scene).expect("sides that coincide");
    assert_consistent(&mesh);
    assert!((total_area(&mesh) / area - 1.0).abs() < 1e-12);
    assert_eq!(euler(&mesh), topology);
    assert_eq!(side(&mesh, "a_right", false), side(&mesh, "b_left", true));
    Problem::new(scene.clone(), mesh.clone(), notes.clone()).expect("a good problem");
    (mesh, notes)
}

#[track_caller]
fn refuse(raw: RawMesh, fragments: &[&str]) {
    let scene = meet(Gap::Constant(0.0));
    let (mesh, _) = Triangulation::new(raw, &scene).expect("a good mesh");
    let message = glue(mesh, &scene).expect_err("sides that do not coincide").to_string();
    for fragment in ["test.msh", "contact 'a_right|b_left'"].iter().chain(fragments) {
        assert!(message.contains(fragment), "'{fragment}' is not in: {message}");
    }
}

#[test]
fn sides_with_different_divisions_get_the_vertices_of_both() {
    let raw = both(grid("a", [0.0; 2], [1.0; 2], [2, 4]), grid("b", [1.0, 0.0], [2.0, 1.0], [3, 6]));
    let (mesh, notes) = glued(tilted(raw), &meet(Gap::Constant(0.0)));
    assert_eq!(mesh.boundary("a_right").len(), 8, "quarters and sixths");
    assert_eq!(notes.len(), 1);
    assert_eq!(
        notes[0].text,
        "contact a_right|b_left: 2 vertices of 'a_right' inserted into 'b_left', 4 vertices of 'b_left' inserted into 'a_right'"
    );
    assert!(!notes[0].weakens_guarantee);
}

#[test]
fn a_corner_triangle_takes_vertices_on_two_edges() {
    // The triangle lies in the corner of an L, whose edges are divided; every corner takes its turn as the first.
    for turn in 0..3 {
        let mut cell = [0, 1, 2];
        cell.rotate_left(turn);
        let corner = RawMesh {
            points: vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]],
            triangles: vec![(cell, "a".into())],
            segments: vec![([0, 1], "a_right".into()), ([1, 2], "a_right".into())],
            ..RawMesh::default()
        };
        let mut upright = grid("b", [1.0, 0.0], [2.0, 1.0], [1, 3]);
        let mut flat = grid("b", [0.0, -1.0], [1.0, 0.0], [4, 1]);
        upright.segments.retain(|(_, name)| name == "b_left");
        flat.segments.retain(|(_, name)| name == "b_top");
        flat.segments.iter_mut().for_each(|(_, name)| *name = "b_left".into());
        let (mesh, _) = glued(both(corner, both(upright, flat)), &meet(Gap::Constant(0.0)));
        assert_eq!(mesh.boundary("a_right").len(), 7);
    }
}

#[test]
fn round_off_is_removed_and_more_is_reported() {
    for (shift, reported) in [(1e-13, false), (1e-8, true)] {
        let raw = both(grid("a", [0.0; 2], [1.0; 2], [2, 2]), grid("b", [1.0 + shift, shift], [2.0, 1.0], [2, 4]));
        let (mesh, _) = Triangulation::new(raw, &meet(Gap::Constant(0.0))).expect("a good mesh");
        let Glued { mesh, notes, .. } = glue(mesh, &meet(Gap::Constant(0.0))).expect("sides that coincide");
        assert_eq!(side(&mesh, "a_right", false), side(&mesh, "b_left", true));
        assert_eq!(notes.iter().any(|n| n.weakens_guarantee && n.text.contains("1.4e-8")), reported);
    }
}

#[test]
fn break_points_of_the_gap_become_vertices() {
    let gap = Gap::Table(vec![[0.0, 0.1], [0.3, 0.0], [0.5, 0.0], [1.0, 0.2]]);
    let raw = both(grid("a", [0.0; 2], [1.0; 2], [2, 2]), grid("b", [1.0, 0.0], [2.0, 1.0], [2, 2]));
    let (mesh, notes) = glued(tilted(raw), &meet(gap.clone()));
    assert_eq!(mesh.boundary("b_left").len(), 3);
    assert!(notes[0].text.contains("1 vertices inserted where the gap bends"));
    let problem = Problem::new(meet(gap.clone()), mesh, notes).expect("a good problem");
    assert!(problem.notes.iter().all(|n| !n.weakens_guarantee));

    let mut rigid = scene(&["a"]);
    rigid.draft.contacts.push(Contact::new(ContactSides::Rigid("a_right".into()), gap));
    let (mesh, _) = Triangulation::new(grid("a", [0.0; 2], [1.0; 2], [2, 2]), &rigid).expect("a good mesh");
    let Glued { mesh, .. } = glue(mesh, &rigid).expect("nothing to match");
    assert_consistent(&mesh);
    assert_eq!(mesh.boundary("a_right").len(), 3);
}

#[test]
fn sides_that_do_not_coincide_are_refused() {
    let a = || grid("a", [0.0; 2], [1.0; 2], [2, 2]);
    refuse(
        both(a(), grid("b", [1.5, 0.0], [2.0, 1.0], [2, 2])),
        &["the vertex (1, 0) of 'a_right' does not lie on 'b_left'"],
    );
    refuse(both(a(), grid("b", [1.0, 0.0], [2.0, 0.7], [2, 2])), &["the vertex (1, 1)", "name the common part"]);
    refuse(both(a(), grid("b", [1.0, -0.5], [2.0, 1.0], [2, 3])), &["the vertex (1, -0.5) of 'b_left'"]);
    let mut bent = both(a(), grid("b", [1.0, 0.0], [2.0, 1.0], [2, 2]));
    bent.points[9 + 3] = [1.1, 0.5];
    refuse(bent, &["coinciding polylines"]);
}

proptest! {
    #[test]
    fn any_two_divisions_match(cuts_a in prop::collection::vec(0.01..0.99f64, 0..8), cuts_b in prop::collection::vec(0.01..0.99f64, 0..8)) {
        let strip = |body: &str, x: [f64; 2], cuts: &[f64]| {
            let mut y: Vec<f64> = cuts.iter().copied().chain([0.0, 1.0]).collect();
            y.sort_by(f64::total_cmp);
            y.dedup();
            let mut raw = grid(body, [x[0], 0.0], [x[1], 1.0], [1, y.len() - 1]);
            raw.points.iter_mut().enumerate().for_each(|(i, p)| p[1] = y[i / 2]);
            raw
        };
        let raw = both(strip("a", [0.0, 1.0], &cuts_a), strip("b", [1.0, 2.0], &cuts_b));
        let (mesh, _) = glued(tilted(raw), &meet(Gap::Constant(0.0)));
        prop_assert!((lengths(&mesh)["a_right"] - 1.0).abs() < 1e-12);
    }
}
