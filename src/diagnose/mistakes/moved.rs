//! Points that the displacement has moved already: the mesh is x + u, and its solution belongs to x.

use crate::bounds::{Nodes, holds};
use crate::compare::solution::Sites;
use crate::compare::{NodalForces, Solution};
use crate::diagnose::space::Space;
use crate::diagnose::words::number;
use crate::diagnose::{Finding, Trial};
use crate::problem::{Direction, Problem};

/// The mesh moved back, where it still is one.
pub fn trial(space: &Space<'_>) -> Option<Trial> {
    let candidate = space.solution.candidate;
    let problem = moved_back(space.problem(), &candidate.vertex)?;
    let forces = NodalForces::new(&problem, candidate.degree, &candidate.vertex, &candidate.middle);
    let holds = holds(&problem).ok()?;
    let inside = std::iter::repeat_n(candidate.degree, problem.mesh.edges.len());
    let mut rest = forces.unsupported(&holds, &Nodes::new(problem.mesh.points.len(), inside));
    Sites::new(&problem, candidate.degree, &holds).take(&mut rest);
    let sum = forces.energy_size(|i| rest[i][0].hypot(rest[i][1])).powi(2);
    let sentence = "the points of the file are displaced already: they are x + u, and the displacement solves the scene on the mesh of \
                    the points x";
    let findings = vec![Finding::new("points/displaced", None, None, sentence)];
    Some(Trial { rank: 0, left: sum / space.square, findings })
}

/// The problem on the points x of a mesh of points x + u.
fn moved_back(problem: &Problem, u: &[[f64; 2]]) -> Option<Problem> {
    let mut problem = problem.clone();
    let mesh = &mut problem.mesh;
    mesh.points.iter_mut().zip(u).for_each(|(x, u)| (0..2).for_each(|c| x[c] -= u[c]));
    if (0..mesh.triangles.len()).any(|t| mesh.area(t) <= 0.0) {
        return None;
    }
    for pair in problem.interfaces.iter_mut().flat_map(|interface| &mut interface.pairs) {
        let along_normal = pair.direction.is_constant() && pair.direction.ends[0] == pair.normal;
        if let (true, Some(edge)) = (along_normal, pair.edges[0]) {
            let (length, normal) = problem.mesh.edge_frame(edge);
            (pair.length, pair.normal, pair.direction) = (length, normal, Direction::constant(normal));
        }
    }
    Some(problem)
}

/// The residual that coordinates leave which are off by δ, in parts of δ/h with the shortest edge h: no more than that.
const LEAVES: f64 = 20.0;

/// Coordinates of the file that were rounded, where that can leave as much as is left.
pub fn rounded(solution: &Solution<'_>) -> Option<Finding> {
    let mesh = &solution.problem.mesh;
    let off = solution.candidate.numbering.as_ref().map_or(0.0, |numbering| numbering.off);
    let shortest = (0..mesh.edges.len()).map(|e| mesh.edge_frame(e).0).fold(f64::INFINITY, f64::min);
    let sentence = format!(
        "points of the file are up to {} away from the vertices of the scene's mesh, as if coordinates were rounded, and that alone can leave as much",
        number(off)
    );
    (off > 0.0 && solution.residual() <= LEAVES * off / shortest)
        .then(|| Finding::new("points/rounded", Some(off), Some(0.0), sentence))
}
