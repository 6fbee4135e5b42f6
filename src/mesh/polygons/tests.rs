//! Polygons that mesh, and polygons that do not.

use std::f64::consts::PI;

use proptest::prelude::*;

use super::{expected_triangles, fill, mesh};
use crate::mesh::testing::*;
use crate::mesh::{MeshError, Triangulation};
use crate::scene::{Gap, Polygon, Scene};

fn meshed(scene: &Scene) -> Triangulation {
    let (raw, notes) = mesh(scene).expect("good polygons");
    assert!(notes.is_empty(), "{notes:?}");
    let (mesh, notes) = Triangulation::new(raw, scene).expect("a good mesh");
    assert!(
        notes.iter().all(|n| n.text.contains("touch along") && n.text.contains("without a contact or a bond")),
        "{notes:?}"
    );
    assert_consistent(&mesh);
    mesh
}

#[track_caller]
fn refuse(size: Option<f64>, polygons: Vec<Polygon>, fragments: &[&str]) {
    let error = mesh(&geometry(scene(&["a", "b"]), size, polygons)).expect_err("bad polygons");
    assert!(matches!(error, MeshError::Polygon { .. }));
    for fragment in fragments {
        assert!(error.to_string().contains(fragment), "'{fragment}' is not in: {error}");
    }
}

#[test]
fn a_square_has_n_edges_a_side() {
    for n in [1, 3, 7, 10, 49] {
        let scene = geometry(scene(&["a"]), Some(1.0 / n as f64), vec![rectangle("a", [0.0; 2], [1.0; 2])]);
        let mesh = meshed(&scene);
        for name in ["a_bottom", "a_right", "a_top", "a_left"] {
            assert_eq!(mesh.boundary(name).len(), n);
        }
        assert!((total_area(&mesh) - 1.0).abs() < 1e-13);
        assert_eq!(euler(&mesh), 1);
        assert!(smallest_angle(&mesh) > 20.0, "{}", smallest_angle(&mesh));
        let longest = (0..mesh.edges.len()).map(|e| mesh.edge_frame(e).0).fold(0.0, f64::max);
        assert!(longest < 2.0 / n as f64, "{longest}");
    }
}

#[test]
fn without_a_size_only_corners_and_contact_ends_are_vertices() {
    let scene = geometry(
        scene(&["a", "b"]),
        None,
        vec![rectangle("a", [0.0; 2], [3.0, 1.0]), rectangle("b", [1.0, 1.0], [2.0, 2.0])],
    );
    let mesh = meshed(&scene);
    assert_eq!((mesh.points.len(), mesh.triangles.len(), euler(&mesh)), (4 + 2 + 4, 4 + 2, 2));
}

/// A block under a curve of `n` facets, beside which it is divided in two along an edge of its own.
fn faceted(n: usize) -> Vec<Polygon> {
    let curve = |i: usize| [i as f64 / n as f64, 1.0 + 0.3 * (PI * i as f64 / n as f64).sin()];
    let mut upper = vec![[0.0, 0.5], [1.0, 0.5]];
    upper.extend((0..=n).rev().map(|i| if i == 0 || i == n { [curve(i)[0], 1.0] } else { curve(i) }));
    let mut edges = vec![String::new(), "right".to_string()];
    edges.extend(vec!["top".to_string(); n]);
    edges.push("left".to_string());
    let lower = rectangle("a", [0.0; 2], [1.0, 0.5]);
    vec![lower, Polygon { body: "a".into(), points: upper, edges, arcs: Vec::new() }]
}

#[test]
fn without_a_size_facets_are_met_by_triangles_of_their_own_size() {
    for n in [24, 48] {
        let mesh = meshed(&geometry(scene(&["a"]), None, faceted(n)));
        assert_eq!((euler(&mesh), mesh.boundary("top").len()), (1, n));
        assert!(mesh.triangles.len() < 10 * n, "{n}: {}", mesh.triangles.len());
        // Sharp angles that meet in one vertex: n of them where the outline alone is triangulated.
        let mut at = vec![0; mesh.points.len()];
        mesh.triangles.iter().flatten().for_each(|v| at[*v] += 1);
        // No more than the angle that is aimed at, 20°, goes into a whole turn.
        assert!(at.iter().all(|count| *count <= 18), "{n}: {at:?}");
    }
}

#[test]
fn sides_of_contacts_keep_their_vertices() {
    let scene = contact(scene(&["a", "b"]), "a_top", "b_bottom", Gap::Constant(0.0));
    let mut polygons = vec![rectangle("a", [0.0; 2], [8.0, 1.0]), rectangle("b", [0.0, 1.0], [8.0, 2.0])];
    // Facets at both ends of the contact.
    polygons[0].points.insert(2, [8.0, 0.9]);
    polygons[0].edges.insert(2, "a_facet".into());
    let mesh = meshed(&geometry(scene, None, polygons));
    assert_eq!((mesh.boundary("a_top").len(), mesh.boundary("b_bottom").len()), (1, 1));
    assert!(mesh.boundary("a_right").len() > 1);
}

#[test]
fn partly_touching_edges_share_their_division() {
    let tilt = |p: Polygon| {
        let turn = |[x, y]: [f64; 2]| [0.8 * x - 0.6 * y + 0.1, 0.6 * x + 0.8 * y - 7.0];
        Polygon { points: p.points.into_iter().map(turn).collect(), ..p }
    };
    let scene = geometry(
        scene(&["a", "b"]),
        Some(0.13),
        vec![tilt(rectangle("a", [0.0; 2], [2.0, 1.0])), tilt(rectangle("b", [0.7, 1.0], [2.4, 1.5]))],
    );
    let mesh = meshed(&scene);
    let (top, bottom) = (side(&mesh, "a_top", false), side(&mesh, "b_bottom", true));
    let common = top.iter().filter(|e| bottom.contains(e)).count();
    assert_eq!(common, 10, "1.3 in pieces of 0.13");
    assert_eq!((top.len(), bottom.len()), (common + 6, common + 4));
}

#[test]
fn polygons_of_one_body_are_joined() {
    let mut l = vec![rectangle("a", [0.0; 2], [2.0, 1.0]), rectangle("a", [0.0, 1.0], [1.0, 2.0])];
    // Named by both, their common edge is a cut.
    let drawn = geometry(scene(&["a"]), Some(0.25), l.clone());
    let (raw, _) = mesh(&drawn).expect("good polygons");
    let (cut, notes) = Triangulation::new(raw, &drawn).expect("a good mesh");
    assert!(
        notes.len() == 1 && notes[0].text.contains("cut open along 4 edges between (0, 1) and (1, 1)"),
        "{notes:?}"
    );
    assert_eq!((cut.pieces().1, cut.boundary("a_bottom").len(), cut.boundary("a_top").len()), (2, 12, 12));
    l[1].edges[0] = String::new();
    let mesh = meshed(&geometry(scene(&["a"]), Some(0.25), l));
    assert_eq!(euler(&mesh), 1);
    assert!((total_area(&mesh) - 3.0).abs() < 1e-13);
    let outer: f64 = (0..mesh.edges.len()).filter(|&e| mesh.edges[e].is_boundary()).map(|e| mesh.edge_frame(e).0).sum();
    assert!((outer - 8.0).abs() < 1e-13);
}

#[test]
fn gap_break_points_become_vertices_of_both_sides() {
    let gap = Gap::Table(vec![[0.0, 0.1], [0.37, 0.0], [0.5, 0.0], [2.0, 0.3]]);
    let scene = contact(scene(&["a", "b"]), "a_right", "b_left", gap);
    let polygons = vec![rectangle("a", [0.0; 2], [1.0; 2]), rectangle("b", [1.0, 0.0], [2.0, 1.0])];
    for size in [None, Some(0.2)] {
        let mesh = meshed(&geometry(scene.clone(), size, polygons.clone()));
        let (first, second) = (side(&mesh, "a_right", false), side(&mesh, "b_left", true));
        assert_eq!(first, second);
        for s in [0.37_f64, 0.5] {
            assert!(first.iter().any(|e| e[0] == [1.0_f64, s].map(f64::to_bits)));
        }
        assert_eq!(first.len(), if size.is_some() { 2 + 1 + 3 } else { 3 });
    }
}

#[test]
fn a_clockwise_nonconvex_polygon_keeps_its_names() {
    let comb = Polygon {
        body: "a".into(),
        points: vec![[0.0, 0.0], [0.0, 2.0], [1.0, 0.5], [2.0, 2.0], [2.0, 0.0]],
        edges: ["left", "in", "out", "right", "foot"].map(String::from).into(),
        arcs: Vec::new(),
    };
    for size in [None, Some(0.2)] {
        let mesh = meshed(&geometry(scene(&["a"]), size, vec![comb.clone()]));
        let found = lengths(&mesh);
        for (name, length) in [("left", 2.0), ("in", 3.25_f64.sqrt()), ("out", 3.25_f64.sqrt()), ("foot", 2.0)] {
            assert!((found[name] - length).abs() < 1e-13, "{name}");
        }
        assert!((total_area(&mesh) - 2.5).abs() < 1e-13);
    }
}

#[test]
fn polygons_that_are_refused() {
    let unit = || rectangle("a", [0.0; 2], [1.0; 2]);
    let with = |points: Vec<[f64; 2]>| Polygon {
        body: "a".into(),
        edges: vec![String::new(); points.len()],
        points,
        arcs: Vec::new(),
    };
    refuse(None, vec![unit(), rectangle("b", [0.5, 0.5], [1.5, 1.5])], &["geometry.polygons[", "overlaps", "body 'b'"]);
    refuse(None, vec![unit(), rectangle("b", [0.25, 0.25], [0.5, 0.5])], &["overlaps", "a hole has to be cut out"]);
    refuse(None, vec![unit(), unit()], &["overlaps", "touch but not overlap"]);
    refuse(None, vec![unit(), rectangle("b", [0.5, 0.0], [1.5, 1.0])], &["overlaps"]);
    refuse(None, vec![with(vec![[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]])], &["crosses itself", "simple"]);
    refuse(None, vec![with(vec![[0.0, 0.0], [1.0, 0.0]])], &["has 2 points", "at least three"]);
    refuse(None, vec![with(vec![[0.0, 0.0], [2.0, 0.0], [1.0, 0.0]])], &["touches itself"]);
    refuse(None, vec![with(vec![[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 1.0]])], &["the corner (1, 0) twice"]);
    refuse(None, vec![with(vec![[0.0, 0.0], [1.0, 0.0], [f64::NAN, 0.0]])], &["not finite"]);
    refuse(None, vec![Polygon { edges: vec![], ..unit() }], &["4 points and 0 edge names"]);
    refuse(Some(1e-9), vec![unit()], &["boundary vertices", "larger size"]);
    refuse(Some(1e-5), vec![unit()], &["1.0e10 vertices", "larger size"]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]
    #[test]
    fn star_shaped_polygons_keep_area_names_and_topology(
        radii in prop::collection::vec(0.4..1.0f64, 5..12), size in 0.08..0.5f64, unit in prop::sample::select(vec![1e-6, 1.0, 1e4]),
    ) {
        let n = radii.len();
        let corner = |i: usize| { let phi = std::f64::consts::TAU * i as f64 / n as f64; [unit * radii[i] * phi.cos(), unit * radii[i] * phi.sin()] };
        let points: Vec<[f64; 2]> = (0..n).map(corner).collect();
        let shoelace: f64 = (0..n).map(|i| { let (a, b) = (points[i], points[(i + 1) % n]); 0.5 * (a[0] * b[1] - a[1] * b[0]) }).sum();
        let edges: Vec<String> = (0..n).map(|i| format!("e{i}")).collect();
        let scene = geometry(scene(&["a"]), Some(size * unit), vec![Polygon { body: "a".into(), points: points.clone(), edges, arcs: Vec::new() }]);
        let mesh = meshed(&scene);
        prop_assert!((total_area(&mesh) / shoelace - 1.0).abs() < 1e-12);
        prop_assert_eq!(euler(&mesh), 1);
        let found = lengths(&mesh);
        for i in 0..n {
            let (a, b) = (points[i], points[(i + 1) % n]);
            let name = format!("e{i}");
            prop_assert!((found[&name] / (b[0] - a[0]).hypot(b[1] - a[1]) - 1.0).abs() < 1e-12);
        }
    }
}

#[test]
fn the_number_of_triangles_is_known_before_they_are_made() {
    let square = |side: f64| Polygon {
        body: "b".into(),
        points: vec![[0.0, 0.0], [side, 0.0], [side, side], [0.0, side]],
        edges: vec![String::new(); 4],
        arcs: Vec::new(),
    };
    for (side, size) in [(1.0, 0.1), (1.0, 0.02), (3.0, 0.1)] {
        let corners = square(side).points;
        let pieces = (side / size).round() as usize;
        let boundary: Vec<[f64; 2]> = (0..4 * pieces)
            .map(|i| {
                let ([a, b], t) =
                    ([corners[i / pieces], corners[(i / pieces + 1) % 4]], (i % pieces) as f64 / pieces as f64);
                [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])]
            })
            .collect();
        let made = fill::fill(&boundary, Some(size)).expect("a simple polygon").triangles.len() as f64;
        let expected = expected_triangles(&[square(side)], Some(size));
        assert!((0.8..1.4).contains(&(expected / made)), "side {side}, size {size}: {expected} for {made}");
    }
    assert_eq!(expected_triangles(&[square(1.0), square(2.0)], None), 8.0);
}
