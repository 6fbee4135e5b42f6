//! The dual problem: minimise the complementary energy over self-equilibrated stresses.
//!
//! A [`DualMethod`] finds the unique λ_h; [`solve`] measures what it found. Methods differ in how they get there and in
//! nothing else, so every one of them is tested against the others.

mod adjoint;
mod contact;
mod degrees;
pub mod equilibrium;
mod factor;
mod footprint;
mod hybrid;
mod methods;
pub mod modes;
pub mod paper;
mod petsc;
mod refinement;
mod resultants;
mod system;
pub mod yardstick;

use std::sync::Arc;
use std::time::Instant;

pub use adjoint::loaded::{Bounds, Loaded};
pub use adjoint::response::{Factorised, Load, Response, Responses, ShapedStrain};
pub use degrees::{carrying, spread};
pub use equilibrium::Equilibrium;
pub use footprint::Size;
pub use hybrid::Motion;
pub use methods::active_set::ActiveSet;
pub use methods::clarabel::Clarabel;
pub use methods::condensed::Condensed;
pub use methods::method::{DualError, DualMethod, Found, Options, Progress};
pub use methods::solver::Solver;
pub use paper::Uzawa;
pub use petsc::{Divided, LinearSolver, Petsc};
pub use system::unknowns::{contact_coefficients, edge_degrees};

use crate::element::{SideValues, StressField};
use crate::problem::{ContactPair, Problem};

/// An equilibrated stress field λ_h that minimises Π, and what is known about how well it does so.
#[derive(Debug, Clone)]
pub struct DualSolution {
    /// Name of the method that found it.
    pub method: &'static str,
    /// λ_h.
    pub stress: StressField,
    /// Moments m_{e,k} = ∫_e u B_k ds of the edge displacement, conjugate to the Bernstein coefficients of the traction: for
    /// each edge of the mesh of degree p, from its first vertex to its second, p + 1 vectors in Cartesian components.
    pub moments: SideValues<[f64; 2]>,
    /// Bernstein coefficients, none of them positive, of t of the traction T' = t n̂ on every contact pair (from end to end as
    /// in [`ContactPair::first`]), interface by interface: T_n where n̂ is the normal.
    pub contact_traction: Vec<SideValues<f64>>,
    /// Which of these coefficients belong to closed contact: pair by pair, one interface after the other.
    pub closed: SideValues<bool>,
    /// Number of unknowns solved for.
    pub unknowns: usize,
    /// Steps of the contact iteration; of a linear solver that iterates, its iterations.
    pub iterations: usize,
    /// Violation of equilibrium, measured on the stresses and relative to the applied load.
    pub equilibrium: Equilibrium,
    /// The equilibrium residual that the method promised.
    pub accuracy: f64,
    /// Seconds by phase.
    pub seconds: Phases,
    /// Notes of the method for the reader of a report.
    pub notes: Vec<String>,
    /// K and its factor for further loads, where they were asked for and the method has them.
    pub factorised: Option<Arc<Factorised>>,
    /// Who found which part, where processes that did can make the upper bound, too.
    pub divided: Option<Arc<Divided>>,
}

/// Wall-clock seconds by phase of the dual solve.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize, schemars::JsonSchema)]
pub struct Phases {
    /// Reading or making the mesh.
    pub read: f64,
    /// How the loads rest on supports and contacts, on every mesh that was tried.
    #[serde(default)]
    pub statics: f64,
    /// Element matrices and the sparse system.
    pub assemble: f64,
    /// Sparse factorisation, symbolic and numeric.
    pub factor: f64,
    /// Contact state.
    pub contact: f64,
    /// Stresses, equilibrium residual and refinement.
    pub recover: f64,
    /// The upper bound, as far as nothing else was done beside it.
    #[serde(default)]
    pub bounds: f64,
    /// Statics, dual solve and bracket.
    pub total: f64,
}

/// Solves the dual problem and measures the solution.
///
/// `motions` are the rigid motions that neither the supports nor the closed contacts resist; the loads do no work on
/// them.
///
/// # Errors
/// As [`DualMethod::solve`].
pub fn solve(
    method: &dyn DualMethod,
    problem: &Problem,
    motions: &[Motion],
    options: &Options,
) -> Result<DualSolution, DualError> {
    let start = Instant::now();
    let options = Options { elements: carrying(problem, &options.elements)?, ..options.clone() };
    let found = method.solve(problem, motions, &options)?;
    let measure = Instant::now();
    let equilibrium = Equilibrium::measure(problem, &found.stress, &found.moments);
    let contact_traction = contact_traction(problem, &found.stress);
    let mut seconds = found.seconds;
    seconds.recover += measure.elapsed().as_secs_f64();
    seconds.total = start.elapsed().as_secs_f64();
    Ok(DualSolution {
        method: method.name(),
        stress: found.stress,
        moments: found.moments,
        contact_traction,
        closed: found.closed,
        unknowns: found.unknowns,
        iterations: found.iterations,
        equilibrium,
        accuracy: method.accuracy(),
        seconds,
        notes: found.notes,
        factorised: found.factorised,
        divided: found.divided,
    })
}

/// The coefficients of t on every pair.
fn contact_traction(problem: &Problem, stress: &StressField) -> Vec<SideValues<f64>> {
    let value = |pair: &ContactPair| equilibrium::contact_traction(problem, stress, pair);
    problem.interfaces.iter().map(|i| i.pairs.iter().map(value).collect()).collect()
}
