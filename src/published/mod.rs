//! The published benchmarks of `cases/published/`, inside the program: a scene each, the numbers that were printed for it, and the verdict of a
//! guaranteed interval on each number.

mod index;
mod table;
mod verdict;

pub use index::{Case, Value, cases};
pub use table::{Row, listed, markdown, text};
pub use verdict::Verdict;
