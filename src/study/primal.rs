//! Displacement solutions of the reference model as candidates for the comparison.

use std::collections::BTreeMap;

use crate::compare::{Candidate, FrictionForces, QuadrilateralSolution, Reactions};
use crate::element::{OnQuadrilaterals, PlainDisplacement};
use crate::mesh::Edge;
use crate::primal::{Cells, PrimalContact, PrimalSolution, Space};
use crate::problem::{Pin, Problem};
use crate::statics::{Statics, VertexPin};

/// Points to hold so that the displacement model has one solution.
pub fn pins(statics: &Statics) -> Vec<Pin> {
    let pin = |p: &VertexPin| Pin { vertex: p.vertex, direction: p.direction, of_vertices: p.of_vertices };
    statics.vertex_pins.iter().map(pin).collect()
}

/// Names the solutions and brings them onto vertices and edges.
pub fn candidates(problem: &Problem, solutions: Vec<PrimalSolution>) -> Vec<Candidate> {
    solutions.into_iter().map(|s| candidate(problem, s)).collect()
}

fn candidate(problem: &Problem, solution: PrimalSolution) -> Candidate {
    let s = &solution.seconds;
    let seconds: BTreeMap<String, f64> = [
        ("import", s.import),
        ("mesh", s.mesh),
        ("assemble", s.assemble),
        ("compile", s.compile),
        ("solve", s.solve),
        ("total", s.total),
    ]
    .into_iter()
    .map(|(k, v)| (k.to_string(), v))
    .collect();
    let mesh = &problem.mesh;
    let degree = usize::from(solution.degree);
    let vertex = solution.vertex_displacement;
    let edge = solution.edge_displacement.unwrap_or_default();
    let inside = solution.triangle_displacement.unwrap_or_default();
    let on_quadrilaterals = match solution.cells {
        Cells::Triangles => None,
        Cells::Quadrilaterals => {
            let field = OnQuadrilaterals::new(mesh, degree, [vertex.as_slice(), &edge].concat());
            field.zip(solution.gauss_points).map(|(field, gauss_points)| QuadrilateralSolution { field, gauss_points })
        }
    };
    let plain = || PlainDisplacement::from_values(mesh, degree, &vertex, &edge, &inside);
    let higher = match &on_quadrilaterals {
        Some(own) => own.field.on_triangles(mesh),
        None if degree > 2 => plain(),
        None => None,
    };
    let mean = |e: &Edge| [0, 1].map(|c| 0.5 * (vertex[e.vertices[0]][c] + vertex[e.vertices[1]][c]));
    let middle = match (&higher, degree) {
        (Some(_), 2) => edge,
        (Some(plain), _) => plain.middles(mesh),
        (None, 1) => mesh.edges.iter().map(mean).collect(),
        (None, _) => edge,
    };
    Candidate {
        name: format!("{} {}", solution.solver, Space { cells: solution.cells, degree: solution.degree }),
        solver: solution.solver,
        version: solution.solver_version,
        degree,
        vertex,
        middle,
        higher,
        cells: Vec::new(),
        on_quadrilaterals,
        reported: solution.energy,
        reported_strain: solution.strain_energy,
        is_solution: true,
        reactions: solution.contacts.map(|contacts| contacts.into_iter().map(reactions).collect()),
        iterations: solution.iterations,
        unknowns: solution.unknowns,
        seconds,
        precision: f64::EPSILON,
        numbering: None,
    }
}

fn reactions(contact: PrimalContact) -> Reactions {
    let PrimalContact { vertices, vertex_reaction: vertex, edge_reaction: edge, resultant, .. } = contact;
    let friction = contact.vertex_friction.map(|vertex| FrictionForces { vertex, edge: contact.edge_friction });
    Reactions { vertices, vertex, edge, friction, resultant }
}
