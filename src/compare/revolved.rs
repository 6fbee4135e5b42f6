//! Displacements of bodies of revolution: stresses, and their differences.

use super::candidate::Judged;
use super::outcome::{ComponentDifference, StressSummary, TwoSides};
use super::stress::{von_mises_of, von_mises_of_means};
use crate::dual::DualSolution;
use crate::element::polynomial::quadrature::triangle_rule;
use crate::element::revolved::Held;
use crate::element::{Displacement, Revolved};
use crate::problem::Problem;

/// σ(v) at a point of a subtriangle: (rr, zz, tt, rz).
pub fn stress_at(
    problem: &Problem,
    revolved: Revolved,
    v: &Displacement,
    t: usize,
    sub: usize,
    bary: [f64; 3],
) -> [f64; 4] {
    let (corners, material) = (problem.mesh.corners(t), problem.material(problem.mesh.body[t]));
    let mut e = revolved.strain_at(v, t, sub, corners, bary);
    if let Some(own) = Held::on(&material, corners).map(|held| held.at(sub, bary)) {
        (0..4).for_each(|c| e[c] -= own[c]);
    }
    material.revolved().stress(e)
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
