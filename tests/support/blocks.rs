//! Two blocks of quadrilaterals, each cut in two.

use hypercircle::mesh::RawMesh;

/// n × n quadrilaterals a block; `place` gives the point (i, j) of block 0 or 1. Block 0 is `left`, 1 is `right`; their
/// sides are called `left_west`, `left_south`, …. Quadrilaterals are cut along alternating diagonals.
pub fn grid(n: usize, place: impl Fn(usize, usize, usize) -> [f64; 2]) -> RawMesh {
    let mut raw = RawMesh::default();
    for (block, body) in ["left", "right"].into_iter().enumerate() {
        let base = raw.points.len();
        for j in 0..=n {
            for i in 0..=n {
                raw.points.push(place(block, i, j));
            }
        }
        let at = |i: usize, j: usize| base + j * (n + 1) + i;
        for j in 0..n {
            for i in 0..n {
                let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
                let cut = if (i + j) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
                raw.triangles.extend(cut.map(|t| (t, body.to_string())));
            }
        }
        for k in 0..n {
            raw.segments.push(([at(k, 0), at(k + 1, 0)], format!("{body}_south")));
            raw.segments.push(([at(k, n), at(k + 1, n)], format!("{body}_north")));
            raw.segments.push(([at(0, k), at(0, k + 1)], format!("{body}_west")));
            raw.segments.push(([at(n, k), at(n, k + 1)], format!("{body}_east")));
        }
    }
    raw
}
