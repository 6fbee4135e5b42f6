//! The values that go from rank to rank.

use crate::bounds::ranks::Ranks;

/// The nodes whose values go to each rank, and those whose values come from each; only ranks with such nodes are there.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Traffic {
    /// Rank and nodes.
    pub to: Vec<(usize, Vec<usize>)>,
    /// Rank and nodes, in the order in which that rank has them.
    pub from: Vec<(usize, Vec<usize>)>,
}

impl Traffic {
    /// Gives and takes the values.
    pub fn pass(&self, ranks: &dyn Ranks, values: &mut [[f64; 2]]) {
        if self.to.is_empty() && self.from.is_empty() {
            return;
        }
        let given = |nodes: &[usize]| nodes.iter().flat_map(|node| values[*node]).collect();
        let to: Vec<(usize, Vec<f64>)> = self.to.iter().map(|(rank, nodes)| (*rank, given(nodes))).collect();
        let from: Vec<(usize, usize)> = self.from.iter().map(|(rank, nodes)| (*rank, 2 * nodes.len())).collect();
        for ((_, nodes), taken) in self.from.iter().zip(ranks.exchange(&to, &from)) {
            nodes.iter().zip(taken.as_chunks::<2>().0).for_each(|(node, value)| values[*node] = *value);
        }
    }
}
