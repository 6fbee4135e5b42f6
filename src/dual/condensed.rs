//! Contact for the price of one linear solve.
//!
//! The jumps on Γ_K come last in one sparse Cholesky factorisation. Their diagonal is shifted so that the matrix is
//! definite even where a body is held by contact alone; the trailing block of the factor then gives the Schur complement
//! S on Γ_K, S = L_JJ L_JJᵀ − shift, and a small dense problem the contact state. One back-substitution gives all other
//! moments. What rounding has cost is won back by refining on the stresses: the traction jumps of λ_h are taken as a
//! load, solved with the same factor, and the stress of that small correction is added.

use std::time::Instant;

use faer::Mat;

use super::factor::{Factor, SymbolicFactor};
use super::hybrid::{Motion, explain, held_unknowns, ordering, parameters, residual, stresses};
use super::long_contact::LongContact;
use super::qp::{self, ContactState};
use super::system::{System, isolate};
use super::{DualError, DualMethod, Found, Options, Phases};
use crate::problem::Problem;

/// The default method.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Condensed {
    /// Limit of refinements on the stresses. It ends earlier where round-off is reached; none leaves the stresses as the
    /// first solve gives them.
    pub most_refinements: usize,
    /// Longest contact, in jumps (two for each pair), whose Schur complement is formed as a dense matrix. Longer ones are
    /// solved iteratively, with the factor as it is stored.
    pub longest_dense: usize,
}

impl Default for Condensed {
    fn default() -> Self {
        Condensed { most_refinements: 8, longest_dense: 6000 }
    }
}

/// Refinement ends when a step no longer improves the residual by this factor …
const WORTHWHILE: f64 = 0.25;
/// … or when the traction jumps are this small against the loads.
const ROUND_OFF: f64 = 2e-14;
/// Residual of a solve that a working factorisation never reaches, relative to matrix and solution.
const BROKEN: f64 = 1e-9;

impl DualMethod for Condensed {
    fn name(&self) -> &'static str {
        "condensed"
    }

    fn solve(&self, problem: &Problem, motions: &[Motion], options: &Options) -> Result<Found, DualError> {
        let mut seconds = Phases::default();
        let start = Instant::now();
        let mut system = System::new(problem, options);
        seconds.assemble = start.elapsed().as_secs_f64();

        let start = Instant::now();
        let reduced = Reduced::new(problem, &mut system, motions, options)?;
        seconds.factor = start.elapsed().as_secs_f64();

        let start = Instant::now();
        let contact = Contact::new(&reduced, self.longest_dense);
        let (y, c) = reduced.condense(&system.rhs);
        let warm = options.closed.as_deref().filter(|closed| closed.len() == system.jump_bound.len());
        let state = contact.solve(&c, &system.jump_bound, warm)?;
        let notes = contact.notes(state.steps, self.longest_dense);
        seconds.contact = start.elapsed().as_secs_f64();

        let start = Instant::now();
        let mut x = reduced.expand(y, &state.jumps);
        let traction = contact.gradient(&c, &state.jumps);
        reduced.check(&system, &x, &traction)?;
        let mut s = parameters(problem, &system, &x, true);
        let mut r = reduced.free_residual(residual(problem, &system, &s), &state.closed);
        let enough = ROUND_OFF * largest(&system.external);
        let mut worst = largest(&r);
        let no_move = vec![0.0; state.closed.len()];
        for _ in 0..self.most_refinements {
            if worst <= enough {
                break;
            }
            let (y, c) = reduced.condense(&r);
            let jumps = contact.with_closed(&c, &no_move, &state.closed).ok_or(DualError::ContactUndetermined)?;
            let dx = reduced.expand(y, &jumps);
            let ds = parameters(problem, &system, &dx, false);
            let trial: Vec<f64> = s.iter().zip(&ds).map(|(a, b)| a + b).collect();
            let trial_r = reduced.free_residual(residual(problem, &system, &trial), &state.closed);
            let trial_worst = largest(&trial_r);
            if trial_worst >= worst {
                break;
            }
            let slow = trial_worst > WORTHWHILE * worst;
            x.iter_mut().zip(&dx).for_each(|(a, b)| *a += b);
            (s, r, worst) = (trial, trial_r, trial_worst);
            if slow {
                break;
            }
        }
        let stress = stresses(problem, &system, &s);
        let moments = system.unknowns.moments(problem, &x);
        seconds.recover = start.elapsed().as_secs_f64();
        Ok(Found {
            stress,
            moments,
            closed: state.closed,
            unknowns: system.unknowns.count,
            iterations: state.steps,
            seconds,
            notes,
        })
    }
}

fn largest(r: &[f64]) -> f64 {
    r.iter().fold(0.0, |m, v| m.max(v.abs()))
}

/// The factorised system with its jumps last.
struct Reduced {
    factor: Factor,
    held: Vec<usize>,
    first_jump: usize,
    /// What was added to the diagonal of each jump.
    shift: Vec<f64>,
}

impl Reduced {
    /// Factorises; the matrix of `system` becomes the definite one.
    fn new(problem: &Problem, system: &mut System, motions: &[Motion], options: &Options) -> Result<Self, DualError> {
        let first_jump = system.unknowns.first_jump;
        let held = held_unknowns(problem, system, motions);
        let shift = make_definite(system, &held);
        let factor = SymbolicFactor::new(system.matrix.symbolic(), first_jump, ordering(problem, system))
            .and_then(|symbolic| Factor::new(symbolic, system.matrix.as_ref(), options.par()))
            .map_err(|breakdown| explain(problem, system, breakdown))?;
        Ok(Reduced { factor, held, first_jump, shift })
    }

    /// L⁻¹b, and the load c = b_J − K_J1 K_11⁻¹ b_1 on the jumps.
    fn condense(&self, b: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let mut b = b.to_vec();
        for &d in &self.held {
            b[d] = 0.0;
        }
        let y = self.factor.forward(&b);
        let c = self.factor.trailing_times(&y[self.first_jump..]);
        (y, c)
    }

    /// All unknowns, from L⁻¹b and the jumps.
    fn expand(&self, mut y: Vec<f64>, jumps: &[f64]) -> Vec<f64> {
        // L_JJᵀ j in place of the tail: back-substitution then reproduces j and solves for the rest.
        y[self.first_jump..].copy_from_slice(&self.factor.trailing_transpose_times(jumps));
        let mut x = self.factor.backward(y);
        x[self.first_jump..].copy_from_slice(jumps);
        x
    }

    /// The residual where it should vanish: not on held unknowns, not on closed jumps.
    fn free_residual(&self, mut r: Vec<f64>, closed: &[bool]) -> Vec<f64> {
        for &d in &self.held {
            r[d] = 0.0;
        }
        for (value, &closed) in r[self.first_jump..].iter_mut().zip(closed) {
            if closed {
                *value = 0.0;
            }
        }
        r
    }

    /// Kx − b vanishes before the jumps and is `traction` on them, or the factor is not that of the matrix.
    fn check(&self, system: &System, x: &[f64], traction: &[f64]) -> Result<(), DualError> {
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
enum Contact<'a> {
    Dense(Mat<f64>),
    Long(LongContact<'a>, usize),
}

impl<'a> Contact<'a> {
    fn new(reduced: &'a Reduced, longest_dense: usize) -> Self {
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

    fn solve(&self, c: &[f64], bound: &[f64], warm: Option<&[bool]>) -> Result<ContactState, DualError> {
        match self {
            Contact::Dense(s) => qp::solve(s, c, bound, warm),
            Contact::Long(s, _) => s.solve(c, bound, warm),
        }
    }

    /// S j − c.
    fn gradient(&self, c: &[f64], jumps: &[f64]) -> Vec<f64> {
        match self {
            Contact::Dense(s) => qp::gradient(s, c, jumps),
            Contact::Long(s, _) => s.apply(jumps).iter().zip(c).map(|(s, c)| s - c).collect(),
        }
    }

    fn with_closed(&self, c: &[f64], bound: &[f64], closed: &[bool]) -> Option<Vec<f64>> {
        match self {
            Contact::Dense(s) => qp::with_closed_or_springs(s, c, bound, closed),
            Contact::Long(s, _) => Some(s.with_closed(c, bound, closed)),
        }
    }

    fn notes(&self, steps: usize, longest_dense: usize) -> Vec<String> {
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
