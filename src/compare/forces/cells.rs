//! Forces at the nodes of a displacement model of quadrilaterals of four, eight or nine nodes.
//!
//! Its program has integrated its equations by a Gauss rule, which on a quadrilateral that is no parallelogram errs. Any rule that
//! counts as full integration is a right one: of those with 2 × 2 points or more, with 3 × 3 for quadratic fields, and of one that is as
//! good as exact, the one with which the equations hold best is taken for that of the program.

use super::NodalForces;
use super::functions::Functions;
use crate::bounds::Cell;
use crate::compare::candidate::Candidate;
use crate::element::Quadrilateral;
use crate::element::polynomial::quadrature::segment_rule;
use crate::load::BodyForce;
use crate::problem::Problem;

/// Points in each direction of a rule that is as good as exact.
pub const EXACT: usize = 12;

/// A point of a rule on the square, with its weight.
pub type Point = ([f64; 2], f64);

/// The rule with so many points in each direction.
pub fn rule(points: usize) -> impl Iterator<Item = Point> {
    let along = segment_rule(2 * points - 1);
    let place = |s: f64| 2.0 * s - 1.0;
    along.iter().flat_map(move |(s, v)| along.iter().map(move |(t, w)| ([place(*s), place(*t)], 4.0 * v * w)))
}

/// Points in each direction of full integration, the fewest.
pub fn full(cell: &Quadrilateral) -> usize {
    if cell.nodes() == 4 { 2 } else { 3 }
}

/// Values and gradients of the functions of the nodes at a point of the unit square, and the determinant there.
pub fn shapes(cell: &Quadrilateral, at: [f64; 2]) -> (Vec<(f64, [f64; 2])>, f64) {
    let (gradients, determinant) = cell.gradients(at);
    let functions = cell.shapes(at).into_iter().zip(gradients);
    (functions.map(|(value, d)| (value, d.map(|d| d / determinant))).collect(), determinant)
}

/// Points in each direction of the rules that a program may have used for `candidate`: none where there is no quadrilateral.
pub fn rules(candidate: &Candidate) -> Vec<Option<usize>> {
    match candidate.cells.iter().map(|cell| full(&cell.field)).max() {
        Some(first) => [first, first + 1, first + 2, EXACT].map(Some).to_vec(),
        None => vec![None],
    }
}

/// ∫ σ:e(φ) for the displacements of the nodes, with the stress that `stress` gives for a strain; per unit thickness.
pub fn forces(
    cell: &Quadrilateral,
    values: &[[f64; 2]],
    points: usize,
    stress: impl Fn([f64; 3]) -> [f64; 3],
) -> Vec<[f64; 2]> {
    let mut forces = vec![[0.0; 2]; cell.nodes()];
    for (at, weight) in rule(points) {
        let (gradients, determinant) = cell.gradients(at);
        let mut e = [0.0; 3];
        for (g, u) in gradients.iter().zip(values) {
            let (x, y) = (u[0] - values[0][0], u[1] - values[0][1]);
            e[0] += g[0] * x;
            e[1] += g[1] * y;
            e[2] += 0.5 * (g[1] * x + g[0] * y);
        }
        let s = stress(e.map(|e| e / determinant));
        for (force, g) in forces.iter_mut().zip(&gradients) {
            force[0] += weight * (g[0] * s[0] + g[1] * s[2]);
            force[1] += weight * (g[0] * s[2] + g[1] * s[1]);
        }
    }
    forces
}

/// ∫ f φ of the nodes, per unit thickness.
pub fn load(cell: &Quadrilateral, force: &BodyForce) -> Vec<[f64; 2]> {
    let mut sums = vec![[0.0; 2]; cell.nodes()];
    for (at, weight) in rule(full(cell)) {
        let (_, determinant) = cell.gradients(at);
        let f = force.at(cell.point(at));
        for (sum, w) in sums.iter_mut().zip(cell.shapes(at)) {
            (0..2).for_each(|c| sum[c] += weight * determinant * w * f[c]);
        }
    }
    sums
}

/// For every triangle the quadrilateral that it is a part of.
pub fn of_triangles(problem: &Problem, cells: &[Cell]) -> Vec<Option<usize>> {
    let mut of = vec![None; problem.mesh.triangles.len()];
    for (i, cell) in cells.iter().enumerate() {
        cell.triangles.iter().for_each(|t| of[*t] = Some(i));
    }
    of
}

impl Cell {
    /// The values of `candidate` at its nodes.
    pub fn values(&self, candidate: &Candidate) -> Vec<[f64; 2]> {
        self.nodes.iter().map(|node| candidate.value(*node)).collect()
    }
}

impl NodalForces {
    /// Forces of a candidate of degree 1 or 2, on quadrilaterals by one of [`rules`].
    pub fn by_rule(problem: &Problem, candidate: &Candidate, points: Option<usize>) -> Self {
        match points {
            None => NodalForces::new(problem, candidate.degree, &candidate.vertex, &candidate.middle),
            Some(points) => NodalForces::of_cells(problem, candidate, points),
        }
    }

    /// The energy ½a(u, u), with that of springs and elastic contact, by the rule that the forces are made with.
    pub fn stored(&self, candidate: &Candidate) -> f64 {
        let nodes = self.left.iter().zip(&self.load).enumerate();
        let term = |(i, (left, load)): (usize, (&[f64; 2], &[f64; 2]))| {
            let u = candidate.value(i);
            (left[0] + load[0]) * u[0] + (left[1] + load[1]) * u[1]
        };
        // Pressures of elastic contact store nothing on its gaps.
        0.5 * (nodes.map(term).sum::<f64>() - self.on_gaps)
    }

    /// Forces of a candidate with quadrilaterals, by a rule with `points` points in each direction.
    pub fn of_cells(problem: &Problem, candidate: &Candidate, points: usize) -> Self {
        let of = of_triangles(problem, &candidate.cells);
        let whole = |t: usize| of[t].is_none();
        let mut forces = NodalForces::on(problem, candidate.degree, &candidate.vertex, &candidate.middle, whole);
        let mut stiffest = forces.stiffness.clone();
        let materials = problem.materials();
        for cell in &candidate.cells {
            let Some(&t) = cell.triangles.first() else { continue };
            let body = problem.mesh.body[t];
            let (material, thickness) = (&materials[body], problem.scene.thickness);
            let modulus = material.stiffest();
            let values = cell.values(candidate);
            let own = self::forces(&cell.field, &values, points, |e| material.stress(e));
            for (node, f) in cell.nodes.iter().zip(own) {
                (0..2).for_each(|c| forces.left[*node][c] += thickness * f[c]);
            }
            if !material.initial().is_none() {
                for (at, weight) in rule(points) {
                    let (gradients, _) = cell.field.gradients(at);
                    let held = material.held_back(cell.field.position(at));
                    forces.add_initial(thickness * weight, held, &cell.nodes, &gradients);
                }
            }
            for (node, f) in cell.nodes.iter().zip(load(&cell.field, problem.body_force(t))) {
                (0..2).for_each(|c| forces.load[*node][c] += thickness * f[c]);
            }
            for (at, weight) in rule(points) {
                let (gradients, determinant) = cell.field.gradients(at);
                let spread: f64 = gradients.iter().zip(&values).map(|(g, u)| g[0].hypot(g[1]) * u[0].hypot(u[1])).sum();
                for (node, g) in cell.nodes.iter().zip(&gradients) {
                    let part = thickness * weight * modulus / determinant * g[0].hypot(g[1]);
                    forces.size[*node] += part * spread;
                    forces.stiffness[*node] += part * g[0].hypot(g[1]);
                    if part * g[0].hypot(g[1]) > stiffest[*node] {
                        (stiffest[*node], forces.triangle[*node]) = (part * g[0].hypot(g[1]), t);
                    }
                }
            }
        }
        forces.add_springs(problem, candidate.degree, Functions::Values, |node| candidate.value(node));
        forces.add_tractions(problem, candidate.degree, Functions::Values);
        forces.take_loads();
        forces
    }
}
