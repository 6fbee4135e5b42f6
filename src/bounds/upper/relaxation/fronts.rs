//! Which patches of a sweep can be moved at the same time without a change of any digit.

use super::groups::Group;
use crate::problem::Problem;

/// Patches divided into fronts: those of one read nothing that another one of it moves, and of two patches that do, the one that
/// comes first in the order of the groups is in an earlier front.
#[derive(Debug, Clone, PartialEq)]
pub struct Fronts(Vec<Vec<usize>>);

impl Fronts {
    /// Those of the patches of `groups`, `of_vertex` being the group of each vertex. Vertices that face each other across Γ_K are of one
    /// group, so that patches that share a contact pressure share triangles too.
    pub fn new(problem: &Problem, groups: &[Group], of_vertex: &[usize]) -> Self {
        let mut front: Vec<usize> = Vec::with_capacity(groups.len());
        let mut fronts: Vec<Vec<usize>> = Vec::new();
        for (k, group) in groups.iter().enumerate() {
            let corners = group.triangles.iter().flat_map(|t| problem.mesh.triangles[*t]);
            let before = corners.map(|v| of_vertex[v]).filter(|j| *j < k);
            let own = before.map(|j| front[j] + 1).max().unwrap_or(0);
            front.push(own);
            if own == fronts.len() {
                fronts.push(Vec::new());
            }
            fronts[own].push(k);
        }
        Fronts(fronts)
    }

    /// Those that are given, each after the ones that its patches read.
    pub fn given(fronts: Vec<Vec<usize>>) -> Self {
        Fronts(fronts)
    }

    /// The fronts, from the first one on.
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = &[usize]> + ExactSizeIterator {
        self.0.iter().map(Vec::as_slice)
    }
}
