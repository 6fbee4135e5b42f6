//! Communication between processes that compute one bracket together.
pub(super) mod on_ranks;
pub(super) mod pipe;

/// The processes, numbered from zero; this one is one of them. What each says to another arrives in the order in which it was said.
///
/// A rank that loses another one ends there: without it there is no bracket, and nothing to go on with.
pub trait Ranks {
    /// Gives numbers to some ranks, and takes numbers from others: `from` has these ranks and how many numbers each gives.
    fn exchange(&self, to: &[(usize, Vec<f64>)], from: &[(usize, usize)]) -> Vec<Vec<f64>>;

    /// Collects the numbers of every rank, in the order of ranks; all ranks call this together.
    fn gather(&self, own: &[f64]) -> Vec<Vec<f64>>;
}
