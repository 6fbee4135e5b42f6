//! Disjoint sets (union–find).

/// Disjoint sets of the numbers from 0.
pub struct Sets {
    parent: Vec<usize>,
    size: Vec<usize>,
}

impl Sets {
    /// `count` sets of one member each.
    pub fn new(count: usize) -> Self {
        Sets { parent: (0..count).collect(), size: vec![1; count] }
    }

    /// The representative of the set of `v`.
    pub fn root(&mut self, v: usize) -> usize {
        let mut root = v;
        while self.parent[root] != root {
            self.parent[root] = self.parent[self.parent[root]];
            root = self.parent[root];
        }
        root
    }

    /// Unites the sets of `v` and `w` where the result has at most `most` members.
    pub fn unite(&mut self, v: usize, w: usize, most: usize) {
        let (a, b) = (self.root(v), self.root(w));
        if a == b || self.size[a] + self.size[b] > most {
            return;
        }
        let (large, small) = if self.size[a] >= self.size[b] { (a, b) } else { (b, a) };
        self.parent[small] = large;
        self.size[large] += self.size[small];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_grow_to_the_limit_and_no_further() {
        let mut sets = Sets::new(5);
        sets.unite(0, 1, 2);
        sets.unite(1, 2, 2);
        assert_eq!(sets.root(0), sets.root(1));
        assert_ne!(sets.root(2), sets.root(1));
        sets.unite(1, 2, 3);
        assert_eq!(sets.root(2), sets.root(0));
    }
}
