//! Scenes of one and two blocks, in any units, and their solution.

use hypercircle::dual::{self, Condensed, DualSolution, Motion, Options};
use hypercircle::problem::{Condition, Problem};
use hypercircle::scene::Draft;
use hypercircle::statics;

use super::{Role, Setup};

pub fn motions(problem: &Problem) -> Vec<Motion> {
    let found = statics::check(problem).expect("statics are decided");
    found.held.iter().map(|m| m.at_vertices(problem, &found.components)).collect()
}

pub fn solved(problem: &Problem, method: Condensed) -> DualSolution {
    dual::solve(&method, problem, &motions(problem), &Options::default()).expect("a solution")
}

/// Two blocks of `cells` squares each with E and ν of both, tilted apart by the load; `map` moves the points.
pub fn blocks(materials: [(f64, f64); 2], cells: [usize; 2], load: fn([f64; 2]) -> [f64; 2]) -> Setup {
    let [(e, n), (f, m)] = materials;
    Setup::default()
        .material("left", [0.0, 0.0], [1.0, 1.0], cells, e, n, [0.0; 2])
        .material("right", [1.0, 0.0], [2.0, 1.0], cells, f, m, [0.0; 2])
        .on("left.left", Role::Load(load))
        .on("left.bottom", Role::Roller)
        .on("right.right", Role::Clamped([0.0; 2]))
        .contact("left.right", Some("right.left"), |_| 0.0)
}

pub fn tilting([_, y]: [f64; 2]) -> [f64; 2] {
    [4.0 - 7.0 * y, 0.0]
}

/// A block pressed into a corner of two rigid obstacles: nothing but contact holds it.
pub fn cornered(young: f64) -> Problem {
    Setup::default()
        .material("block", [0.0, 0.0], [1.0, 1.0], [8, 8], young, 0.3, [0.3, -1.0])
        .on("block.top", Role::Load(|[x, _]| [0.0, -1.0 - x]))
        .on("block.left", Role::Load(|[_, y]| [1.0 - 0.9 * y, 0.0]))
        .contact("block.bottom", None, |_| 0.0)
        .contact("block.right", None, |_| 0.0)
        .build()
}

/// A free block between the load and a clamped one.
pub fn sliding() -> Problem {
    Setup::default()
        .rectangle("left", [0.0, 0.0], [1.0, 1.0], 8)
        .rectangle("right", [1.0, 0.0], [2.0, 1.0], 8)
        .on("left.left", Role::Load(|[_, y]| [3.0 * y, 0.0]))
        .on("right.right", Role::Clamped([0.0; 2]))
        .contact("left.right", Some("right.left"), |_| 0.0)
        .build()
}

/// The problem in other units: lengths, forces per area and E multiplied.
pub fn scaled(problem: &Problem, length: f64, force: f64, young: f64) -> Problem {
    let mut p = problem.clone();
    let displacement = length * force / young;
    p.mesh.points.as_flattened_mut().iter_mut().for_each(|x| *x *= length);
    let change = |draft: &mut Draft| {
        for body in &mut draft.bodies {
            body.elasticity = body.elasticity.stiffened(young);
            body.body_force = body.body_force.times(force / length);
        }
    };
    p.scene = p.scene.changed(change).expect("a valid scene");
    for condition in &mut p.conditions {
        match condition {
            Condition::Traction(t) => t.as_flattened_mut().iter_mut().for_each(|t| *t *= force),
            Condition::Clamped(u) => u.as_flattened_mut().iter_mut().for_each(|u| *u *= displacement),
            _ => {}
        }
    }
    for pair in p.interfaces.iter_mut().flat_map(|i| &mut i.pairs) {
        pair.length *= length;
        pair.arc.iter_mut().for_each(|s| *s *= length);
        pair.gap.iter_mut().for_each(|g| *g *= displacement);
    }
    p
}
