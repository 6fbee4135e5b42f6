//! The dual problem: minimise the complementary energy over self-equilibrated stresses.

use crate::element::StressField;

/// An equilibrated stress field λ_h that minimises Π, and what is known about how well it does so.
#[derive(Debug, Clone)]
pub struct DualSolution {
    /// Name of the method that found it.
    pub method: &'static str,
    /// λ_h.
    pub stress: StressField,
    /// Moments m_{e,p} = ∫_e u q_p ds of the edge displacement, conjugate to the traction end values: for each edge of
    /// the mesh and each of its two end vertices a vector in Cartesian components.
    pub moments: Vec<[[f64; 2]; 2]>,
    /// Normal traction T_n ≤ 0 at the two ends of every contact pair (ends as in [`crate::problem::ContactPair::first`]).
    pub contact_traction: Vec<Vec<[f64; 2]>>,
    /// Number of traction unknowns or multipliers solved for.
    pub unknowns: usize,
    /// Steps of the contact iteration.
    pub iterations: usize,
    /// Largest violation of equilibrium, measured on the stresses and relative to the applied load.
    pub equilibrium_residual: f64,
    /// Seconds by phase.
    pub seconds: Phases,
    /// What the method wants the reader to know.
    pub notes: Vec<String>,
}

/// Wall-clock seconds by phase of the dual solve.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize, schemars::JsonSchema)]
pub struct Phases {
    /// Reading or making the mesh.
    pub read: f64,
    /// Element matrices and the sparse system.
    pub assemble: f64,
    /// Sparse factorisation, symbolic and numeric.
    pub factor: f64,
    /// Contact state.
    pub contact: f64,
    /// Stresses, equilibrium residual and refinement.
    pub recover: f64,
    /// The whole dual solve with its bracket.
    pub total: f64,
}
