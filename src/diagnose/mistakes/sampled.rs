//! Polynomial tractions that are replaced by what a program knows of them: their values at nodes, or at the points of a rule.

use crate::compare::forces::springs::Functions;
use crate::compare::forces::tractions;
use crate::diagnose::space::Space;
use crate::diagnose::{Finding, Trial};
use crate::element::polynomial::quadrature::segment_rule;
use crate::element::polynomial::side;
use crate::problem::Problem;

/// Most points of a rule that is tried; one more is exact for every traction that a scene can have.
const POINTS: usize = 5;

/// Every way to replace all of them.
pub fn trials(space: &Space<'_>) -> Vec<Trial> {
    let problem = space.problem();
    if !problem.has_polynomial_tractions() {
        return Vec::new();
    }
    let edges = problem.pressed_edges();
    let mut exact = vec![[0.0; 2]; space.count()];
    for (e, traction) in &edges {
        add(space, (*e, traction), &mut exact);
    }
    let trial = |name: &str, points: Option<usize>, sentence: String, replaced: Vec<[f64; 2]>| {
        let change = exact.iter().zip(replaced).map(|(f, g)| [f[0] - g[0], f[1] - g[1]]).collect();
        let findings = vec![Finding::new(format!("loads/{name}"), points.map(|n| n as f64), None, sentence)];
        Trial { rank: 1, left: space.left_with(&space.column(change)), findings }
    };
    let mut at_nodes = vec![[0.0; 2]; space.count()];
    for (e, traction) in &edges {
        add(space, (*e, &interpolated(traction, space.solution.candidate.degree)), &mut at_nodes);
    }
    let sentence = "tractions are interpolated between their values at the nodes of edges, and are not the polynomials";
    let mut trials = vec![trial("at-nodes", None, sentence.to_string(), at_nodes)];
    for points in 1..=POINTS {
        let mut sampled = vec![[0.0; 2]; space.count()];
        edges.iter().for_each(|(e, traction)| sample(space, (*e, traction), points, &mut sampled));
        let sentence = format!(
            "tractions are integrated with {points} point{} on each edge, which is exact up to degree {}, and the integrands are of a higher one",
            if points == 1 { "" } else { "s" },
            2 * points - 1
        );
        trials.push(trial("points", Some(points), sentence, sampled));
    }
    trials
}

/// Adds the forces of a traction, integrated exactly.
fn add(space: &Space<'_>, (e, traction): (usize, &[[f64; 2]]), forces: &mut [[f64; 2]]) {
    let problem: &Problem = space.problem();
    let whole = problem.times_weight(e, traction);
    tractions::add(problem, (e, &whole), space.solution.candidate.degree, Functions::Values, forces);
}

/// Bernstein coefficients of the polynomial of `degree` 1 or 2 that has the values of `traction` at the nodes.
fn interpolated(traction: &[[f64; 2]], degree: usize) -> Vec<[f64; 2]> {
    let at = |s: f64| [0, 1].map(|c| side::value(&traction.iter().map(|t| t[c]).collect::<Vec<_>>(), s));
    let [a, b] = [at(0.0), at(1.0)];
    match degree {
        2 => vec![a, [0, 1].map(|c| 2.0 * at(0.5)[c] - 0.5 * (a[c] + b[c])), b],
        _ => vec![a, b],
    }
}

/// Adds the forces of a traction by the Gauss rule with that many points.
fn sample(space: &Space<'_>, (e, traction): (usize, &[[f64; 2]]), points: usize, forces: &mut [[f64; 2]]) {
    let (problem, degree) = (space.problem(), space.solution.candidate.degree);
    let whole = problem.times_weight(e, traction);
    let length = problem.scene.thickness * problem.mesh.edge_frame(e).0;
    for c in 0..2 {
        let along: Vec<f64> = whole.iter().map(|t| t[c]).collect();
        let of = |k: usize| {
            let rule = segment_rule(2 * points - 1).iter();
            rule.map(|(s, w)| w * side::value(&along, *s) * side::bernstein(degree, k, *s)).sum::<f64>()
        };
        let own = Functions::Values.moments((0..=degree).map(of).collect());
        let nodes = tractions::nodes(&problem.mesh, e, degree);
        nodes.zip(own).for_each(|(node, f)| forces[node][c] += length * f);
    }
}
