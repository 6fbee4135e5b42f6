//! Rows of the jumps by which a rigid motion opens contacts.
//!
//! Along a straight run a jump is linear: its values at two points say all of it. Where the direction turns, n̂ and the motion are both
//! linear along the edge and the jump is quadratic. Of a curve that the edges stand for, what happens at vertices is what is meant, and so
//! whether loads can be balanced, and what is free, is asked there. But a ring that turns about the centre of an eccentric pin, and opens
//! no vertex, opens what is between them, and stresses on the edges have to balance that too.

use nalgebra::{DVector, Vector3};

use super::restraint::{Group, Part, Run, along, unit};

/// Which two points of a run tell whether it opens.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Points {
    /// Its ends.
    Ends,
    /// [`Run::reach`].
    Reach,
}

/// Where contacts keep closed in a motion that is allowed both ways.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Ties {
    /// At vertices, where the direction turns.
    Vertices,
    /// All along edges.
    Edges,
}

impl Points {
    /// The points of `run`.
    fn of(self, run: &Run) -> [[f64; 2]; 2] {
        match self {
            Points::Ends => run.ends,
            Points::Reach => run.reach,
        }
    }
}

impl Group<'_> {
    /// The rows, of unit length, that are not positive in a motion that does not penetrate at the `points` of `run`.
    pub fn jumps(&self, run: &Run, points: Points) -> [Vec<Part>; 2] {
        points.of(run).map(|point| self.jump(run, point))
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

    /// The rows that vanish when `run` keeps closed. Where its direction turns they are the jumps at its ends, and with [`Ties::Edges`] the
    /// coefficient between; otherwise the relative displacement of its middle and the relative rotation, which unlike jumps at its two ends
    /// stay independent however short the run is. With friction the run does not slide either.
    pub fn ties(&self, run: &Run, ties: Ties) -> Vec<Vec<Part>> {
        let mut rows = match (run.turning, ties) {
            (Some(ends), Ties::Edges) => self.quadratic(run, ends).map(unit).to_vec(),
            (Some(_), Ties::Vertices) => self.jumps(run, Points::Ends).to_vec(),
            (None, _) => self.straight_ties(run).to_vec(),
        };
        if run.friction > 0.0 {
            rows.push(unit(self.slip(run, run.ends[0])));
        }
        rows
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
