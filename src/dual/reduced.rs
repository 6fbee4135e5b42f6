//! The factorised hybrid form with its jumps last, and the contact problem it leaves on Γ_K.

use std::sync::Arc;

use faer::Mat;

use super::clearing::cleared;
use super::factor::{Breakdown, Factor, SymbolicFactor, power_of_two_near};
use super::hybrid::{Motion, explain, held_unknowns};
use super::long_contact::LongContact;
use super::qp::{self, ContactState, largest_finite};
use super::system::{System, isolate};
use super::{DualError, Options};
use crate::budget::Budget;
use crate::problem::Problem;
use crate::vector::long::largest;

/// Residual of a solve that a working factorisation never reaches, relative to matrix and solution.
const BROKEN: f64 = 1e-9;

/// Bytes for each entry of S while the contact is solved: S twice, its open part and the factor of that.
const DENSE: f64 = 32.0;

/// Entries of S, times motions that it does not resist, up to which it is cleared of their rounding errors: many bodies in
/// contact would make that cost more than everything else.
const MOST_CLEARING: usize = 1_000_000_000;

/// The factorised system with its jumps last.
#[derive(Debug)]
pub struct Reduced {
    factor: Factor,
    held: Vec<usize>,
    first_jump: usize,
    /// What was added to the diagonal of each jump.
    shift: Vec<f64>,
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

    /// What the factorisation broke down at, where replaced pivots helped it on.
    pub fn breakdown(&self, problem: &Problem, system: &System) -> Option<DualError> {
        Some(explain(problem, &system.unknowns, Breakdown::NotPositive(self.factor.broken()?)))
    }

    /// L⁻¹b, and the load c = b_J − K_J1 K_11⁻¹ b_1 on the jumps.
    pub fn condense(&self, b: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let mut b = b.to_vec();
        for &d in &self.held {
            b[d] = 0.0;
        }
        let y = self.factor.forward(&b);
        let c = self.factor.trailing_times(&y[self.first_jump..]);
        (y, c)
    }

    /// All unknowns, from L⁻¹b and the jumps.
    pub fn expand(&self, mut y: Vec<f64>, jumps: &[f64]) -> Vec<f64> {
        // L_JJᵀ j in place of the tail: back-substitution then reproduces j and solves for the rest.
        y[self.first_jump..].copy_from_slice(&self.factor.trailing_transpose_times(jumps));
        let mut x = self.factor.backward(y);
        x[self.first_jump..].copy_from_slice(jumps);
        x
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

/// The problem on Γ_K, by the length of the contact.
pub enum Schur<'a> {
    /// S as a dense matrix.
    Dense(Dense),
    /// S as an operator, and the number of jumps.
    Long(LongContact<'a>, usize),
}

/// S in units that make its diagonal about one.
pub struct Dense {
    /// As elimination gives it: where it solves for tractions, it keeps to those of the factor to the last digit.
    matrix: Mat<f64>,
    /// Cleared of what rounding has left of the motions that it does not resist, where there are any: the one to tell
    /// how much a contact resists them.
    cleared: Option<Mat<f64>>,
    /// The units: powers of two u, so that jumps are u times the numbers that the matrix takes, and the numbers it gives
    /// u times tractions.
    unit: Vec<f64>,
}

impl Dense {
    /// The jumps of least energy within `bound`, which may be infinite.
    ///
    /// # Errors
    /// As [`qp::solve`].
    pub fn solve(&self, c: &[f64], bound: &[f64], warm: Option<&[bool]>) -> Result<ContactState, DualError> {
        let Dense { matrix, cleared, unit } = self;
        let (c, bound) = (times(c, unit), over(bound, unit));
        let mut state = qp::solve(cleared.as_ref().unwrap_or(matrix), &c, &bound, warm)?;
        if cleared.is_some()
            && let Some(jumps) = qp::with_closed_or_springs(matrix, &c, &bound, &state.closed)
        {
            state.jumps = jumps;
        }
        state.jumps.iter_mut().zip(unit).for_each(|(j, u)| *j *= u);
        Ok(state)
    }
}

impl<'a> Schur<'a> {
    /// `unresisted` gives jumps, of motions that no support resists, to which S gives no traction: none where they are
    /// more than it is asked for. S is dense up to `longest_dense` jumps, and where `budget` has room for it.
    pub fn new(
        reduced: &'a Reduced,
        longest_dense: usize,
        budget: Budget,
        unresisted: impl FnOnce(usize) -> Vec<Vec<f64>>,
    ) -> Self {
        let m = reduced.factor.trailing_len();
        if m > longest_dense || budget.admit_more(DENSE * (m * m) as f64).is_err() {
            return Schur::Long(LongContact::new(&reduced.factor, &reduced.shift), m);
        }
        let mut matrix = reduced.factor.trailing_product();
        for i in 0..m {
            matrix[(i, i)] -= reduced.shift[i];
        }
        let unit: Vec<f64> = (0..m).map(|i| power_of_two_near(matrix[(i, i)].abs())).collect();
        for k in 0..m {
            for i in 0..m {
                matrix[(i, k)] *= unit[i] * unit[k];
            }
        }
        let unresisted = unresisted(MOST_CLEARING / (m * m).max(1));
        let cleared = cleared(&matrix, unresisted.iter().map(|z| over(z, &unit)));
        Schur::Dense(Dense { matrix, cleared, unit })
    }

    pub fn solve(&self, c: &[f64], bound: &[f64], warm: Option<&[bool]>) -> Result<ContactState, DualError> {
        match self {
            Schur::Dense(dense) => dense.solve(c, bound, warm),
            Schur::Long(s, _) => s.solve(c, bound, warm),
        }
    }

    /// S j − c.
    pub fn gradient(&self, c: &[f64], jumps: &[f64]) -> Vec<f64> {
        match self {
            Schur::Dense(Dense { matrix: s, unit, .. }) => {
                over(&qp::gradient(s, &times(c, unit), &over(jumps, unit)), unit)
            }
            Schur::Long(s, _) => s.apply(jumps).iter().zip(c).map(|(s, c)| s - c).collect(),
        }
    }

    pub fn with_closed(&self, c: &[f64], bound: &[f64], closed: &[bool]) -> Option<Vec<f64>> {
        match self {
            Schur::Dense(Dense { matrix: s, unit, .. }) => {
                let jumps = qp::with_closed_or_springs(s, &times(c, unit), &over(bound, unit), closed)?;
                Some(times(&jumps, unit))
            }
            Schur::Long(s, _) => Some(s.with_closed(c, bound, closed)),
        }
    }

    /// Penetration that is `part` of the largest jump or gap, end by end.
    pub fn allowed(&self, jumps: &[f64], bound: &[f64], part: f64) -> Vec<f64> {
        match self {
            Schur::Dense(Dense { unit, .. }) => {
                let depth = part * largest(&over(jumps, unit)).max(largest_finite(&over(bound, unit)));
                unit.iter().map(|u| u * depth).collect()
            }
            Schur::Long(..) => vec![part * largest(jumps).max(largest_finite(bound)); jumps.len()],
        }
    }

    pub fn notes(&self, steps: usize) -> Vec<String> {
        match self {
            Schur::Dense(..) => Vec::new(),
            Schur::Long(_, m) => vec![format!(
                "the contact has {m} ends, more than are solved with a dense matrix: its state was found iteratively \
                 (MPRGP, {steps} steps)"
            )],
        }
    }
}

fn times(a: &[f64], unit: &[f64]) -> Vec<f64> {
    a.iter().zip(unit).map(|(a, u)| a * u).collect()
}

fn over(a: &[f64], unit: &[f64]) -> Vec<f64> {
    a.iter().zip(unit).map(|(a, u)| a / u).collect()
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
