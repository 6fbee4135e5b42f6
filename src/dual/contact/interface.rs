//! Where many bodies touch: the unknowns of interfaces that keep what is left of K sparse.
//!
//! Jumps replace the moments of first sides along the direction of contact. Eliminating those of second sides couples every jump
//! with every other one, through all bodies that touch each other. Where they stay, beside the jumps, each body couples those of its
//! own contacts alone: the Schur complement is the sum of one dense block for each body, and a contact state costs a sparse
//! factorisation of it.

use std::sync::Arc;

use crate::dual::system::unknowns::{EdgeMoments, Unknowns};
use crate::optimise::Structure;
use crate::problem::Problem;
use crate::statics::Components;

/// Jumps from which sparse blocks are worth their administration.
const MANY_JUMPS: usize = 300;

/// The unknowns of interfaces.
#[derive(Debug)]
pub struct Interface {
    /// Their numbers, jumps first.
    pub unknowns: Vec<usize>,
    /// Where the entries of their Schur complement are.
    pub structure: Arc<Structure>,
    /// The order of elimination, and the place of each in it.
    order: Vec<usize>,
    place: Vec<usize>,
}

impl Interface {
    /// Those of a problem with so many bodies that all their blocks hold fewer numbers than one for all jumps; otherwise none.
    pub fn new(problem: &Problem, unknowns: &Unknowns) -> Option<Self> {
        let jumps = unknowns.count - unknowns.first_jump;
        if jumps < MANY_JUMPS {
            return None;
        }
        let pieces = Components::new(problem);
        let mut cliques = vec![Vec::new(); pieces.count()];
        let mut numbers: Vec<usize> = (unknowns.first_jump..unknowns.count).collect();
        // Second sides by their first unknown: where they are among the numbers here.
        let mut seconds = std::collections::HashMap::new();
        let contacts = || {
            let edges = unknowns.edges.iter().zip(&problem.mesh.edges);
            edges.filter_map(|(moments, edge)| match (moments, edge.triangles[0]) {
                (EdgeMoments::Contact(contact), Some(t)) => Some((contact, pieces.of_triangle[t])),
                _ => None,
            })
        };
        let block_of = unknowns.block_of();
        let len = |first: usize| unknowns.blocks[block_of[first] as usize].len;
        for (contact, piece) in contacts() {
            let clique: &mut Vec<usize> = &mut cliques[piece];
            if contact.side == 0 {
                for jump in [Some(contact.jump), contact.slide].into_iter().flatten() {
                    let first = jump - unknowns.first_jump;
                    clique.extend(first..first + len(jump));
                }
            }
            if let Some(second) = contact.second {
                let start = *seconds.entry(second).or_insert_with(|| {
                    numbers.extend(second..second + len(second));
                    numbers.len() - len(second)
                });
                clique.extend(start..start + len(second));
            }
        }
        cliques.iter_mut().for_each(|clique| {
            clique.sort_unstable();
            clique.dedup();
        });
        if cliques.iter().map(|clique| clique.len() * clique.len()).sum::<usize>() > jumps * jumps {
            return None;
        }
        let structure = Arc::new(Structure::of_cliques(numbers.len(), &cliques)?);
        let order = structure.order();
        let mut place = vec![0; order.len()];
        order.iter().enumerate().for_each(|(k, i)| place[*i] = k);
        Some(Interface { unknowns: numbers, structure, order, place })
    }

    /// The numbers of the unknowns in the order of elimination.
    pub fn eliminated(&self) -> impl Iterator<Item = usize> + '_ {
        self.order.iter().map(|i| self.unknowns[*i])
    }

    /// The unknown, counted from the first jump, at place `k` of the order of elimination.
    pub fn at(&self, k: usize) -> usize {
        self.order[k]
    }

    /// Values, jumps first, in the order of elimination.
    pub fn in_factor_order(&self, values: &[f64]) -> Vec<f64> {
        self.order.iter().map(|i| values[*i]).collect()
    }

    /// Values in the order of elimination, jumps first.
    pub fn in_interface_order(&self, values: &[f64]) -> Vec<f64> {
        self.place.iter().map(|k| values[*k]).collect()
    }
}
