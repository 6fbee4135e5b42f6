//! Finding the triangles at an edge.

/// The sides of triangles, sorted by the vertices they join. Side 3 t + i is the edge of triangle t opposite corner i.
pub(in crate::mesh) struct HalfEdges {
    /// Where the sides whose lower vertex is v begin.
    start: Vec<usize>,
    /// (higher vertex, side), sorted for each lower vertex.
    sides: Vec<(usize, usize)>,
}

impl HalfEdges {
    /// Sorts the sides of `triangles`, whose vertices are below `vertices`.
    pub fn new(triangles: &[[usize; 3]], vertices: usize) -> Self {
        let ends = |side: usize| Self::ends(triangles, side);
        let mut start = vec![0; vertices + 2];
        for side in 0..3 * triangles.len() {
            let [a, b] = ends(side);
            start[a.min(b) + 2] += 1;
        }
        for v in 2..start.len() {
            start[v] += start[v - 1];
        }
        let mut sides = vec![(0, 0); 3 * triangles.len()];
        for side in 0..3 * triangles.len() {
            let [a, b] = ends(side);
            let place = &mut start[a.min(b) + 1];
            sides[*place] = (a.max(b), side);
            *place += 1;
        }
        for v in 0..vertices {
            sides[start[v]..start[v + 1]].sort_unstable();
        }
        HalfEdges { start, sides }
    }

    /// The vertices of a side, counter-clockwise as seen from its triangle.
    pub fn ends(triangles: &[[usize; 3]], side: usize) -> [usize; 2] {
        let corners = triangles[side / 3];
        [corners[(side + 1) % 3], corners[(side + 2) % 3]]
    }

    /// The sides that join two vertices, ascending.
    pub fn joining(&self, a: usize, b: usize) -> impl Iterator<Item = usize> + '_ {
        let (low, high) = (a.min(b), a.max(b));
        let bucket = &self.sides[self.start[low]..self.start[low + 1]];
        let first = bucket.partition_point(|(other, _)| *other < high);
        bucket[first..].iter().take_while(move |(other, _)| *other == high).map(|(_, side)| *side)
    }
}
