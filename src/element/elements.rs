//! Which element each triangle has.

use std::sync::Arc;

use super::{EquilibriumElement, block};

/// The element of every triangle.
#[derive(Clone)]
pub enum Elements {
    /// The same on all.
    Uniform(&'static dyn EquilibriumElement),
    /// Blocks, of a degree for each triangle.
    Blocks(Arc<[u8]>),
}

impl Elements {
    /// The element of triangle `t`.
    pub fn of(&self, t: usize) -> &'static dyn EquilibriumElement {
        match self {
            Elements::Uniform(element) => *element,
            Elements::Blocks(degrees) => block(degrees[t].into()),
        }
    }

    /// The degree p of triangle `t`.
    pub fn degree(&self, t: usize) -> usize {
        match self {
            Elements::Uniform(element) => element.degree(),
            Elements::Blocks(degrees) => degrees[t].into(),
        }
    }

    /// Those of a finer mesh whose triangle t lies in triangle `parent[t]`.
    pub fn within(&self, parent: &[usize]) -> Elements {
        match self {
            Elements::Uniform(element) => Elements::Uniform(*element),
            Elements::Blocks(degrees) => Elements::Blocks(parent.iter().map(|&t| degrees[t]).collect()),
        }
    }

    /// The same with at least these degrees.
    pub fn at_least(&self, least: &[u8]) -> Elements {
        if (0..least.len()).all(|t| self.degree(t) >= least[t].into()) {
            return self.clone();
        }
        Elements::Blocks(least.iter().enumerate().map(|(t, p)| (*p).max(self.degree(t) as u8)).collect())
    }

    /// The largest degree of the triangles.
    pub fn largest_degree(&self) -> usize {
        match self {
            Elements::Uniform(element) => element.degree(),
            Elements::Blocks(degrees) => degrees.iter().copied().max().unwrap_or(1).into(),
        }
    }
}

impl std::fmt::Debug for Elements {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Elements::Uniform(element) => f.debug_tuple("Uniform").field(&element.name()).finish(),
            Elements::Blocks(degrees) => f.debug_tuple("Blocks").field(degrees).finish(),
        }
    }
}
