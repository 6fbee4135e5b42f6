//! Families of triangulations of two blocks that meet on a straight Γ_K.

use hypercircle::mesh::RawMesh;

use super::super::blocks::grid;
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

/// Two blocks of n × n quadrilaterals: `shape` places a point (s, t) of the unit square of block 0 or 1 in the plane;
/// names as in [`grid`].
pub fn blocks(n: usize, family: Family, shape: impl Fn(usize, [f64; 2]) -> [f64; 2]) -> RawMesh {
    grid(n, |block, i, j| shape(block, family.place(n, i, j)))
}

/// The unit squares [−1, 0] × [0, 1] and [0, 1]².
pub fn side_by_side(block: usize, [s, t]: [f64; 2]) -> [f64; 2] {
    [s + block as f64 - 1.0, t]
}
