//! Numbering of the edge moments.
//!
//! The unknowns of the hybrid form are the moments m_{e,k} = ∫_e u B_k ds of the edge displacement against the Bernstein
//! polynomials of each edge, conjugate to the coefficients of its traction. An edge has the larger degree of its two
//! triangles, a contact pair the larger one of both sides. Moments given by a support drop out; on Γ_K the moments of the
//! first side along the direction of contact are replaced by the jumps j_k = ∫(v' − v'')·n̂ B_k ds (see
//! [`crate::dual::contact::moments`]), where there is friction those along t̂ too, and all jumps are numbered last, first those along n̂.

use super::beds::BedEdge;
use crate::dual::contact::moments::{ContactEdge, ContactUnknowns, columns_along};
use crate::element::polynomial::side;
use crate::element::{Elements, SideValues};
use crate::problem::{Condition, ContactPair, Problem};

/// Unknowns that belong together: consecutive numbers that share one sparsity pattern.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct UnknownBlock {
    /// First unknown.
    pub start: usize,
    /// Number of unknowns.
    pub len: usize,
}

/// The unknowns that the moments of one edge are made of.
#[derive(Debug, Clone, PartialEq)]
pub enum EdgeMoments {
    /// x and y of one moment after the other.
    Free(usize),
    /// Γ_u: the moments of u0.
    Given(Vec<[f64; 2]>),
    /// Γ_0: the moments across the direction of a roller are unknown, those along it given, and all the same.
    Across {
        /// The first unknown.
        first: usize,
        /// The direction.
        direction: [f64; 2],
        /// Each moment along it.
        given: f64,
    },
    /// Γ_K.
    Contact(Box<ContactEdge>),
    /// On springs, or a side of an elastic layer: on the first side the jumps are the unknowns.
    Elastic(BedEdge),
}

/// The part of a moment along an axis, in terms of unknowns: (m · direction) = fixed + Σ coefficient · x.
#[derive(Debug, Clone)]
pub struct Component {
    /// Unit vector.
    pub direction: [f64; 2],
    terms: Terms,
    /// How many of the terms, from the first on, the edges of other bodies have no part in.
    own: usize,
    /// Part that is given.
    pub fixed: f64,
}

#[derive(Debug, Clone)]
enum Terms {
    Few([(usize, f64); 2], usize),
    Many(Vec<(usize, f64)>),
}

impl Component {
    /// Σ coefficient · x over `terms`, the first `own` of which belong to this edge alone.
    pub(in crate::dual) fn sum(direction: [f64; 2], terms: &[(usize, f64)], own: usize) -> Self {
        let terms = match *terms {
            [] => Terms::Few([(0, 0.0); 2], 0),
            [a] => Terms::Few([a, (0, 0.0)], 1),
            [a, b] => Terms::Few([a, b], 2),
            _ => Terms::Many(terms.to_vec()),
        };
        Component { direction, terms, own, fixed: 0.0 }
    }

    fn unknown(direction: [f64; 2], dof: usize) -> Self {
        Component::sum(direction, &[(dof, 1.0)], 1)
    }

    fn given(direction: [f64; 2], fixed: f64) -> Self {
        Component { fixed, ..Component::sum(direction, &[], 0) }
    }

    /// The contributing unknowns with their coefficients.
    pub fn terms(&self) -> &[(usize, f64)] {
        match &self.terms {
            Terms::Few(terms, len) => &terms[..*len],
            Terms::Many(terms) => terms,
        }
    }

    /// Those that the edges of other bodies have no part in.
    pub fn own_terms(&self) -> &[(usize, f64)] {
        &self.terms()[..self.own]
    }
}

/// The numbering.
#[derive(Debug, Clone)]
pub struct Unknowns {
    /// Blocks in the order of their numbers; those of the jumps come last.
    pub blocks: Vec<UnknownBlock>,
    /// Moments of each edge of the mesh.
    pub edges: Vec<EdgeMoments>,
    /// Degree of each edge.
    degree: Vec<u8>,
    /// Number of unknowns.
    pub count: usize,
    /// First jump; all unknowns from here on are jumps.
    pub first_jump: usize,
    /// First jump along t̂; all from here on are such jumps.
    pub first_slide: usize,
}

impl Unknowns {
    /// Numbers the unknowns of `problem`.
    pub fn new(problem: &Problem, elements: &Elements) -> Self {
        let degree = edge_degrees(problem, elements);
        let of_pair = |pair: &ContactPair| pair.edges[0].map_or(1, |e| usize::from(degree[e]));
        let mut blocks = Vec::with_capacity(problem.mesh.edges.len());
        let mut next = 0;
        let mut push = |len: usize| {
            blocks.push(UnknownBlock { start: next, len });
            next += len;
            blocks.len() - 1
        };
        // Placeholders for contact blocks are filled in once all other numbers are known.
        let mut second: Vec<Vec<Option<usize>>> =
            problem.interfaces.iter().map(|i| vec![None; i.pairs.len()]).collect();
        let mut first_block = vec![usize::MAX; problem.mesh.edges.len()];
        for (e, condition) in problem.conditions.iter().enumerate() {
            let coefficients = usize::from(degree[e]) + 1;
            match *condition {
                Condition::Interior | Condition::Traction(_) | Condition::Elastic { .. } => {
                    first_block[e] = push(2 * coefficients);
                }
                Condition::Roller { .. } => first_block[e] = push(coefficients),
                Condition::Clamped(_) | Condition::Axis => {}
                Condition::Contact { interface, pair, side } => {
                    let matched = &problem.interfaces[interface].pairs[pair];
                    let jumps: usize = columns_along(matched, of_pair(matched)).iter().sum();
                    // Stretches of an elastic contact follow the moments of its first side.
                    let stretches = if side == 0 && matched.stiffness.is_some() { jumps } else { 0 };
                    if 2 * coefficients + stretches > jumps {
                        first_block[e] = push(2 * coefficients - jumps + stretches);
                    }
                    if side == 1 {
                        second[interface][pair] = Some(push(jumps));
                    }
                }
            }
        }
        let pairs = problem.interfaces.iter().map(|i| i.pairs.iter());
        let jump_blocks: Vec<Vec<usize>> =
            pairs.clone().map(|pairs| pairs.map(|p| push(p.direction.columns(of_pair(p)))).collect()).collect();
        let slides = |p: &ContactPair| columns_along(p, of_pair(p))[1];
        let mut with_friction = |p| Some(slides(p)).filter(|count| *count > 0).map(&mut push);
        let slide_blocks: Vec<Vec<Option<usize>>> =
            pairs.map(|pairs| pairs.map(&mut with_friction).collect()).collect();
        let first_slide = slide_blocks.iter().flatten().flatten().next().map_or(next, |&b| blocks[b].start);
        let first_jump = jump_blocks.iter().flatten().next().map_or(first_slide, |&b| blocks[b].start);
        let edges = problem
            .conditions
            .iter()
            .enumerate()
            .map(|(e, condition)| match *condition {
                Condition::Interior | Condition::Traction(_) => EdgeMoments::Free(blocks[first_block[e]].start),
                Condition::Roller { direction, displacement } => EdgeMoments::Across {
                    first: blocks[first_block[e]].start,
                    direction,
                    given: displacement * problem.mesh.edge_frame(e).0 / f64::from(degree[e] + 1),
                },
                Condition::Axis => EdgeMoments::Given(vec![[0.0; 2]; usize::from(degree[e]) + 1]),
                Condition::Clamped(ends) => {
                    EdgeMoments::Given(side::linear_moments(ends, problem.mesh.edge_frame(e).0, degree[e].into()))
                }
                Condition::Elastic { bed, pair, side } => {
                    let pair = &problem.beds[bed].pairs[pair];
                    let other = if side == 0 { pair.opposite } else { Some(pair.edge) };
                    let first = |e: usize| blocks[first_block[e]].start;
                    EdgeMoments::Elastic(BedEdge::new(pair, side, degree[e].into(), first(e), other.map(first)))
                }
                Condition::Contact { interface, pair, side } => {
                    let matched = &problem.interfaces[interface].pairs[pair];
                    let own = if side == 0 { matched.first } else { matched.second.unwrap_or(matched.first) };
                    let reversed = own[0] != problem.mesh.edges[e].vertices[0];
                    let start = |b: usize| blocks[b].start;
                    let contact = ContactUnknowns {
                        across: blocks.get(first_block[e]).map_or(usize::MAX, |block| block.start),
                        jump: start(jump_blocks[interface][pair]),
                        slide: slide_blocks[interface][pair].map(start),
                        second: second[interface][pair].map(start),
                    };
                    let mut edge = ContactEdge::new(matched, degree[e].into(), side, reversed, contact);
                    let coefficients = usize::from(degree[e]) + 1;
                    let is_elastic = side == 0 && matched.stiffness.is_some();
                    edge.stretch = is_elastic.then(|| contact.across + coefficients);
                    EdgeMoments::Contact(Box::new(edge))
                }
            })
            .collect();
        Unknowns { blocks, edges, degree, count: next, first_jump, first_slide }
    }

    /// Degree of the traction on edge `e`.
    pub fn degree(&self, e: usize) -> usize {
        self.degree[e].into()
    }

    /// The two components, at right angles, of moment `k` (in the order of the edge's vertices) of an edge.
    pub fn components(&self, e: usize, k: usize) -> [Component; 2] {
        const X: [f64; 2] = [1.0, 0.0];
        const Y: [f64; 2] = [0.0, 1.0];
        match &self.edges[e] {
            EdgeMoments::Free(first) => {
                [Component::unknown(X, first + 2 * k), Component::unknown(Y, first + 2 * k + 1)]
            }
            EdgeMoments::Given(m) => [Component::given(X, m[k][0]), Component::given(Y, m[k][1])],
            EdgeMoments::Across { first, direction: [x, y], given } => {
                [Component::given([*x, *y], *given), Component::unknown([-y, *x], first + k)]
            }
            EdgeMoments::Contact(edge) => edge.components(k),
            EdgeMoments::Elastic(edge) => edge.components(k),
        }
    }

    /// The block of each unknown.
    pub fn block_of(&self) -> Vec<u32> {
        let mut block_of = vec![0; self.count];
        for (b, block) in self.blocks.iter().enumerate() {
            block_of[block.start..block.start + block.len].fill(b as u32);
        }
        block_of
    }

    /// Blocks that the moments of edge `e` depend on, and how many.
    pub fn blocks_of_edge(&self, e: usize, block_of: &[u32]) -> ([usize; 4], usize) {
        let mut all = ([0; 4], 0);
        let mut add = |first: usize| {
            all.0[all.1] = block_of[first] as usize;
            all.1 += 1;
        };
        match &self.edges[e] {
            EdgeMoments::Given(_) => {}
            EdgeMoments::Free(first) | EdgeMoments::Across { first, .. } => add(*first),
            EdgeMoments::Elastic(edge) => [Some(edge.first()), edge.second()].into_iter().flatten().for_each(add),
            EdgeMoments::Contact(edge) => edge.first_unknowns().for_each(add),
        }
        all
    }

    /// The Cartesian moments of every edge, from the values of the unknowns.
    pub fn moments(&self, x: &[f64]) -> SideValues<[f64; 2]> {
        let counts = self.degree.iter().map(|&p| usize::from(p) + 1);
        let mut moments = SideValues::filled(counts, [0.0; 2]);
        for (e, edge) in self.edges.iter().enumerate() {
            let own = moments.of_mut(e);
            match edge {
                EdgeMoments::Free(first) => {
                    let values = x[*first..].chunks_exact(2);
                    own.iter_mut().zip(values).for_each(|(m, x)| *m = [x[0], x[1]]);
                }
                EdgeMoments::Given(given) => own.copy_from_slice(given),
                EdgeMoments::Across { .. } | EdgeMoments::Contact(_) | EdgeMoments::Elastic(_) => {
                    for (k, m) in own.iter_mut().enumerate() {
                        for component in self.components(e, k) {
                            let value =
                                component.fixed + component.terms().iter().map(|&(dof, c)| c * x[dof]).sum::<f64>();
                            m[0] += value * component.direction[0];
                            m[1] += value * component.direction[1];
                        }
                    }
                }
            }
        }
        moments
    }

    /// Moments of a change of the unknowns: prescribed displacements do not change.
    pub fn moments_of_change(&self, x: &[f64]) -> SideValues<[f64; 2]> {
        let mut moments = self.moments(x);
        for (e, edge) in self.edges.iter().enumerate() {
            match edge {
                EdgeMoments::Given(_) => moments.of_mut(e).fill([0.0; 2]),
                EdgeMoments::Across { direction: [x, y], given, .. } if *given != 0.0 => {
                    moments.of_mut(e).iter_mut().for_each(|m| *m = [m[0] - given * x, m[1] - given * y]);
                }
                _ => {}
            }
        }
        moments
    }

    /// Values of the unknowns of a displacement: `at(e, k)` gives moment k of an edge. Jumps and rollers take the components
    /// they stand for.
    pub fn project(&self, at: impl Fn(usize, usize) -> [f64; 2]) -> Vec<f64> {
        let mut x = vec![0.0; self.count];
        for e in 0..self.edges.len() {
            (0..=self.degree(e)).for_each(|k| self.project_moment(e, k, at(e, k), &mut x));
        }
        x
    }

    /// Gives the unknowns `x` what moment `k` of edge `e` contributes to them.
    pub fn project_moment(&self, e: usize, k: usize, m: [f64; 2], x: &mut [f64]) {
        match &self.edges[e] {
            EdgeMoments::Contact(edge) => return edge.project(k, m, x),
            EdgeMoments::Elastic(edge) => return edge.project(k, m, x),
            _ => {}
        }
        for component in self.components(e, k) {
            if let [(dof, _)] = component.terms() {
                x[*dof] = m[0] * component.direction[0] + m[1] * component.direction[1];
            }
        }
    }

    /// The blocks of jumps along n̂, one for each pair.
    pub fn jump_blocks(&self) -> impl Iterator<Item = &UnknownBlock> {
        self.blocks.iter().filter(|b| b.start >= self.first_jump && b.start < self.first_slide)
    }

    /// The blocks of jumps along t̂, one for each pair with friction.
    pub fn slide_blocks(&self) -> impl Iterator<Item = &UnknownBlock> {
        self.blocks.iter().filter(|b| b.start >= self.first_slide)
    }

    /// Number of jumps along n̂.
    pub fn normal_jumps(&self) -> usize {
        self.first_slide - self.first_jump
    }

    /// Flags of the jumps along n̂, pair by pair.
    pub fn by_pair(&self, mut flags: Vec<bool>) -> SideValues<bool> {
        flags.truncate(self.normal_jumps());
        SideValues::new(self.jump_blocks().map(|b| b.len), flags)
    }
}

/// The number of coefficients of t on each contact pair, one interface after the other.
pub fn contact_coefficients(problem: &Problem, elements: &Elements) -> Vec<usize> {
    let degree = edge_degrees(problem, elements);
    let of = |pair: &ContactPair| pair.direction.columns(pair.edges[0].map_or(1, |e| degree[e].into()));
    problem.pairs().map(of).collect()
}

/// The degree of the traction on every edge: the larger one of its triangles, on a contact pair that of both sides.
pub fn edge_degrees(problem: &Problem, elements: &Elements) -> Vec<u8> {
    let largest = |edge: &crate::mesh::Edge| edge.triangles.iter().flatten().map(|&t| elements.degree(t)).max();
    let mut degree: Vec<u8> = problem.mesh.edges.iter().map(|e| largest(e).unwrap_or(1) as u8).collect();
    for (pair, _) in problem.bed_pairs() {
        let both = pair.sides().map(|(_, e)| degree[e]).max().unwrap_or(1);
        pair.sides().for_each(|(_, e)| degree[e] = both);
    }
    for pair in problem.pairs() {
        let both = pair.edges.iter().flatten().map(|&e| degree[e]).max().unwrap_or(1);
        pair.edges.iter().flatten().for_each(|&e| degree[e] = both);
    }
    degree
}
