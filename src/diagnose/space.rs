//! Nodal forces of parts of a model, as columns that can be held against the residual.

use crate::bounds::{Cell, Hold};
use crate::compare::Solution;
use crate::compare::forces::{cells, turned};
use crate::elasticity::Elasticity;
use crate::element::geometry::{gradients, shape_gradients};
use crate::element::{Material, Quadrilateral};
use crate::problem::Problem;
use crate::scene::{Body, Kinematics};

/// Factors of strains in a stress: (λ tr e + 2μ e_xx, λ tr e + 2μ e_yy, 2G e_xy), with G = μ in any true material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moduli {
    /// λ, that of the plane state.
    pub lambda: f64,
    /// μ in the normal stresses.
    pub mu: f64,
    /// μ in the shear stress.
    pub shear: f64,
    /// The anisotropic part: stresses (xx, yy, xy) of unit strains ε_xx, ε_yy and ε_xy.
    pub other: [[f64; 3]; 3],
}

impl Moduli {
    /// No stiffness at all.
    pub const NONE: Self = Moduli { lambda: 0.0, mu: 0.0, shear: 0.0, other: [[0.0; 3]; 3] };

    /// Those of a material that is not isotropic.
    pub fn of_material(material: &Material) -> Self {
        let other = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|e| material.stress(e));
        Moduli { other, ..Self::NONE }
    }

    /// Those of any Hooke's law in a plane state.
    pub fn of_law(kinematics: Kinematics, elasticity: &Elasticity) -> Self {
        match elasticity.isotropic() {
            Some([young, poisson]) => Self::of(kinematics, young, poisson),
            None => Self::of_material(&Material::new(kinematics, elasticity)),
        }
    }

    /// Those of a material.
    pub fn of(kinematics: Kinematics, young: f64, poisson: f64) -> Self {
        let mu = young / (2.0 * (1.0 + poisson));
        let lambda = match kinematics {
            Kinematics::PlaneStrain | Kinematics::Axisymmetric => 2.0 * mu * poisson / (1.0 - 2.0 * poisson),
            Kinematics::PlaneStress => 2.0 * mu * poisson / (1.0 - poisson),
        };
        Moduli { lambda, mu, shear: mu, other: [[0.0; 3]; 3] }
    }

    /// Those of a body of the scene.
    pub fn of_body(problem: &Problem, body: &Body) -> Self {
        Self::of_law(problem.scene.kinematics, &body.elasticity)
    }

    /// Young's modulus and Poisson's ratio of a material with these constants.
    pub fn engineering(kinematics: Kinematics, lambda: f64, mu: f64) -> [f64; 2] {
        let poisson = match kinematics {
            Kinematics::PlaneStrain | Kinematics::Axisymmetric => 0.5 * lambda / (lambda + mu),
            Kinematics::PlaneStress => lambda / (lambda + 2.0 * mu),
        };
        [2.0 * mu * (1.0 + poisson), poisson]
    }

    /// The stress of a strain (xx, yy, xy).
    pub fn stress(&self, e: [f64; 3]) -> [f64; 3] {
        let pressure = self.lambda * (e[0] + e[1]);
        let own = [pressure + 2.0 * self.mu * e[0], pressure + 2.0 * self.mu * e[1], 2.0 * self.shear * e[2]];
        let [xx, yy, xy] = &self.other;
        [0, 1, 2].map(|i| own[i] + (xx[i] * e[0] + yy[i] * e[1] + xy[i] * e[2]))
    }

    /// The difference from `other`.
    pub fn less(self, other: Self) -> Self {
        let apart = |i: usize| [0, 1, 2].map(|j| self.other[i][j] - other.other[i][j]);
        Moduli {
            lambda: self.lambda - other.lambda,
            mu: self.mu - other.mu,
            shear: self.shear - other.shear,
            other: [0, 1, 2].map(apart),
        }
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
    /// Of every triangle the quadrilateral that it is a part of.
    cell_of: Vec<Option<usize>>,
}

impl<'a> Space<'a> {
    /// That of `solution`.
    pub fn new(solution: &'a Solution<'a>) -> Self {
        let cell_of = cells::of_triangles(solution.problem, &solution.candidate.cells);
        let mut space = Space { solution, residual: Vec::new(), square: 0.0, cell_of };
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

    /// Nodal forces less the components that supports and contacts take, each over √K_ii.
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

    /// The quadrilateral that triangle `t` is a part of.
    pub fn cell(&self, t: usize) -> Option<&'a Cell> {
        Some(&self.solution.candidate.cells[self.cell_of[t]?])
    }

    /// As [`Self::cell`], but `None` where `t` is not the first of its triangles, which counts for all of them.
    pub fn counted(&self, t: usize) -> Option<Option<&'a Cell>> {
        match self.cell(t) {
            Some(cell) if cell.triangles.first() != Some(&t) => None,
            cell => Some(cell),
        }
    }

    /// The nodes of triangle `t`: corners, then the midpoints opposite them; those of its quadrilateral where it is a part of one.
    pub fn nodes(&self, t: usize) -> Vec<usize> {
        if let Some(cell) = self.cell(t) {
            return cell.nodes.clone();
        }
        let mesh = &self.problem().mesh;
        let middles = mesh.triangle_edges[t].map(|e| mesh.points.len() + e);
        let all = mesh.triangles[t].into_iter().chain(middles);
        all.filter(|n| *n < self.count()).collect()
    }

    /// Adds the nodal forces of triangle `t`, or with the first of its triangles those of a quadrilateral, with the given constants, for
    /// displacements `value`.
    pub fn add_element(
        &self,
        t: usize,
        moduli: Moduli,
        value: impl Fn(usize) -> [f64; 2],
        mut add: impl FnMut(usize, [f64; 2]),
    ) {
        let problem = self.problem();
        let Some(cell) = self.counted(t) else { return };
        if let Some(cell) = cell {
            let values: Vec<[f64; 2]> = cell.nodes.iter().map(|n| value(*n)).collect();
            let points = self.solution.points.unwrap_or(cells::full(&cell.field));
            let forces = cells::forces(&cell.field, &values, points, |e| moduli.stress(e));
            for (node, f) in cell.nodes.iter().zip(forces) {
                add(*node, f.map(|f| problem.scene.thickness * f));
            }
            return;
        }
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
            let s = moduli.stress(e);
            for (node, d) in nodes.iter().zip(&shape) {
                add(*node, [weight * (d[0] * s[0] + d[1] * s[2]), weight * (d[0] * s[2] + d[1] * s[1])]);
            }
        }
    }

    /// Nodal forces of the stresses of the bodies as the scene has them for displacements `value`: of the given triangles, or of all.
    pub fn own_forces(&self, of: Option<&[usize]>, value: impl Fn(usize) -> [f64; 2]) -> Vec<[f64; 2]> {
        let (problem, solution) = (self.problem(), self.solution);
        if let Some(rule) = solution.rule {
            let materials = problem.materials();
            let counted = |t: usize| of.is_none_or(|of| of.contains(&t));
            return turned::stress_forces(problem, solution.candidate, rule, counted, |at| {
                let values: Vec<[f64; 2]> = at.nodes.iter().map(|n| value(*n)).collect();
                Some(materials[at.body].revolved().stress(at.with(&values).strain().0))
            });
        }
        let mut forces = vec![[0.0; 2]; self.count()];
        let all = 0..if of.is_some() { 0 } else { problem.mesh.triangles.len() };
        for t in of.into_iter().flatten().copied().chain(all) {
            let moduli = Moduli::of_body(problem, &problem.scene.bodies[problem.mesh.body[t]]);
            self.add_element(t, moduli, &value, |node, f| (0..2).for_each(|c| forces[node][c] += f[c]));
        }
        forces
    }

    /// The column of what stresses with the constants `moduli`, body by body, ask for: those of the strains without the initial ones.
    pub fn stiffness(&self, moduli: impl Fn(usize) -> Option<Moduli>) -> Vec<f64> {
        let mut column = self.stiffness_on(&moduli, |node| self.solution.candidate.value(node));
        let problem = self.problem();
        if problem.scene.bodies.iter().any(|body| !body.initial.is_none()) {
            let materials = problem.materials();
            let held = self.forces_of(|body, x| Some(moduli(body)?.stress(materials[body].initial().at(x))));
            column.iter_mut().zip(self.column(held)).for_each(|(c, f)| *c -= f);
        }
        column
    }

    /// Change of the residual by bodies of other materials; with the material its initial strain changes too.
    pub fn with_materials(&self, other: impl Fn(usize) -> Option<Material>) -> Vec<f64> {
        let (problem, solution) = (self.problem(), self.solution);
        let (scene, materials) = (&problem.scene, problem.materials());
        let others: Vec<Option<Material>> = (0..scene.bodies.len()).map(other).collect();
        if let Some(rule) = solution.rule {
            return self.column(turned::stress_forces(
                problem,
                solution.candidate,
                rule,
                |_| true,
                |at| {
                    let stress = |material: &Material| material.revolved().stress(at.elastic(material).0);
                    let (other, own) = (stress(others[at.body].as_ref()?), stress(&materials[at.body]));
                    Some([0, 1, 2, 3].map(|c| other[c] - own[c]))
                },
            ));
        }
        let mut change = self.stiffness(|b| {
            let own = Moduli::of_body(problem, &scene.bodies[b]);
            others[b].as_ref().map(|material| Moduli::of_material(material).less(own))
        });
        if scene.bodies.iter().any(|body| !body.initial.is_none()) {
            let forces = self.forces_of(|b, x| {
                let material = others[b].as_ref()?;
                let (other, own) = (material.initial().at(x), materials[b].initial().at(x));
                Some(material.stress([0, 1, 2].map(|c| own[c] - other[c])))
            });
            change.iter_mut().zip(self.column(forces)).for_each(|(c, f)| *c += f);
        }
        change
    }

    /// As [`Self::with_materials`], with other laws and the temperatures and initial stresses of the scene.
    pub fn with_laws(&self, law: impl Fn(usize) -> Option<Elasticity>) -> Vec<f64> {
        let scene = &self.problem().scene;
        self.with_materials(|b| {
            let (law, kinematics) = (law(b)?, scene.kinematics);
            Some(Material::new(kinematics, &law).with_initial(kinematics, &law, &scene.bodies[b].initial))
        })
    }

    /// Nodal forces ∫ s:e(φ) of a stress that is affine in each body.
    pub fn forces_of(&self, stress: impl Fn(usize, [f64; 2]) -> Option<[f64; 3]>) -> Vec<[f64; 2]> {
        self.forces_at(|body, x, _| stress(body, x))
    }

    /// As [`Self::forces_of`], with the quadrilateral that a point lies in.
    pub fn forces_at(
        &self,
        stress: impl Fn(usize, [f64; 2], Option<&Quadrilateral>) -> Option<[f64; 3]>,
    ) -> Vec<[f64; 2]> {
        let problem = self.problem();
        let mut forces = vec![[0.0; 2]; self.count()];
        let mut add = |node: usize, weight: f64, d: [f64; 2], s: [f64; 3]| {
            forces[node][0] += weight * (d[0] * s[0] + d[1] * s[2]);
            forces[node][1] += weight * (d[0] * s[2] + d[1] * s[1]);
        };
        for (t, body) in problem.mesh.body.iter().enumerate() {
            let corners = problem.mesh.corners(t);
            if stress(*body, corners[0], None).is_none() {
                continue;
            }
            let Some(cell) = self.counted(t) else { continue };
            if let Some(cell) = cell {
                for (at, weight) in cells::rule(self.solution.points.unwrap_or(cells::full(&cell.field))) {
                    let (gradients, _) = cell.field.gradients(at);
                    let s = stress(*body, cell.field.position(at), Some(&cell.field)).unwrap_or_default();
                    let weight = problem.scene.thickness * weight;
                    cell.nodes.iter().zip(gradients).for_each(|(node, d)| add(*node, weight, d, s));
                }
                continue;
            }
            let weight = problem.scene.thickness * problem.mesh.area(t) / 3.0;
            let g = gradients(corners);
            let nodes = self.nodes(t);
            for at in 0..3 {
                let shape = if nodes.len() == 6 { shape_gradients(&g, at).to_vec() } else { g.to_vec() };
                let (p, q) = (corners[(at + 1) % 3], corners[(at + 2) % 3]);
                let s = stress(*body, [0, 1].map(|c| 0.5 * (p[c] + q[c])), None).unwrap_or_default();
                nodes.iter().zip(shape).for_each(|(node, d)| add(*node, weight, d, s));
            }
        }
        forces
    }

    /// As [`Self::stiffness`], for other displacements.
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

    /// What a model that is no longer this one leaves is held against: the squared residual, and no more than that of the loads and initial
    /// strains where nothing else moves the bodies. What leaves as much as these are explains nothing.
    pub fn whole(&self) -> f64 {
        let is_moved = (0..self.count()).any(|node| match self.solution.hold(node) {
            Hold::Free => false,
            Hold::Line { value, .. } => value != 0.0,
            Hold::Fixed(value) => value != [0.0; 2],
        });
        let forces = &self.solution.forces;
        let driven: f64 =
            [self.column(forces.applied()), self.column(forces.initial.clone())].iter().flatten().map(|f| f * f).sum();
        if is_moved || driven == 0.0 { self.square } else { self.square.min(driven) }
    }

    /// Part of the squared residual that is left with `change` added to the residual.
    pub fn left_with(&self, change: &[f64]) -> f64 {
        self.residual.iter().zip(change).map(|(r, c)| (r + c) * (r + c)).sum::<f64>() / self.square
    }
}
