//! Union–find.

/// Sets of the numbers from 0 to n − 1.
pub(crate) struct DisjointSets {
    parent: Vec<usize>,
}

impl DisjointSets {
    /// `n` sets of one element each.
    pub fn new(n: usize) -> Self {
        DisjointSets { parent: (0..n).collect() }
    }

    fn root(&mut self, mut i: usize) -> usize {
        while self.parent[i] != i {
            self.parent[i] = self.parent[self.parent[i]];
            i = self.parent[i];
        }
        i
    }

    /// Unites the sets of `i` and `j`.
    pub fn join(&mut self, i: usize, j: usize) {
        let (i, j) = (self.root(i), self.root(j));
        self.parent[i.max(j)] = i.min(j);
    }

    /// A label per element, numbered by first appearance, and the number of sets.
    pub fn labels(&mut self) -> (Vec<usize>, usize) {
        let mut label = vec![usize::MAX; self.parent.len()];
        let mut count = 0;
        let labels = (0..self.parent.len())
            .map(|i| {
                let root = self.root(i);
                if label[root] == usize::MAX {
                    label[root] = count;
                    count += 1;
                }
                label[root]
            })
            .collect();
        (labels, count)
    }
}
