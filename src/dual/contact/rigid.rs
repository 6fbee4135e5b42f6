//! Motions of whole pieces that no support resists, as jumps on Γ_K.
//!
//! S gives no traction to them: not a small one, none. Elimination leaves round-off in its place, which decides nothing
//! as long as contact holds a piece firmly, and everything where it rests on a millionth of its side.

use nalgebra::{Matrix3, Vector3};

use crate::dual::system::unknowns::{UnknownBlock, Unknowns};
use crate::element::polynomial::side;
use crate::problem::{Condition, ContactPair, Direction, Problem};
use crate::statics::Components;

/// Squares of displacements at the supports, relative to the largest, that are zero.
const UNRESISTED: f64 = 1e-15;

/// The jumps of a basis of the motions that supports leave to the pieces when contact does not hold them; none where
/// these are more than `most`.
pub fn unsupported(problem: &Problem, unknowns: &Unknowns, most: usize) -> Vec<Vec<f64>> {
    let mesh = &problem.mesh;
    let mut clamped = vec![false; problem.scene.bodies.len()];
    for (edge, condition) in mesh.edges.iter().zip(&problem.conditions) {
        if let (Condition::Clamped(_), Some(t)) = (condition, edge.triangles[0]) {
            clamped[mesh.body[t]] = true;
        }
    }
    if problem.interfaces.is_empty() || clamped.iter().all(|c| *c) {
        return Vec::new();
    }
    let pieces = Components::new(problem);
    let free: Vec<Vec<Vector3<f64>>> = left_by_supports(problem, &pieces);
    let mut all = Vec::new();
    if free.iter().map(Vec::len).sum::<usize>() > most {
        return all;
    }
    for (piece, motions) in free.iter().enumerate() {
        all.extend(motions.iter().map(|motion| jumps(problem, unknowns, &pieces, piece, motion)));
    }
    all
}

/// Displacement of a point in the motion (a, b, ω · size) of a piece.
fn at(pieces: &Components, piece: usize, motion: &Vector3<f64>, point: [f64; 2]) -> [f64; 2] {
    let ([x, y], size) = (pieces.centre[piece], pieces.size[piece]);
    [motion[0] - motion[2] * ((point[1] - y) / size), motion[1] + motion[2] * ((point[0] - x) / size)]
}

/// Of each piece, a basis of the motions that move no support.
fn left_by_supports(problem: &Problem, pieces: &Components) -> Vec<Vec<Vector3<f64>>> {
    let mesh = &problem.mesh;
    let mut moved = vec![Matrix3::zeros(); pieces.count()];
    let mut clamped = vec![false; pieces.count()];
    if problem.section().is_revolved() {
        // Motions along the axis alone strain nothing.
        let across = Matrix3::from_diagonal(&Vector3::new(1.0, 0.0, 1.0));
        moved.iter_mut().for_each(|moved| *moved += across);
    }
    for (e, condition) in problem.conditions.iter().enumerate() {
        let Some(t) = mesh.edges[e].triangles[0] else { continue };
        let piece = pieces.of_triangle[t];
        let mut hold = |e: usize, n: [f64; 2]| {
            for v in mesh.edges[e].vertices {
                let row = Vector3::from_fn(|i, _| {
                    let u = at(pieces, piece, &Vector3::ith(i, 1.0), mesh.points[v]);
                    u[0] * n[0] + u[1] * n[1]
                });
                moved[piece] += row * row.transpose();
            }
        };
        match condition {
            Condition::Clamped(_) => clamped[piece] = true,
            Condition::Roller { direction, .. } => hold(e, *direction),
            Condition::Elastic { bed, pair, .. } => {
                let bed = &problem.beds[*bed];
                let grounded = bed.pairs[*pair].opposite.is_none();
                let along = bed.pairs[*pair].axes.into_iter().zip(bed.stiffness).filter(|(_, k)| grounded && *k > 0.0);
                along.for_each(|(axis, _)| hold(e, axis));
            }
            _ => {}
        }
    }
    let basis = |(moved, clamped): (Matrix3<f64>, bool)| {
        let eigen = moved.symmetric_eigen();
        let none = |i: &usize| !clamped && eigen.eigenvalues[*i] <= UNRESISTED * moved.trace();
        (0..3).filter(none).map(|i| eigen.eigenvectors.column(i).into_owned()).collect()
    };
    moved.into_iter().zip(clamped).map(basis).collect()
}

/// The jump moments of a motion of one piece.
fn jumps(problem: &Problem, unknowns: &Unknowns, pieces: &Components, piece: usize, motion: &Vector3<f64>) -> Vec<f64> {
    let mesh = &problem.mesh;
    let along_direction = |pair: &ContactPair, direction: &Direction, block: &UnknownBlock| {
        let mut jump = vec![0.0; block.len];
        for (edge, sign) in pair.edges.into_iter().zip([1.0, -1.0]) {
            let t = edge.and_then(|e| mesh.edges[e].triangles[0]);
            if t.is_none_or(|t| pieces.of_triangle[t] != piece) {
                continue;
            }
            // Opposite vertices lie on one line along the direction of contact, where a rigid motion is the same along it.
            let u = pair.first.map(|v| at(pieces, piece, motion, mesh.points[v]));
            let along = |end: usize, other: usize| {
                let n = direction.ends[other];
                sign * (u[end][0] * n[0] + u[end][1] * n[1])
            };
            let (first, last) = (along(0, 0), along(1, 1));
            let moments = if direction.is_constant() {
                side::moments(&[first, last], block.len - 1)
            } else {
                side::moments(&[first, 0.5 * (along(0, 1) + along(1, 0)), last], block.len - 1)
            };
            jump.iter_mut().zip(moments).for_each(|(j, m)| *j += pair.length * m);
        }
        jump
    };
    let normal = problem.pairs().zip(unknowns.jump_blocks());
    let tangential =
        problem.pairs().filter_map(|pair| Some((pair, pair.friction?.tangent))).zip(unknowns.slide_blocks());
    normal
        .flat_map(|(pair, block)| along_direction(pair, &pair.direction, block))
        .chain(tangential.flat_map(|((pair, tangent), block)| along_direction(pair, &tangent, block)))
        .collect()
}
