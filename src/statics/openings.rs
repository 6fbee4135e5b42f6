//! Rows of the jumps by which a rigid motion opens contacts.
//!
//! Along a straight run a jump is linear: its values at two points say all of it. Where the direction turns, n̂ and the motion are both
//! linear along the edge and the jump is quadratic. It vanishes at both ends of an edge of a ring that turns about the centre of an
//! eccentric obstacle, and yet pressure along the edge resists that: the coefficient between the ends counts as well.

use nalgebra::{DVector, Vector3};

use super::restraint::{Group, Part, Run, along, unit};
use crate::element::polynomial::side;

/// What tells whether a run opens.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Points {
    /// Its ends: any pressure along it. Where the direction turns, the Bernstein coefficients of the jump.
    Ends,
    /// [`Run::reach`]: the pressures of the mesh. Where the direction turns, the work of each of their coefficients.
    Reach,
    /// Its ends alone, as for displacements that contact holds at vertices.
    Vertices,
}

impl Points {
    /// The points of `run` at which it is told what touches.
    fn of(self, run: &Run) -> [[f64; 2]; 2] {
        match self {
            Points::Ends | Points::Vertices => run.ends,
            Points::Reach => run.reach,
        }
    }
}

impl Group<'_> {
    /// The rows, of unit length, that are not positive in a motion that does not penetrate along `run`.
    pub fn jumps(&self, run: &Run, points: Points) -> Vec<Vec<Part>> {
        let rows = match (run.turning, points) {
            (None, _) | (_, Points::Vertices) => points.of(run).map(|point| self.across(run, point)).to_vec(),
            (Some(ends), Points::Ends) => self.quadratic(run, ends).to_vec(),
            (Some(ends), Points::Reach) => moments(&self.quadratic(run, ends), run.degree[0]),
        };
        rows.into_iter().map(unit).collect()
    }

    /// The Bernstein coefficients of the jump along a run with these directions at its ends.
    fn quadratic(&self, run: &Run, [m, n]: [[f64; 2]; 2]) -> [Vec<Part>; 3] {
        let [a, b] = run.ends;
        let [first, far, near, last] = [(a, m), (a, n), (b, m), (b, n)].map(|(x, n)| self.apart(run, x, n));
        let middle = far.iter().zip(&near).map(|((member, p), (_, q))| (*member, 0.5 * (p + q))).collect();
        [first, middle, last]
    }

    /// The row (v' − v'')·n̂ at `point` of `run`, scaled to unit length.
    fn jump(&self, run: &Run, point: [f64; 2]) -> Vec<Part> {
        unit(self.across(run, point))
    }

    /// The rows that vanish when `run` keeps closed: where its direction turns, its [`Self::jumps`]; otherwise the relative displacement
    /// of its middle and the relative rotation, which unlike jumps at its two ends stay independent however short the run is. With
    /// friction the run does not slide either.
    pub fn ties(&self, run: &Run, points: Points) -> Vec<Vec<Part>> {
        let mut ties = match (run.turning, points) {
            (Some(_), Points::Vertices) => self.jumps(run, points),
            (Some(_), _) => self.jumps(run, Points::Ends),
            (None, _) => self.straight_ties(run).to_vec(),
        };
        if run.friction > 0.0 {
            ties.push(unit(self.slip(run, run.ends[0])));
        }
        ties
    }

    fn straight_ties(&self, run: &Run) -> [Vec<Part>; 2] {
        let [p, q] = run.ends;
        let middle = [0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])];
        let size = |c: &usize| self.components.size[*c];
        let smallest = run.sides.iter().flatten().map(size).fold(f64::INFINITY, f64::min);
        let sides = run.sides.iter().zip([1.0, -1.0]);
        let turn = sides.filter_map(|(side, sign)| {
            let c = (*side)?;
            Some((self.member(c)?, Vector3::new(0.0, 0.0, sign * smallest / size(&c))))
        });
        [self.jump(run, middle), unit(turn.collect())]
    }

    /// The runs and ends that stay in touch in a `motion` that turns pieces; none where no piece turns or nothing touches.
    pub fn touching(&self, motion: &DVector<f64>, points: Points) -> Option<Vec<(&Run, [f64; 2])>> {
        let size = motion.amax();
        let turns = (0..motion.len()).any(|i| i % 3 == 2 && motion[i].abs() > 1e-5 * size);
        let ends = self.runs.iter().flat_map(|run| points.of(run).map(|end| (*run, end)));
        let jump = |run: &Run, end| self.jump(run, end).iter().map(|part| along(part, motion)).sum::<f64>();
        let touching: Vec<_> = ends.filter(|(run, end)| jump(run, *end).abs() <= 1e-5 * size).collect();
        (turns && !touching.is_empty()).then_some(touching)
    }
}

/// The work of each coefficient of a pressure of this degree on a jump with these Bernstein coefficients.
fn moments(jump: &[Vec<Part>; 3], degree: usize) -> Vec<Vec<Part>> {
    let weights: Vec<Vec<f64>> = (0..3).map(|i| side::moments(&[0, 1, 2].map(|k| f64::from(i == k)), degree)).collect();
    let part = |k: usize, at: usize| {
        let sum = (0..3).fold(Vector3::zeros(), |sum, i| sum + weights[i][k] * jump[i][at].1);
        (jump[0][at].0, sum)
    };
    (0..=degree).map(|k| (0..jump[0].len()).map(|at| part(k, at)).collect()).collect()
}
