//! Loads that are shared among nodes by hand where shape functions would share them.

use crate::compare::forces::functions::{Functions, nodes_along};
use crate::compare::forces::tractions as edges;
use crate::diagnose::space::Space;
use crate::diagnose::{Finding, Trial};
use crate::element::polynomial::side;
use crate::problem::Problem;

/// How a load is shared.
#[derive(Clone, Copy)]
struct Shares {
    /// In words.
    what: &'static str,
    /// Parts of a traction for the two ends and the middle of an edge.
    edge: [f64; 3],
    /// True if ends have their own value of the traction, and not the mean of the edge.
    own: bool,
    /// Parts of a body force for each corner and each middle of a triangle.
    triangle: [f64; 2],
}

const LINEAR: [Shares; 2] = [
    Shares { what: "half of each edge at its own value", edge: [0.5, 0.5, 0.0], own: true, triangle: [1.0 / 3.0, 0.0] },
    Shares { what: "half of the mean of each edge", edge: [0.5, 0.5, 0.0], own: false, triangle: [1.0 / 3.0, 0.0] },
];
const QUADRATIC: [Shares; 3] = [
    Shares {
        what: "a third of each edge",
        edge: [1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0],
        own: false,
        triangle: [1.0 / 6.0, 1.0 / 6.0],
    },
    Shares {
        what: "a quarter, a half, a quarter of each edge",
        edge: [0.25, 0.25, 0.5],
        own: true,
        triangle: [0.0, 1.0 / 3.0],
    },
    Shares { what: "all of it at the ends of edges", edge: [0.5, 0.5, 0.0], own: true, triangle: [1.0 / 3.0, 0.0] },
];

/// Every way of sharing all tractions, all body forces, or both.
pub fn trials(space: &Space<'_>) -> Vec<Trial> {
    let problem = space.problem();
    let all: &[Shares] = if space.count() > problem.mesh.points.len() { &QUADRATIC } else { &LINEAR };
    let mut trials = Vec::new();
    for shares in all {
        let [edges, bodies] = [tractions(space, shares), body_forces(space, shares)];
        let both: Vec<[f64; 2]> = edges.iter().zip(&bodies).map(|(a, b)| [a[0] + b[0], a[1] + b[1]]).collect();
        let named =
            [(edges, "edges", "tractions are"), (bodies, "bodies", "body forces are"), (both, "all", "loads are")];
        for (forces, key, what) in named {
            let column = space.column(forces);
            if column.iter().all(|x| *x == 0.0) {
                continue;
            }
            let sentence =
                format!("{what} lumped at the nodes, {}, and are not the consistent nodal forces", shares.what);
            let findings = vec![Finding::new(format!("loads/lumped-{key}"), None, None, sentence)];
            trials.push(Trial { rank: if key == "all" { 2 } else { 1 }, left: space.left_with(&column), findings });
        }
    }
    trials
}

/// Consistent forces of the tractions less those that are shared as `shares` say.
fn tractions(space: &Space<'_>, shares: &Shares) -> Vec<[f64; 2]> {
    let problem: &Problem = space.problem();
    let mesh = &problem.mesh;
    let mut forces = vec![[0.0; 2]; space.count()];
    let degree = space.solution.candidate.degree;
    for (e, traction) in problem.pressed_edges() {
        edges::add(problem, (e, &traction), degree, Functions::Values, &mut forces);
        let length = problem.scene.thickness * mesh.edge_frame(e).0;
        // Shares are those of the ends, then of the middle.
        let order: &[usize] = if degree == 2 { &[0, 2, 1] } else { &[0, 1] };
        let given = [0, 1].map(|c| {
            let along = side::component(&traction, c);
            let mean = along.iter().sum::<f64>() / along.len() as f64;
            if shares.own { [0.0, 1.0, 0.5].map(|s| side::value(&along, s)) } else { [mean; 3] }
        });
        for (node, &k) in nodes_along(mesh, e, degree).zip(order) {
            (0..2).for_each(|c| forces[node][c] -= length * shares.edge[k] * given[c][k]);
        }
    }
    forces
}

/// As [`tractions`], for the body forces.
fn body_forces(space: &Space<'_>, shares: &Shares) -> Vec<[f64; 2]> {
    let problem = space.problem();
    let mesh = &problem.mesh;
    let mut forces = vec![[0.0; 2]; space.count()];
    for t in 0..mesh.triangles.len() {
        let force = problem.force_on(t).of_area(problem.scene.thickness * mesh.area(t));
        let (whole, nodes) = (force.resultant(), space.nodes(t));
        for (k, (node, consistent)) in nodes.iter().zip(force.at_nodes(nodes.len() > 3)).enumerate() {
            let given = shares.triangle[usize::from(k >= 3)];
            (0..2).for_each(|c| forces[*node][c] += consistent[c] - given * whole[c]);
        }
    }
    forces
}
