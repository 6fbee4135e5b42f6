//! The verdict of a linear program solver, with one row per vertex instead of per straight run.

use super::build::transformed;
use super::freedom::work_of_vertices;
use super::scenes::cases;
use crate::problem::{Condition, Problem};
use crate::statics::{Components, RigidMotion, Solvability, check};
use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT, ZeroConeT};
use proptest::prelude::*;

/// The largest L(y) over allowed motions y with |a|, |b|, size · |ω| ≤ 1 for each piece.
fn largest_work(problem: &Problem) -> f64 {
    let components = Components::new(problem);
    let n = 3 * components.count();
    let unit = |i: usize| {
        let mut component = vec![[0.0; 3]; components.count()];
        component[i / 3][i % 3] = if i % 3 == 2 { 1.0 / components.size[i / 3] } else { 1.0 };
        RigidMotion { component }.at_vertices(problem, &components)
    };
    let units: Vec<_> = (0..n).map(unit).collect();
    let row = |v: usize, d: [f64; 2]| units.iter().map(move |u| u[v][0] * d[0] + u[v][1] * d[1]).collect::<Vec<_>>();
    let mut held = Vec::new();
    for (e, condition) in problem.conditions.iter().enumerate() {
        for v in problem.mesh.edges[e].vertices {
            match condition {
                Condition::Clamped(_) => held.extend([row(v, [1.0, 0.0]), row(v, [0.0, 1.0])]),
                Condition::Roller { direction, .. } => held.push(row(v, *direction)),
                _ => {}
            }
        }
    }
    let mut limited = Vec::new();
    for pair in problem.pairs() {
        for end in 0..2 {
            let first = row(pair.first[end], pair.normal);
            let second = pair.second.map_or(vec![0.0; n], |second| row(second[end], pair.normal));
            limited.push(first.iter().zip(second).map(|(a, b)| a - b).collect());
        }
    }
    let closed = limited.len();
    for i in 0..n {
        for sign in [1.0, -1.0] {
            limited.push((0..n).map(|j| if i == j { sign } else { 0.0 }).collect::<Vec<f64>>());
        }
    }
    let cones = [ZeroConeT(held.len()), NonnegativeConeT(limited.len())];
    let bounds: Vec<f64> = (0..held.len() + limited.len()).map(|i| f64::from(i >= held.len() + closed)).collect();
    let rows: Vec<_> = held.into_iter().chain(limited).collect();
    let work: Vec<f64> = units.iter().map(|u| -work_of_vertices(problem, u)).collect();
    let quadratic = CscMatrix::zeros((n, n));
    let settings = DefaultSettings { verbose: false, ..DefaultSettings::default() };
    let mut solver = DefaultSolver::new(&quadratic, &work, &CscMatrix::from(&rows), &bounds, &cones, settings).unwrap();
    solver.solve();
    -solver.solution.obj_val
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]
    #[test]
    fn verdict_agrees_with_a_linear_program(
        which in 0usize..20,
        excess in -0.9..0.5f64,
        forces in proptest::collection::vec([-0.3..0.3f64, -0.3..0.3], 3),
        disturb in any::<bool>(),
        angle in 0.0..6.0f64,
    ) {
        let mut problem = (cases()[which].scene)(excess);
        if disturb {
            for (body, force) in problem.scene.draft.bodies.iter_mut().zip(forces) {
                let own = body.body_force.given().value;
                body.body_force = [own[0] + force[0], own[1] + force[1]].into();
            }
        }
        let problem = transformed(problem, angle, 1.0, 1.0, [0.3, -0.2]);
        let work = largest_work(&problem);
        prop_assume!(!(1e-7..1e-4).contains(&work));
        let impossible = matches!(check(&problem).unwrap().equilibrium, Solvability::Impossible { .. });
        prop_assert_eq!(impossible, work > 1e-5, "{}: the program finds work {}", cases()[which].name, work);
    }
}
