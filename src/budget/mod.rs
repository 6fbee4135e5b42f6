//! How much memory a run may take, asked before it is taken.
//!
//! Linux grants memory that is not there and ends the process that touches it; under a limit of the address space an
//! allocation fails, and Rust aborts. Both lose everything. So whoever is about to take much — a mesh, a factorisation —
//! says first how much that will be, and a [`Budget`] admits it or gives the figures of an [`Excess`].

mod available;
mod bytes;
mod exhausted;

pub use available::{available, resident};
pub use bytes::{parse, words};
pub use exhausted::{ExitOnExhaustion, fallible};

/// Part of what is available that a run may take unless told otherwise: the rest is for what cannot be foreseen to the
/// byte, and for other programs.
const SHARE: f64 = 0.8;

/// The most memory that this process may hold at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Budget {
    bytes: f64,
}

/// An excess over the memory that may be used, in bytes.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("{} of memory would be needed where {} may be used", words(*.needed), words(*.allowed))]
pub struct Excess {
    /// The process would hold so much.
    pub needed: f64,
    /// It may hold so much.
    pub allowed: f64,
}

impl Budget {
    /// No limit.
    pub const UNLIMITED: Budget = Budget { bytes: f64::INFINITY };

    /// So many bytes.
    pub fn of(bytes: u64) -> Self {
        Budget { bytes: bytes as f64 }
    }

    /// Four fifths of what is available now to a run with so many threads; no limit where the system does not tell.
    pub fn of_available(threads: usize) -> Self {
        available(threads).map_or(Self::UNLIMITED, |free| Budget { bytes: resident() as f64 + SHARE * free as f64 })
    }

    /// The most bytes that may be held; infinite without a limit.
    pub fn bytes(self) -> f64 {
        self.bytes
    }

    /// Checks that the process may hold `needed` bytes in all.
    ///
    /// # Errors
    /// [`Excess`] with both figures.
    pub fn admit(self, needed: f64) -> Result<(), Excess> {
        if needed <= self.bytes { Ok(()) } else { Err(Excess { needed, allowed: self.bytes }) }
    }

    /// Checks that the process may take `more` bytes beside what it holds now.
    ///
    /// # Errors
    /// [`Excess`] with both figures.
    pub fn admit_more(self, more: f64) -> Result<(), Excess> {
        self.admit(resident() as f64 + more)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_budget_admits_what_fits_and_names_both_figures_otherwise() {
        let budget = Budget::of(2_000_000_000);
        assert_eq!(budget.admit(2e9), Ok(()));
        let excess = budget.admit(3.4e10).expect_err("too much");
        assert_eq!(excess.to_string(), "34 GB of memory would be needed where 2 GB may be used");
        assert!(budget.admit(f64::NAN).is_err(), "what is not known does not fit");
        assert_eq!(Budget::UNLIMITED.admit(1e300), Ok(()));
    }

    #[test]
    fn what_is_held_counts() {
        if resident() > 0 {
            assert!(Budget::of(resident() / 2).admit_more(0.0).is_err());
        }
        assert_eq!(Budget::of(u64::MAX).admit_more(1e9), Ok(()));
    }

    #[test]
    fn the_default_is_less_than_what_is_available() {
        let Some(free) = available(1) else { return };
        let budget = Budget::of_available(1);
        assert!(budget.bytes() < resident() as f64 + free as f64);
        assert!(budget.bytes() > 0.0);
    }
}
