//! Polynomial tractions that are replaced by what a program knows of them: their values at nodes, or at the points of a rule.

use crate::compare::forces::functions::Functions;
use crate::compare::forces::tractions;
use crate::diagnose::space::Space;
use crate::diagnose::{Finding, Trial};
use crate::element::polynomial::quadrature::segment_rule;
use crate::element::polynomial::side;

/// Most points of a rule that is tried; one more is exact for every traction that a scene can have.
const POINTS: usize = 5;

/// Every way to replace all of them.
pub fn trials(space: &Space<'_>) -> Vec<Trial> {
    let problem = space.problem();
    if !problem.has_polynomial_tractions() {
        return Vec::new();
    }
    let degree = space.solution.candidate.degree;
    let edges = problem.pressed_edges();
    let integrated = |edges: &[(usize, Vec<[f64; 2]>)]| {
        let mut forces = vec![[0.0; 2]; space.count()];
        for (e, traction) in edges {
            let whole = problem.times_weight(*e, traction);
            tractions::add(problem, (*e, &whole), degree, Functions::Values, &mut forces);
        }
        forces
    };
    let sampled = |points: usize| {
        let mut forces = vec![[0.0; 2]; space.count()];
        for (e, traction) in &edges {
            let whole = problem.times_weight(*e, traction);
            let moments = [0, 1].map(|c| moments(&side::component(&whole, c), degree, points));
            tractions::spread(problem, (*e, moments), Functions::Values, &mut forces);
        }
        forces
    };
    let exact = integrated(&edges);
    let trial = |name: &str, points: Option<usize>, sentence: String, replaced: Vec<[f64; 2]>| {
        let change = exact.iter().zip(replaced).map(|(f, g)| [f[0] - g[0], f[1] - g[1]]).collect();
        let findings = vec![Finding::new(format!("loads/{name}"), points.map(|n| n as f64), None, sentence)];
        Trial { rank: 1, left: space.left_with(&space.column(change)), findings }
    };
    let between: Vec<_> = edges.iter().map(|(e, traction)| (*e, interpolated(traction, degree))).collect();
    let sentence = "tractions are interpolated between their values at the nodes of edges, and are not the polynomials";
    let mut trials = vec![trial("at-nodes", None, sentence.to_string(), integrated(&between))];
    for points in 1..=POINTS {
        let sentence = format!(
            "tractions are integrated with {points} point{} on each edge, which is exact up to degree {}, and the integrands are of a higher one",
            if points == 1 { "" } else { "s" },
            2 * points - 1
        );
        trials.push(trial("points", Some(points), sentence, sampled(points)));
    }
    trials
}

/// Bernstein coefficients of the polynomial of `degree` 1 or 2 that has the values of `traction` at the nodes.
fn interpolated(traction: &[[f64; 2]], degree: usize) -> Vec<[f64; 2]> {
    let nodes = (0..=degree).map(|i| i as f64 / degree as f64);
    let [x, y] = [0, 1].map(|c| {
        let along = side::component(traction, c);
        Functions::Values.coefficients(&nodes.clone().map(|s| side::value(&along, s)).collect::<Vec<_>>())
    });
    x.into_iter().zip(y).map(|(x, y)| [x, y]).collect()
}

/// ∫₀¹ f B_k ds of degree `degree` by the Gauss rule with that many points.
fn moments(f: &[f64], degree: usize, points: usize) -> Vec<f64> {
    let rule = segment_rule(2 * points - 1);
    let of = |k: usize| rule.iter().map(|(s, w)| w * side::value(f, *s) * side::bernstein(degree, k, *s)).sum();
    (0..=degree).map(of).collect()
}
