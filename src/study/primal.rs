//! Displacement solutions of the reference model as candidates for the comparison.

use std::collections::BTreeMap;

use crate::compare::{Candidate, Reactions};
use crate::primal::PrimalSolution;
use crate::problem::{Pin, Problem};
use crate::statics::Statics;

/// Points to hold so that the displacement model has one solution.
pub fn pins(statics: &Statics) -> Vec<Pin> {
    statics.vertex_pins.iter().map(|p| Pin { vertex: p.vertex, direction: p.direction }).collect()
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
    let middle = solution.edge_displacement.unwrap_or_else(|| {
        let u = &solution.vertex_displacement;
        problem.mesh.edges.iter().map(|e| [0, 1].map(|c| 0.5 * (u[e.vertices[0]][c] + u[e.vertices[1]][c]))).collect()
    });
    Candidate {
        name: format!("{} P{}", solution.solver, solution.degree),
        solver: solution.solver,
        version: solution.solver_version,
        degree: usize::from(solution.degree),
        vertex: solution.vertex_displacement,
        middle,
        reported: Some(solution.energy),
        reported_strain: Some(solution.strain_energy),
        is_solution: true,
        reactions: Some(
            solution
                .contacts
                .into_iter()
                .map(|c| Reactions {
                    vertices: c.vertices,
                    vertex: c.vertex_reaction,
                    edge: c.edge_reaction,
                    resultant: c.resultant,
                })
                .collect(),
        ),
        iterations: solution.iterations,
        unknowns: solution.unknowns,
        seconds,
        precision: f64::EPSILON,
        numbering: None,
    }
}
