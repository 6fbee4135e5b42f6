//! Places of mistakes: a node, with the body, contact and boundary it belongs to.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::bounds::{bernstein, holds, of_pair};
use crate::compare::solution::{Sites, written_place};
use crate::compare::{Candidate, Judged};
use crate::diagnose::Finding;
use crate::problem::{ContactPair, Problem};

/// A point of the scene and what it belongs to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Place {
    /// Its coordinates, as in the file.
    pub at: [f64; 2],
    /// The vertex of the mesh there, counted from zero; `null` at the midpoint of an edge.
    pub vertex: Option<usize>,
    /// A triangle that has it, counted from zero as in `fields.vtu`.
    pub triangle: Option<usize>,
    /// The body of this triangle.
    pub body: String,
    /// The contact it is on.
    pub contact: Option<String>,
    /// The named boundary it is on.
    pub boundary: Option<String>,
}

impl Place {
    /// The place of a node: vertices, then edge midpoints; `contact` where it is looked at as a node of this interface.
    pub fn of(problem: &Problem, node: usize, contact: Option<usize>) -> Self {
        let mesh = &problem.mesh;
        let vertex = (node < mesh.points.len()).then_some(node);
        let has = |t: &usize| match node.checked_sub(mesh.points.len()) {
            None => mesh.triangles[*t].contains(&node),
            Some(e) => mesh.triangle_edges[*t].contains(&e),
        };
        let triangle = (0..mesh.triangles.len()).find(has);
        let at_edge = |e: &usize| match vertex {
            Some(v) => mesh.edges[*e].vertices.contains(&v),
            None => node == mesh.points.len() + e,
        };
        let named = (0..mesh.edges.len()).filter(at_edge).filter_map(|e| mesh.edges[e].name);
        let body = triangle.map_or(String::new(), |t| problem.scene.bodies[mesh.body[t]].name.clone());
        Place {
            at: written_place(problem, node),
            vertex,
            triangle,
            body,
            contact: contact.map(|i| problem.interfaces[i].name.clone()),
            boundary: named.map(|name| mesh.names[name].clone()).next(),
        }
    }

    /// `at (1, 0.5): vertex 12 of triangle 7, on left_face, in left`.
    pub fn in_words(&self) -> String {
        let [x, y] = self.at.map(short);
        let node = match (self.vertex, self.triangle) {
            (Some(v), Some(t)) => format!(", vertex {v} of triangle {t}"),
            (None, Some(t)) => format!(", an edge midpoint of triangle {t}"),
            _ => String::new(),
        };
        let on = self.boundary.as_ref().map_or(String::new(), |name| format!(" on {name}"));
        format!("at ({x}, {y}){node}{on} in {}", self.body)
    }
}

/// A coordinate with six digits.
fn short(x: f64) -> f64 {
    let rounded = format!("{x:.5e}").parse().unwrap_or(x);
    if rounded == 0.0 { 0.0 } else { rounded }
}

/// Penetration at nodes below this part of that between them is what touching nodes have of rounding.
const AT_NODES: f64 = 0.01;

/// The deepest penetration of `candidate` in contact `interface`, or in any contact if none is given: place, interface and depth. Where nodes
/// do no more than touch it is that between them, by the largest Bernstein coefficient of the edge.
pub(super) fn deepest(
    problem: &Problem,
    candidate: &Candidate,
    interface: Option<usize>,
) -> Option<(Place, usize, f64)> {
    let sites = Sites::new(problem, candidate.degree, &holds(problem).ok()?);
    let is_own = |i: usize| interface.is_none_or(|own| own == i);
    let value = |node: usize| candidate.value(node);
    let at_nodes = sites.list.iter().filter(|site| is_own(site.interface)).map(|site| (site, site.excess(value)));
    let (site, depth) = at_nodes.max_by(|(_, a), (_, b)| a.total_cmp(b))?;
    match deepest_between(problem, candidate, is_own) {
        Some((edge, own, between)) if depth < AT_NODES * between => {
            Some((Place::of(problem, problem.mesh.points.len() + edge, Some(own)), own, between))
        }
        _ => Some((Place::of(problem, site.first, Some(site.interface)), site.interface, depth)),
    }
}

/// The edge with the largest Bernstein coefficient of the jump less the gap, its contact, and the coefficient.
fn deepest_between(
    problem: &Problem,
    candidate: &Candidate,
    is_own: impl Fn(usize) -> bool,
) -> Option<(usize, usize, f64)> {
    let vertices = problem.mesh.points.len();
    let ends = |pair: &ContactPair| [Some(pair.first.to_vec()), pair.second.map(|s| s.to_vec())];
    let largest = |pair: &ContactPair| {
        let rows = if candidate.degree > 1 { bernstein(pair, vertices) } else { of_pair(pair, &ends(pair)) };
        rows.iter().map(|row| row.excess_at(|node| candidate.value(node))).max_by(f64::total_cmp)
    };
    let interfaces = problem.interfaces.iter().enumerate().filter(|(i, _)| is_own(*i));
    let pairs = interfaces.flat_map(|(i, interface)| interface.pairs.iter().map(move |pair| (i, pair)));
    pairs.filter_map(|(i, pair)| Some((pair.edges[0]?, i, largest(pair)?))).max_by(|a, b| a.2.total_cmp(&b.2))
}

/// The place with the largest residual of equilibrium.
pub(super) fn unbalanced(problem: &Problem, judged: &Judged) -> Option<Place> {
    worst_node(judged).map(|node| Place::of(problem, node, None))
}

fn worst_node(judged: &Judged) -> Option<usize> {
    judged.balance.as_ref().and_then(|balance| balance.worst_node)
}

/// The place that a finding is about, if its name tells one; otherwise the place with the largest residual of
/// equilibrium.
pub(super) fn of_finding(problem: &Problem, judged: &Judged, finding: &Finding) -> Option<Place> {
    let name = finding.name.as_str();
    let interface = problem.interfaces.iter().position(|i| name.starts_with(&format!("contact/{}/", i.name)));
    if let Some(node) = finding.node {
        return Some(Place::of(problem, node, interface));
    }
    if interface.is_some() {
        return deepest(problem, &judged.candidate, interface).map(|(place, ..)| place);
    }
    let nodes = named(problem, name);
    let node = match worst_node(judged) {
        Some(worst) if nodes.is_empty() || nodes.contains(&worst) => Some(worst),
        _ => nodes.get(nodes.len() / 2).copied(),
    };
    node.map(|node| Place::of(problem, node, None))
}

/// The vertices of the boundary or body named in a finding.
fn named(problem: &Problem, finding: &str) -> Vec<usize> {
    let mesh = &problem.mesh;
    let within = |kind: &str, name: &str| {
        finding
            .strip_prefix(kind)
            .and_then(|rest| rest.strip_prefix(name))
            .is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
    };
    let on = |name: &str| ["support/", "load/", "boundary/"].iter().any(|kind| within(kind, name));
    let of_edge = |e: &crate::mesh::Edge| e.name.is_some_and(|n| on(&mesh.names[n]));
    let mut nodes: Vec<usize> = mesh.edges.iter().filter(|e| of_edge(e)).flat_map(|e| e.vertices).collect();
    let body = problem.scene.bodies.iter().position(|body| within("body/", &body.name));
    nodes.extend((0..mesh.triangles.len()).filter(|t| Some(mesh.body[*t]) == body).flat_map(|t| mesh.triangles[t]));
    nodes.sort_by(|a, b| {
        mesh.points[*a][1].total_cmp(&mesh.points[*b][1]).then(mesh.points[*a][0].total_cmp(&mesh.points[*b][0]))
    });
    nodes.dedup();
    nodes
}
