//! The algorithm of Section 3 of the paper, object by object.
//!
//! | object | where |
//! |---|---|
//! | A_u, Q = [Q_0 Q_1], F, side parameters (3.4), (3.9)–(3.12) | [`BlockMatrices`] |
//! | D and E of (3.13), (3.14), each row with its meaning | [`Constraints`] |
//! | dependent rows of B | [`dependences`] |
//! | the reaction g of Examples 1, 2, 3 | [`Reaction`] |
//! | λ̄ = λ⁽¹⁾ + λ⁽²⁾ of (3.16)–(3.19) | [`Auxiliary`] |
//! | A, b, B, G of (3.15) | [`Program`] |
//! | Uzawa's iteration, ‖BA⁻¹Bᵀ‖ | [`Uzawa`], [`Iteration`] |
//!
//! Printed (3.4) has −2(X2 − X3)(Y2 − Y3) in row 2, column 5 of C; with that sign a side's traction would not be the
//! stress times its normal. It is + here.

mod auxiliary;
mod block;
mod constraints;
mod dependence;
mod program;
mod reaction;
mod rows;
mod uzawa;

pub use auxiliary::Auxiliary;
pub use block::BlockMatrices;
pub use constraints::{Constraints, Meaning, TractionShape};
pub use dependence::{Dependence, dependences, multipliers};
pub use program::{CompensatedBlock, Program};
pub use reaction::{Reaction, applied};
pub use rows::SparseRows;
pub use uzawa::{Arrived, Iteration, Uzawa};
