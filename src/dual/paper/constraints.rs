//! The global constraints D Ŝ = 0 and E Ŝ ≤ −g of (3.13) and (3.14), every row with its meaning.
//!
//! Ŝ holds nine parameters per triangle, block by block. A row is a combination of means and slopes of tractions on
//! edges; the same combination can be taken of any stress field ([`Constraints::evaluate`]), which is how the right-hand
//! sides (3.16)–(3.19) come about.

use std::fmt;

use super::rows::SparseRows;
use crate::element::SideValues;
use crate::element::subtriangle::Matrix;
use crate::problem::{Condition, Problem};

/// The two basis functions of a traction component on an edge: T(p) = mean + slope · p.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TractionShape {
    /// S_j*.
    Mean,
    /// S_{j+1}*, with p from −1 at the first end of the edge to 1 at the second.
    Slope,
}

/// The equation that a constraint row states.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Meaning {
    /// (3.5) on an interior edge, for component 0 or 1 of the traction.
    Continuity {
        /// Edge of the mesh.
        edge: usize,
        /// 0 for T1, 1 for T2.
        component: usize,
        /// Mean or slope.
        basis: TractionShape,
    },
    /// (3.6): T = P on Γ_τ.
    Applied {
        /// Edge of the mesh.
        edge: usize,
        /// 0 for T1, 1 for T2.
        component: usize,
        /// Mean or slope.
        basis: TractionShape,
    },
    /// (3.7) on Γ_0.
    RollerShear {
        /// Edge of the mesh.
        edge: usize,
        /// Mean or slope.
        basis: TractionShape,
    },
    /// (3.7) on one side of Γ_K.
    ContactShear {
        /// Edge of the mesh.
        edge: usize,
        /// Mean or slope.
        basis: TractionShape,
    },
    /// T_n' = T_n'' on Γ_K.
    ContactEquality {
        /// Contact of the scene.
        interface: usize,
        /// Pair of edges.
        pair: usize,
        /// Mean or slope along the first side's edge.
        basis: TractionShape,
    },
    /// (3.8): the normal traction at an end of a contact pair.
    Reaction {
        /// Contact of the scene.
        interface: usize,
        /// Pair of edges.
        pair: usize,
        /// 0 or 1, as in [`crate::problem::ContactPair::first`].
        end: usize,
    },
}

impl fmt::Display for Meaning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = |b: &TractionShape| if *b == TractionShape::Mean { "mean" } else { "slope" };
        match self {
            Meaning::Continuity { edge, component, basis } => {
                write!(f, "{} of T{} continuous across edge {edge}", name(basis), component + 1)
            }
            Meaning::Applied { edge, component, basis } => {
                write!(f, "{} of T{} given on edge {edge}", name(basis), component + 1)
            }
            Meaning::RollerShear { edge, basis } => write!(f, "{} of T_t zero on roller edge {edge}", name(basis)),
            Meaning::ContactShear { edge, basis } => write!(f, "{} of T_t zero on contact edge {edge}", name(basis)),
            Meaning::ContactEquality { interface, pair, basis } => {
                write!(f, "{} of T_n' = T_n'' on pair {pair} of contact {interface}", name(basis))
            }
            Meaning::Reaction { interface, pair, end } => {
                write!(f, "T_n <= 0 at end {end} of pair {pair} of contact {interface}")
            }
        }
    }
}

/// A traction component's share in a row.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Term {
    edge: usize,
    /// 0 or 1: index into [`crate::mesh::Edge::triangles`].
    side: usize,
    direction: [f64; 2],
    /// Factors of mean and slope along the edge.
    weights: [f64; 2],
}

/// D and E with the meaning of their rows.
#[derive(Debug, Clone)]
pub struct Constraints {
    /// D, p1 × N.
    pub d: SparseRows,
    /// E, p2 × N: normal traction at the contact ends, two per pair, interface by interface.
    pub e: SparseRows,
    /// Meaning of the rows of D.
    pub d_meaning: Vec<Meaning>,
    /// Meaning of the rows of E.
    pub e_meaning: Vec<Meaning>,
    /// The right-hand side of the rows of D for the whole stress λ: P on Γ_τ, else zero.
    pub d_target: Vec<f64>,
    d_terms: Vec<Vec<Term>>,
    e_terms: Vec<Vec<Term>>,
}

const AXES: [[f64; 2]; 2] = [[1.0, 0.0], [0.0, 1.0]];
const BASES: [(TractionShape, [f64; 2]); 2] = [(TractionShape::Mean, [1.0, 0.0]), (TractionShape::Slope, [0.0, 1.0])];

impl Constraints {
    /// Collects the constraints of `problem`; `external` are the 12 × 9 side parameters of every block.
    pub fn new(problem: &Problem, external: &[Matrix<12, 9>]) -> Self {
        let columns = 9 * external.len();
        let mut all = Constraints {
            d: SparseRows::new(columns),
            e: SparseRows::new(columns),
            d_meaning: Vec::new(),
            e_meaning: Vec::new(),
            d_target: Vec::new(),
            d_terms: Vec::new(),
            e_terms: Vec::new(),
        };
        for (edge, condition) in problem.conditions.iter().enumerate() {
            let (_, normal) = problem.mesh.edge_frame(edge);
            let tangent = [-normal[1], normal[0]];
            for (basis, weights) in BASES {
                let term = |side, direction| Term { edge, side, direction, weights };
                match condition {
                    Condition::Interior => {
                        for (component, axis) in AXES.into_iter().enumerate() {
                            let meaning = Meaning::Continuity { edge, component, basis };
                            all.equality(meaning, 0.0, vec![term(0, axis), term(1, axis)]);
                        }
                    }
                    Condition::Traction(p) => {
                        for (component, axis) in AXES.into_iter().enumerate() {
                            let [a, b] = [p[0][component], p[1][component]];
                            let target = if basis == TractionShape::Mean { 0.5 * (a + b) } else { 0.5 * (b - a) };
                            all.equality(Meaning::Applied { edge, component, basis }, target, vec![term(0, axis)]);
                        }
                    }
                    Condition::Clamped(_) | Condition::Axis | Condition::Elastic { .. } => {}
                    Condition::Roller { direction: [x, y], .. } => {
                        all.equality(Meaning::RollerShear { edge, basis }, 0.0, vec![term(0, [-y, *x])]);
                    }
                    Condition::Contact { .. } => {
                        all.equality(Meaning::ContactShear { edge, basis }, 0.0, vec![term(0, tangent)]);
                    }
                }
            }
        }
        all.contacts(problem);
        for i in 0..all.d_terms.len() {
            all.d.push(entries(problem, external, &all.d_terms[i]));
        }
        for i in 0..all.e_terms.len() {
            all.e.push(entries(problem, external, &all.e_terms[i]));
        }
        all
    }

    fn equality(&mut self, meaning: Meaning, target: f64, terms: Vec<Term>) {
        self.d_meaning.push(meaning);
        self.d_target.push(target);
        self.d_terms.push(terms);
    }

    fn contacts(&mut self, problem: &Problem) {
        for (interface, contact) in problem.interfaces.iter().enumerate() {
            for (pair, matched) in contact.pairs.iter().enumerate() {
                let Some(first) = matched.edges[0] else { continue };
                let direction = matched.normal;
                let from =
                    |edge: usize, vertex| if problem.mesh.edges[edge].vertices[0] == vertex { 1.0 } else { -1.0 };
                let along = from(first, matched.first[0]);
                if let (Some(second), Some(vertices)) = (matched.edges[1], matched.second) {
                    // Slopes are compared along the first edge; the second usually runs against it.
                    let turn = along * from(second, vertices[0]);
                    for (basis, weights) in BASES {
                        let own = Term { edge: first, side: 0, direction, weights };
                        let weights = [weights[0], turn * weights[1]];
                        let other = Term { edge: second, side: 0, direction, weights };
                        self.equality(Meaning::ContactEquality { interface, pair, basis }, 0.0, vec![own, other]);
                    }
                }
                for end in 0..2 {
                    let p = if end == 0 { -along } else { along };
                    self.e_meaning.push(Meaning::Reaction { interface, pair, end });
                    self.e_terms.push(vec![Term { edge: first, side: 0, direction, weights: [1.0, p] }]);
                }
            }
        }
    }

    /// The rows of D and of E applied to any field, given its traction at both ends of an edge (in the edge's order) as
    /// seen from its first or second triangle.
    pub fn evaluate(&self, traction: impl Fn(usize, usize) -> [[f64; 2]; 2]) -> (Vec<f64>, Vec<f64>) {
        let row = |terms: &Vec<Term>| {
            terms
                .iter()
                .map(|t| {
                    let [a, b] =
                        traction(t.edge, t.side).map(|v: [f64; 2]| v[0] * t.direction[0] + v[1] * t.direction[1]);
                    0.5 * (t.weights[0] * (a + b) + t.weights[1] * (b - a))
                })
                .sum()
        };
        (self.d_terms.iter().map(row).collect(), self.e_terms.iter().map(row).collect())
    }

    /// Moments ∫ u q ds of the edge displacement that multipliers stand for: the work Σ z_i (row i of the traction) is
    /// that of the moments on the tractions, edge by edge.
    ///
    /// Mean and slope turn into the end values of T by p = ∓1, so that z of a mean is the sum of the two end moments and
    /// z of a slope their difference.
    pub fn moments(&self, problem: &Problem, z_d: &[f64], z_e: &[f64]) -> SideValues<[f64; 2]> {
        let mut moments = SideValues::filled(vec![2; problem.mesh.edges.len()], [0.0; 2]);
        for (terms, &z) in self.d_terms.iter().zip(z_d).chain(self.e_terms.iter().zip(z_e)) {
            // The displacement is the same on both sides of an interior edge: the first side speaks for it.
            for term in terms.iter().filter(|t| t.side == 0) {
                for (end, sign) in [-1.0, 1.0].into_iter().enumerate() {
                    let weight = 0.5 * (term.weights[0] + sign * term.weights[1]) * z;
                    for (m, direction) in moments.of_mut(term.edge)[end].iter_mut().zip(term.direction) {
                        *m += weight * direction;
                    }
                }
            }
        }
        moments
    }
}

/// A row in the block parameters, by (3.4) and (3.12).
fn entries(problem: &Problem, external: &[Matrix<12, 9>], terms: &[Term]) -> Vec<(usize, f64)> {
    let mesh = &problem.mesh;
    let mut out = Vec::with_capacity(9 * terms.len());
    for term in terms {
        let Some(t) = mesh.edges[term.edge].triangles[term.side] else { continue };
        let sub = mesh.triangle_edges[t].iter().position(|&e| e == term.edge).unwrap_or(0);
        // Seen from the triangle on its right an edge runs backwards.
        let slope = if term.side == 0 { term.weights[1] } else { -term.weights[1] };
        let side = &external[t];
        for k in 0..9 {
            let value: f64 = (0..2)
                .map(|c| {
                    let row = 4 * sub + 2 * c;
                    term.direction[c] * (term.weights[0] * side[(row, k)] + slope * side[(row + 1, k)])
                })
                .sum();
            out.push((9 * t + k, value));
        }
    }
    out
}
