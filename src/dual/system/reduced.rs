//! The factorised hybrid form with the unknowns of its interfaces last.

use std::sync::Arc;

use super::{System, isolate};
use crate::dual::factor::{Breakdown, Factor, SymbolicFactor};
use crate::dual::hybrid::{Motion, explain, held_unknowns};
use crate::dual::{DualError, Options};
use crate::problem::Problem;
use crate::vector::long::largest;

/// Residual of a solve that a working factorisation never reaches, relative to matrix and solution.
const BROKEN: f64 = 1e-9;

/// The factorised system, with the unknowns of its interfaces last: the jumps, and where many bodies touch the moments of
/// second sides too, see [`crate::dual::contact::interface`].
#[derive(Debug)]
pub struct Reduced {
    pub(in crate::dual) factor: Factor,
    held: Vec<usize>,
    first_jump: usize,
    /// Added to the diagonal of each jump.
    pub(in crate::dual) shift: Vec<f64>,
}

impl Reduced {
    /// Factorises; the matrix of `system` becomes the definite one.
    pub fn new(
        problem: &Problem,
        system: &mut System,
        structure: SymbolicFactor,
        motions: &[Motion],
        options: &Options,
    ) -> Result<Self, DualError> {
        let first_jump = system.unknowns.first_jump;
        let held = held_unknowns(problem, &system.unknowns, motions);
        let shift = make_definite(system, &held);
        let par = options.par(structure.numbers());
        let factor = Factor::of_semidefinite(structure, (*system.matrix).as_ref(), par)
            .map_err(|breakdown| explain(problem, &system.unknowns, breakdown))?;
        Ok(Reduced { factor, held, first_jump, shift })
    }

    /// The breakdown of the factorisation, where replaced pivots helped it on.
    pub fn breakdown(&self, problem: &Problem, system: &System) -> Option<DualError> {
        Some(explain(problem, &system.unknowns, Breakdown::NotPositive(self.factor.broken()?)))
    }

    /// L⁻¹b, and the load c = b_J − K_J1 K_11⁻¹ b_1 on the unknowns J of interfaces, jumps first.
    pub fn condense(&self, b: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let mut b = b.to_vec();
        for &d in &self.held {
            b[d] = 0.0;
        }
        let y = self.factor.forward(&b);
        let c = self.factor.trailing_times(&y[self.leading()..]);
        (y, self.in_interface_order(c))
    }

    /// All unknowns, from L⁻¹b and those of interfaces, jumps first.
    pub fn expand(&self, mut y: Vec<f64>, jumps: &[f64]) -> Vec<f64> {
        // L_JJᵀ j in place of the tail: back-substitution then reproduces j and solves for the rest.
        let leading = self.leading();
        let interface = self.factor.interface();
        let trailing = match interface {
            Some(interface) => &interface.in_factor_order(jumps),
            None => jumps,
        };
        y[leading..].copy_from_slice(&self.factor.trailing_transpose_times(trailing));
        let mut x = self.factor.backward(y);
        match interface {
            Some(interface) => interface.unknowns.iter().zip(jumps).for_each(|(i, j)| x[*i] = *j),
            None => x[leading..].copy_from_slice(jumps),
        }
        x
    }

    /// Number of unknowns that are eliminated before those of interfaces.
    fn leading(&self) -> usize {
        self.first_jump + self.shift.len() - self.factor.trailing_len()
    }

    /// Values of the unknowns at the end of the factor, jumps first.
    fn in_interface_order(&self, values: Vec<f64>) -> Vec<f64> {
        match self.factor.interface() {
            Some(interface) => interface.in_interface_order(&values),
            None => values,
        }
    }

    /// Which unknowns stay as they are while stresses are refined: held ones and closed jumps.
    pub fn fixed(&self, closed: &[bool]) -> Vec<bool> {
        let mut fixed = vec![false; self.first_jump];
        for &d in &self.held {
            fixed[d] = true;
        }
        fixed.extend(closed);
        fixed
    }

    /// Kx − b vanishes before the jumps and is `traction` on them, or the factor is not that of the matrix.
    pub fn check(&self, system: &System, x: &[f64], traction: &[f64]) -> Result<(), DualError> {
        // A factor with replaced pivots is one of a matrix nearby; refinement shows whether that was near enough.
        if system.unknowns.count == 0 || self.factor.broken().is_some() {
            return Ok(());
        }
        let mut left = system.multiply(x);
        left.iter_mut().zip(&system.rhs).for_each(|(l, b)| *l -= b);
        for &d in &self.held {
            left[d] = 0.0;
        }
        for (i, t) in traction.iter().enumerate() {
            left[self.first_jump + i] -= self.shift[i] * x[self.first_jump + i] + t;
        }
        let size = system.size_of_terms(x) + largest(&system.rhs);
        // A sum notices what a maximum passes over: values that are not numbers.
        let found = left.iter().map(|l| l.abs()).sum::<f64>() / left.len() as f64 / size.max(f64::MIN_POSITIVE);
        if found <= BROKEN {
            return Ok(());
        }
        let reason = format!(
            "a solve with its factor leaves a residual of {found:.1e} where {BROKEN:.0e} would be too much already"
        );
        Err(DualError::Factorisation { reason })
    }
}

/// Takes held unknowns out of K and shifts the diagonal of every jump by itself; returns the shifts.
///
/// On a graded mesh the entries differ by many orders of magnitude, and a common shift would drown those of long edges.
pub fn make_definite(system: &mut System, held: &[usize]) -> Vec<f64> {
    let jumps = system.unknowns.first_jump..system.unknowns.count;
    let (symbolic, values) = Arc::make_mut(&mut system.matrix).parts_mut();
    let columns = symbolic.col_ptr();
    let shift: Vec<f64> = jumps.clone().map(|j| values[columns[j]]).collect();
    for (j, shift) in jumps.zip(&shift) {
        values[columns[j]] += shift;
    }
    if !held.is_empty() {
        let mut is_held = vec![false; system.unknowns.count];
        for &d in held {
            is_held[d] = true;
        }
        isolate(Arc::make_mut(&mut system.matrix), |d| is_held[d]);
    }
    shift
}
