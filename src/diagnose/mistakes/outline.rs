//! Loads, springs and supports on sides of which the scene says nothing.

use std::collections::{BTreeMap, BTreeSet};

use crate::bounds::Hold;
use crate::compare::forces::functions::{Functions, nodes_along};
use crate::compare::forces::tractions;
use crate::compare::solution::SOLVER;
use crate::diagnose::fit::Terms;
use crate::diagnose::physical::is_simple;
use crate::diagnose::space::Space;
use crate::diagnose::words::number;
use crate::diagnose::{Finding, Trial};
use crate::problem::Condition;
use crate::sets::DisjointSets;

/// Sides that are tried, the longest first.
const MOST: usize = 48;
/// Cosine of the largest turn within a side without a name.
const SMOOTH: f64 = 0.9;
/// Cosine of the angle to the normal up to which a traction is a pressure.
const ALONG: f64 = 1e-6;
/// Nodes that have to stand still for a side to be held.
const STILL: usize = 3;
/// The part of the squared residual that may be left beside a side that is held.
const LEFT: f64 = 1e-6;

/// A side of a body without a condition.
struct Side {
    edges: Vec<usize>,
    name: String,
    /// What it is called in a sentence.
    what: String,
}

/// Puts uniform loads and springs on every side into `terms`; gives supports and obstacles on them.
pub fn trials<'a>(space: &'a Space<'a>, terms: &mut Terms<'a>) -> Vec<Trial> {
    if space.solution.candidate.degree > 2 {
        return Vec::new();
    }
    let mut trials = Vec::new();
    for side in sides(space).into_iter().filter(|side| is_acted_on(space, side)) {
        for side in [acted_on(space, &side), Some(side)].into_iter().flatten() {
            loads(space, &side, terms);
            springs(space, &side, terms);
            trials.extend(held(space, &side));
        }
    }
    trials
}

fn sides(space: &Space<'_>) -> Vec<Side> {
    let problem = space.problem();
    let mesh = &problem.mesh;
    let free: Vec<usize> = (0..mesh.edges.len())
        .filter(|e| mesh.edges[*e].triangles[1].is_none())
        .filter(|e| matches!(problem.conditions[*e], Condition::Traction(t) if t == [[0.0; 2]; 2]))
        .collect();
    let pressed: BTreeSet<usize> = problem
        .pressed_edges()
        .into_iter()
        .filter(|(_, load)| load.iter().flatten().any(|t| *t != 0.0))
        .map(|(e, _)| e)
        .collect();
    let sprung: BTreeSet<usize> =
        problem.bed_pairs().flat_map(|(pair, _)| [Some(pair.edge), pair.opposite]).flatten().collect();
    let free: Vec<usize> = free.into_iter().filter(|e| !pressed.contains(e) && !sprung.contains(e)).collect();
    let mut sets = DisjointSets::new(free.len());
    let mut at: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (i, e) in free.iter().enumerate() {
        mesh.edges[*e].vertices.iter().for_each(|v| at.entry(*v).or_default().push(i));
    }
    for both in at.values().filter(|both| both.len() == 2) {
        let [a, b] = [both[0], both[1]].map(|i| free[i]);
        let [m, n] = [a, b].map(|e| mesh.edge_frame(e).1);
        let named = mesh.edges[a].name.is_some() || mesh.edges[b].name.is_some();
        let alike = if named { mesh.edges[a].name == mesh.edges[b].name } else { m[0] * n[0] + m[1] * n[1] > SMOOTH };
        if alike {
            sets.join(both[0], both[1]);
        }
    }
    let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (i, e) in free.iter().enumerate() {
        groups.entry(sets.root(i)).or_default().push(*e);
    }
    let length = |edges: &[usize]| edges.iter().map(|e| mesh.edge_frame(*e).0).sum::<f64>();
    let mut groups: Vec<Vec<usize>> = groups.into_values().collect();
    groups.sort_by(|a, b| length(b).total_cmp(&length(a)));
    groups.truncate(MOST);
    groups.into_iter().map(|edges| called(space, edges)).collect()
}

fn nodes_of<'a>(space: &Space<'a>, e: usize) -> impl Iterator<Item = usize> + use<'a> {
    nodes_along(&space.problem().mesh, e, space.solution.candidate.degree)
}

/// True if any of the residual is on a side: elsewhere nothing there explains it.
fn is_acted_on(space: &Space<'_>, side: &Side) -> bool {
    let nodes: BTreeSet<usize> = side.edges.iter().flat_map(|e| nodes_of(space, *e)).collect();
    nodes.into_iter().map(|node| space.square_at(node)).sum::<f64>() > LEFT * space.square
}

/// The part of a side on which forces act; `None` where that is all or nothing of it.
fn acted_on(space: &Space<'_>, side: &Side) -> Option<Side> {
    let is_acted_on = |e: &usize| {
        // What a support takes shows nothing.
        let free: Vec<usize> = nodes_of(space, *e).filter(|n| space.solution.hold(*n) == Hold::Free).collect();
        !free.is_empty() && free.iter().all(|n| space.square_at(*n) > LEFT * space.square)
    };
    let edges: Vec<usize> = side.edges.iter().copied().filter(is_acted_on).collect();
    let is_part = !edges.is_empty() && edges.len() < side.edges.len();
    is_part.then(|| Side { name: side.name.clone(), ..called(space, edges) })
}

fn called(space: &Space<'_>, edges: Vec<usize>) -> Side {
    let mesh = &space.problem().mesh;
    if let Some(name) = edges.first().and_then(|e| mesh.edges[*e].name) {
        let name = mesh.names[name].clone();
        let whole = edges.len() == mesh.boundary(&name).len();
        let what = if whole { name.clone() } else { format!("a part of {name}") };
        return Side { edges, what, name };
    }
    let mut count: BTreeMap<usize, usize> = BTreeMap::new();
    edges.iter().flat_map(|e| mesh.edges[*e].vertices).for_each(|v| *count.entry(v).or_default() += 1);
    let ends: Vec<String> = count.iter().filter(|(_, n)| **n == 1).map(|(v, _)| space.solution.named(*v)).collect();
    let what = match ends.as_slice() {
        [from, to] => format!("the side from {from} to {to}"),
        _ => format!("the side through {}", count.keys().next().map_or(String::new(), |v| space.solution.named(*v))),
    };
    Side { edges, name: "outline".to_string(), what }
}

/// Nodal forces of tractions along the edges of a side, each by its Bernstein coefficients.
fn column(space: &Space<'_>, side: &Side, traction: impl Fn(usize) -> Vec<[f64; 2]>) -> Vec<f64> {
    let problem = space.problem();
    let mut forces = vec![[0.0; 2]; space.count()];
    let degree = space.solution.candidate.degree;
    for e in &side.edges {
        let weighed = problem.times_weight(*e, &traction(*e));
        tractions::add(problem, (*e, &weighed), degree, Functions::Values, &mut forces);
    }
    space.column(forces)
}

fn loads<'a>(space: &'a Space<'a>, side: &Side, terms: &mut Terms<'a>) {
    let mesh = &space.problem().mesh;
    let normals: Vec<[f64; 2]> = side.edges.iter().map(|e| mesh.edge_frame(*e).1).collect();
    let straight = normals.iter().all(|n| n[0] * normals[0][0] + n[1] * normals[0][1] > 1.0 - ALONG);
    let (name, what, normal) = (format!("boundary/{}/forces", side.name), side.what.clone(), normals[0]);
    let along = |t: [f64; 2]| column(space, side, |_| vec![[-t[0], -t[1]]; 2]);
    let told = name.clone();
    let of = what.clone();
    terms.push(3, vec![along([1.0, 0.0]), along([0.0, 1.0])], move |x| {
        let size = x[0].hypot(x[1]);
        let pressure = -(x[0] * normal[0] + x[1] * normal[1]);
        let sentence = match straight && size - pressure.abs() < ALONG * size {
            true => format!("a pressure of {} acts on {of}, where the scene has no load", number(pressure)),
            false => {
                format!("a traction ({}, {}) acts on {of}, where the scene has no load", number(x[0]), number(x[1]))
            }
        };
        vec![Finding::new(told.clone(), Some(size), Some(0.0), sentence)]
    });
    if !straight {
        let pressed = column(space, side, |e| {
            let n = mesh.edge_frame(e).1;
            vec![n; 2]
        });
        terms.push(2, vec![pressed], move |x| {
            let sentence = format!("a pressure of {} acts on {what}, where the scene has no load", number(x[0]));
            vec![Finding::new(name.clone(), Some(x[0].abs()), Some(0.0), sentence)]
        });
    }
}

fn springs<'a>(space: &'a Space<'a>, side: &Side, terms: &mut Terms<'a>) {
    let (mesh, candidate) = (&space.problem().mesh, space.solution.candidate);
    let vertices = mesh.points.len();
    // Of the displacement, the part that springs of one direction resist.
    let part = |normal: bool| {
        column(space, side, |e| {
            let [a, b] = mesh.edges[e].vertices.map(|v| candidate.value(v));
            let values = match candidate.degree {
                2 => {
                    let m = candidate.value(vertices + e);
                    vec![a, [0, 1].map(|c| 2.0 * m[c] - 0.5 * (a[c] + b[c])), b]
                }
                _ => vec![a, b],
            };
            let n = mesh.edge_frame(e).1;
            let d = if normal { n } else { [-n[1], n[0]] };
            values.into_iter().map(|u| d.map(|x| (u[0] * d[0] + u[1] * d[1]) * x)).collect()
        })
    };
    let [normal, tangential] = [true, false].map(part);
    let (name, what) = (format!("boundary/{}/springs", side.name), side.what.clone());
    let told = move |stiffness: String, direction: &str, least: f64| {
        let sentence =
            format!("springs of the stiffness {stiffness} hold {what}{direction}, of which the scene says nothing");
        vec![Finding::new(name.clone(), Some(least), Some(0.0), sentence)]
    };
    let both = told.clone();
    terms.push(3, vec![normal.clone(), tangential.clone()], move |x| {
        both(format!("[{}, {}]", number(x[0]), number(x[1])), "", x[0].min(x[1]))
    });
    for (column, direction) in [(normal, " along its normal"), (tangential, " along it")] {
        let told = told.clone();
        terms.push(2, vec![column], move |x| told(number(x[0]), direction, x[0]));
    }
}

/// A side that stands still, or is pushed where it does, under forces of which the scene says nothing.
fn held(space: &Space<'_>, side: &Side) -> Option<Trial> {
    let (mesh, solution) = (&space.problem().mesh, space.solution);
    let enough = (SOLVER + solution.candidate.precision) * solution.reference;
    let mut nodes: BTreeMap<usize, [f64; 2]> = BTreeMap::new();
    for e in &side.edges {
        let n = mesh.edge_frame(*e).1;
        nodes.extend(nodes_of(space, *e).map(|node| (node, n)));
    }
    let straight =
        nodes.values().next().is_some_and(|m| nodes.values().all(|n| n[0] * m[0] + n[1] * m[1] > 1.0 - ALONG));
    let force = |node: usize| [0, 1].map(|c| space.residual[2 * node + c]);
    let across = |node: usize, n: [f64; 2]| {
        let r = force(node);
        r[0] * n[0] + r[1] * n[1]
    };
    let left = |whole: bool| {
        let inside: f64 =
            nodes.iter().map(|(node, n)| if whole { space.square_at(*node) } else { across(*node, *n).powi(2) }).sum();
        (1.0 - inside / space.square).max(0.0)
    };
    // Nodes that are held have forces that others have not.
    let acting: Vec<(usize, [f64; 2])> =
        nodes.iter().filter(|(node, _)| space.square_at(**node) > LEFT * space.square).map(|(v, n)| (*v, *n)).collect();
    let still = |along: &dyn Fn([f64; 2], [f64; 2]) -> f64| {
        acting.len() >= STILL
            && acting.iter().all(|(node, n)| along(solution.candidate.value(*node), *n).abs() <= enough)
    };
    let normal = |u: [f64; 2], n: [f64; 2]| u[0] * n[0] + u[1] * n[1];
    let (what, all) = (&side.what, acting.len() == nodes.len());
    let trial = |rank: usize, left: f64, key: &str, sentence: String| {
        let findings = vec![Finding::new(format!("boundary/{}/{key}", side.name), None, None, sentence)];
        Some(Trial { rank, left, findings })
    };
    if straight && still(&normal) && left(false) <= LEFT {
        let sentence = match all {
            true => format!("{what} does not move across itself, as on a roller, of which the scene says nothing"),
            false => format!(
                "forces push {what} where it does not move across itself, as on an obstacle, of which the scene says nothing"
            ),
        };
        return trial(2, left(false), "held", sentence);
    }
    if still(&|u, _| u[0].hypot(u[1])) && left(true) <= LEFT {
        return trial(
            3,
            left(true),
            "held",
            format!("{what} does not move, as where it is clamped, of which the scene says nothing"),
        );
    }
    // Another curve than that of the boundary with a name, which `local` tries.
    let unnamed = side.name == "outline" && is_simple(nodes.len(), space.count());
    let sentence = format!("forces act on {what} that the scene does not have");
    if unnamed { trial(7, left(true), "forces", sentence) } else { None }
}
