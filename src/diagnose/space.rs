//! Nodal forces of parts of a model, as columns that can be held against the residual.

use crate::compare::Solution;
use crate::element::geometry::{gradients, shape_gradients};
use crate::problem::Problem;
use crate::scene::{Body, Kinematics};

/// What multiplies strains in a stress: (λ tr e + 2μ e_xx, λ tr e + 2μ e_yy, 2G e_xy), with G = μ in any true material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moduli {
    /// λ, that of the plane state.
    pub lambda: f64,
    /// μ in the normal stresses.
    pub mu: f64,
    /// μ in the shear stress.
    pub shear: f64,
}

impl Moduli {
    /// Those of a material.
    pub fn of(kinematics: Kinematics, young: f64, poisson: f64) -> Self {
        let mu = young / (2.0 * (1.0 + poisson));
        let lambda = match kinematics {
            Kinematics::PlaneStrain => 2.0 * mu * poisson / (1.0 - 2.0 * poisson),
            Kinematics::PlaneStress => 2.0 * mu * poisson / (1.0 - poisson),
        };
        Moduli { lambda, mu, shear: mu }
    }

    /// Those of a body of the scene.
    pub fn of_body(problem: &Problem, body: &Body) -> Self {
        Self::of(problem.scene.kinematics, body.young, body.poisson)
    }

    /// Young's modulus and Poisson's ratio of a material with these constants.
    pub fn engineering(kinematics: Kinematics, lambda: f64, mu: f64) -> [f64; 2] {
        let poisson = match kinematics {
            Kinematics::PlaneStrain => 0.5 * lambda / (lambda + mu),
            Kinematics::PlaneStress => lambda / (lambda + 2.0 * mu),
        };
        [2.0 * mu * (1.0 + poisson), poisson]
    }

    /// The difference from `other`.
    pub fn less(self, other: Self) -> Self {
        Moduli { lambda: self.lambda - other.lambda, mu: self.mu - other.mu, shear: self.shear - other.shear }
    }
}

/// The residual of a field as a vector, with what makes such vectors from nodal forces.
pub struct Space<'a> {
    /// The field.
    pub solution: &'a Solution<'a>,
    /// Q(K u − F), each node over √K_ii.
    pub residual: Vec<f64>,
    /// Its square.
    pub square: f64,
}

impl<'a> Space<'a> {
    /// That of `solution`.
    pub fn new(solution: &'a Solution<'a>) -> Self {
        let mut space = Space { solution, residual: Vec::new(), square: 0.0 };
        space.residual = space.weighed(&solution.rest);
        space.square = space.residual.iter().map(|x| x * x).sum();
        space
    }

    /// Scene and mesh.
    pub fn problem(&self) -> &'a Problem {
        self.solution.problem
    }

    /// Number of nodes.
    pub fn count(&self) -> usize {
        self.solution.rest.len()
    }

    /// What supports and contacts leave of nodal forces, each over √K_ii.
    pub fn column(&self, mut forces: Vec<[f64; 2]>) -> Vec<f64> {
        for (node, force) in forces.iter_mut().enumerate() {
            *force = self.solution.hold(node).project(*force);
        }
        self.solution.sites.take(&mut forces);
        self.weighed(&forces)
    }

    fn weighed(&self, forces: &[[f64; 2]]) -> Vec<f64> {
        let weigh = |(force, stiffness): (&[f64; 2], &f64)| force.map(|f| f / stiffness.max(f64::MIN_POSITIVE).sqrt());
        forces.iter().zip(&self.solution.forces.stiffness).flat_map(weigh).collect()
    }

    /// The part of the squared residual that belongs to a node.
    pub fn square_at(&self, node: usize) -> f64 {
        self.residual[2 * node].powi(2) + self.residual[2 * node + 1].powi(2)
    }

    /// The nodes of triangle `t`: corners, then the midpoints opposite them.
    pub fn nodes(&self, t: usize) -> Vec<usize> {
        let mesh = &self.problem().mesh;
        let middles = mesh.triangle_edges[t].map(|e| mesh.points.len() + e);
        let all = mesh.triangles[t].into_iter().chain(middles);
        all.filter(|n| *n < self.count()).collect()
    }

    /// Adds the nodal forces of triangle `t` with the given constants, for displacements `value`.
    pub fn add_element(
        &self,
        t: usize,
        moduli: Moduli,
        value: impl Fn(usize) -> [f64; 2],
        mut add: impl FnMut(usize, [f64; 2]),
    ) {
        let problem = self.problem();
        let weight = problem.scene.thickness * problem.mesh.area(t) / 3.0;
        let g = gradients(problem.mesh.corners(t));
        let nodes = self.nodes(t);
        let u: Vec<[f64; 2]> = nodes.iter().map(|n| value(*n)).collect();
        for at in 0..3 {
            let shape = if nodes.len() == 6 { shape_gradients(&g, at).to_vec() } else { g.to_vec() };
            let mut e = [0.0; 3];
            for (d, v) in shape.iter().zip(&u) {
                let (x, y) = (v[0] - u[0][0], v[1] - u[0][1]);
                e[0] += d[0] * x;
                e[1] += d[1] * y;
                e[2] += 0.5 * (d[1] * x + d[0] * y);
            }
            let pressure = moduli.lambda * (e[0] + e[1]);
            let s = [0, 1].map(|c| pressure + 2.0 * moduli.mu * e[c]);
            let shear = 2.0 * moduli.shear * e[2];
            for (node, d) in nodes.iter().zip(&shape) {
                add(*node, [weight * (d[0] * s[0] + d[1] * shear), weight * (d[0] * shear + d[1] * s[1])]);
            }
        }
    }

    /// The column of what stresses with the constants `moduli`, body by body, ask for.
    pub fn stiffness(&self, moduli: impl Fn(usize) -> Option<Moduli>) -> Vec<f64> {
        self.stiffness_on(moduli, |node| self.solution.candidate.value(node))
    }

    /// The same for other displacements.
    pub fn stiffness_on(
        &self,
        moduli: impl Fn(usize) -> Option<Moduli>,
        value: impl Fn(usize) -> [f64; 2],
    ) -> Vec<f64> {
        let mut forces = vec![[0.0; 2]; self.count()];
        for (t, body) in self.problem().mesh.body.iter().enumerate() {
            let Some(moduli) = moduli(*body) else { continue };
            self.add_element(t, moduli, &value, |node, f| (0..2).for_each(|c| forces[node][c] += f[c]));
        }
        self.column(forces)
    }

    /// What is left of the squared residual, relative to it, with `change` added to it.
    pub fn left_with(&self, change: &[f64]) -> f64 {
        self.residual.iter().zip(change).map(|(r, c)| (r + c) * (r + c)).sum::<f64>() / self.square
    }
}
