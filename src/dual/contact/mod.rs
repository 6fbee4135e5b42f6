//! Contact on Γ_K once K is factorised: its Schur complement, the state that stresses and jumps ask for, motions that nothing resists.

pub(super) mod clearing;
pub(super) mod ends;
pub(super) mod interface;
pub(super) mod moments;
pub(super) mod rigid;
pub(super) mod schur;
pub(super) mod settling;
pub(super) mod states;
