//! Force and moment of the loads on each piece.

use super::components::{Components, RigidMotion};
use crate::problem::{Condition, Problem};
use crate::vector::{cross, norm};

/// Resultants of body forces and tractions on each piece of the mesh, times the thickness. Exact but for round-off:
/// body forces are affine, tractions are linear along an edge, and the sums are compensated.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadResultants {
    /// Resultant force.
    pub force: Vec<[f64; 2]>,
    /// Resultant moment about the centroid of the piece, counter-clockwise.
    pub moment: Vec<f64>,
    /// Sum of the magnitudes of all forces that went into `force`: what round-off in it is relative to.
    pub magnitude: Vec<f64>,
}

impl LoadResultants {
    /// The resultants of the loads of `problem`.
    pub fn new(problem: &Problem, components: &Components) -> Self {
        let (mesh, section) = (&problem.mesh, problem.section());
        let mut sums = vec![[Compensated::default(); 4]; components.count()];
        let mut add = |c: usize, force: [f64; 2], moment: f64, magnitude: f64| {
            for (sum, value) in sums[c].iter_mut().zip([force[0], force[1], moment, magnitude]) {
                sum.add(value);
            }
        };
        for (t, &c) in components.of_triangle.iter().enumerate() {
            let body = problem.scene.bodies.get(mesh.body[t]);
            let Some(f) = body.map(|body| body.body_force.on(mesh.corners(t))).filter(|f| !f.is_none()) else {
                continue;
            };
            let arms = mesh.corners(t).map(|x| arm(x, components.centre[c]));
            let [p, q, r] = arms;
            let area = 0.5 * cross([q[0] - p[0], q[1] - p[1]], [r[0] - p[0], r[1] - p[1]]);
            let centroid = [(p[0] + q[0] + r[0]) / 3.0, (p[1] + q[1] + r[1]) / 3.0];
            if section.is_revolved() {
                let weight = section.volume(mesh.corners(t));
                let [_, axial] = section.forces(problem.body_force(t));
                add(c, [0.0, weight * axial], 0.0, weight * f.largest());
                continue;
            }
            let f = f.of_area(area);
            let force = f.resultant();
            // A force that turns its sign on a triangle is not small for that.
            let size = if f.moment() == 0.0 { norm(force) } else { area * f.largest() };
            add(c, force, cross(centroid, force) + f.moment(), size);
        }
        for (e, condition) in problem.conditions.iter().enumerate() {
            let (Condition::Traction([p, q]), Some(t)) = (condition, mesh.edges[e].triangles[0]) else { continue };
            if (p, q) == (&[0.0; 2], &[0.0; 2]) {
                continue;
            }
            let c = components.of_triangle[t];
            let [x, y] = mesh.edges[e].vertices.map(|v| arm(mesh.points[v], components.centre[c]));
            let length = (y[0] - x[0]).hypot(y[1] - x[1]);
            let half = 0.5 * length;
            if section.is_revolved() {
                let own = problem.weighted(e, [*p, *q]);
                let share = length / own.len() as f64;
                let force = own.iter().map(|t| share * t[1]).sum();
                add(c, [0.0, force], 0.0, own.iter().map(|t| share * t[0].hypot(t[1])).sum());
                continue;
            }
            let moment = length / 6.0 * (2.0 * cross(x, *p) + 2.0 * cross(y, *q) + cross(x, *q) + cross(y, *p));
            let magnitude = half * (p[0].hypot(p[1]) + q[0].hypot(q[1]));
            add(c, [half * (p[0] + q[0]), half * (p[1] + q[1])], moment, magnitude);
        }
        let total = |c: usize, i: usize| problem.scene.thickness * sums[c][i].value();
        let all = 0..components.count();
        LoadResultants {
            force: all.clone().map(|c| [total(c, 0), total(c, 1)]).collect(),
            moment: all.clone().map(|c| total(c, 2)).collect(),
            magnitude: all.map(|c| total(c, 3)).collect(),
        }
    }

    /// Work L(y) of the loads on piece `c` in the motion `y`.
    pub fn work_on(&self, motion: &RigidMotion, c: usize) -> f64 {
        let [a, b, omega] = motion.component[c];
        self.force[c][0] * a + self.force[c][1] * b + self.moment[c] * omega
    }

    /// Work L(y) of all loads in the motion `y`.
    pub fn work(&self, motion: &RigidMotion) -> f64 {
        (0..self.force.len()).map(|c| self.work_on(motion, c)).sum()
    }
}

fn arm(point: [f64; 2], centre: [f64; 2]) -> [f64; 2] {
    [point[0] - centre[0], point[1] - centre[1]]
}

/// A sum that carries its own round-off along (Neumaier).
#[derive(Debug, Clone, Copy, Default)]
struct Compensated {
    sum: f64,
    lost: f64,
}

impl Compensated {
    fn add(&mut self, value: f64) {
        let sum = self.sum + value;
        self.lost += if self.sum.abs() >= value.abs() { (self.sum - sum) + value } else { (value - sum) + self.sum };
        self.sum = sum;
    }

    fn value(&self) -> f64 {
        self.sum + self.lost
    }
}
