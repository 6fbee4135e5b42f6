//! Tolerances for rounding in these programs, with reasons.

/// Tolerances of a search for the state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerances {
    /// Forces, relative to the terms that they are sums of, and penetrations, relative to the largest value, that are rounding:
    /// an unknown that grazes keeps its state. A thousand units in the last place: sums have some hundred terms that matter.
    pub grazing: f64,
    /// Amount added to a diagonal entry, relative to it, where a state leaves motions free: the least that leaves all pivots positive. More
    /// than the last would give the factor of another matrix, and is refused.
    pub regular: [f64; 3],
    /// Mean product of room and force, relative to data of size one, at which the interior point has told which of both
    /// vanishes: the two then differ by several orders of magnitude wherever the solution is not degenerate.
    pub identified: f64,
    /// Load that may be left over, relative to all of it, in an accepted state: as much as the largest of `regular` leaves where motions
    /// are a thousand times softer than the rest.
    pub balanced: f64,
    /// Residual, relative to the loads, at which a linear solve by iteration ends.
    pub solved: f64,
}

/// Those of forces and values that are numbers of size one with all digits.
pub const TOLERANCES: Tolerances =
    Tolerances { grazing: 1e-13, regular: [1e-13, 1e-11, 1e-9], identified: 1e-12, balanced: 1e-6, solved: 1e-13 };
