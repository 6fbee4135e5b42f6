//! Nodal supports at each vertex and inside each edge.

use std::collections::HashMap;

use super::nodes::Nodes;
use crate::bounds::upper::NoUpperBound;
use crate::problem::{Condition, ContactPair, Problem};
use crate::sets::DisjointSets;

/// The support of one node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Hold {
    /// Not held.
    Free,
    /// u · normal = value.
    Line {
        /// Unit vector.
        normal: [f64; 2],
        /// Prescribed component.
        value: f64,
    },
    /// u = value.
    Fixed([f64; 2]),
}

impl Hold {
    /// The nearest displacement that the support allows.
    pub fn impose(&self, u: [f64; 2]) -> [f64; 2] {
        match *self {
            Hold::Free => u,
            Hold::Line { normal: n, value } => {
                let off = u[0] * n[0] + u[1] * n[1] - value;
                [u[0] - off * n[0], u[1] - off * n[1]]
            }
            Hold::Fixed(value) => value,
        }
    }

    /// The part of a change that the support allows.
    pub fn project(&self, d: [f64; 2]) -> [f64; 2] {
        match *self {
            Hold::Free => d,
            Hold::Line { normal: n, .. } => {
                let off = d[0] * n[0] + d[1] * n[1];
                [d[0] - off * n[0], d[1] - off * n[1]]
            }
            Hold::Fixed(_) => [0.0; 2],
        }
    }

    /// This hold on the way to one of the same kind.
    fn towards(&self, end: &Hold, t: f64) -> Hold {
        let between = |a: f64, b: f64| if a == b { a } else { a + t * (b - a) };
        match (*self, *end) {
            (Hold::Fixed(a), Hold::Fixed(b)) => Hold::Fixed([between(a[0], b[0]), between(a[1], b[1])]),
            (Hold::Line { normal, value: a }, Hold::Line { value: b, .. }) => {
                Hold::Line { normal, value: between(a, b) }
            }
            _ => *self,
        }
    }

    /// Adds a condition u · normal = value; `None` where it contradicts what holds already.
    fn with_line(self, normal: [f64; 2], value: f64, size: f64) -> Option<Hold> {
        match self {
            Hold::Free => Some(Hold::Line { normal, value }),
            Hold::Line { normal: n, value: w } => {
                let cross = n[0] * normal[1] - n[1] * normal[0];
                if cross.abs() > PARALLEL {
                    let u = [(w * normal[1] - value * n[1]) / cross, (value * n[0] - w * normal[0]) / cross];
                    return Some(Hold::Fixed(u));
                }
                let sign = n[0] * normal[0] + n[1] * normal[1];
                ((w * sign - value).abs() <= PARALLEL * size).then_some(self)
            }
            Hold::Fixed(u) => {
                let off = u[0] * normal[0] + u[1] * normal[1] - value;
                (off.abs() <= PARALLEL * size).then_some(self)
            }
        }
    }

    fn with_point(self, u0: [f64; 2], size: f64) -> Option<Hold> {
        self.with_line([1.0, 0.0], u0[0], size)?.with_line([0.0, 1.0], u0[1], size)?;
        Some(Hold::Fixed(u0))
    }
}

/// Normals whose cross product is smaller are parallel.
const PARALLEL: f64 = 1e-10;

/// The holds of all nodes.
#[derive(Debug, Clone)]
pub struct Holds {
    /// Of every vertex.
    pub vertices: Vec<Hold>,
    /// Of every edge at its two ends, linear between.
    pub edges: Vec<[Hold; 2]>,
}

impl Holds {
    /// The holds of all nodes.
    pub fn of_nodes<'a>(&'a self, nodes: &'a Nodes) -> impl Iterator<Item = Hold> + 'a {
        let inside = |e: usize| self.inside(e, nodes.inside(e).len());
        self.vertices.iter().copied().chain((0..self.edges.len()).flat_map(inside))
    }

    /// The holds of the coefficients inside an edge that has so many.
    pub fn inside(&self, e: usize, count: usize) -> impl Iterator<Item = Hold> + use<> {
        let [from, to] = self.edges[e];
        (1..=count).map(move |k| from.towards(&to, k as f64 / (count + 1) as f64))
    }

    /// The support in the middle of an edge.
    pub fn middle(&self, e: usize) -> Hold {
        let [from, to] = self.edges[e];
        from.towards(&to, 0.5)
    }
}

/// The hold of every node.
///
/// # Errors
/// [`NoUpperBound::SupportsDisagree`].
pub fn holds(problem: &Problem) -> Result<Holds, NoUpperBound> {
    holds_at(problem, |e, v| {
        let ends = problem.conditions[e].prescribed().unwrap_or_default();
        if v == problem.mesh.edges[e].vertices[0] { ends[0] } else { ends[1] }
    })
}

/// The hold of every node where supports prescribe other displacements: `prescribed` gives them by edge and vertex, of
/// which rollers take the part along their normal. Inside an edge it is the one at the first vertex.
///
/// # Errors
/// [`NoUpperBound::SupportsDisagree`].
pub fn holds_at(problem: &Problem, prescribed: impl Fn(usize, usize) -> [f64; 2]) -> Result<Holds, NoUpperBound> {
    let mesh = &problem.mesh;
    let normals = roller_directions(problem);
    let of = |e: usize, v: usize| match (problem.conditions[e], normals.get(&e)) {
        (Condition::Clamped(_), _) => Hold::Fixed(prescribed(e, v)),
        (Condition::Axis, _) => Hold::Line { normal: [1.0, 0.0], value: 0.0 },
        (Condition::Roller { .. }, Some(normal)) => {
            let u = prescribed(e, v);
            Hold::Line { normal: *normal, value: u[0] * normal[0] + u[1] * normal[1] }
        }
        _ => Hold::Free,
    };
    // Prescribed displacements are compared with each other, on the scale of the largest.
    let supported = problem.conditions.iter().enumerate().filter(|(_, c)| c.prescribed().is_some());
    let size = supported
        .flat_map(|(e, _)| mesh.edges[e].vertices.map(|v| prescribed(e, v)))
        .fold(0.0_f64, |m, u| m.max(u[0].abs()).max(u[1].abs()));
    let mut holds =
        Holds { vertices: vec![Hold::Free; mesh.points.len()], edges: vec![[Hold::Free; 2]; mesh.edges.len()] };
    for (e, edge) in mesh.edges.iter().enumerate() {
        holds.edges[e] = edge.vertices.map(|v| of(e, v));
        for v in edge.vertices {
            let next = match of(e, v) {
                Hold::Fixed(u0) => holds.vertices[v].with_point(u0, size),
                Hold::Line { normal, value } => holds.vertices[v].with_line(normal, value, size),
                Hold::Free => continue,
            };
            let [x, y] = problem.scene.as_written(mesh.points[v]);
            holds.vertices[v] = next.ok_or(NoUpperBound::SupportsDisagree { x, y })?;
        }
    }
    for (hold, point) in holds.vertices.iter_mut().zip(&mesh.points).filter(|(_, p)| problem.section().on_axis(**p)) {
        let [x, y] = problem.scene.as_written(*point);
        *hold = hold.with_line([1.0, 0.0], 0.0, size).ok_or(NoUpperBound::SupportsDisagree { x, y })?;
    }
    Ok(holds)
}

/// Checks that some displacement of finite energy meets all supports and contacts: supports must agree where they meet, and leave the gap
/// that a contact requires.
///
/// # Errors
/// [`NoUpperBound`] names the place.
pub fn supports_agree(problem: &Problem) -> Result<(), NoUpperBound> {
    // Nothing is too deep for an elastic contact.
    let problem = &*problem.softened();
    let holds = holds(problem)?.vertices;
    for pair in problem.pairs() {
        for end in 0..2 {
            let Some((by, size)) = forced(pair, end, &holds) else { continue };
            if by > jump_rounding(problem, pair, size) {
                let [x, y] = problem.scene.as_written(problem.mesh.points[pair.first[end]]);
                return Err(match pair.shared(end) {
                    Some(_) => NoUpperBound::PressedInside { x, y, by },
                    None => NoUpperBound::ForcedPenetration { x, y, by },
                });
            }
        }
    }
    Ok(())
}

/// The penetration at one end of a pair, and the size of the displacements that it comes from, where supports leave it no choice, or the
/// body that the contact ends in.
pub fn forced(pair: &ContactPair, end: usize, holds: &[Hold]) -> Option<(f64, f64)> {
    if pair.shared(end).is_some() {
        return Some((-pair.gap[end], 0.0));
    }
    let n = pair.direction.ends[end];
    let held = |v: usize| {
        let [own, left] = [holds[v].impose([0.0; 2]), holds[v].project(n)];
        (left[0].hypot(left[1]) <= PARALLEL).then_some(own)
    };
    let first = held(pair.first[end])?;
    let second = pair.second.map_or(Some([0.0; 2]), |s| held(s[end]))?;
    let by = (first[0] - second[0]) * n[0] + (first[1] - second[1]) * n[1] - pair.gap[end];
    Some((by, first.iter().chain(&second).fold(0.0_f64, |m, u| m.max(u.abs()))))
}

/// Penetrations smaller than this, relative to the displacements they come from, are rounding.
const ROUNDED: f64 = 1e-12;

/// Rounding error of a jump less the gap along `pair` that is exactly zero for displacements of size `size`: they may slide along it, in a
/// direction that its ends give to few digits where they lie close together, and the gap between sides that lie apart is a difference of
/// coordinates.
pub fn jump_rounding(problem: &Problem, pair: &ContactPair, size: f64) -> f64 {
    let ends = pair.first.map(|v| problem.mesh.points[v]);
    let opposite = pair.second.map_or(ends, |second| second.map(|v| problem.mesh.points[v]));
    let farthest = ends.iter().chain(&opposite).flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
    let of_coordinates = 8.0 * f64::EPSILON * farthest;
    let of_gap = if opposite == ends { 0.0 } else { of_coordinates };
    (ROUNDED + of_coordinates / pair.length) * size + of_gap
}

/// The direction of every roller edge: where it is the normal, that of the whole straight side which the edge is a part of.
///
/// The ends of an edge are rounded, and the direction of one that is short beside its coordinates is known to few digits.
/// Two such directions at a vertex would hold it in both, where the side lets it slide.
fn roller_directions(problem: &Problem) -> HashMap<usize, [f64; 2]> {
    let mesh = &problem.mesh;
    let of = |e: usize| match problem.conditions[e] {
        Condition::Roller { direction, .. } => Some((e, mesh.edge_frame(e).0, direction)),
        _ => None,
    };
    let rollers: Vec<(usize, f64, [f64; 2])> = (0..mesh.edges.len()).filter_map(of).collect();
    let mut at = HashMap::<usize, Vec<usize>>::new();
    for (i, &(e, ..)) in rollers.iter().enumerate() {
        for v in mesh.edges[e].vertices {
            at.entry(v).or_default().push(i);
        }
    }
    let mut sides = DisjointSets::new(rollers.len());
    for (&v, meeting) in &at {
        let &[i, j] = meeting.as_slice() else { continue };
        let [(_, l, n), (_, k, m)] = [i, j].map(|i| rollers[i]);
        let [x, y] = mesh.points[v];
        let rounding = 8.0 * f64::EPSILON * x.abs().max(y.abs()) / l.min(k);
        if (n[0] * m[1] - n[1] * m[0]).abs() <= PARALLEL + rounding {
            sides.join(i, j);
        }
    }
    let mut sum = vec![[0.0; 2]; rollers.len()];
    for (i, &(_, length, normal)) in rollers.iter().enumerate() {
        let side = &mut sum[sides.root(i)];
        *side = [side[0] + length * normal[0], side[1] + length * normal[1]];
    }
    let unit = |[x, y]: [f64; 2]| [x / x.hypot(y), y / x.hypot(y)];
    rollers.iter().enumerate().map(|(i, &(e, ..))| (e, unit(sum[sides.root(i)]))).collect()
}
