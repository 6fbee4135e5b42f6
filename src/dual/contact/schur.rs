//! The contact problem on Γ_K: min ½ jᵀSj − cᵀj over jumps j ≤ g along n̂, with τ̄|j| for those along t̂ where there is friction, and S
//! what elimination leaves of K.
//!
//! S is a dense matrix where a few bodies touch, sparse where many do (see [`super::interface`]), and only applied where a contact is
//! too long for either. All are given to [`crate::optimise`] in units in which the diagonal is about one: what they give are then
//! forces and not tractions, and ends can be compared with each other.
//!
//! Round-off is relative to the terms of S j − c, not to their sum: a body that rests on a point
//! turns and shifts by much, and its contact forces are small differences.

use faer::Mat;

use super::clearing::cleared;
use crate::budget::Budget;
use crate::dual::DualError;
use crate::dual::factor::{Factor, power_of_two_near};
use crate::dual::system::System;
use crate::dual::system::reduced::Reduced;
use crate::optimise::{self, Law, Program, Quadratic, SparseForm, State, conjugate_gradients};
use crate::vector::long::largest;

/// Bytes for each entry of S while the contact is solved: S twice, its open part and the factor of that.
const DENSE: f64 = 32.0;

/// Entries of S, times motions that it does not resist, up to which it is cleared of their rounding errors: many bodies in
/// contact would make that cost more than everything else.
const MOST_CLEARING: usize = 1_000_000_000;

/// The contact state.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactState {
    /// Jumps, and what other unknowns of interfaces there are.
    pub jumps: Vec<f64>,
    /// Where each jump is on its law.
    pub states: Vec<State>,
    /// Steps taken.
    pub steps: usize,
}

/// S, and the problem with it.
pub struct Schur<'a> {
    /// As elimination gives it: where it solves for tractions, it keeps to those of the factor to the last digit.
    form: Box<dyn Quadratic + Send + Sync + 'a>,
    /// Cleared of what rounding has left of the motions that it does not resist, where there are any: the one to tell
    /// how much a contact resists them.
    cleared: Option<Mat<f64>>,
    /// The units: powers of two u, so that unknowns are u times the numbers that S takes, and the numbers it gives u times
    /// tractions.
    unit: Vec<f64>,
    /// Number of jumps: the first unknowns.
    jumps: usize,
}

impl<'a> Schur<'a> {
    /// `unresisted` gives jumps, of motions that no support resists, to which S gives no traction: none where they are
    /// more than it is asked for. S is dense up to `longest_dense` jumps, and where `budget` has room for it.
    pub fn new(
        system: &System,
        reduced: &'a Reduced,
        longest_dense: usize,
        budget: Budget,
        unresisted: impl FnOnce(usize) -> Vec<Vec<f64>>,
    ) -> Self {
        let jumps = reduced.shift.len();
        if let Some(interface) = reduced.factor.interface() {
            let mut values = reduced.factor.complement(interface, (*system.matrix).as_ref());
            let structure = &interface.structure;
            (0..jumps).for_each(|i| values[structure.column(i).0] -= reduced.shift[i]);
            let n = interface.unknowns.len();
            let unit: Vec<f64> = (0..n).map(|i| power_of_two_near(values[structure.column(i).0].abs())).collect();
            for k in 0..n {
                let (start, rows) = structure.column(k);
                rows.iter().enumerate().for_each(|(at, row)| values[start + at] *= unit[k] * unit[*row]);
            }
            let form = Box::new(SparseForm::new(structure.clone(), values));
            return Schur { form, cleared: None, unit, jumps };
        }
        if jumps > longest_dense || budget.admit_more(DENSE * (jumps * jumps) as f64).is_err() {
            let form = Box::new(Applied::new(&reduced.factor, &reduced.shift));
            return Schur { form, cleared: None, unit: vec![1.0; jumps], jumps };
        }
        let mut matrix = reduced.factor.trailing_product();
        for i in 0..jumps {
            matrix[(i, i)] -= reduced.shift[i];
        }
        let unit: Vec<f64> = (0..jumps).map(|i| power_of_two_near(matrix[(i, i)].abs())).collect();
        for k in 0..jumps {
            for i in 0..jumps {
                matrix[(i, k)] *= unit[i] * unit[k];
            }
        }
        let unresisted = unresisted(MOST_CLEARING / (jumps * jumps).max(1));
        let cleared = cleared(&matrix, unresisted.iter().map(|z| over(z, &unit)));
        Schur { form: Box::new(matrix), cleared, unit, jumps }
    }

    /// The jumps of least energy under their `laws`; `warm` is a first guess of their states (those that resist most, where there is
    /// none).
    ///
    /// # Errors
    /// [`DualError::ContactUndetermined`] where the energy has no minimum.
    pub fn solve(&self, c: &[f64], laws: &[Law], warm: Option<&[State]>) -> Result<ContactState, DualError> {
        let (load, laws) = (times(c, &self.unit), self.laws(laws));
        let form = self.cleared.as_ref().map_or(&*self.form as &dyn Quadratic, |cleared| cleared);
        let program = Program { form, load: &load, laws: &laws };
        let start = warm.map(|states| self.states(states));
        let mut found = optimise::solve(&program, start).ok_or(DualError::ContactUndetermined)?;
        if self.cleared.is_some() {
            // The values of the state as the factor has them; what is loose may be elsewhere only where that changes no state.
            let program = Program { form: &*self.form, ..program };
            let alone = program.in_state(&found.states, None);
            let alone = alone.filter(|x| program.next_states(&found.states, x) == found.states);
            if let Some(x) = alone.or_else(|| program.in_state(&found.states, Some(&found.x))) {
                found.x = x;
            }
        }
        found.states.truncate(self.jumps);
        Ok(ContactState { jumps: times(&found.x, &self.unit), states: found.states, steps: found.steps })
    }

    /// S j − c of the jumps.
    pub fn gradient(&self, c: &[f64], jumps: &[f64]) -> Vec<f64> {
        let mut forces = over(&self.form.gradient(&times(c, &self.unit), &over(jumps, &self.unit)), &self.unit);
        forces.truncate(self.jumps);
        forces
    }

    /// Jumps in these `states` of their laws, in equilibrium where they are not held, by weak springs where nothing else holds
    /// them: the stress of the result is right to the stiffness of these, and refinement takes that error away.
    pub fn in_states(&self, c: &[f64], laws: &[Law], states: &[State]) -> Option<Vec<f64>> {
        let (load, laws) = (times(c, &self.unit), self.laws(laws));
        let program = Program { form: &*self.form, load: &load, laws: &laws };
        let x = program.in_state(&self.states(states), None)?;
        Some(times(&x, &self.unit))
    }

    /// Penetration that is `part` of the largest jump or gap, end by end.
    pub fn allowed(&self, jumps: &[f64], laws: &[Law], part: f64) -> Vec<f64> {
        let unit = &self.unit[..self.jumps];
        let extent = self.laws(laws).iter().fold(largest(&over(jumps, unit)), |most, law| most.max(law.extent()));
        let depth = part * extent;
        unit.iter().map(|u| u * depth).collect()
    }

    /// True if a search that changes states one after the other is at hand.
    pub fn is_direct(&self) -> bool {
        self.form.is_direct()
    }

    /// Notes on the way to the state, for the reader of a report.
    pub fn notes(&self, steps: usize) -> Vec<String> {
        if self.form.is_direct() {
            return Vec::new();
        }
        let m = self.jumps;
        vec![format!(
            "the contact has {m} ends, more than are solved with a dense matrix: its state was found iteratively (MPRGP, \
             {steps} steps)"
        )]
    }

    fn laws(&self, of_jumps: &[Law]) -> Vec<Law> {
        let scaled = of_jumps.iter().zip(&self.unit).map(|(law, u)| law.in_unit(*u));
        scaled.chain(std::iter::repeat_n(Law::Free, self.unit.len() - self.jumps)).collect()
    }

    fn states(&self, of_jumps: &[State]) -> Vec<State> {
        let rest = std::iter::repeat_n(State::Below, self.unit.len() - self.jumps);
        of_jumps.iter().copied().chain(rest).collect()
    }
}

/// S as the factor has it stored: S j = L_JJ (L_JJᵀ j) − shift · j.
struct Applied<'a> {
    factor: &'a Factor,
    shift: &'a [f64],
    diagonal: Vec<f64>,
}

impl<'a> Applied<'a> {
    fn new(factor: &'a Factor, shift: &'a [f64]) -> Self {
        let squares = factor.trailing_squares();
        let diagonal = squares.iter().zip(shift).map(|(d, s)| (d - s).max(1e-14 * s)).collect();
        Applied { factor, shift, diagonal }
    }
}

impl Quadratic for Applied<'_> {
    fn len(&self) -> usize {
        self.shift.len()
    }

    fn diagonal(&self, i: usize) -> f64 {
        self.diagonal[i]
    }

    fn add_product(&self, x: &[f64], out: &mut [f64]) {
        let product = self.factor.trailing_times(&self.factor.trailing_transpose_times(x));
        for (((o, p), x), shift) in out.iter_mut().zip(product).zip(x).zip(self.shift) {
            *o += p - shift * x;
        }
    }

    /// The largest sum stands for the terms of all.
    fn terms(&self, x: &[f64]) -> Vec<f64> {
        vec![largest(&self.apply(x)); x.len()]
    }

    fn is_direct(&self) -> bool {
        false
    }

    fn factor(&self, _: &[f64], held: &[bool]) -> Option<Box<dyn optimise::Factor + '_>> {
        Some(Box::new(Iterated { form: self, held: held.to_vec() }))
    }
}

/// Solves by conjugate gradients.
struct Iterated<'a> {
    form: &'a Applied<'a>,
    held: Vec<bool>,
}

impl optimise::Factor for Iterated<'_> {
    fn solve(&self, b: &[f64]) -> Vec<f64> {
        conjugate_gradients(self.form, b, &self.held)
    }
}

fn times(a: &[f64], unit: &[f64]) -> Vec<f64> {
    a.iter().zip(unit).map(|(a, u)| a * u).collect()
}

fn over(a: &[f64], unit: &[f64]) -> Vec<f64> {
    a.iter().zip(unit).map(|(a, u)| a / u).collect()
}
