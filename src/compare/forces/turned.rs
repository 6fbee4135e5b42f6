//! Nodal forces of displacement models of bodies of revolution, and of body forces in slices, by the rule that a program integrates with.
//!
//! Integrands with v_r/r are rational. A displacement model integrates them by a rule and minimises the energy that this rule gives: its
//! identities hold with the same rule, and bounds with enclosed integrals, as for every field. FEniCSx is given the rule of this program;
//! for other programs the rule with which the equations hold best is assumed.

use super::NodalForces;
use super::cells;
use super::functions::Functions;
use crate::bounds::Potential;
use crate::compare::candidate::Candidate;
use crate::element::Material;
use crate::element::geometry::gradients;
use crate::element::polynomial::symmetric_rules::symmetric_rules;
use crate::element::revolved::{NEAR, rule};
use crate::load::BodyForce;
use crate::problem::Problem;

/// The polynomial degree up to which the rule that is as good as exact integrates exactly.
const EXACT: usize = 12;

/// The rule by which a program integrates its equations.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rule {
    /// On triangles the index in [`symmetric_rules`]; `None` for a rule that is as good as exact.
    pub triangles: Option<usize>,
    /// On quadrilaterals the points in each direction.
    pub points: usize,
    /// True if body forces are integrated as good as exactly, whatever the rule of the stiffness.
    pub exact_loads: bool,
}

/// The kinds of cells, each of which a program integrates by a rule of its own.
#[derive(Debug, Clone, Copy)]
pub enum Kind {
    /// Triangles.
    Triangles,
    /// Quadrilaterals.
    Quadrilaterals,
}

impl Rule {
    /// The rule of FEniCSx as run by this program.
    pub const OWN: Self = Rule { triangles: Some(0), points: 3, exact_loads: false };

    /// The index of the rule with one point.
    pub const ONE_POINT: usize = 1;

    /// The rules that a program may have used for `candidate` on cells of one kind, with those of this one on the other.
    pub fn others(self, problem: &Problem, candidate: &Candidate, on: Kind) -> Vec<Self> {
        let own: Vec<Self> = match on {
            Kind::Triangles if has_triangles(candidate) => {
                let mesh = &problem.mesh;
                let touches = mesh.points.iter().any(|p| problem.section().on_axis(*p));
                // Points on sides may lie on the axis, where nothing is divided by r.
                let inside = |rule: &usize| symmetric_rules()[*rule].iter().all(|(at, _)| !at.contains(&0.0));
                let all = (0..symmetric_rules().len()).filter(|rule| !touches || inside(rule)).map(Some).chain([None]);
                all.map(|triangles| Rule { triangles, ..self }).collect()
            }
            Kind::Triangles => Vec::new(),
            Kind::Quadrilaterals => {
                let points: Vec<usize> = cells::rules(candidate).into_iter().flatten().collect();
                // Close to the axis more points are told apart than in the plane.
                let more = points.first().into_iter().flat_map(|first| [first + 3, first + 4]);
                points.iter().copied().chain(more).map(|points| Rule { points, ..self }).collect()
            }
        };
        let loaded = problem.scene.bodies.iter().any(|body| !body.body_force.is_none());
        let loads = [false, true].into_iter().filter(|exact| loaded || !exact);
        loads.flat_map(|exact_loads| own.iter().map(move |rule| Rule { exact_loads, ..*rule })).collect()
    }

    /// That of body forces.
    fn of_loads(self) -> Self {
        match self.exact_loads {
            true => Rule { triangles: None, points: cells::EXACT, ..self },
            false => self,
        }
    }
}

fn has_triangles(candidate: &Candidate) -> bool {
    let covered: usize = candidate.cells.iter().map(|cell| cell.triangles.len()).sum();
    candidate.cells.is_empty()
        || candidate.numbering.as_ref().is_none_or(|numbering| covered < numbering.triangles.len())
}

/// A displacement model at one point of its rule.
pub struct At<'a> {
    /// The triangle, the first one of a quadrilateral.
    pub triangle: usize,
    /// The body.
    pub body: usize,
    /// The nodes of the cell, with their functions and gradients.
    pub nodes: &'a [usize],
    /// Values and gradients of their functions.
    pub shapes: &'a [(f64, [f64; 2])],
    /// Their displacements.
    pub values: &'a [[f64; 2]],
    /// Distance from the axis.
    pub radius: f64,
    /// Coordinates of the point.
    pub place: [f64; 2],
    /// Weight of the point, thickness and angle included, without the radius.
    pub weight: f64,
}

impl At<'_> {
    /// The strain (rr, zz, tt, rz), and the sum of the magnitudes of its terms.
    pub fn strain(&self) -> ([f64; 4], f64) {
        let (mut e, mut spread) = ([0.0; 4], 0.0);
        for ((value, d), u) in self.shapes.iter().zip(self.values) {
            // A translation along the axis leaves no trace.
            let (r, z) = (u[0], u[1] - self.values[0][1]);
            e[0] += d[0] * r;
            e[1] += d[1] * z;
            e[2] += value / self.radius * r;
            e[3] += 0.5 * (d[1] * r + d[0] * z);
            spread += (d[0].hypot(d[1]) + (value / self.radius).abs()) * u[0].hypot(u[1]);
        }
        (e, spread)
    }

    /// The same point with other displacements of the nodes.
    pub fn with<'b>(&'b self, values: &'b [[f64; 2]]) -> At<'b> {
        At { values, ..*self }
    }

    /// As [`Self::strain`], without the initial strain of a material.
    pub fn elastic(&self, material: &Material) -> ([f64; 4], f64) {
        let (e, spread) = self.strain();
        if material.initial().is_none() {
            return (e, spread);
        }
        let own = material.initial().around(self.place);
        ([0, 1, 2, 3].map(|c| e[c] - own[c]), spread + own.iter().map(|e| e.abs()).sum::<f64>())
    }

    /// The force of a stress at node `i` of the cell, per unit of weight.
    pub fn force(&self, i: usize, s: [f64; 4]) -> [f64; 2] {
        let (value, d) = self.shapes[i];
        [d[0] * s[0] + d[1] * s[3] + value / self.radius * s[2], d[0] * s[3] + d[1] * s[1]]
    }
}

/// Shape functions of degree 1 or 2 at a point of a triangle, with their gradients: corners, then the midpoints opposite them.
fn shapes(degree: usize, l: [f64; 3], g: &[[f64; 2]; 3]) -> Vec<(f64, [f64; 2])> {
    if degree != 2 {
        return (0..3).map(|i| (l[i], g[i])).collect();
    }
    let corner = |i: usize| (l[i] * (2.0 * l[i] - 1.0), g[i].map(|d| (4.0 * l[i] - 1.0) * d));
    let middle = |i: usize| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        (4.0 * l[j] * l[k], [0, 1].map(|c| 4.0 * (l[j] * g[k][c] + l[k] * g[j][c])))
    };
    (0..3).map(corner).chain((0..3).map(middle)).collect()
}

/// Calls `each` at every point of the rule, cell by cell.
pub fn points(problem: &Problem, candidate: &Candidate, by: Rule, each: impl FnMut(&At<'_>)) {
    points_of(problem, candidate, by, |_| true, each);
}

/// As [`points`], on the triangles that are `counted` and the quadrilaterals whose first triangle is.
pub fn points_of(
    problem: &Problem,
    candidate: &Candidate,
    by: Rule,
    counted: impl Fn(usize) -> bool,
    mut each: impl FnMut(&At<'_>),
) {
    let (mesh, section, thickness) = (&problem.mesh, problem.section(), problem.scene.thickness);
    let vertices = mesh.points.len();
    let of = cells::of_triangles(problem, &candidate.cells);
    let known = by.triangles.map(|rule| &symmetric_rules()[rule]);
    for t in (0..mesh.triangles.len()).filter(|t| counted(*t) && of[*t].is_none()) {
        let g = gradients(mesh.corners(t));
        let corners = mesh.corners(t);
        let radii = corners.map(|p| section.weight(p));
        let middles = mesh.triangle_edges[t].map(|e| vertices + e);
        let quadratic = candidate.degree == 2;
        let nodes: Vec<usize> =
            mesh.triangles[t].into_iter().chain(middles.into_iter().filter(|_| quadratic)).collect();
        let values: Vec<[f64; 2]> = nodes.iter().map(|node| candidate.value(*node)).collect();
        let area = thickness * mesh.area(t);
        let mut one = |l: [f64; 3], weight: f64| {
            let shapes = shapes(candidate.degree, l, &g);
            let radius = (0..3).map(|i| l[i] * radii[i]).sum();
            let body = mesh.body[t];
            let place = [0, 1].map(|c| (0..3).map(|i| l[i] * corners[i][c]).sum());
            each(&At {
                place,
                triangle: t,
                body,
                nodes: &nodes,
                shapes: &shapes,
                values: &values,
                radius,
                weight: area * weight,
            });
        };
        match known {
            Some(known) => known.iter().for_each(|(l, weight)| one(*l, *weight)),
            None => rule(radii, EXACT, NEAR).iter().for_each(|point| one(point.bary, point.weight)),
        }
    }
    for cell in &candidate.cells {
        let Some(&t) = cell.triangles.first().filter(|t| counted(**t)) else { continue };
        let values = cell.values(candidate);
        for (at, weight) in cells::rule(by.points) {
            let (shapes, determinant) = cells::shapes(&cell.field, at);
            let place = cell.field.point(at);
            let (radius, weight) = (section.weight(place), thickness * weight * determinant);
            let body = mesh.body[t];
            each(&At {
                triangle: t,
                body,
                nodes: &cell.nodes,
                shapes: &shapes,
                values: &values,
                radius,
                place,
                weight,
            });
        }
    }
}

/// Number of nodes of `candidate`.
pub fn count(problem: &Problem, candidate: &Candidate) -> usize {
    problem.mesh.points.len() + if candidate.degree == 2 { problem.mesh.edges.len() } else { 0 }
}

/// ∫ s:e(φ) of the nodes for the stress that `stress` gives at every point of the cells that are `counted`, as [`points_of`] has them.
pub fn stress_forces(
    problem: &Problem,
    candidate: &Candidate,
    by: Rule,
    counted: impl Fn(usize) -> bool,
    stress: impl Fn(&At<'_>) -> Option<[f64; 4]>,
) -> Vec<[f64; 2]> {
    let mut forces = vec![[0.0; 2]; count(problem, candidate)];
    points_of(problem, candidate, by, counted, |at| {
        let Some(s) = stress(at) else { return };
        for (i, &node) in at.nodes.iter().enumerate() {
            let own = at.force(i, s);
            (0..2).for_each(|c| forces[node][c] += at.weight * at.radius * own[c]);
        }
    });
    forces
}

/// Nodal forces of the body force that `of` names for each body.
pub fn body_forces<'a>(
    problem: &Problem,
    candidate: &Candidate,
    by: Rule,
    of: impl Fn(usize) -> &'a BodyForce,
) -> Vec<[f64; 2]> {
    let section = problem.section();
    let mut loads = vec![[0.0; 2]; count(problem, candidate)];
    let pulled = |t: usize| !of(problem.mesh.body[t]).is_none();
    points_of(problem, candidate, by.of_loads(), pulled, |at| {
        let force = section.force(of(at.body), at.place);
        let weight = at.weight * at.radius;
        for (&node, (value, _)) in at.nodes.iter().zip(at.shapes) {
            (0..2).for_each(|c| loads[node][c] += weight * value * force[c]);
        }
    });
    loads
}

impl NodalForces {
    /// Takes body forces by a rule in the place of exact ones.
    pub fn sample_body_forces(&mut self, problem: &Problem, candidate: &Candidate, by: Rule) {
        let of = |body: usize| &problem.scene.bodies[body].body_force;
        let [exact, sampled] =
            [true, false].map(|exact_loads| body_forces(problem, candidate, Rule { exact_loads, ..by }, of));
        for (node, (exact, sampled)) in exact.iter().zip(&sampled).enumerate() {
            for c in 0..2 {
                self.load[node][c] += sampled[c] - exact[c];
                self.left[node][c] -= sampled[c] - exact[c];
            }
        }
    }
}

/// The forces at the nodes of a displacement of degree 1 or 2, and its energy, by a rule.
pub fn forces(problem: &Problem, candidate: &Candidate, by: Rule) -> (NodalForces, Potential) {
    let mut forces = NodalForces::zeros(count(problem, candidate));
    let mut stiffest = vec![0.0; forces.left.len()];
    let materials = problem.materials();
    let (mut strain, mut rounded) = (0.0, 0.0);
    points(problem, candidate, by, |at| {
        let (material, law) = (&materials[at.body], materials[at.body].revolved());
        let modulus = material.stiffest();
        let weight = at.weight * at.radius;
        let (e, spread) = at.elastic(material);
        let s = law.stress(e);
        strain += 0.5 * weight * law.strain_product(e, e);
        for (i, (&node, (value, d))) in at.nodes.iter().zip(at.shapes).enumerate() {
            let (long, hoop) = (d[0].hypot(d[1]), value / at.radius);
            let own = at.force(i, s);
            (0..2).for_each(|c| forces.left[node][c] += weight * own[c]);
            forces.size[node] += weight.abs() * modulus * (long + hoop.abs()) * spread;
            let part = weight * modulus * long * long;
            forces.stiffness[node] += part;
            if part > stiffest[node] {
                (stiffest[node], forces.triangle[node]) = (part, at.triangle);
            }
        }
        if !material.initial().is_none() {
            let held = law.stress(material.initial().around(at.place));
            for (i, &node) in at.nodes.iter().enumerate() {
                let own = at.force(i, held);
                (0..2).for_each(|c| forces.initial[node][c] += weight * own[c]);
            }
        }
    });
    forces.load = body_forces(problem, candidate, by, |body| &problem.scene.bodies[body].body_force);
    forces.add_tractions(problem, candidate.degree, Functions::Values);
    let springs = forces.add_springs(problem, candidate.degree, Functions::Values, |node| candidate.value(node));
    forces.take_loads();
    let mut work = 0.0;
    for (node, load) in forces.load.iter().enumerate() {
        let u = candidate.value(node);
        for c in 0..2 {
            work += load[c] * u[c];
            rounded += (load[c] * u[c]).abs();
        }
    }
    // The stresses above are without cε0, which is a load beside those of the whole strain.
    for (load, initial) in forces.load.iter_mut().zip(&forces.initial) {
        (0..2).for_each(|c| load[c] += initial[c]);
    }
    let magnitude = strain + springs + rounded;
    (forces, Potential { strain, work, magnitude, sensitivity: magnitude, springs, friction: 0.0 })
}
