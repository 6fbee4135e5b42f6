//! Which element each triangle has.

use std::sync::Arc;

use super::{EquilibriumElement, block};

/// The element of every triangle.
#[derive(Clone)]
pub enum Elements {
    /// One element for all triangles.
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

    /// Those of `count` triangles with blocks of the degrees `least` where their own is lower; `None` where an element that is no block
    /// would have to be another.
    pub fn at_least(&self, count: usize, least: impl Fn(usize) -> usize) -> Option<Elements> {
        if (0..count).all(|t| self.degree(t) >= least(t)) {
            return Some(self.clone());
        }
        if let Elements::Uniform(element) = self
            && element.name() != block(element.degree()).name()
        {
            return None;
        }
        let degrees: Vec<u8> = (0..count).map(|t| self.degree(t).max(least(t)) as u8).collect();
        Some(match degrees.iter().all(|degree| *degree == degrees[0]) {
            true => Elements::Uniform(block(degrees[0].into())),
            false => Elements::Blocks(degrees.into()),
        })
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
