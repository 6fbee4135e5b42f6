//! The factorised hybrid form with its jumps last, and the contact problem it leaves on Γ_K.

use faer::Mat;

use super::factor::{Factor, SymbolicFactor};
use super::hybrid::{Motion, explain, held_unknowns, ordering};
use super::long_contact::LongContact;
use super::qp::{self, ContactState};
use super::system::{System, isolate};
use super::{DualError, Options};
use crate::problem::Problem;

/// Residual of a solve that a working factorisation never reaches, relative to matrix and solution.
const BROKEN: f64 = 1e-9;

fn largest(r: &[f64]) -> f64 {
    r.iter().fold(0.0, |m, v| m.max(v.abs()))
}

/// The factorised system with its jumps last.
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
        motions: &[Motion],
        options: &Options,
    ) -> Result<Self, DualError> {
        let first_jump = system.unknowns.first_jump;
        let held = held_unknowns(problem, system, motions);
        let shift = make_definite(system, &held);
        let factor = SymbolicFactor::new(system.matrix.symbolic(), first_jump, ordering(problem, system))
            .and_then(|symbolic| Factor::new(symbolic, system.matrix.as_ref(), options.par()))
            .map_err(|breakdown| explain(problem, system, breakdown))?;
        Ok(Reduced { factor, held, first_jump, shift })
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
        if system.unknowns.count == 0 {
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
        let columns = system.matrix.symbolic().col_ptr();
        let diagonal = columns[..x.len()].iter().fold(0.0_f64, |m, &k| m.max(system.matrix.val()[k]));
        let size = diagonal * largest(x) + largest(&system.rhs);
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
pub enum Contact<'a> {
    /// S as a dense matrix.
    Dense(Mat<f64>),
    /// S as an operator, and the number of jumps.
    Long(LongContact<'a>, usize),
}

impl<'a> Contact<'a> {
    pub fn new(reduced: &'a Reduced, longest_dense: usize) -> Self {
        let m = reduced.factor.trailing_len();
        if m > longest_dense {
            return Contact::Long(LongContact::new(&reduced.factor, &reduced.shift), m);
        }
        let lower = reduced.factor.trailing();
        let mut matrix = &lower * lower.transpose();
        for i in 0..m {
            matrix[(i, i)] -= reduced.shift[i];
        }
        Contact::Dense(matrix)
    }

    pub fn solve(&self, c: &[f64], bound: &[f64], warm: Option<&[bool]>) -> Result<ContactState, DualError> {
        match self {
            Contact::Dense(s) => qp::solve(s, c, bound, warm),
            Contact::Long(s, _) => s.solve(c, bound, warm),
        }
    }

    /// S j − c.
    pub fn gradient(&self, c: &[f64], jumps: &[f64]) -> Vec<f64> {
        match self {
            Contact::Dense(s) => qp::gradient(s, c, jumps),
            Contact::Long(s, _) => s.apply(jumps).iter().zip(c).map(|(s, c)| s - c).collect(),
        }
    }

    pub fn with_closed(&self, c: &[f64], bound: &[f64], closed: &[bool]) -> Option<Vec<f64>> {
        match self {
            Contact::Dense(s) => qp::with_closed_or_springs(s, c, bound, closed),
            Contact::Long(s, _) => Some(s.with_closed(c, bound, closed)),
        }
    }

    pub fn notes(&self, steps: usize, longest_dense: usize) -> Vec<String> {
        match self {
            Contact::Dense(_) => Vec::new(),
            Contact::Long(_, m) => vec![format!(
                "the contact has {m} ends, more than the {longest_dense} that are solved with a dense matrix: its state \
                 was found iteratively (MPRGP, {steps} steps)"
            )],
        }
    }
}

/// Takes held unknowns out of K and shifts the diagonal of every jump by itself; returns the shifts.
///
/// On a graded mesh the entries differ by many orders of magnitude, and a common shift would drown those of long edges.
pub fn make_definite(system: &mut System, held: &[usize]) -> Vec<f64> {
    let jumps = system.unknowns.first_jump..system.unknowns.count;
    let (symbolic, values) = system.matrix.parts_mut();
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
        isolate(&mut system.matrix, |d| is_held[d]);
    }
    shift
}
