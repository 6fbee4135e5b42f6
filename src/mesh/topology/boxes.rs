//! A tree of bounding boxes, for the few questions of the kind "which boundary edges come near this one".
//!
//! Boundary edges of graded meshes differ in length by orders of magnitude, which rules out a uniform grid.

/// Lower and upper corner.
pub(crate) type Bounds = [[f64; 2]; 2];

/// The box of a set of points, widened by `margin` on all sides.
pub(crate) fn around(points: &[[f64; 2]], margin: f64) -> Bounds {
    let mut bounds = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    for p in points {
        for k in 0..2 {
            bounds[0][k] = bounds[0][k].min(p[k] - margin);
            bounds[1][k] = bounds[1][k].max(p[k] + margin);
        }
    }
    bounds
}

fn meet(a: &Bounds, b: &Bounds) -> bool {
    (0..2).all(|k| a[0][k] <= b[1][k] && b[0][k] <= a[1][k])
}

/// Boxes per leaf.
const LEAF: usize = 8;

struct Node {
    bounds: Bounds,
    /// Range of `order` below this node.
    range: [usize; 2],
    children: Option<[usize; 2]>,
}

/// Boxes sorted by repeated halving, so that a query visits only what it meets.
pub(crate) struct BoxTree {
    boxes: Vec<Bounds>,
    order: Vec<usize>,
    nodes: Vec<Node>,
}

impl BoxTree {
    /// Sorts `boxes`; queries answer with indices into it.
    pub(crate) fn new(boxes: Vec<Bounds>) -> Self {
        let order = (0..boxes.len()).collect();
        let mut tree = BoxTree { boxes, order, nodes: Vec::new() };
        tree.grow([0, tree.order.len()]);
        tree
    }

    fn grow(&mut self, range: [usize; 2]) -> usize {
        let part = &self.order[range[0]..range[1]];
        let corners: Vec<[f64; 2]> = part.iter().flat_map(|&i| self.boxes[i]).collect();
        let bounds = around(&corners, 0.0);
        let node = self.nodes.len();
        self.nodes.push(Node { bounds, range, children: None });
        if part.len() > LEAF {
            let axis = usize::from(bounds[1][1] - bounds[0][1] > bounds[1][0] - bounds[0][0]);
            let centre = |i: usize| self.boxes[i][0][axis] + self.boxes[i][1][axis];
            let half = part.len() / 2;
            let mut sorted = part.to_vec();
            sorted.select_nth_unstable_by(half, |&i, &j| centre(i).total_cmp(&centre(j)));
            self.order[range[0]..range[1]].copy_from_slice(&sorted);
            let middle = range[0] + half;
            let left = self.grow([range[0], middle]);
            let right = self.grow([middle, range[1]]);
            self.nodes[node].children = Some([left, right]);
        }
        node
    }

    /// The boxes that meet `query`, in ascending order.
    pub(crate) fn meeting(&self, query: &Bounds) -> Vec<usize> {
        let mut found = Vec::new();
        let mut open = vec![0];
        while let Some(n) = open.pop() {
            let node = &self.nodes[n];
            if !meet(&node.bounds, query) {
                continue;
            }
            match node.children {
                Some(children) => open.extend(children),
                None => found
                    .extend(self.order[node.range[0]..node.range[1]].iter().filter(|&&i| meet(&self.boxes[i], query))),
            }
        }
        found.sort_unstable();
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn finds_what_trying_all_boxes_finds(
            corners in prop::collection::vec(prop::array::uniform4(-1.0..1.0f64), 0..60),
            query in prop::array::uniform4(-1.0..1.0f64),
        ) {
            let bounds = |c: &[f64; 4]| around(&[[c[0], c[1]], [c[0] + 0.1 * c[2], c[1] + 0.1 * c[3]]], 0.0);
            let boxes: Vec<Bounds> = corners.iter().map(bounds).collect();
            let query = bounds(&query);
            let all: Vec<usize> = (0..boxes.len()).filter(|&i| meet(&boxes[i], &query)).collect();
            prop_assert_eq!(BoxTree::new(boxes).meeting(&query), all);
        }
    }
}
