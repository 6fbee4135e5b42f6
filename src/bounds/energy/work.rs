//! Work of loads on a displacement.

use crate::bounds::jump::side_coefficients;
use crate::bounds::rounding::counted::Counted;
use crate::bounds::rounding::sum::Sum;
use crate::element::Displacement;
use crate::element::geometry::{sub_area, sub_corners};
use crate::element::polynomial::{side, triangle};
use crate::load::BodyForce;
use crate::problem::Problem;

/// The work of the loads on `v`, ∫F·v + ∫P·v, per unit thickness.
pub fn work(problem: &Problem, v: &Displacement) -> Sum {
    work_of(problem, v, |body| problem.scene.bodies[body].body_force, problem.tractions())
}

/// The work on `v` of a body force of each body, and of tractions given by their values at the ends of edges, per unit
/// thickness.
pub fn work_of(
    problem: &Problem,
    v: &Displacement,
    force: impl Fn(usize) -> BodyForce,
    tractions: impl Iterator<Item = (usize, [[f64; 2]; 2])>,
) -> Sum {
    counted_work(problem, v, force, tractions, Counted::ALL)
}

pub(super) fn counted_work(
    problem: &Problem,
    v: &Displacement,
    force: impl Fn(usize) -> BodyForce,
    tractions: impl Iterator<Item = (usize, [[f64; 2]; 2])>,
    counted: Counted<'_>,
) -> Sum {
    let (mesh, section) = (&problem.mesh, problem.section());
    let mut work = Sum::default();
    for t in (0..mesh.triangles.len()).filter(|t| counted.triangle(*t)) {
        let force = force(mesh.body[t]);
        if !force.is_none() {
            if let Some(revolved) = section.revolved() {
                work.extend(revolved.work_inside(&force, mesh.corners(t), v, t));
                continue;
            }
            work.extend(work_inside(&force, mesh.corners(t), v, t));
        }
    }
    let tractions = tractions.filter(|(e, _)| counted.boundary_edge(mesh, *e));
    tractions.for_each(|(e, ends)| work.extend(work_on_edge(problem, v, e, ends)));
    work
}

/// The work on `v` of tractions along edges of any kind, by their Bernstein coefficients, per unit thickness.
pub fn work_on_edges(problem: &Problem, v: &Displacement, tractions: &[(usize, Vec<[f64; 2]>)]) -> f64 {
    let mut work = Sum::default();
    for (e, coefficients) in tractions {
        let (length, _) = problem.mesh.edge_frame(*e);
        let u = side_coefficients(problem, v, *e);
        for c in 0..2 {
            let [t, u] = [&coefficients[..], &u[..]].map(|list| side::component(list, c));
            work.add(length * side::integral(&t, &u));
        }
    }
    work.value()
}

/// The work of a body force on the displacement that `v` has as its triangle `t`, in the terms of a sum.
pub fn work_inside(force: &BodyForce, corners: [[f64; 2]; 3], v: &Displacement, t: usize) -> [f64; 6] {
    let forces = [0, 1, 2].map(|sub| force.on(sub_corners(corners, sub)).of_area(sub_area(corners)));
    // Component by component: what cancels between them is rounded all the same.
    [0, 1, 2, 3, 4, 5].map(|term| {
        let (sub, c) = (term / 2, term % 2);
        let weights = triangle::indices(v.degree(t)).map(|alpha| forces[sub].against(alpha)[c]);
        v.sub(t, sub).zip(weights).map(|(u, weight)| weight * u[c]).sum()
    })
}

/// The work on `v` of a traction with the given values at the ends of edge `e`, per unit thickness, by components.
fn work_on_edge(problem: &Problem, v: &Displacement, e: usize, [a, b]: [[f64; 2]; 2]) -> [f64; 2] {
    if a == [0.0; 2] && b == [0.0; 2] {
        return [0.0; 2];
    }
    let (length, _) = problem.mesh.edge_frame(e);
    let u = side_coefficients(problem, v, e);
    let own = problem.weighted(e, [a, b]);
    let along = |c: usize| side::integral(&side::component(&own, c), &side::component(&u, c));
    [0, 1].map(|c| length * along(c))
}
