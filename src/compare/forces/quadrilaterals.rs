//! Forces at the nodes of a displacement on quadrilaterals, and its energy, by the Gauss rule of the program that found it.
//!
//! On parallelograms the rule is exact. On others the integrands are no polynomials, the rule is part of what the discrete problem is, and
//! a solution balances the loads to round-off only in the same one.

use super::NodalForces;
use super::functions::Functions;
use crate::bounds::Potential;
use crate::element::OnQuadrilaterals;
use crate::element::displacement::bilinear;
use crate::element::displacement::bilinear::Bilinear;
use crate::element::displacement::on_quadrilaterals::nodes;
use crate::element::polynomial::quadrature::segment_rule;
use crate::problem::Problem;

impl NodalForces {
    /// Forces and energy of a displacement on quadrilaterals, by the rule with `points` points in each direction.
    pub fn on_quadrilaterals(problem: &Problem, field: &OnQuadrilaterals, points: usize) -> (Self, Potential) {
        let mesh = &problem.mesh;
        let (k, values) = (field.degree(), field.values());
        let count = values.len();
        let mut forces = NodalForces::zeros(count);
        let mut stiffest = vec![0.0; count];
        let mut strain = 0.0;
        let materials = problem.materials();
        let rule = segment_rule(2 * points - 1);
        // Initial strains pull without doing the work of a load.
        let mut pulls = Vec::new();
        for cell in mesh.quadrilaterals() {
            let body = mesh.body[cell.triangles[0]];
            let material = &materials[body];
            let modulus = material.stiffest();
            let map = Bilinear::new(cell.points(mesh));
            let nodes = nodes(mesh, k, &cell);
            let u: Vec<[f64; 2]> = nodes.iter().map(|&n| values[n]).collect();
            let force = &problem.scene.bodies[body].body_force;
            let mut parts = vec![0.0; nodes.len()];
            for (at, weight) in rule.iter().flat_map(|(x, v)| rule.iter().map(move |(y, w)| ([*x, *y], v * w))) {
                let weight = weight * problem.scene.thickness * map.determinant(at);
                let (shape, gradients) = (bilinear::values(k, at), map.gradients(k, at));
                let f = force.at(map.at(at));
                let [e, s] = forces.add_stress((material, weight), &nodes, &gradients, &u);
                let place = map.at(at);
                let (held, initial) = (material.held_back(place), material.initial().at(place));
                let (s, e) = ([0, 1, 2].map(|c| s[c] - held[c]), [0, 1, 2].map(|c| e[c] - initial[c]));
                strain += 0.5 * weight * (s[0] * e[0] + s[1] * e[1] + 2.0 * s[2] * e[2]);
                if !material.initial().is_none() {
                    pulls.push((weight, held, nodes.clone(), gradients.clone()));
                }
                for (i, (&node, d)) in nodes.iter().zip(&gradients).enumerate() {
                    let long = d[0].hypot(d[1]);
                    parts[i] += weight * modulus * long * long;
                    forces.load[node] = [0, 1].map(|c| forces.load[node][c] + weight * shape[i] * f[c]);
                }
            }
            for (&node, part) in nodes.iter().zip(parts) {
                forces.stiffness[node] += part;
                if part > stiffest[node] {
                    (stiffest[node], forces.triangle[node]) = (part, cell.triangles[0]);
                }
            }
        }
        let springs = forces.add_springs(problem, k, Functions::Values, |node| values[node]);
        forces.add_tractions(problem, k, Functions::Values);
        let products = || forces.load.iter().zip(values).map(|(f, u)| f[0] * u[0] + f[1] * u[1]);
        let work = products().sum();
        let magnitude = strain + springs + products().map(f64::abs).sum::<f64>();
        pulls.iter().for_each(|(weight, held, nodes, gradients)| forces.add_initial(*weight, *held, nodes, gradients));
        forces.take_loads();
        let sensitivity = forces.size.iter().zip(values).map(|(f, u)| f * u[0].hypot(u[1])).sum();
        (forces, Potential { strain, springs, friction: 0.0, work, magnitude, sensitivity })
    }
}
