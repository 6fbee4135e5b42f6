//! Motions that stay free, and loads that are or are not compatible with them.

use super::build::{Build, transformed};
use super::scenes::{cases, tower};
use crate::problem::{Condition, Problem};
use crate::statics::{MotionKind, Solvability, Statics, check, check_with_degrees};

/// ∫ F·u + ∫ P·u for u given at vertices and linear between, by the quadrature of products of linear functions.
pub fn work_of_vertices(problem: &Problem, u: &[[f64; 2]]) -> f64 {
    let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
    let mesh = &problem.mesh;
    let mut work = 0.0;
    for (t, triangle) in mesh.triangles.iter().enumerate() {
        let [p, q, r] = mesh.corners(t);
        let area = 0.5 * ((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]));
        let force = problem.force_on(t).mean();
        work += triangle.iter().map(|v| area / 3.0 * dot(force, u[*v])).sum::<f64>();
    }
    for (e, condition) in problem.conditions.iter().enumerate() {
        let Condition::Traction([p, q]) = condition else { continue };
        let [v, w] = mesh.edges[e].vertices.map(|v| u[v]);
        let (length, _) = mesh.edge_frame(e);
        work += length / 6.0 * (2.0 * dot(*p, v) + 2.0 * dot(*q, w) + dot(*p, w) + dot(*q, v));
    }
    work
}

fn impossible(statics: &Statics) -> (&str, MotionKind, &str) {
    match &statics.equilibrium {
        Solvability::Impossible { bodies, sentence, .. } => (&bodies[0].bodies[0], bodies[0].kind, sentence),
        Solvability::Possible { .. } => panic!("taken for possible"),
    }
}

fn possible(statics: &Statics) -> bool {
    matches!(statics.equilibrium, Solvability::Possible { .. })
}

fn stack(push: [f64; 2]) -> Problem {
    Build::default()
        .block("base", [0.0, 0.0], [2.0, 1.0], 3)
        .block("top", [0.0, 1.0], [2.0, 2.0], 3)
        .clamp("base", [[0.0, 0.0], [2.0, 0.0]])
        .contact("top", "base", [[0.0, 1.0], [2.0, 1.0]])
        .push("top", [[0.0, 2.0], [2.0, 2.0]], push)
        .problem()
}

#[test]
fn block_on_a_plane_slides_under_any_sideways_load() {
    let at_rest = check(&stack([0.0, -1.0])).unwrap();
    assert!(possible(&at_rest));
    assert_eq!(at_rest.held.len(), 1);
    let [a, b, omega] = at_rest.held[0].component[1];
    assert!((a.abs() - 1.0).abs() < 1e-14 && b.abs() < 1e-14 && omega.abs() < 1e-14);
    assert_eq!(at_rest.held[0].component[0], [0.0; 3]);
    assert!(at_rest.notes[0].contains("body `top` slides along its contact `top|base` in direction"));

    for sign in [1.0, -1.0] {
        let statics = check(&stack([sign * 1e-6, -1.0])).unwrap();
        let (body, kind, _) = impossible(&statics);
        assert_eq!((body, kind), ("top", MotionKind::Slides));
    }
    let statics = check(&stack([0.15, -1.0])).unwrap();
    assert_eq!(
        impossible(&statics).2,
        "Body `top` slides along its contact `top|base` in direction (1, 0): nothing holds it against the load 0.3."
    );
    let Solvability::Possible { one_way, beyond_mesh } = at_rest.equilibrium else { unreachable!() };
    assert!(one_way.is_none() && beyond_mesh.is_none());
}

#[test]
fn unloaded_block_may_lift_off() {
    let statics = check(&stack([0.0, 0.0])).unwrap();
    assert!(matches!(statics.equilibrium, Solvability::Possible { one_way: Some(_), beyond_mesh: None }));
}

#[test]
fn clamped_scene_has_no_freedom() {
    let mut build = Build::default();
    build.block("a", [0.0, 0.0], [1.0, 1.0], 2).clamp("a", [[0.0, 0.0], [0.0, 0.5]]).gravity("a", [3.0, 1.0]);
    let statics = check(&build.problem()).unwrap();
    assert!(possible(&statics) && statics.held.is_empty() && statics.notes.is_empty());
    assert!(statics.vertex_pins.is_empty() && statics.edge_pins.is_empty());
}

#[test]
fn free_body_needs_loads_in_balance() {
    let face = |x: f64| [[x, 0.0], [x, 1.0]];
    let scene = |right: [f64; 2]| {
        let mut build = Build::default();
        build.block("a", [0.0, 0.0], [1.0, 1.0], 2).push("a", face(0.0), [-1.0, 0.0]).push("a", face(1.0), right);
        build.problem()
    };
    let balanced = check(&scene([1.0, 0.0])).unwrap();
    assert!(possible(&balanced));
    assert_eq!((balanced.held.len(), balanced.notes.len()), (3, 3));
    let statics = check(&scene([1.0 + 1e-6, 0.0])).unwrap();
    assert_eq!(impossible(&statics).1, MotionKind::MovesOff);
}

#[test]
fn couple_on_a_free_disk_turns_it() {
    let n = 24;
    let corner = |i: usize| {
        let angle = std::f64::consts::TAU * i as f64 / n as f64;
        [5.0 + angle.cos(), 2.0 + angle.sin()]
    };
    let corners: Vec<_> = (0..n).map(corner).collect();
    let mut build = Build::default();
    build.fan("disk", &corners);
    for i in 0..n {
        let (p, q) = (corners[i], corners[(i + 1) % n]);
        build.push("disk", [p, q], [q[0] - p[0], q[1] - p[1]]);
    }
    let statics = check(&build.problem()).unwrap();
    let (body, kind, _) = impossible(&statics);
    let MotionKind::Turns { centre } = kind else { panic!("{kind:?}") };
    assert!(body == "disk" && (centre[0] - 5.0).hypot(centre[1] - 2.0) < 1e-12);
}

#[test]
fn rollers_leave_their_direction_and_corners_none() {
    let mut build = Build::default();
    build.block("a", [0.0, 0.0], [1.0, 1.0], 4).roller("a", [[0.0, 0.0], [0.25, 0.0]]);
    let bottom = transformed(build.problem(), 0.4, 1e-3, 1.0, [1.0, 1.0]);
    let statics = check(&bottom).unwrap();
    assert_eq!(statics.held.len(), 1);
    let [a, b, omega] = statics.held[0].component[0];
    assert!((a * 0.4f64.sin() - b * 0.4f64.cos()).abs() < 1e-10 && omega == 0.0);
    build.roller("a", [[0.0, 0.0], [0.0, 0.25]]);
    assert!(check(&build.problem()).unwrap().held.is_empty());
}

#[test]
fn two_blocks_apart_are_judged_each_on_its_own_loads() {
    // A load 1e12 times smaller on another block is still out of balance.
    let mut build = Build::default();
    build
        .block("large", [0.0, 0.0], [1.0, 1.0], 2)
        .block("small", [5.0, 0.0], [5.1, 0.1], 2)
        .roller("large", [[0.0, 0.0], [1.0, 0.0]])
        .gravity("large", [0.0, -1e6])
        .roller("small", [[5.0, 0.0], [5.1, 0.0]])
        .gravity("small", [1e-6, 0.0]);
    let statics = check(&build.problem()).unwrap();
    let (body, kind, sentence) = impossible(&statics);
    assert_eq!((body, kind), ("small", MotionKind::Slides));
    assert!(sentence.starts_with("Body `small` slides along its rollers in direction (1, 0)"), "{sentence}");
}

#[test]
fn pieces_of_one_body_are_told_apart() {
    let mut build = Build::default();
    build.block("a", [0.0, 0.0], [1.0, 1.0], 1).block("a", [4.0, 0.0], [5.0, 1.0], 1);
    build.clamp("a", [[0.0, 0.0], [0.0, 1.0]]).push("a", [[4.0, 1.0], [5.0, 1.0]], [0.0, 2.0]);
    let statics = check(&build.problem()).unwrap();
    assert_eq!(statics.components.count(), 2);
    let (_, kind, sentence) = impossible(&statics);
    assert_eq!(kind, MotionKind::MovesOff);
    assert!(
        sentence.starts_with("The piece of body `a` around (4.5, 0.5) moves off in direction (0, 1)"),
        "{sentence}"
    );
}

#[test]
fn pressure_close_to_an_end_is_beyond_a_coarse_mesh() {
    // Four edges of length ¼ under the tower: a compressive linear pressure reaches to within 1/12 of the end, and the
    // weight of a tower that leans by s acts at (1 + s)/2.
    let reach = 2.0 * (1.0 - 1.0 / 12.0) - 1.0;
    for (lean, beyond) in [(reach - 1e-6, false), (reach + 1e-6, true), (1.0 - 1e-6, true)] {
        let statics = check(&tower(lean)).unwrap();
        let Solvability::Possible { beyond_mesh, .. } = &statics.equilibrium else { panic!("{lean}") };
        assert_eq!(beyond_mesh.is_some(), beyond, "{lean}");
        let told =
            statics.notes.iter().any(|note| note.contains("about (0.9167, 1)") && note.contains("refine the ends"));
        assert_eq!(told, beyond, "{:?}", statics.notes);
    }
}

#[test]
fn pressure_of_a_higher_degree_acts_closer_to_an_end() {
    // The first of p + 1 Bernstein polynomials has its centroid at 1/(p + 2) of an edge. Stresses of the base are linear, but
    // where both bodies have the degree.
    for p in 1..=8 {
        let reach = 2.0 * (1.0 - 0.25 / (p + 2) as f64) - 1.0;
        for (lean, beyond) in [(reach - 1e-6, false), (reach + 1e-6, true)] {
            let problem = tower(lean);
            let is_beyond = |degree: &dyn Fn(usize) -> usize| {
                let statics = check_with_degrees(&problem, degree).unwrap();
                let Solvability::Possible { beyond_mesh, .. } = statics.equilibrium else { panic!("{lean}") };
                assert_eq!(beyond_mesh.is_some(), statics.notes.iter().any(|note| note.contains("refine the ends")));
                beyond_mesh.is_some()
            };
            assert_eq!(is_beyond(&|_| p), beyond, "degree {p}, {lean}");
            let base = problem.scene.bodies.iter().position(|body| body.name == "base").unwrap();
            let linear_base = |t: usize| if problem.mesh.body[t] == base { 1 } else { p };
            assert_eq!(is_beyond(&linear_base), p > 1 || beyond, "degree {p} on a linear base, {lean}");
        }
    }
}

#[test]
fn borderline_is_told() {
    for case in cases() {
        let one_way = |excess: f64| match check(&(case.scene)(excess)).unwrap().equilibrium {
            Solvability::Possible { one_way, .. } => one_way.is_some(),
            Solvability::Impossible { .. } => panic!("{}", case.name),
        };
        assert!(one_way(0.0), "{}", case.name);
        assert!(!one_way(-1e-2), "{}", case.name);
    }
}

/// Two rings of blocks, one inside the other, in contact along `n` straight pieces of an arc from `from` to `to`.
fn bearing(n: usize, from: f64, to: f64) -> Build {
    let at = |r: f64, i: usize| {
        let angle = from + (to - from) * i as f64 / n as f64;
        [r * angle.cos(), r * angle.sin()]
    };
    let arc: Vec<_> = (0..=n).map(|i| at(1.0, i)).collect();
    let mut build = Build::default();
    let inner: Vec<_> = arc.iter().copied().chain([[0.0, 0.0]]).collect();
    build.fan("shaft", &inner);
    let outer = arc.iter().rev().copied().chain([at(2.0, 0), at(2.0, n / 2), at(2.0, n)]);
    build.fan("shell", &outer.collect::<Vec<_>>());
    build.clamp("shell", [at(2.0, 0), at(2.0, n / 2)]);
    for i in 0..n {
        build.contact("shaft", "shell", [arc[i], arc[i + 1]]);
    }
    build
}

#[test]
fn facets_of_an_arc_hold_a_shaft_and_let_go_of_it_outwards() {
    let (from, to) = (std::f64::consts::PI * 1.1, std::f64::consts::PI * 1.9);
    let mut build = bearing(40, from, to);
    build.gravity("shaft", [0.1, -1.0]);
    let statics = check(&build.problem()).unwrap();
    assert!(possible(&statics) && statics.held.is_empty(), "{:?}", statics.notes);
    build.gravity("shaft", [0.0, 1.0]);
    let statics = check(&build.problem()).unwrap();
    let (body, kind, _) = impossible(&statics);
    assert!(body == "shaft" && matches!(kind, MotionKind::LiftsOff { .. }), "{kind:?}");
}

#[test]
fn pieces_that_touch_in_a_vertex_are_hinged() {
    // Two triangles that share vertex 2 and nothing else; the first is clamped.
    let mut build = Build::default();
    build.fan("a", &[[0.0, 0.0], [1.0, 0.0], [0.5, 1.0]]).fan("b", &[[1.0, 2.0], [0.0, 2.0], [0.5, 1.0]]);
    build.clamp("a", [[0.0, 0.0], [1.0, 0.0]]).gravity("b", [0.0, -1.0]);
    let mut problem = build.problem();
    let (kept, doubled) = (3, 7);
    assert_eq!(problem.mesh.points[kept], problem.mesh.points[doubled]);
    let to_kept = |v: &mut usize| *v = if *v == doubled { kept } else { *v };
    problem.mesh.triangles.iter_mut().flatten().for_each(to_kept);
    problem.mesh.edges.iter_mut().flat_map(|edge| &mut edge.vertices).for_each(to_kept);
    let statics = check(&problem).unwrap();
    assert_eq!((statics.components.count(), statics.held.len()), (2, 3));
    assert_eq!(impossible(&statics).0, "b");
    assert!(statics.vertex_pins.iter().all(|pin| pin.vertex != kept));
}
