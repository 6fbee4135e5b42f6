//! The energy of a continuous quadratic displacement as a function of its nodes, with what holds them.
//!
//! Nodes are the vertices, then the edge midpoints.

use super::contact::{Row, rows};
use super::groups::Group;
use super::holds::{Hold, Holds};
use super::split::BOUNDARY;
use super::stiffness::{Condensed, condensed};
use crate::problem::Problem;

/// What does not change while patches move.
#[derive(Debug)]
pub struct Model<'a> {
    problem: &'a Problem,
    /// ½uᵀKu − fᵀu of every triangle, `None` where its inside has no unique minimum.
    pub elements: Vec<Option<Condensed>>,
    /// The directions in which each node may move.
    pub free: Vec<Directions>,
    /// Bernstein coefficients of the jumps: at most zero.
    pub rows: Vec<Row>,
    /// Which of them have a part at each vertex.
    pub touching: Vec<Vec<usize>>,
}

impl<'a> Model<'a> {
    /// Prepares the energy of all triangles and the conditions on all nodes.
    pub fn new(problem: &'a Problem, holds: &Holds) -> Self {
        Model {
            problem,
            elements: condensed(problem),
            free: directions(holds),
            rows: rows(problem),
            touching: touching(problem),
        }
    }

    /// 𝓛 of the values per unit thickness, without the triangles that have no unique minimum inside.
    pub fn energy(&self, values: &[[f64; 2]]) -> f64 {
        let of = |(t, element): (usize, &Condensed)| {
            let u = self.bent(t, values);
            let nodes = self.nodes(t);
            let work: f64 = (0..BOUNDARY).map(|i| element.load[i] * values[nodes[i / 2]][i % 2]).sum();
            0.5 * dot(&u, &element.times(&u)) - work
        };
        self.elements.iter().enumerate().filter_map(|(t, e)| Some(of((t, e.as_ref()?)))).sum()
    }

    /// Values on the boundary of triangle `t` about its first corner: translations carry no energy and should cost no
    /// digits.
    pub fn bent(&self, t: usize, values: &[[f64; 2]]) -> [f64; BOUNDARY] {
        let nodes = self.nodes(t);
        let base = values[nodes[0]];
        std::array::from_fn(|i| values[nodes[i / 2]][i % 2] - base[i % 2])
    }

    /// The six nodes on the boundary of triangle `t`: corners, then edges.
    pub fn nodes(&self, t: usize) -> [usize; 6] {
        let mesh = &self.problem.mesh;
        let ([a, b, c], [p, q, r]) = (mesh.triangles[t], mesh.triangle_edges[t]);
        let first = mesh.points.len();
        [a, b, c, first + p, first + q, first + r]
    }

    /// Whether a node moves with the vertices of a group.
    pub fn moves(&self, node: usize, group: &Group) -> bool {
        match node.checked_sub(self.problem.mesh.points.len()) {
            None => group.vertices.contains(&node),
            Some(e) => self.problem.mesh.edges[e].vertices.iter().any(|v| group.vertices.contains(v)),
        }
    }
}

/// uᵀv.
pub fn dot(u: &[f64; BOUNDARY], v: &[f64; BOUNDARY]) -> f64 {
    u.iter().zip(v).map(|(u, v)| u * v).sum()
}

/// The directions in which each node may move: vertices, then edges.
fn directions(holds: &Holds) -> Vec<Directions> {
    let of = |hold: &Hold| match hold {
        Hold::Free => Directions { count: 2, unit: [[1.0, 0.0], [0.0, 1.0]] },
        Hold::Line { normal: [x, y], .. } => Directions { count: 1, unit: [[-y, *x]; 2] },
        Hold::Fixed(_) => Directions { count: 0, unit: [[0.0; 2]; 2] },
    };
    holds.vertices.iter().chain(&holds.middles).map(of).collect()
}

/// Up to two unit vectors.
#[derive(Debug, Clone, Copy)]
pub struct Directions {
    /// How many.
    pub count: usize,
    /// Them; those beyond the count are not used.
    pub unit: [[f64; 2]; 2],
}

impl Directions {
    /// The part of a step that goes along them.
    pub fn along(&self, step: [f64; 2]) -> [f64; 2] {
        match self.count {
            0 => [0.0; 2],
            1 => {
                let [x, y] = self.unit[0];
                let by = step[0] * x + step[1] * y;
                [by * x, by * y]
            }
            _ => step,
        }
    }
}

/// The rows of contact at each vertex: all of each pair that ends there.
fn touching(problem: &Problem) -> Vec<Vec<usize>> {
    let mut touching = vec![Vec::new(); problem.mesh.points.len()];
    let mut next = 0;
    for pair in problem.interfaces.iter().flat_map(|i| &i.pairs) {
        let rows = next..next + if pair.direction.is_constant() { 3 } else { 4 };
        next = rows.end;
        for &v in pair.first.iter().chain(pair.second.iter().flatten()) {
            touching[v].extend(rows.clone());
        }
    }
    touching
}
