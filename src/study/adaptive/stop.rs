//! Why refinement ends before its tolerance, and what to do about it: a limit that was met can be raised, numbers cannot.

use std::fmt;

use crate::budget::Excess;

/// The reason.
#[derive(Debug, Clone, PartialEq)]
pub enum Stop {
    /// The next mesh would have more triangles than these.
    Triangles(usize),
    /// The next mesh, of so many triangles, would not fit into memory.
    Memory(usize, Excess),
    /// So many seconds have passed.
    Seconds(f64),
    /// Too little time is left for the next mesh.
    SecondsLeft,
    /// The next mesh could not be solved.
    Unsolved(String),
    /// The factors of the next mesh did not fit into memory.
    Factors(String),
    /// There is no upper bound.
    NoUpperBound(String),
    /// The last two meshes were hardly worth their triangles.
    Stalled,
    /// The remaining error lies on scales that no triangle has.
    Scales(String),
    /// The gap is no more than what rounding can leave, and stays.
    Rounding {
        /// The gap.
        gap: f64,
        /// The gap that rounding can leave.
        round_off: f64,
    },
}

impl fmt::Display for Stop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Stop::Triangles(most) => write!(f, "the next mesh would have more than {most} triangles"),
            Stop::Memory(count, excess) => {
                write!(f, "the next mesh, of {count} triangles, would not fit into memory (about {excess})")
            }
            Stop::Seconds(most) => write!(f, "{most} seconds have passed"),
            Stop::SecondsLeft => f.write_str("the time that is left is too short for the next mesh"),
            Stop::Unsolved(why) | Stop::Factors(why) => write!(f, "the next mesh could not be solved ({why})"),
            Stop::NoUpperBound(why) => write!(f, "no upper bound could be built ({why})"),
            Stop::Stalled => f.write_str("it no longer makes the error smaller"),
            Stop::Scales(where_it_is) => f.write_str(where_it_is),
            Stop::Rounding { gap, round_off } => write!(
                f,
                "what is left between the bounds, {gap:.1e}, is no more than rounding can leave, {round_off:.1e}, \
                 and no longer becomes smaller"
            ),
        }
    }
}

impl Stop {
    /// Advice on what to do.
    pub fn advice(&self) -> &'static str {
        match self {
            Stop::Triangles(_) => "Refine further, with a larger --max-triangles, or ask for less.",
            Stop::Memory(..) | Stop::Factors(_) => "Refine further, with more memory (--max-memory), or ask for less.",
            Stop::Seconds(_) | Stop::SecondsLeft => "Refine further, with a larger --max-seconds, or ask for less.",
            Stop::Unsolved(_) | Stop::NoUpperBound(_) => {
                "No limit of this run was met, and a larger one would change nothing: try another --method, or ask for less."
            }
            Stop::Stalled | Stop::Scales(_) | Stop::Rounding { .. } => {
                "No limit of this run was met, and a larger one would change nothing: ask for less."
            }
        }
    }
}
