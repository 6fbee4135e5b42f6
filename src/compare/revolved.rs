//! Displacement solutions of bodies of revolution: forces and energy by the rule that they are integrated with, stresses, differences.
//!
//! Integrals of v_r/r are rational. A displacement model integrates them by a rule, the one that it was given
//! ([`crate::element::quadrature::even_rule`]), and minimises the energy that this rule gives: its identities hold with the same rule, and
//! bounds with enclosed integrals, as of every field.

use super::candidate::{Candidate, Judged};
use super::forces::NodalForces;
use super::outcome::{ComponentDifference, StressSummary, TwoSides};
use super::stress::{von_mises_of, von_mises_of_means};
use crate::bounds::Potential;
use crate::dual::DualSolution;
use crate::element::geometry::gradients;
use crate::element::quadrature::{even_rule, segment_rule, triangle_rule};
use crate::element::{Displacement, Revolved, side};
use crate::problem::Problem;

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

/// The forces at the nodes of a displacement of degree 1 or 2, and its energy, by the rule of the model.
pub fn forces(problem: &Problem, candidate: &Candidate) -> (NodalForces, Potential) {
    let (mesh, section, degree) = (&problem.mesh, problem.section(), candidate.degree);
    let vertices = mesh.points.len();
    let count = vertices + if degree == 2 { mesh.edges.len() } else { 0 };
    let mut forces = NodalForces::zeros(count);
    let mut stiffest = vec![0.0; count];
    let materials = problem.materials();
    let (rule, thickness) = (even_rule(), problem.scene.thickness);
    let (mut strain, mut rounded) = (0.0, 0.0);
    for (t, corners) in mesh.triangles.iter().enumerate() {
        let (material, law) = (&materials[mesh.body[t]], materials[mesh.body[t]].revolved());
        let modulus = material.stiffest();
        let g = gradients(mesh.corners(t));
        let radii = mesh.corners(t).map(|p| section.weight(p));
        let middles = mesh.triangle_edges[t].map(|e| vertices + e);
        let nodes: Vec<usize> = corners.iter().copied().chain(middles.into_iter().filter(|_| degree == 2)).collect();
        let u: Vec<[f64; 2]> = nodes.iter().map(|&node| candidate.value(node)).collect();
        let ([a, b], [_, axial]) = (section.radial(problem.body_force(t)), section.forces(problem.body_force(t)));
        for (l, weight) in &rule {
            let radius: f64 = (0..3).map(|i| l[i] * radii[i]).sum();
            let weight = weight * thickness * mesh.area(t) * radius;
            let force = [a + b * radius, axial];
            let shape = shapes(degree, *l, &g);
            let (mut e, mut spread) = ([0.0; 4], 0.0);
            for ((value, d), u0) in shape.iter().zip(&u) {
                // A translation along the axis leaves no trace.
                let (r, z) = (u0[0], u0[1] - u[0][1]);
                e[0] += d[0] * r;
                e[1] += d[1] * z;
                e[2] += value / radius * r;
                e[3] += 0.5 * (d[1] * r + d[0] * z);
                spread += (d[0].hypot(d[1]) + (value / radius).abs()) * u0[0].hypot(u0[1]);
            }
            let s = law.stress(e);
            strain += 0.5 * weight * law.strain_product(e, e);
            for (&node, (value, d)) in nodes.iter().zip(&shape) {
                let (long, hoop) = (d[0].hypot(d[1]), value / radius);
                forces.left[node][0] += weight * (d[0] * s[0] + d[1] * s[3] + hoop * s[2]);
                forces.left[node][1] += weight * (d[0] * s[3] + d[1] * s[1]);
                forces.size[node] += weight * modulus * (long + hoop.abs()) * spread;
                let part = weight * modulus * long * long;
                forces.stiffness[node] += part;
                if part > stiffest[node] {
                    (stiffest[node], forces.triangle[node]) = (part, t);
                }
                (0..2).for_each(|c| forces.load[node][c] += weight * value * force[c]);
            }
        }
    }
    for (e, ends) in problem.tractions() {
        let own = problem.weighted(e, ends);
        let [a, b] = mesh.edges[e].vertices;
        let (length, _) = mesh.edge_frame(e);
        let at = |s: f64| [0, 1].map(|c| side::value(&own.iter().map(|t| t[c]).collect::<Vec<_>>(), s));
        for &(s, weight) in segment_rule(4) {
            let (weight, traction) = (weight * thickness * length, at(s));
            let along = match degree {
                2 => vec![
                    (a, (1.0 - s) * (1.0 - 2.0 * s)),
                    (b, s * (2.0 * s - 1.0)),
                    (vertices + e, 4.0 * s * (1.0 - s)),
                ],
                _ => vec![(a, 1.0 - s), (b, s)],
            };
            for (node, value) in along {
                (0..2).for_each(|c| forces.load[node][c] += weight * value * traction[c]);
            }
        }
    }
    forces.take_loads();
    let mut work = 0.0;
    for (node, load) in forces.load.iter().enumerate() {
        let u = candidate.value(node);
        for c in 0..2 {
            work += load[c] * u[c];
            rounded += (load[c] * u[c]).abs();
        }
    }
    let magnitude = strain + rounded;
    (forces, Potential { strain, work, magnitude, sensitivity: magnitude, springs: 0.0, friction: 0.0 })
}

/// σ(v) at a point of a subtriangle: (rr, zz, tt, rz).
pub fn stress_at(
    problem: &Problem,
    revolved: Revolved,
    v: &Displacement,
    t: usize,
    sub: usize,
    bary: [f64; 3],
) -> [f64; 4] {
    let e = revolved.strain_at(v, t, sub, problem.mesh.corners(t), bary);
    problem.material(problem.mesh.body[t]).revolved().stress(e)
}

/// Von Mises stress of the mean stress of a displacement on each triangle.
pub fn von_mises_of_displacement(problem: &Problem, revolved: Revolved, v: &Displacement) -> Vec<f64> {
    let mean = |t: usize| {
        let mut mean = [0.0; 4];
        for sub in 0..3 {
            for &(bary, weight) in triangle_rule(2 * v.degree(t)) {
                let s = stress_at(problem, revolved, v, t, sub, bary);
                (0..4).for_each(|c| mean[c] += weight * s[c] / 3.0);
            }
        }
        von_mises_of(mean)
    };
    (0..v.len()).map(mean).collect()
}

/// Compares the stresses; L² norms are those of the figure, without the weight r.
pub fn compare_stresses(
    problem: &Problem,
    revolved: Revolved,
    (dual, complementary): (&DualSolution, f64),
    judged: &Judged,
) -> StressSummary {
    let mesh = &problem.mesh;
    let terms = &judged.field.local.triangles;
    let total: f64 = terms.iter().sum();
    let worst = (0..terms.len()).max_by(|&a, &b| terms[a].total_cmp(&terms[b])).unwrap_or(0);
    let field = &judged.field.displacement;
    let (mut difference, mut norm, mut mises) = ([0.0; 4], 0.0, 0.0);
    for t in 0..mesh.triangles.len() {
        let force = problem.body_force(t);
        for sub in 0..3 {
            for &(bary, weight) in triangle_rule(2 * dual.stress.degree(t).max(field.degree(t))) {
                let l = revolved.stress_at(&dual.stress, t, sub, mesh.corners(t), force, bary);
                let s = stress_at(problem, revolved, field, t, sub, bary);
                let w = weight * mesh.area(t) / 3.0;
                (0..4).for_each(|c| difference[c] += w * (l[c] - s[c]).powi(2));
                norm += w * (l[0] * l[0] + l[1] * l[1] + l[2] * l[2] + 2.0 * l[3] * l[3]);
                mises += w * (von_mises_of(l) - von_mises_of(s)).powi(2);
            }
        }
    }
    let relative = |square: f64| if norm > 0.0 { (square / norm).sqrt() } else { 0.0 };
    let largest = |values: Vec<f64>| values.into_iter().fold(0.0, f64::max);
    let corners = mesh.corners(worst);
    StressSummary {
        against: judged.candidate.name.clone(),
        relative_energy_norm_difference: if complementary > 0.0 { (total / complementary).sqrt() } else { 0.0 },
        worst_triangle: worst,
        worst_at: [0, 1].map(|c| (corners[0][c] + corners[1][c] + corners[2][c]) / 3.0),
        worst_share: if total > 0.0 { terms.get(worst).copied().unwrap_or(0.0) / total } else { 0.0 },
        von_mises_max: TwoSides {
            dual: largest(von_mises_of_means(problem, &dual.stress)),
            primal: Some(largest(von_mises_of_displacement(problem, revolved, field))),
        },
        component_l2_difference: ComponentDifference {
            xx: relative(difference[0]),
            yy: relative(difference[1]),
            tt: Some(relative(difference[2])),
            xy: relative(difference[3]),
            von_mises: relative(mises),
        },
    }
}
