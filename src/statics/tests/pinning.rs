//! Pins: together they remove exactly the motions that nothing holds, and well.

use super::build::{Build, transformed};
use crate::problem::{Condition, Problem};
use crate::statics::{Statics, check};
use nalgebra::DMatrix;

/// Smallest over largest singular value of pin × held motion.
fn conditioning(rows: usize, held: usize, entry: impl Fn(usize, usize) -> f64) -> f64 {
    assert_eq!(rows, held);
    let values = DMatrix::from_fn(rows, held, entry).singular_values();
    values.min() / values.max()
}

/// Checks both kinds of pins of `problem`, with `freedom` motions to remove.
fn assert_pinned(problem: &Problem, freedom: usize) -> Statics {
    let statics = check(problem).unwrap();
    assert_eq!(statics.held.len(), freedom);
    let u = statics.held_at_vertices(problem);
    let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
    let vertex = conditioning(statics.vertex_pins.len(), freedom, |i, j| {
        let pin = statics.vertex_pins[i];
        dot(pin.direction, u[j][pin.vertex])
    });
    assert!(vertex > 0.05 / freedom as f64, "vertex pins: {vertex}");
    let edge = conditioning(statics.edge_pins.len(), freedom, |i, j| {
        let pin = statics.edge_pins[i];
        let [a, b] = problem.mesh.edges[pin.edge].vertices;
        let [near, far] = if pin.end == 0 { [a, b] } else { [b, a] };
        // ∫ u q_p over the edge, by Simpson, divided by half the length.
        let middle = [0, 1].map(|k| 0.5 * (u[j][near][k] + u[j][far][k]));
        dot(pin.direction, [0, 1].map(|k| (u[j][near][k] + 2.0 * middle[k]) / 3.0))
    });
    assert!(edge > 0.05 / freedom as f64, "edge pins: {edge}");
    statics
}

#[test]
fn free_bodies_of_all_sizes_and_shapes() {
    for length in [1e-6, 1.0, 1e6] {
        for height in [1e-4, 1.0, 1e4] {
            let mut build = Build::default();
            build.block("a", [0.0, 0.0], [1.0, height], 3);
            let statics = assert_pinned(&transformed(build.problem(), 0.3, length, 1.0, [length, 0.0]), 3);
            let axes = statics.vertex_pins.iter().map(|pin| pin.direction);
            assert!(
                axes.chain(statics.edge_pins.iter().map(|pin| pin.direction))
                    .all(|d| d == [1.0, 0.0] || d == [0.0, 1.0])
            );
        }
    }
}

#[test]
fn sliding_blocks_are_pinned_off_their_contacts() {
    let mut build = Build::default();
    build.block("base", [0.0, 0.0], [2.0, 1.0], 3).block("top", [0.0, 1.0], [2.0, 2.0], 3);
    build.rigid("base", [[0.0, 0.0], [2.0, 0.0]]).contact("top", "base", [[0.0, 1.0], [2.0, 1.0]]);
    let problem = build.problem();
    let statics = assert_pinned(&problem, 2);
    for pin in &statics.edge_pins {
        assert!(matches!(problem.conditions[pin.edge], Condition::Interior | Condition::Traction(_)));
    }
    for pin in &statics.vertex_pins {
        assert!(problem.mesh.points[pin.vertex][1].fract() != 0.0 || problem.mesh.points[pin.vertex][1] == 2.0);
    }
}

#[test]
fn single_triangle_between_rollers_is_pinned_along_them() {
    let mut build = Build::default();
    build.block("a", [0.0, 0.0], [1.0, 1.0], 1);
    for line in [[[0.0, 0.0], [1.0, 0.0]], [[0.0, 1.0], [1.0, 1.0]]] {
        build.roller("a", line);
    }
    let statics = assert_pinned(&build.problem(), 1);
    assert!(statics.vertex_pins[0].direction[1].abs() < 1e-15);
}

#[test]
fn fifty_blocks_in_a_stack() {
    let mut build = Build::default();
    let names: Vec<_> = (0..50).map(|i| format!("b{i}")).collect();
    for (i, name) in names.iter().enumerate() {
        let y = i as f64;
        build.block(name, [0.0, y], [2.0, y + 1.0], 2).gravity(name, [0.0, -1.0]);
    }
    for (i, pair) in names.windows(2).enumerate() {
        let y = i as f64 + 1.0;
        build.contact(&pair[1], &pair[0], [[0.0, y], [2.0, y]]);
    }
    build.rigid("b0", [[0.0, 0.0], [2.0, 0.0]]);
    let statics = assert_pinned(&transformed(build.problem(), 0.2, 1.0, 1.0, [0.0; 2]), 50);
    assert_eq!(statics.notes[6], "44 more rigid motions are free in the same way.");
}
