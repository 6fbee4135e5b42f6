//! Supports that the field does not respect, read from displacements and forces there.

use std::collections::BTreeSet;

use crate::bounds::Hold;
use crate::compare::Solution;
use crate::compare::solution::SOLVER;
use crate::diagnose::Finding;
use crate::diagnose::words::number;
use crate::scene::{Support, SupportKind};

/// Forces this small beside all others are none.
const NO_FORCE: f64 = 1e-6;
/// How well a spring's force has to follow its displacement to be one.
const SPRING: f64 = 0.05;

/// One finding for each support that is not met.
pub fn findings(solution: &Solution<'_>) -> Vec<Finding> {
    let (mesh, scene) = (&solution.problem.mesh, &solution.problem.scene);
    let enough = (SOLVER + solution.candidate.precision) * solution.reference;
    let applied = solution.applied();
    let mut findings: Vec<Finding> = on_axis(solution, enough).into_iter().collect();
    let vertices = mesh.points.len();
    let nodes_of = |support: &Support| -> Vec<usize> {
        let edges = mesh.boundary(&support.on);
        let nodes: BTreeSet<usize> =
            edges.iter().flat_map(|e| mesh.edges[*e].vertices.into_iter().chain([vertices + e])).collect();
        nodes.into_iter().filter(|n| *n < solution.rest.len()).collect()
    };
    let is_missed = |n: &usize| {
        let [x, y] = of_support(solution, *n);
        x.hypot(y) > enough
    };
    let rigid = scene.supports.iter().filter(|support| !matches!(support.kind, SupportKind::Spring { .. }));
    let all: Vec<(&Support, Vec<usize>)> = rigid.map(|support| (support, nodes_of(support))).collect();
    let missed: Vec<BTreeSet<usize>> =
        all.iter().map(|(_, nodes)| nodes.iter().copied().filter(is_missed).collect()).collect();
    // A corner that another support misses with all of its nodes is that one's.
    let is_of_another =
        |own: &BTreeSet<usize>| missed.iter().any(|other| other.len() > own.len() && own.is_subset(other));
    for ((support, nodes), _) in all.iter().zip(&missed).filter(|(_, own)| !is_of_another(own)) {
        let off: Vec<[f64; 2]> = nodes.iter().map(|n| of_support(solution, *n)).collect();
        let (worst, depth) = nodes.iter().zip(&off).fold((0, 0.0_f64), |(node, most), (n, d)| {
            let size = d[0].hypot(d[1]);
            if size > most { (*n, size) } else { (node, most) }
        });
        if depth <= enough {
            continue;
        }
        let force: Vec<[f64; 2]> = nodes.iter().map(|n| solution.supported(*n)).collect();
        let name = |what: &str| format!("support/{}/{what}", support.on);
        let largest = force.iter().map(|f| f[0].hypot(f[1])).fold(0.0, f64::max);
        let bad = off.iter().filter(|d| d[0].hypot(d[1]) > enough).count();
        let on = &support.on;
        let scaled = prescribed(solution, nodes);
        findings.push(if scaled.is_some_and(|s| s.abs() <= SOLVER) {
            let sentence = format!("the prescribed displacement of {on} is not applied: it is zero there");
            Finding::new(name("displacement"), Some(0.0), Some(1.0), sentence)
        } else if largest <= NO_FORCE * applied {
            let sentence = format!("the support on {on} is not applied: no force acts there, and it moves by up to {}", number(depth));
            Finding::new(name("missing"), Some(depth), Some(0.0), sentence)
        } else if let Some(c) = (0..2).find(|c| free_along(*c, &off, &force, enough, NO_FORCE * applied)) {
            let axis = ["x", "y"][c];
            let sentence = format!(
                "the support on {on} is not applied along {axis}: no force acts in this direction, and it moves by up to {}",
                number(depth)
            );
            Finding::new(name("missing"), Some(depth), Some(0.0), sentence)
        } else if let Some(s) = scaled {
            let sentence = format!("the displacement of {on} is {} times the prescribed one", number(s));
            Finding::new(name("displacement"), Some(s), Some(1.0), sentence)
        } else if let Some(stiffness) = spring(&off, &force) {
            let sentence = format!(
                "the support on {on} acts as a penalty with the stiffness {} for each node, which gives way by up to {}",
                number(stiffness),
                number(depth)
            );
            Finding::new(name("penalty"), Some(stiffness), None, sentence)
        } else if bad < nodes.len() {
            let sentence = format!(
                "the support on {on} is violated at {bad} of {} nodes, by at most {}, at {}",
                nodes.len(),
                number(depth),
                solution.named(worst)
            );
            Finding::new(name("in-part"), Some(depth), Some(0.0), sentence)
        } else {
            let sentence = format!("the support on {on} is missed by up to {}, at {}", number(depth), solution.named(worst));
            Finding::new(name("missed"), Some(depth), Some(0.0), sentence)
        });
    }
    findings
}

/// The displacement across the axis of revolution, where it is not zero: no support says so, and every body that touches it is held there.
fn on_axis(solution: &Solution<'_>, enough: f64) -> Option<Finding> {
    let across = |n: usize| off(solution, n)[0].abs();
    let nodes = (0..solution.rest.len()).filter(|n| is_on_axis(solution, *n));
    let worst = nodes.max_by(|a, b| across(*a).total_cmp(&across(*b))).filter(|n| across(*n) > enough)?;
    let (most, place) = (across(worst), solution.named(worst));
    let sentence =
        format!("the displacement across the axis of revolution is not zero there: it is {} at {place}", number(most));
    Some(Finding::new("support/axis/radial", Some(most), Some(0.0), sentence))
}

/// True for a vertex or the middle of an edge on the axis of revolution.
fn is_on_axis(solution: &Solution<'_>, node: usize) -> bool {
    let (problem, mesh) = (solution.problem, &solution.problem.mesh);
    let on = |v: &usize| problem.section().on_axis(mesh.points[*v]);
    match node.checked_sub(mesh.points.len()) {
        None => on(&node),
        Some(e) => mesh.edges.get(e).is_some_and(|edge| edge.vertices.iter().all(on)),
    }
}

/// As [`off`], without what the axis of revolution holds.
fn of_support(solution: &Solution<'_>, node: usize) -> [f64; 2] {
    let [x, y] = off(solution, node);
    [if is_on_axis(solution, node) { 0.0 } else { x }, y]
}

/// True if a support misses along axis `c` alone, and no force acts along it.
fn free_along(c: usize, off: &[[f64; 2]], force: &[[f64; 2]], enough: f64, no_force: f64) -> bool {
    let most = |values: &[[f64; 2]], c: usize| values.iter().fold(0.0_f64, |m, v| m.max(v[c].abs()));
    most(off, c) > enough && most(off, 1 - c) <= enough && most(force, c) <= no_force
}

/// By how much the displacement of a node misses its support.
fn off(solution: &Solution<'_>, node: usize) -> [f64; 2] {
    let u = solution.candidate.value(node);
    let there = solution.hold(node).impose(u);
    [u[0] - there[0], u[1] - there[1]]
}

/// The factor on a prescribed displacement that the nodes have, where they all have the same.
fn prescribed(solution: &Solution<'_>, nodes: &[usize]) -> Option<f64> {
    let pair = |n: &usize| {
        let u = solution.candidate.value(*n);
        match solution.hold(*n) {
            Hold::Free => [[0.0; 2]; 2],
            Hold::Line { normal: [x, y], value } => [[u[0] * x + u[1] * y, 0.0], [value, 0.0]],
            Hold::Fixed(value) => [u, value],
        }
    };
    let pairs: Vec<[[f64; 2]; 2]> = nodes.iter().map(pair).collect();
    let sum = |i: usize| pairs.iter().map(|pair| pair[i][0] * pair[1][0] + pair[i][1] * pair[1][1]).sum::<f64>();
    let square = sum(1);
    let factor = sum(0) / square;
    let met =
        |[u, w]: &[[f64; 2]; 2]| (u[0] - factor * w[0]).hypot(u[1] - factor * w[1]) <= SOLVER * solution.reference;
    (square > 0.0 && pairs.iter().all(met)).then_some(factor)
}

/// The stiffness of springs that would exert these forces, where there is one.
fn spring(off: &[[f64; 2]], force: &[[f64; 2]]) -> Option<f64> {
    let dot = |a: &[[f64; 2]], b: &[[f64; 2]]| a.iter().zip(b).map(|(a, b)| a[0] * b[0] + a[1] * b[1]).sum::<f64>();
    let stiffness = -dot(off, force) / dot(off, off);
    let miss =
        off.iter().zip(force).map(|(d, f)| (f[0] + stiffness * d[0]).powi(2) + (f[1] + stiffness * d[1]).powi(2));
    (stiffness > 0.0 && miss.sum::<f64>() <= SPRING * SPRING * dot(force, force)).then_some(stiffness)
}
