//! Contact sides with different vertices, made to match or refused.

use proptest::prelude::*;

use super::glue::{Glued, glue};
use crate::mesh::testing::*;
use crate::mesh::{RawMesh, Triangulation};
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
    assert!(notes[0].text.contains("1 vertex inserted where the gap bends"));
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

/// Two strips of one height, one above the other, with vertices at these places along the sides that meet.
fn strips(lower: &[f64], upper: &[f64]) -> RawMesh {
    let strip = |body: &str, y: [f64; 2], cuts: &[f64]| {
        let mut raw = grid(body, [0.0, y[0]], [1.0, y[1]], [cuts.len() - 1, 1]);
        let n = cuts.len();
        raw.points.iter_mut().enumerate().for_each(|(i, p)| p[0] = cuts[i % n]);
        raw
    };
    both(strip("low", [-1.0, 0.0], lower), strip("up", [0.0, 1.0], upper))
}

/// A contact between the two strips, along a direction where one is given.
fn across_strips(direction: Option<[f64; 2]>) -> Scene {
    let mut scene = contact(scene(&["low", "up"]), "low_top", "up_bottom", Gap::Constant(0.0));
    scene.draft.contacts[0].direction = direction;
    scene
}

/// Lengths of the pairs of the contact, summed up.
fn paired(scene: &Scene, mesh: &Triangulation) -> f64 {
    let problem = Problem::new(scene.clone(), mesh.clone(), Vec::new()).expect("a good problem");
    problem.interfaces[0].pairs.iter().map(|pair| pair.length).sum()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn vertices_beside_each_other_make_no_needles(
        cuts in prop::collection::vec(0.05..1.0f64, 3..9),
        offsets in prop::collection::vec((3.0..14.0f64, prop::bool::ANY), 9),
        along in prop::bool::ANY,
        turned in prop::bool::ANY,
    ) {
        let whole: f64 = cuts.iter().sum();
        let ends = cuts.iter().scan(0.0, |s, cut| { *s += cut / whole; Some(*s) });
        let mut lower: Vec<f64> = std::iter::once(0.0).chain(ends).collect();
        *lower.last_mut().expect("an end") = 1.0;
        let inner = 1..lower.len() - 1;
        let upper: Vec<f64> = lower.iter().enumerate().map(|(i, x)| {
            let (power, back) = offsets[i % offsets.len()];
            let off = 10.0_f64.powf(-power) * if back { -1.0 } else { 1.0 };
            if inner.contains(&i) { x + off } else { *x }
        }).collect();
        let raw = strips(&lower, &upper);
        // In the frame of a 3-4-5 triangle, where no position is a round number.
        let (raw, down) = if turned { (tilted(raw), [0.6, -0.8]) } else { (raw, [0.0, -1.0]) };
        let scene = across_strips(along.then_some(down));
        let (mesh, _) = Triangulation::new(raw, &scene).expect("a good mesh");
        let (area, before) = (total_area(&mesh), smallest_angle(&mesh));
        let Glued { mesh, notes, .. } = glue(mesh, &scene).expect("sides that coincide");
        assert_consistent(&mesh);
        prop_assert!((total_area(&mesh) / area - 1.0).abs() < 1e-12);
        let shortest = (0..mesh.edges.len()).map(|e| mesh.edge_frame(e).0).fold(f64::INFINITY, f64::min);
        // A vertex is put no nearer to another one than a millionth of an edge.
        let least = lower.windows(2).map(|w| w[1] - w[0]).fold(f64::INFINITY, f64::min);
        prop_assert!(shortest > 0.9e-6 * least, "an edge of {shortest:e}");
        prop_assert!(smallest_angle(&mesh) > 1e-7 * before, "{:e}", smallest_angle(&mesh));
        prop_assert!((paired(&scene, &mesh) - 1.0).abs() < 1e-9, "a pair is missing");
        // Sliding on straight sides changes no body.
        prop_assert!(notes.iter().all(|note| !note.weakens_guarantee), "{notes:?}");
    }
}

#[test]
fn a_vertex_beside_the_end_of_a_long_edge_stays_paired() {
    // The lower side has edges of a thousandth where the upper one has a single long one, which begins 5e-9 off.
    let lower: Vec<f64> = (0..=500).map(|k| f64::from(k) * 1e-3).chain([1.0]).collect();
    for off in [5e-9, -5e-9, 4e-7, 1e-12] {
        let upper = [0.0, 1e-3 + off, 1.0];
        for direction in [None, Some([0.0, -1.0])] {
            let scene = across_strips(direction);
            let (mesh, _) = Triangulation::new(strips(&lower, &upper), &scene).expect("a good mesh");
            let Glued { mesh, .. } = glue(mesh, &scene).expect("sides that coincide");
            assert!((paired(&scene, &mesh) - 1.0).abs() < 1e-9, "{off:e} {direction:?}: a pair is missing");
            let shortest = (0..mesh.edges.len()).map(|e| mesh.edge_frame(e).0).fold(f64::INFINITY, f64::min);
            assert!(shortest > 9e-4, "{off:e} {direction:?}: {shortest:e}");
        }
    }
}

#[test]
fn an_end_of_contact_that_is_moved_costs_the_guarantee() {
    let lower = [0.0, 0.5, 1.0];
    for (upper, weakens) in [([1e-8, 0.5, 1.0], true), ([0.0, 0.5 + 1e-8, 1.0], false)] {
        let scene = across_strips(Some([0.0, -1.0]));
        let (mesh, _) = Triangulation::new(strips(&lower, &upper), &scene).expect("a good mesh");
        let Glued { mesh, notes, .. } = glue(mesh, &scene).expect("sides that coincide");
        assert_eq!(mesh.triangles.len(), 8, "nothing is inserted");
        assert_eq!(notes.len(), 1, "{notes:?}");
        assert!(notes[0].text.starts_with("contact sides coincide only up to 1.0e-8: "), "{}", notes[0].text);
        assert_eq!(notes[0].weakens_guarantee, weakens);
    }
}
