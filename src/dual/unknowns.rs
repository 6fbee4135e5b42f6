//! Numbering of the edge moments.
//!
//! The unknowns of the hybrid form are the moments m_{e,p} = ∫_e u q_p ds of the edge displacement against the two hat
//! functions of each edge, conjugate to the traction end values. Moments given by a support drop out; on Γ_K the moments
//! of the first side along the direction of contact are replaced by the jumps j_p = ∫(v' − v'')·n̂ q_p ds (see
//! [`super::contact_moments`]), and all jumps are numbered last.

use super::contact_moments::ContactEdge;
use crate::problem::{Condition, ContactPair, Problem};

/// Unknowns that belong together: consecutive numbers that share one sparsity pattern.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Block {
    /// First unknown.
    pub start: usize,
    /// Number of unknowns, at most four.
    pub len: usize,
}

/// What the moments of one edge are made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum EdgeMoments {
    /// Four unknowns: x and y at the first end, x and y at the second.
    Free(usize),
    /// Γ_u: the moments of u0, the same for both ends.
    Given([f64; 2]),
    /// Γ_0: the tangential moments at the two ends are unknown, the normal ones zero.
    Tangential(usize),
    /// Γ_K.
    Contact(ContactEdge),
}

/// A moment component at one end of an edge, in terms of unknowns: (m · direction) = fixed + Σ coefficient · x.
#[derive(Debug, Clone, Copy, Default)]
pub struct Component {
    /// Unit vector.
    pub direction: [f64; 2],
    /// Contributing unknowns.
    pub terms: [(usize, f64); 3],
    /// How many of `terms` count.
    pub len: usize,
    /// How many of these, from the first on, the edges of other bodies have no part in.
    pub own: usize,
    /// Part that is given.
    pub fixed: f64,
}

impl Component {
    /// Σ coefficient · x over `terms`, the first `own` of which belong to this edge alone.
    pub(super) fn sum(direction: [f64; 2], terms: &[(usize, f64)], own: usize) -> Self {
        let mut all = [(0, 0.0); 3];
        all[..terms.len()].copy_from_slice(terms);
        Component { direction, terms: all, len: terms.len(), own, fixed: 0.0 }
    }

    fn unknown(direction: [f64; 2], dof: usize) -> Self {
        Component::sum(direction, &[(dof, 1.0)], 1)
    }

    fn given(direction: [f64; 2], fixed: f64) -> Self {
        Component { fixed, ..Component::sum(direction, &[], 0) }
    }

    /// The contributing unknowns with their coefficients.
    pub fn terms(&self) -> &[(usize, f64)] {
        &self.terms[..self.len]
    }

    /// Those that the edges of other bodies have no part in.
    pub fn own_terms(&self) -> &[(usize, f64)] {
        &self.terms[..self.own]
    }
}

/// The numbering.
#[derive(Debug, Clone)]
pub struct Unknowns {
    /// Blocks in the order of their numbers; those of the jumps come last.
    pub blocks: Vec<Block>,
    /// Moments of each edge of the mesh.
    pub edges: Vec<EdgeMoments>,
    /// Number of unknowns.
    pub count: usize,
    /// First jump; all unknowns from here on are jumps.
    pub first_jump: usize,
}

impl Unknowns {
    /// Numbers the unknowns of `problem`.
    pub fn new(problem: &Problem) -> Self {
        let mut blocks = Vec::with_capacity(problem.mesh.edges.len());
        let mut next = 0;
        let mut push = |len: usize| {
            blocks.push(Block { start: next, len });
            next += len;
            blocks.len() - 1
        };
        // Placeholders for contact blocks are filled in once all other numbers are known.
        let mut second: Vec<Vec<Option<usize>>> =
            problem.interfaces.iter().map(|i| vec![None; i.pairs.len()]).collect();
        let mut first_block = vec![usize::MAX; problem.mesh.edges.len()];
        for (e, condition) in problem.conditions.iter().enumerate() {
            match *condition {
                Condition::Interior | Condition::Traction(_) => first_block[e] = push(4),
                Condition::Roller => first_block[e] = push(2),
                Condition::Clamped(_) => {}
                Condition::Contact { interface, pair, side } => {
                    let jumps = jumps(&problem.interfaces[interface].pairs[pair]);
                    first_block[e] = push(4 - jumps);
                    if side == 1 {
                        second[interface][pair] = Some(push(jumps));
                    }
                }
            }
        }
        let pairs = problem.interfaces.iter().map(|i| i.pairs.iter());
        let jump_blocks: Vec<Vec<usize>> = pairs.map(|pairs| pairs.map(|p| push(jumps(p))).collect()).collect();
        let first_jump = jump_blocks.iter().flatten().next().map_or(next, |&b| blocks[b].start);
        let edges = problem
            .conditions
            .iter()
            .enumerate()
            .map(|(e, condition)| match *condition {
                Condition::Interior | Condition::Traction(_) => EdgeMoments::Free(blocks[first_block[e]].start),
                Condition::Roller => EdgeMoments::Tangential(blocks[first_block[e]].start),
                Condition::Clamped(u0) => {
                    let half = 0.5 * problem.mesh.edge_frame(e).0;
                    EdgeMoments::Given([u0[0] * half, u0[1] * half])
                }
                Condition::Contact { interface, pair, side } => {
                    let matched = &problem.interfaces[interface].pairs[pair];
                    let own = if side == 0 { matched.first } else { matched.second.unwrap_or(matched.first) };
                    EdgeMoments::Contact(ContactEdge {
                        across: first_block[e],
                        jump: jump_blocks[interface][pair],
                        second: second[interface][pair],
                        side,
                        reversed: own[0] != problem.mesh.edges[e].vertices[0],
                        direction: matched.direction,
                    })
                }
            })
            .collect();
        Unknowns { blocks, edges, count: next, first_jump }
    }

    /// The two components, at right angles, of the moment at end `end` (0 or 1, in the order of the edge's vertices) of
    /// an edge with outward unit normal `normal`.
    pub fn components(&self, e: usize, end: usize, normal: [f64; 2]) -> [Component; 2] {
        const X: [f64; 2] = [1.0, 0.0];
        const Y: [f64; 2] = [0.0, 1.0];
        let tangent = [-normal[1], normal[0]];
        match self.edges[e] {
            EdgeMoments::Free(first) => {
                [Component::unknown(X, first + 2 * end), Component::unknown(Y, first + 2 * end + 1)]
            }
            EdgeMoments::Given(m) => [Component::given(X, m[0]), Component::given(Y, m[1])],
            EdgeMoments::Tangential(first) => [Component::given(normal, 0.0), Component::unknown(tangent, first + end)],
            EdgeMoments::Contact(edge) => edge.components(&self.blocks, end),
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
    pub fn blocks_of_edge(&self, e: usize, block_of: &[u32]) -> ([usize; 3], usize) {
        match self.edges[e] {
            EdgeMoments::Given(_) => ([0; 3], 0),
            EdgeMoments::Free(first) | EdgeMoments::Tangential(first) => ([block_of[first] as usize, 0, 0], 1),
            EdgeMoments::Contact(ContactEdge { across, jump, second, side, .. }) => match (side, second) {
                (0, Some(other)) => ([across, jump, other], 3),
                (1, Some(own)) => ([across, own, 0], 2),
                _ => ([across, jump, 0], 2),
            },
        }
    }

    /// The Cartesian moments at both ends of every edge, from the values of the unknowns.
    pub fn moments(&self, problem: &Problem, x: &[f64]) -> Vec<[[f64; 2]; 2]> {
        (0..self.edges.len())
            .map(|e| {
                let (_, normal) = problem.mesh.edge_frame(e);
                [0, 1].map(|end| {
                    let mut m = [0.0; 2];
                    for component in self.components(e, end, normal) {
                        let value = component.fixed + component.terms().iter().map(|&(dof, c)| c * x[dof]).sum::<f64>();
                        m[0] += value * component.direction[0];
                        m[1] += value * component.direction[1];
                    }
                    m
                })
            })
            .collect()
    }

    /// Values of the unknowns of a displacement: `at(e, end)` gives the vector moment at an end. Jumps and rollers take the
    /// components they stand for.
    pub fn project(&self, problem: &Problem, at: impl Fn(usize, usize) -> [f64; 2]) -> Vec<f64> {
        let mut x = vec![0.0; self.count];
        for e in 0..self.edges.len() {
            let (_, normal) = problem.mesh.edge_frame(e);
            for end in 0..2 {
                let m = at(e, end);
                if let EdgeMoments::Contact(edge) = &self.edges[e] {
                    edge.project(&self.blocks, end, m, &mut x);
                    continue;
                }
                for component in self.components(e, end, normal) {
                    if let [(dof, _)] = component.terms() {
                        x[*dof] = m[0] * component.direction[0] + m[1] * component.direction[1];
                    }
                }
            }
        }
        x
    }

    /// For every jump the other one of its pair, or itself where the pair has only one.
    pub fn partners(&self) -> Vec<usize> {
        let jumps = self.blocks.iter().filter(|b| b.start >= self.first_jump);
        jumps.flat_map(|b| (0..b.len).rev().map(|k| b.start + k - self.first_jump)).collect()
    }

    /// Which jumps are closed, from the two ends of every pair.
    pub fn by_jump(&self, ends: &[bool]) -> Vec<bool> {
        let jumps = self.blocks.iter().filter(|b| b.start >= self.first_jump);
        let each = jumps.zip(ends.chunks_exact(2));
        each.flat_map(|(b, ends)| if b.len == 2 { ends.to_vec() } else { vec![ends[0] || ends[1]] }).collect()
    }

    /// Which of the two ends of every pair are closed, from the jumps.
    pub fn by_end(&self, closed: &[bool]) -> Vec<bool> {
        let jumps = self.blocks.iter().filter(|b| b.start >= self.first_jump);
        jumps.flat_map(|b| [0, b.len - 1].map(|k| closed[b.start + k - self.first_jump])).collect()
    }
}

/// The number of jumps of a pair.
fn jumps(pair: &ContactPair) -> usize {
    pair.direction.columns(1)
}
