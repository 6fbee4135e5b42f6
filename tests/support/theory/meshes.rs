//! Families of triangulations of two blocks that meet on a straight Γ_K.

use hypercircle::mesh::RawMesh;

use super::Numbers;

/// How squares are turned into quadrilaterals before they are cut.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Family {
    /// Equal squares.
    Squares,
    /// Strips that leave Γ_K and the far side at right angles and bend between: the "vaulted strips" of (A3).
    Vaulted,
    /// Inner vertices moved by up to 0.3 of the mesh size, in a random pattern that repeats every four squares: shape-regular
    /// on all meshes alike, and nothing more.
    Shaken,
}

impl Family {
    pub fn name(self) -> &'static str {
        match self {
            Family::Squares => "squares",
            Family::Vaulted => "vaulted strips",
            Family::Shaken => "shaken squares",
        }
    }

    /// Image of the grid point (i, j) of an n × n grid on the unit square; the sides of the square stay.
    fn place(self, n: usize, i: usize, j: usize) -> [f64; 2] {
        let (s, t) = (i as f64 / n as f64, j as f64 / n as f64);
        let pi = std::f64::consts::PI;
        let inner = |k: usize| k > 0 && k < n;
        let mut numbers = Numbers((4 * (j % 4) + i % 4) as u64);
        let (dx, dy) = (numbers.next(), numbers.next());
        match self {
            Family::Squares => [s, t],
            // d/ds of the shift vanishes at s = 0 and s = 1.
            Family::Vaulted => [s, t + 0.2 * (pi * s).sin().powi(2) * (pi * t).sin()],
            Family::Shaken if inner(i) && inner(j) => {
                [s + 0.6 * (dx - 0.5) / n as f64, t + 0.6 * (dy - 0.5) / n as f64]
            }
            Family::Shaken => [s, t],
        }
    }
}

/// Two blocks of n × n quadrilaterals: `shape` places a point (s, t) of the unit square of block 0 or 1 in the plane.
/// Block 0 is `left`, 1 is `right`; their sides are called `left_west`, `left_south`, …, and they meet along the east
/// side of the left one. Quadrilaterals are cut along alternating diagonals.
pub fn blocks(n: usize, family: Family, shape: impl Fn(usize, [f64; 2]) -> [f64; 2]) -> RawMesh {
    let mut raw = RawMesh::default();
    for (block, body) in ["left", "right"].into_iter().enumerate() {
        let base = raw.points.len();
        for j in 0..=n {
            for i in 0..=n {
                raw.points.push(shape(block, family.place(n, i, j)));
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

/// The unit squares [−1, 0] × [0, 1] and [0, 1]².
pub fn side_by_side(block: usize, [s, t]: [f64; 2]) -> [f64; 2] {
    [s + block as f64 - 1.0, t]
}
