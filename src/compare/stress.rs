//! Stress of the dual solution against stress of a displacement solution, triangle by triangle.

use super::candidate::Judged;
use super::outcome::{ComponentDifference, StressSummary, TwoSides};
use super::revolved::{compare_stresses, von_mises_of_displacement};
use crate::dual::DualSolution;
use crate::element::geometry::sub_corners;
use crate::element::{Samples, StressField, contraction};
use crate::element::{Strains, elastic_degree};
use crate::problem::Problem;

/// Von Mises stress of a stress (xx, yy, out of the plane, xy).
pub fn von_mises_of(s: [f64; 4]) -> f64 {
    let (a, b, c) = (s[0] - s[1], s[1] - s[2], s[2] - s[0]);
    (0.5 * (a * a + b * b + c * c) + 3.0 * s[3] * s[3]).sqrt()
}

/// Von Mises stress of the mean stress of a [`StressField`] on each triangle.
pub fn von_mises_of_means(problem: &Problem, stress: &StressField) -> Vec<f64> {
    let mesh = &problem.mesh;
    let all = 0..stress.len();
    match problem.section().revolved() {
        None => von_mises_map(problem, &all.map(|t| stress.mean(t)).collect::<Vec<_>>()),
        Some(revolved) => {
            all.map(|t| von_mises_of(revolved.mean(stress, t, mesh.corners(t), problem.body_force(t)))).collect()
        }
    }
}

/// Von Mises stress of the mean stress of a displacement solution on each triangle.
pub fn von_mises_of_field(problem: &Problem, judged: &Judged) -> Vec<f64> {
    match problem.section().revolved() {
        None => von_mises_map(problem, &primal_means(problem, judged)),
        Some(revolved) => von_mises_of_displacement(problem, revolved, &judged.field.displacement),
    }
}

/// Mean stress of the displacement solution on each triangle.
pub fn primal_means(problem: &Problem, judged: &Judged) -> Vec<[f64; 3]> {
    let mesh = &problem.mesh;
    let materials = problem.materials();
    let mut strains = Strains::default();
    (0..mesh.triangles.len())
        .map(|t| {
            let mut mean = [0.0; 3];
            let field = &judged.field.displacement;
            let material = &materials[mesh.body[t]];
            let samples = Samples::of(elastic_degree(field.degree(t), material), 0);
            for sub in 0..3 {
                strains.elastic(mesh.corners(t), field, t, sub, material);
                for (q, (_, weight)) in samples.points.iter().enumerate() {
                    let s = material.stress(strains.sample(samples, q));
                    (0..3).for_each(|c| mean[c] += weight * s[c] / 3.0);
                }
            }
            mean
        })
        .collect()
}

/// Von Mises stress of mean stresses.
pub fn von_mises_map(problem: &Problem, means: &[[f64; 3]]) -> Vec<f64> {
    let materials = problem.materials();
    let of =
        |(t, &s): (usize, &[f64; 3])| materials[problem.mesh.body[t]].von_mises(s, centroid(problem.mesh.corners(t)));
    means.iter().enumerate().map(of).collect()
}

fn centroid(corners: [[f64; 2]; 3]) -> [f64; 2] {
    [0, 1].map(|c| (corners[0][c] + corners[1][c] + corners[2][c]) / 3.0)
}

/// Compares the stresses.
pub fn compare(problem: &Problem, dual: &DualSolution, complementary: f64, judged: &Judged) -> StressSummary {
    if let Some(revolved) = problem.section().revolved() {
        return compare_stresses(problem, revolved, (dual, complementary), judged);
    }
    let mesh = &problem.mesh;
    let materials = problem.materials();
    // ½‖λ_h − σ(u_h)‖² on each triangle.
    let terms = &judged.field.local.triangles;
    let total: f64 = terms.iter().sum();
    let worst = (0..terms.len()).max_by(|&a, &b| terms[a].total_cmp(&terms[b])).unwrap_or(0);
    let (mut difference, mut norm, mut mises) = ([0.0; 3], 0.0, 0.0);
    let mut strains = Strains::default();
    for t in 0..mesh.triangles.len() {
        let material = &materials[mesh.body[t]];
        let field = &judged.field.displacement;
        let (of_field, own) = (elastic_degree(field.degree(t), material), dual.stress.degree(t));
        let (samples, shapes) = (Samples::of(of_field, own), Samples::of_stress(own, of_field));
        for sub in 0..3 {
            strains.elastic(mesh.corners(t), field, t, sub, material);
            let place = sub_corners(mesh.corners(t), sub);
            for (q, (l_at, weight)) in samples.points.iter().enumerate() {
                let l = dual.stress.sample(t, sub, shapes, q);
                let s = material.stress(strains.sample(samples, q));
                let w = weight * mesh.area(t) / 3.0;
                for c in 0..3 {
                    difference[c] += w * (l[c] - s[c]).powi(2);
                }
                norm += w * contraction(l, l);
                let at = [0, 1].map(|c| (0..3).map(|i| l_at[i] * place[i][c]).sum());
                let of = |s| material.von_mises(s, at);
                mises += w * (of(l) - of(s)).powi(2);
            }
        }
    }
    let relative = |square: f64| if norm > 0.0 { (square / norm).sqrt() } else { 0.0 };
    let largest = |means: Vec<[f64; 3]>| von_mises_map(problem, &means).into_iter().fold(0.0, f64::max);
    let corners = mesh.corners(worst);
    StressSummary {
        against: judged.candidate.name.clone(),
        relative_energy_norm_difference: if complementary > 0.0 { (total / complementary).sqrt() } else { 0.0 },
        worst_triangle: worst,
        worst_at: [0, 1].map(|c| (corners[0][c] + corners[1][c] + corners[2][c]) / 3.0),
        worst_share: if total > 0.0 { terms.get(worst).copied().unwrap_or(0.0) / total } else { 0.0 },
        von_mises_max: TwoSides {
            dual: von_mises_of_means(problem, &dual.stress).into_iter().fold(0.0, f64::max),
            primal: Some(largest(primal_means(problem, judged))),
        },
        component_l2_difference: ComponentDifference {
            xx: relative(difference[0]),
            yy: relative(difference[1]),
            tt: None,
            xy: relative(difference[2]),
            von_mises: relative(mises),
        },
    }
}
