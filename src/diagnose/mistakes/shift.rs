//! Right displacements with one constant added to all of them, which supports show and strains do not.

use nalgebra::{Matrix2, Vector2};

use crate::bounds::Hold;
use crate::compare::forces::springs::{Part, spring_forces};
use crate::compare::solution::SOLVER;
use crate::diagnose::space::Space;
use crate::diagnose::words::number;
use crate::diagnose::{Finding, Trial};

/// Components of the directions of supports that are smaller than this do not tell a shift.
const TELLS: f64 = 1e-6;

/// The shift that all supports miss by, undone; `hoop` are the nodal forces of the hoop stress of a constant displacement.
pub fn trial(space: &Space<'_>, hoop: impl Fn([f64; 2]) -> Vec<[f64; 2]>) -> Option<Trial> {
    let shift = shift(space)?;
    let back = shift.map(|x| -x);
    let mut change = space.column(hoop(back));
    let springs = springs(space, [0.0; 2]).into_iter().zip(springs(space, back));
    change.iter_mut().zip(springs).for_each(|(c, (own, moved))| *c += moved - own);
    let [x, y] = shift.map(number);
    let sentence = format!("every displacement is off by the same ({x}, {y})");
    let finding = Finding::new("displacement/rigid", Some(shift[0].hypot(shift[1])), Some(0.0), sentence);
    Some(Trial { rank: 0, left: space.left_with(&change), findings: vec![finding] })
}

/// By how much the displacements of all nodes with supports are off, where that is one vector.
fn shift(space: &Space<'_>) -> Option<[f64; 2]> {
    let solution = space.solution;
    let (mut matrix, mut side) = (Matrix2::zeros(), Vector2::zeros());
    let mut misses: Vec<(Vector2<f64>, f64)> = Vec::new();
    for node in 0..space.count() {
        let u = solution.candidate.value(node);
        match solution.hold(node) {
            Hold::Free => {}
            Hold::Line { normal, value } => misses.push((normal.into(), u[0] * normal[0] + u[1] * normal[1] - value)),
            Hold::Fixed(value) => {
                misses.push((Vector2::x(), u[0] - value[0]));
                misses.push((Vector2::y(), u[1] - value[1]));
            }
        }
    }
    for (normal, off) in &misses {
        matrix += normal * normal.transpose();
        side += normal * *off;
    }
    if matrix.symmetric_eigenvalues().min() <= TELLS * misses.len() as f64 {
        return None;
    }
    let shift = matrix.lu().solve(&side)?;
    let enough = (SOLVER + solution.candidate.precision) * solution.reference;
    let same = misses.iter().all(|(normal, off)| (normal.dot(&shift) - off).abs() <= enough);
    (same && shift.norm() > enough).then_some([shift.x, shift.y])
}

/// The column of the forces of all springs, layers and elastic contacts, with `more` added to all displacements.
fn springs(space: &Space<'_>, more: [f64; 2]) -> Vec<f64> {
    let problem = space.problem();
    let of = (space.solution.candidate.degree.min(2), space.count());
    let value = |node: usize| {
        let u = space.solution.candidate.value(node);
        [u[0] + more[0], u[1] + more[1]]
    };
    let mut forces = vec![[0.0; 2]; space.count()];
    for (bed, direction) in problem.beds.iter().flat_map(|bed| [(bed, 0), (bed, 1)]) {
        let own = spring_forces(problem, bed, direction, Part::Own, of, value);
        let stiffness = bed.stiffness[direction];
        forces.iter_mut().zip(own).for_each(|(f, own)| (0..2).for_each(|c| f[c] += stiffness * own[c]));
    }
    space.column(forces)
}
