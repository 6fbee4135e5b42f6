//! Convex quadratic programs with a simple convex term for each unknown:
//!
//! min ½xᵀAx − bᵀx + Σ φ_i(x_i), A symmetric and positive semidefinite.
//!
//! The contact problem on Γ_K is one (φ a bound on each jump), and every interface law of theory.md §11 makes one. [`Law`] is φ,
//! [`Quadratic`] what an algorithm may ask of A, [`solve`] the way from both to the minimum: primal–dual active sets from a first
//! guess, which end in a few steps where they end; where they do not, a primal–dual interior point, whose steps are always as
//! many as the digits it wins, tells the state, and active sets from there settle what grazes.

mod barrier;
mod form;
mod interior;
mod law;
mod mprgp;
mod newton;
mod sparse;
mod tolerance;

pub use form::{Factor, Quadratic};
pub use interior::interior_point;
pub use law::{Law, Piece, State};
pub use mprgp::{conjugate_gradients, mprgp};
pub use newton::active_sets;
pub use sparse::{SparseForm, Structure};
pub use tolerance::{TOLERANCES, Tolerances};

/// Steps of active sets from a guess at most, as long as fewer unknowns change than ever before …
const STEPS: usize = 60;
/// … and where every step is an iteration of its own.
const ITERATED_STEPS: usize = 3;
/// Steps of active sets from the point where another algorithm ended.
const SETTLING: usize = 20;

/// A, b and φ.
#[derive(Clone, Copy)]
pub struct Program<'a> {
    /// A.
    pub form: &'a dyn Quadratic,
    /// b.
    pub load: &'a [f64],
    /// φ of each unknown.
    pub laws: &'a [Law],
}

/// Values, and where they are on their laws.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// x.
    pub x: Vec<f64>,
    /// The state of each unknown.
    pub states: Vec<State>,
    /// Steps taken.
    pub steps: usize,
    /// True if values and forces require these states, up to rounding.
    pub settled: bool,
}

/// The minimum; `start` gives a first guess of the states (those that resist most, where there is none). Nothing where the
/// energy has no minimum, or where rounding leaves no digit of it. A solution that has not settled fulfils all conditions to the
/// accuracy of the interior point.
pub fn solve(program: &Program<'_>, start: Option<Vec<State>>) -> Option<Solution> {
    let direct = program.form.is_direct();
    let most = match start {
        Some(_) if !direct => ITERATED_STEPS,
        // Of many pieces, some are loose in any state that is not yet the solution.
        None if !direct || program.form.is_loose() => 0,
        _ => STEPS,
    };
    let states = start.unwrap_or_else(|| program.laws.iter().map(|law| law.stiffest()).collect());
    let first = active_sets(program, states, None, most);
    if first.settled {
        return Some(first);
    }
    let inner = if direct { interior_point(program, TOLERANCES.identified) } else { mprgp(program) }?;
    let about = direct.then(|| inner.x.clone());
    let last = active_sets(program, inner.states.clone(), about, SETTLING);
    let steps = first.steps + inner.steps + last.steps;
    let found = if last.settled { last } else { inner };
    Some(Solution { steps, ..found })
}
