//! The solution that the displacement model writes, and that it fits the problem.

use std::fs;
use std::path::Path;

use serde::Deserialize;

use super::solution_file;
use crate::element::displacement::on_quadrilaterals::{HIGHEST, can_carry};
use crate::element::displacement::plain::inner_len;
use crate::primal::{Cells, PrimalError, PrimalSolution, Space};
use crate::problem::Problem;

/// The largest Gauss rule in each direction of a quadrilateral.
const MOST_GAUSS_POINTS: usize = 20;

#[derive(Deserialize)]
struct SolutionFile {
    format: String,
    version: u32,
    #[serde(flatten)]
    solution: PrimalSolution,
}

/// Read the result for `space` from `folder` and check that it fits `problem`.
pub fn read_solution(folder: &Path, space: Space, problem: &Problem) -> Result<PrimalSolution, PrimalError> {
    let file = solution_file(space);
    let text = fs::read(folder.join(&file)).map_err(|error| {
        let reason = format!("it cannot be read ({error})");
        PrimalError::BadResult { file, reason }
    })?;
    parse_solution(&text, space, problem)
}

/// The result for `space` from the content of its file, once it was seen to fit `problem`.
///
/// # Errors
/// [`PrimalError::BadResult`].
pub fn parse_solution(text: &[u8], space: Space, problem: &Problem) -> Result<PrimalSolution, PrimalError> {
    let bad = |reason: String| PrimalError::BadResult { file: solution_file(space), reason };
    let found: SolutionFile = serde_json::from_slice(text).map_err(|error| bad(error.to_string()))?;
    if (found.format.as_str(), found.version) != ("hypercircle-primal", 1) {
        return Err(bad(format!(
            "expected hypercircle-primal version 1, found {} version {}",
            found.format, found.version
        )));
    }
    check(&found.solution, space, problem).map_err(bad)?;
    Ok(found.solution)
}

fn check(solution: &PrimalSolution, Space { cells, degree }: Space, problem: &Problem) -> Result<(), String> {
    if solution.cells != cells {
        return Err(format!("its cells are {}", solution.cells.name()));
    }
    if cells == Cells::Quadrilaterals && !(usize::from(degree) <= HIGHEST && can_carry(&problem.mesh)) {
        return Err(format!(
            "on quadrilaterals a result has a degree of at most {HIGHEST}, on a mesh file of convex quadrilaterals alone"
        ));
    }
    if cells == Cells::Quadrilaterals && !solution.gauss_points.is_some_and(|n| (1..=MOST_GAUSS_POINTS).contains(&n)) {
        return Err(format!("gauss_points, from 1 to {MOST_GAUSS_POINTS}, is missing"));
    }
    if solution.degree != degree {
        return Err(format!("it holds degree {}, not {degree}", solution.degree));
    }
    if let Some(rounding) = solution.energy_rounding.filter(|rounding| *rounding < 0.0) {
        return Err(format!("energy_rounding is {rounding}, and an error cannot be negative"));
    }
    // It is part of the names of checks.
    if solution.solver.contains(['/', '|']) || solution.solver.contains(char::is_control) || solution.solver.len() > 60
    {
        return Err("solver has to be a name of at most 60 bytes without /, | and line breaks".to_owned());
    }
    if let Some(other) = [solution.energy, solution.strain_energy].into_iter().flatten().find(|e| !e.is_finite()) {
        return Err(format!("an energy is {other}"));
    }
    let vertices = problem.mesh.points.len();
    if solution.vertex_displacement.len() != vertices {
        return Err(format!("{} vertex displacements for {vertices} vertices", solution.vertex_displacement.len()));
    }
    let k = usize::from(degree);
    let expected = (k > 1).then_some((k - 1) * problem.mesh.edges.len());
    if solution.edge_displacement.as_ref().map(Vec::len) != expected {
        return Err("edge displacements do not match the edges".to_owned());
    }
    let expected = (k > 2).then_some(inner_len(k) * problem.mesh.triangles.len());
    if solution.triangle_displacement.as_ref().map(Vec::len) != expected {
        return Err("triangle displacements do not match the triangles".to_owned());
    }
    let Some(contacts) = &solution.contacts else { return Ok(()) };
    let names = problem.interfaces.iter().map(|interface| interface.name.as_str());
    if !contacts.iter().map(|contact| contact.name.as_str()).eq(names) {
        return Err("its contacts are not those of the scene".to_owned());
    }
    for (contact, interface) in contacts.iter().zip(&problem.interfaces) {
        let edges = (k > 1).then_some(interface.pairs.len());
        let fits = contact.vertices.len() == contact.vertex_reaction.len()
            && contact.vertices.iter().all(|&v| v < vertices)
            && contact.edge_reaction.as_ref().map(Vec::len) == edges
            && contact
                .edge_reaction
                .iter()
                .flatten()
                .zip(&interface.pairs)
                .all(|(inner, pair)| inner.len() == if pair.direction.is_constant() { k - 1 } else { k });
        if !fits {
            return Err(format!("the reactions of {} do not match its edges", contact.name));
        }
        let rubs = contact.vertex_friction.as_ref().is_none_or(|forces| forces.len() == contact.vertices.len());
        let inside = contact.edge_friction.iter().flatten().zip(contact.edge_reaction.iter().flatten());
        let few = contact.edge_friction.as_ref().is_some_and(|pairs| Some(pairs.len()) != edges);
        if !rubs || few || inside.into_iter().any(|(own, other)| own.len() != other.len()) {
            return Err(format!("the friction forces of {} do not match its edges", contact.name));
        }
    }
    Ok(())
}
