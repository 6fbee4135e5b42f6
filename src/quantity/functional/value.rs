//! Quantities of fields that are known.

use super::Functional;
use crate::bounds::{Sum, work, work_of, work_on_edges};
use crate::element::Displacement;
use crate::element::geometry::sub_area;
use crate::element::polynomial::quadrature::triangle_rule;
use crate::element::{Strains, elastic_degree};
use crate::problem::Problem;
use crate::quantity::adjoint::pass::strained;
use crate::quantity::adjoint::revolved;
use crate::quantity::adjoint::revolved::Of;
use crate::quantity::adjoint::springs::product_of;

/// ∫ q·v, the part of a quantity that is a mean displacement, for any displacement.
pub fn displaced(problem: &Problem, functional: &Functional, v: &Displacement) -> f64 {
    if let Some(local) = &functional.local {
        return local.displaced(problem, v);
    }
    let load = &functional.load;
    work_of(problem, v, |body| load.force[body], load.tractions.iter().copied()).value()
        + work_on_edges(problem, v, &load.edges)
}

/// The quantity of an admissible displacement alone: means of it and of its stress, and forces by the work that they do on
/// the motion which lifts them; `None` where no such motion meets the supports.
pub fn value_of(problem: &Problem, functional: &Functional, v: &Displacement) -> Option<f64> {
    let materials = problem.materials();
    let (mut strains, mut on) = (Strains::default(), None);
    let at = |t: usize, sub: usize, l: [f64; 3]| {
        if on.replace((t, sub)) != Some((t, sub)) {
            strains.elastic(problem.mesh.corners(t), v, t, sub, &materials[problem.mesh.body[t]]);
        }
        materials[problem.mesh.body[t]].stress(strains.at(l))
    };
    let degree = |t: usize| elastic_degree(v.degree(t), &materials[problem.mesh.body[t]]);
    let mut sum = functional.constant + displaced(problem, functional, v);
    sum += match problem.section().revolved() {
        Some(of) => revolved::strained(problem, of, functional, Of::Displacement(v)),
        None => strained(problem, functional, degree, at),
    };
    if functional.load.weights.iter().any(|w| !w.is_empty()) {
        // ∫ φ t = −∫ t j(w̃) = F(w̃) − ∫ σ(v) : e(w̃).
        let lift = functional.lift.as_ref()?;
        sum += work(problem, lift).value() - product(problem, v, lift) - product_of(problem, v, lift);
    }
    Some(functional.scale * sum)
}

/// ∫ σ(v) : e(w).
fn product(problem: &Problem, v: &Displacement, w: &Displacement) -> f64 {
    if let Some(revolved) = problem.section().revolved() {
        return revolved::product(problem, revolved, v, w);
    }
    let materials = problem.materials();
    let (mut of_v, mut of_w) = (Strains::default(), Strains::default());
    let mut sum = Sum::default();
    for t in 0..problem.mesh.triangles.len() {
        if w.largest(t) == 0.0 {
            continue;
        }
        let corners = problem.mesh.corners(t);
        for sub in 0..3 {
            of_v.elastic(corners, v, t, sub, &materials[problem.mesh.body[t]]);
            of_w.on(corners, w, t, sub);
            for (l, weight) in
                triangle_rule(elastic_degree(v.degree(t), &materials[problem.mesh.body[t]]) + w.degree(t) - 1)
            {
                let product = materials[problem.mesh.body[t]].strain_product(of_v.at(*l), of_w.at(*l));
                sum.add(weight * sub_area(corners) * product);
            }
        }
    }
    sum.value()
}
