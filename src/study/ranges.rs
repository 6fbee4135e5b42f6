//! Guarantees for all data of a scene some of whose numbers are known as ranges.
//!
//! The least energy is monotone in each of these numbers ([`crate::scene::DataRange`]), so that the lower bound of the ends with the lowest
//! energy and the upper bound of those with the highest enclose the energies of all that lie between: two solves.

use super::Certified;
use crate::bounds::Bracket;
use crate::problem::{Note, Problem};
use crate::report::text::number::{digits_to_tell, enclosing, outward, significant};
use crate::report::{DataRangeSummary, RangedParameter};

/// The scene of the ends with the highest energy, solved.
#[derive(Debug, Clone, PartialEq)]
pub struct OtherEnd {
    /// The two bounds of its exact energy; `None` where no upper bound could be built.
    pub bracket: Option<[f64; 2]>,
    /// True if its loads alone do work.
    pub is_cone: bool,
}

impl OtherEnd {
    /// Keeps the two bounds of a solution, and whether loads alone do work.
    pub fn of(certified: &Certified) -> Self {
        let upper = certified.bracket.free.as_ref().ok().map(|free| free.upper());
        OtherEnd {
            bracket: upper.map(|upper| [certified.bracket.lower(), upper]),
            is_cone: certified.problem.is_cone() && !certified.problem.has_friction(),
        }
    }
}

/// The summary for all data, from the bracket of the ends with the lowest energy and the other end.
pub(super) fn data_range(problem: &Problem, lowest: &Bracket, other: &OtherEnd) -> DataRangeSummary {
    let scene = &problem.scene;
    let parameter = |range: &crate::scene::DataRange| RangedParameter {
        name: scene.name_of(range),
        low: range.low,
        high: range.high,
        taken: range.softest(),
    };
    let (lower, upper) = (lowest.lower(), other.bracket.map(|[_, upper]| upper));
    DataRangeSummary {
        parameters: scene.ranges.iter().map(parameter).collect(),
        lower,
        upper,
        compliance: upper
            .filter(|_| problem.only_loads_work() && other.is_cone)
            .map(|upper| [0.0 - 2.0 * upper, 0.0 - 2.0 * lower]),
        other_end: other.bracket,
    }
}

/// The addition to the verdict.
pub(super) fn in_words(range: &DataRangeSummary) -> String {
    match range.upper {
        Some(upper) => {
            let digits = digits_to_tell(range.lower, upper);
            let [lower, upper] = enclosing([range.lower, upper], digits);
            format!(" For all data in the ranges of the scene the exact energy lies between {lower} and {upper}.")
        }
        None => {
            let lower = outward(range.lower, 6, false);
            format!(" For all data in the ranges of the scene the exact energy is no lower than {lower}.")
        }
    }
}

/// The note that tells what the numbers of the report are for.
pub(super) fn ranges_note(range: &DataRangeSummary) -> Note {
    let parameter = |p: &RangedParameter| {
        let [low, high, taken] = [p.low, p.high, p.taken].map(|x| significant(x, 6));
        format!("{} lies between {low} and {high}, and is {taken} here", p.name)
    };
    let all: Vec<String> = range.parameters.iter().map(parameter).collect();
    Note {
        weakens_guarantee: false,
        text: format!(
            "Numbers of the scene are known as ranges: {}. These are the ends with the lowest energy; all numbers and fields, those of \
             displacement models too, are for them, and the range of the data adds the upper bound of the other ends.",
            all.join("; ")
        ),
    }
}
