//! Stiff elastic contact on the way to an admissible displacement: as a contact whose gap is wider by what it yields.
//!
//! φ(j) = ½ k (j − g)₊² is the least ½ k s² of all s ≥ 0 with j ≤ g + s. Any s gives an upper bound, and that of the dual solution,
//! −t/k, a sharp one where the contact is stiff beside its bodies, whose displacement no spring could be fitted to. At a vertex that
//! supports press further than that, it yields as far as they press. Where it is soft a small error of t is a large one of s, and springs
//! take its place ([`crate::problem::Problem::softened`]).

use std::borrow::Cow;
use std::collections::HashMap;

use super::holds::{Hold, forced, jump_rounding};
use crate::bounds::springs::spring_tractions;
use crate::bounds::upper::Groundwork;
use crate::dual::DualSolution;
use crate::element::polynomial::side;
use crate::problem::{BedPair, ContactPair, EdgeWeight, Problem};

/// `problem` with rigid contacts that have yielded in the place of stiff elastic ones, and the energy ½ ∫ k s² of these, per unit
/// thickness; `ground` knows the supports.
pub fn yielded<'a>(problem: &'a Problem, dual: &DualSolution, ground: &Groundwork) -> (Cow<'a, Problem>, f64) {
    if !problem.has_elastic_contact() {
        return (Cow::Borrowed(problem), 0.0);
    }
    let (mut wider, mut stored) = (problem.clone(), 0.0);
    for (index, interface) in problem.interfaces.iter().enumerate() {
        if !interface.pairs.iter().any(|pair| is_stiff(problem, pair)) {
            continue;
        }
        // Continuous along the contact: at a vertex the mean of both edges.
        let mut at = HashMap::<usize, Vec<f64>>::new();
        for pair in &interface.pairs {
            for (v, s) in pair.first.into_iter().zip(ends(problem, dual, pair)) {
                at.entry(v).or_default().push(s);
            }
        }
        let mean = |v: usize| at.get(&v).map_or(0.0, |all| all.iter().sum::<f64>() / all.len() as f64);
        let least = pressed(problem, &interface.pairs, &ground.holds.vertices);
        for pair in &mut wider.interfaces[index].pairs {
            let Some(k) = pair.stiffness.take() else { continue };
            let s = pair.first.map(|v| mean(v).max(least.get(&v).copied().unwrap_or(0.0)));
            pair.gap = [pair.gap[0] + s[0], pair.gap[1] + s[1]];
            let weight = EdgeWeight::of_pair(problem.section(), &problem.mesh, pair);
            stored += 0.5 * k * pair.length * side::integral(&s, &weight.times(&s));
        }
    }
    (Cow::Owned(wider), stored)
}

/// What the contact yields at least, by vertex of its first side: how far supports press it there.
fn pressed(problem: &Problem, pairs: &[ContactPair], held: &[Hold]) -> HashMap<usize, f64> {
    let mut least = HashMap::<usize, f64>::new();
    for pair in pairs {
        for (end, v) in pair.first.into_iter().enumerate() {
            let Some((by, size)) = forced(pair, end, held) else { continue };
            let at = least.entry(v).or_insert(0.0);
            *at = at.max(by + jump_rounding(problem, pair, size));
        }
    }
    least
}

/// True if an elastic contact is stiffer than the bodies it touches, on the scale of its edge.
fn is_stiff(problem: &Problem, pair: &ContactPair) -> bool {
    let of = |e: usize| problem.mesh.edges[e].triangles[0].map(|t| problem.mesh.body[t]);
    let softest = pair.edges.iter().flatten().filter_map(|e| of(*e)).map(|body| problem.material(body).young()[0]);
    pair.stiffness.is_some_and(|k| k * pair.length > softest.fold(f64::INFINITY, f64::min))
}

/// −t/k at both ends of a pair, zero where it would be below.
fn ends(problem: &Problem, dual: &DualSolution, pair: &ContactPair) -> [f64; 2] {
    let Some((bed, [k, _])) = BedPair::of_contact(pair, problem.section(), &problem.mesh) else { return [0.0; 2] };
    let [t, _] = spring_tractions(problem, &dual.stress, &bed);
    let ends = [0, 1].map(|end| (-bed.weight.unweighted_at_end(&t, end) / k).max(0.0));
    if problem.mesh.edges[bed.edge].vertices[0] == pair.first[0] { ends } else { [ends[1], ends[0]] }
}
