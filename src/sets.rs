//! Disjoint sets of numbers (union–find).

/// A partition of the numbers from 0 to n − 1.
pub(crate) struct DisjointSets {
    parent: Vec<usize>,
    size: Vec<usize>,
}

impl DisjointSets {
    /// `n` sets of one member each.
    pub fn new(n: usize) -> Self {
        DisjointSets { parent: (0..n).collect(), size: vec![1; n] }
    }

    /// The representative of the set of `i`.
    pub fn root(&mut self, mut i: usize) -> usize {
        while self.parent[i] != i {
            self.parent[i] = self.parent[self.parent[i]];
            i = self.parent[i];
        }
        i
    }

    /// Unites the sets of `i` and `j`; their least member represents them.
    pub fn join(&mut self, i: usize, j: usize) {
        self.join_up_to(i, j, usize::MAX);
    }

    /// Unites the sets of `i` and `j` where the result has at most `most` members.
    pub fn join_up_to(&mut self, i: usize, j: usize, most: usize) {
        let (i, j) = (self.root(i), self.root(j));
        if i == j || self.size[i] + self.size[j] > most {
            return;
        }
        self.parent[i.max(j)] = i.min(j);
        self.size[i.min(j)] += self.size[i.max(j)];
    }

    /// A label per member, numbered by first appearance, and the number of sets.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_grow_to_the_limit_and_no_further() {
        let mut sets = DisjointSets::new(5);
        sets.join_up_to(0, 1, 2);
        sets.join_up_to(1, 2, 2);
        assert_eq!(sets.root(0), sets.root(1));
        assert_ne!(sets.root(2), sets.root(1));
        sets.join_up_to(1, 2, 3);
        assert_eq!(sets.root(2), sets.root(0));
        assert_eq!(sets.labels(), (vec![0, 0, 0, 1, 2], 3));
    }
}
