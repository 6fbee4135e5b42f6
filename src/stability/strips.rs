//! Blocks in a row, pressed and bent: a contact problem with a closed solution.
//!
//! Blocks of height H stand side by side, contact between them; the first is pushed by (a + b y, 0) with a + b y ≥ 0, the
//! last rests on a roller at its far side. σ_xx = −(a + b y) and no other stress in the plane solve it, for any moduli:
//! all sections rotate together, every contact stays closed with pressure a + b y, and
//! E = −½ Σ_i ℓ_i (1 − ν_i²)/E_i ∫ (a + b y)² dy in plane strain. The stress is linear, so the equilibrium elements
//! and quadratic displacements contain it: nothing but round-off keeps them from being exact.

use super::known::Known;
use super::scenes::{Sketch, steps};
use crate::scene::Gap;

/// A row of blocks.
#[derive(Debug, Clone)]
pub struct Strips {
    /// E and ν of each block.
    pub materials: Vec<[f64; 2]>,
    /// Length of each block.
    pub length: f64,
    /// Height.
    pub height: f64,
    /// a and b.
    pub load: [f64; 2],
    /// Cells of each block along the row, and across it for each block.
    pub cells: (usize, Vec<usize>),
}

impl Strips {
    /// Two unit blocks of `n` by `n` squares.
    pub fn new(n: usize) -> Self {
        Strips { materials: vec![[1.0, 0.3]; 2], length: 1.0, height: 1.0, load: [1.0, -0.75], cells: (n, vec![n; 2]) }
    }

    /// The row, with the lines x of a block given for a block from 0 to 1.
    pub fn on(&self, unit: &[f64]) -> Sketch {
        let mut model = Sketch::new();
        let last = self.materials.len() - 1;
        for (i, material) in self.materials.iter().enumerate() {
            // Mirrored from block to block, so that fine lines meet.
            let x = |u: f64| self.length * (i as f64 + u);
            let xs: Vec<f64> = match i % 2 {
                0 => unit.iter().map(|u| x(*u)).collect(),
                _ => unit.iter().rev().map(|u| x(1.0 - u)).collect(),
            };
            model = model.block(&format!("b{i}"), *material, &xs, &steps(0.0, self.height, self.cells.1[i]));
        }
        model = model.roller(&format!("b{last}_right")).push("b0_left", self.load[0], self.load[1]);
        for i in 0..last {
            model = model.contact(&format!("b{i}_right"), &format!("b{}_left", i + 1), Gap::Constant(0.0));
        }
        model
    }

    /// The row on equal cells.
    pub fn model(&self) -> Sketch {
        self.on(&steps(0.0, 1.0, self.cells.0))
    }

    /// The closed solution.
    pub fn known(&self) -> Known {
        let ([a, b], h) = (self.load, self.height);
        let square = a * a * h + a * b * h * h + b * b * h * h * h / 3.0;
        let flexibility: f64 = self.materials.iter().map(|[young, nu]| self.length * (1.0 - nu * nu) / young).sum();
        let strain = 0.5 * flexibility * square;
        let force = a * h + 0.5 * b * h * h;
        let contacts = self.materials.len() - 1;
        Known {
            energy: Some([-strain, strain]),
            variation: vec![(b * h).abs(); contacts],
            ..Known::forces(vec![[-force, 0.0]; contacts], force)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dual::{Condensed, Options};
    use crate::study::certify;

    #[test]
    fn the_elements_contain_the_closed_solution() {
        let mut row = Strips::new(3);
        row.materials = vec![[1.0, 0.3], [50.0, 0.45], [0.1, 0.0]];
        row.cells.1 = vec![3; 3];
        let known = row.known();
        let [energy, strain] = known.energy.expect("closed");
        let problem = row.model().problem().expect("valid");
        let found = certify(problem, &Condensed::default(), &Options::default()).expect("solvable");
        let upper = found.bracket.free.expect("an upper bound").upper();
        assert!((found.bracket.complementary.lower() - energy).abs() < 1e-11 * strain);
        assert!((upper - energy).abs() < 1e-11 * strain, "{upper} for {energy}");
    }
}
