//! Plane stress made of a layer of solid elements, as CalculiX makes its elements CPS3, CPS4, CPS6 and CPS8.
//!
//! The nodes of such a layer move across it by ±½t e, with a thickness strain e that is continuous between elements: the stress across
//! the layer vanishes in the mean around a node and not in every point. With the shear strains z∇e the energy is
//! ½∫ σ:ε + ½G (t²/12) |∇e|², whose minimum over e is sought here by conjugate gradients.

use crate::compare::forces::cells;
use crate::diagnose::space::{Moduli, Space};
use crate::diagnose::{Finding, Trial};
use crate::scene::Kinematics;

/// Points of the rules of CalculiX in the plane.
const CENTRE: [[f64; 3]; 1] = [[1.0 / 3.0; 3]];
const INNER: [[f64; 3]; 3] =
    [[2.0 / 3.0, 1.0 / 6.0, 1.0 / 6.0], [1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0], [1.0 / 6.0, 1.0 / 6.0, 2.0 / 3.0]];
/// Steps of conjugate gradients, at most.
const STEPS: usize = 4000;
/// Where they stop: the residual has fallen by this factor.
const FALLEN: f64 = 1e-12;

/// Layers of the thickness of the scene and of one.
pub fn trials(space: &Space<'_>) -> Vec<Trial> {
    let scene = &space.problem().scene;
    let isotropic = scene.bodies.iter().all(|body| body.elasticity.isotropic().is_some());
    if scene.kinematics != Kinematics::PlaneStress || !isotropic {
        return Vec::new();
    }
    let mut thicknesses = vec![scene.thickness];
    if scene.thickness != 1.0 {
        thicknesses.push(1.0);
    }
    // Quadrilaterals of eight nodes are integrated in full, or with one point less in each direction.
    let fields = space.solution.candidate.cells.iter();
    let full = fields.map(|cell| cells::full(&cell.field)).max().unwrap_or(2);
    let rules = (if full > 2 { full - 1 } else { full })..=full;
    let tried = thicknesses.into_iter().flat_map(|thickness| rules.clone().map(move |points| (thickness, points)));
    tried.map(|(thickness, points)| trial(space, thickness, points)).collect()
}

fn trial(space: &Space<'_>, thickness: f64, points: usize) -> Trial {
    let layer = Layer::new(space, thickness, points);
    let strain = layer.thickness_strain();
    let made = space.column(layer.forces(&strain));
    let problem = space.problem();
    let own = space.stiffness_on(
        |b| Some(Moduli::of_body(problem, &problem.scene.bodies[b])),
        |node| space.solution.candidate.value(node),
    );
    let change: Vec<f64> = made.iter().zip(&own).map(|(made, own)| made - own).collect();
    let sentence = "plane stress is made of a layer of solid elements whose thickness strain is continuous between elements, as CalculiX \
                    makes its CPS elements";
    let findings = vec![Finding::new("kinematics/thickness-strain", None, None, sentence)];
    Trial { rank: 0, left: space.left_with(&change), findings }
}

/// One quadrature point.
struct Point {
    /// Area times the thickness of the scene.
    weight: f64,
    /// λ and μ of the solid.
    lambda: f64,
    mu: f64,
    /// Strains in the plane: xx, yy, xy.
    strain: [f64; 3],
    /// Nodes with the values and the gradients of their shape functions.
    shapes: Vec<(usize, f64, [f64; 2])>,
}

struct Layer {
    points: Vec<Point>,
    nodes: usize,
    /// t²/12.
    bending: f64,
}

impl Layer {
    fn new(space: &Space<'_>, thickness: f64, of_cells: usize) -> Self {
        let (problem, solution) = (space.problem(), space.solution);
        let quadratic = solution.candidate.degree > 1;
        let rule: &[[f64; 3]] = if quadratic { &INNER } else { &CENTRE };
        let mut points = Vec::new();
        for t in 0..problem.mesh.triangles.len() {
            let body = &problem.scene.bodies[problem.mesh.body[t]];
            let Moduli { lambda, mu, .. } = Moduli::of_law(Kinematics::PlaneStrain, &body.elasticity);
            let strain_of = |shapes: &[(usize, f64, [f64; 2])]| {
                let mut strain = [0.0; 3];
                for (node, _, d) in shapes {
                    let u = solution.candidate.value(*node);
                    strain[0] += d[0] * u[0];
                    strain[1] += d[1] * u[1];
                    strain[2] += 0.5 * (d[0] * u[1] + d[1] * u[0]);
                }
                strain
            };
            let Some(cell) = space.counted(t) else { continue };
            if let Some(cell) = cell {
                for (at, weight) in cells::rule(of_cells) {
                    let (functions, determinant) = cells::shapes(&cell.field, at);
                    let shapes: Vec<_> =
                        cell.nodes.iter().zip(functions).map(|(node, (value, d))| (*node, value, d)).collect();
                    let weight = problem.scene.thickness * weight * determinant;
                    points.push(Point { weight, lambda, mu, strain: strain_of(&shapes), shapes });
                }
                continue;
            }
            for l in rule {
                let gradients = solution.gradients(t, *l);
                let values: Vec<f64> = match quadratic {
                    false => l.to_vec(),
                    true => {
                        let corner = |i: usize| l[i] * (2.0 * l[i] - 1.0);
                        let middle = |i: usize| 4.0 * l[(i + 1) % 3] * l[(i + 2) % 3];
                        (0..3).map(corner).chain((0..3).map(middle)).collect()
                    }
                };
                let shapes: Vec<_> =
                    gradients.into_iter().zip(values).map(|((node, d), value)| (node, value, d)).collect();
                let weight = problem.scene.thickness * problem.mesh.area(t) / rule.len() as f64;
                points.push(Point { weight, lambda, mu, strain: strain_of(&shapes), shapes });
            }
        }
        Layer { points, nodes: space.count(), bending: thickness * thickness / 12.0 }
    }

    /// The derivative of the energy in e, but for the part that strains in the plane give.
    fn times(&self, e: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; self.nodes];
        for point in &self.points {
            let value: f64 = point.shapes.iter().map(|(node, v, _)| v * e[*node]).sum();
            let slope = [0, 1].map(|c| point.shapes.iter().map(|(node, _, d)| d[c] * e[*node]).sum::<f64>());
            let stress = (point.lambda + 2.0 * point.mu) * value;
            for (node, v, d) in &point.shapes {
                let sheared = self.bending * point.mu * (d[0] * slope[0] + d[1] * slope[1]);
                out[*node] += point.weight * (v * stress + sheared);
            }
        }
        out
    }

    /// The thickness strain of least energy, node by node.
    fn thickness_strain(&self) -> Vec<f64> {
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        let (mut left, mut diagonal) = (vec![0.0; self.nodes], vec![f64::MIN_POSITIVE; self.nodes]);
        for point in &self.points {
            let stress = point.lambda * (point.strain[0] + point.strain[1]);
            for (node, v, d) in &point.shapes {
                left[*node] -= point.weight * v * stress;
                let sheared = self.bending * point.mu * (d[0] * d[0] + d[1] * d[1]);
                diagonal[*node] += point.weight * ((point.lambda + 2.0 * point.mu) * v * v + sheared);
            }
        }
        let scaled = |r: &[f64]| -> Vec<f64> { r.iter().zip(&diagonal).map(|(r, d)| r / d).collect() };
        let mut e = vec![0.0; self.nodes];
        let mut step = scaled(&left);
        let mut size = dot(&left, &step);
        let enough = FALLEN * FALLEN * size;
        for _ in 0..STEPS {
            let moved = self.times(&step);
            let length = size / dot(&step, &moved);
            if size <= enough || !length.is_finite() {
                break;
            }
            e.iter_mut().zip(&step).for_each(|(e, p)| *e += length * p);
            left.iter_mut().zip(&moved).for_each(|(r, q)| *r -= length * q);
            let next = scaled(&left);
            let new = dot(&left, &next);
            let turned = new / size;
            step.iter_mut().zip(&next).for_each(|(p, z)| *p = z + turned * *p);
            size = new;
        }
        e
    }

    /// Nodal forces of the stresses in the plane.
    fn forces(&self, e: &[f64]) -> Vec<[f64; 2]> {
        let mut forces = vec![[0.0; 2]; self.nodes];
        for point in &self.points {
            let across: f64 = point.shapes.iter().map(|(node, v, _)| v * e[*node]).sum();
            let [xx, yy, xy] = point.strain;
            let pressure = point.lambda * (xx + yy + across);
            let [sx, sy, shear] = [pressure + 2.0 * point.mu * xx, pressure + 2.0 * point.mu * yy, 2.0 * point.mu * xy];
            for (node, _, d) in &point.shapes {
                forces[*node][0] += point.weight * (d[0] * sx + d[1] * shear);
                forces[*node][1] += point.weight * (d[0] * shear + d[1] * sy);
            }
        }
        forces
    }
}
