//! Two-sided bounds: complementary and potential energy, the free upper bound, and the gap in local terms.

mod at_rest;
mod bracket;
mod cells;
pub mod energy;
mod friction;
mod gap;
mod jump;
mod mid;
pub mod oscillation;
mod ranks;
mod rounding;
mod springs;
pub mod upper;

pub use at_rest::without_stress;
pub use bracket::{Bracket, UpperBound, work_of_remainders};
pub use cells::{Cell, Enclosed, strain_energy, strain_energy_by};
pub use energy::{
    Complementary, Potential, complementary, excess_work, potential, support_work, work, work_of, work_on_edges,
};
pub use friction::{absolute, friction_error, slides};
pub use gap::{LocalGap, local_gap};
pub use jump::{jumps, jumps_along, openings, openings_within, side_coefficients};
pub use mid::{mid_field, stress_of};
pub use ranks::on_ranks::{make_part, on_ranks};
pub use rounding::ROUNDING_PER_TERM;
pub use rounding::sum::Sum;
pub use springs::{OnSprings, spring_jumps, spring_tractions};
pub use upper::{
    Beside, Groundwork, Hold, Holds, Nearest, NoUpperBound, NodalValues, Nodes, Prepared, Pull, Repair, Row, Until,
    Violation, admissible, bernstein, holds, holds_at, lifted_within, of_pair, repaired, repaired_at_contact, sides,
    supports_agree,
};
