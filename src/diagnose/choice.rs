//! Which of the hypotheses that explain a residual is named.

use super::Trial;
use crate::compare::Solution;

/// Of the squared residual what an explanation may leave: a hundredth of the residual.
const LEFT: f64 = 1e-4;
/// The part that a solver may have left counts as explained where it is no larger than this part of the squared residual: beyond it,
/// whatever explains a little would explain all.
const FLOOR: f64 = 1e-2;
/// Of the squared residual what the nearest hypothesis has to explain to be worth a name.
const NAMED: f64 = 0.5;
/// As [`NAMED`], for a hypothesis that drops the equations of whole places: on a coarse mesh these hold half of any residual.
const NAMED_PLACE: f64 = 0.9;
/// Hypotheses of this rank and above are such.
const PLACES: usize = 7;
/// Of the squared residual what the digits of a file may leave of an explanation, at most.
const BY_DIGITS: f64 = 0.05;
/// Of what digits leave of the squared residual at most, what they leave as a rule: roundings are not all of one sign.
const TYPICAL: f64 = 1e-2;
/// Of the squared residual what counts as explained owing to that, at most.
const FEW_DIGITS: f64 = 1e-3;
/// The nearest hypotheses leave less than this times what the nearest leaves.
const ABOUT: f64 = 3.0;
/// Explanations that leave less than this times what the best leaves are as good.
const AS_GOOD: f64 = 10.0;

/// Parts of the squared residual that count as explained.
pub struct Limits {
    /// What the solver and the digits of the file are taken to have left.
    floor: f64,
    /// What the digits of the file may have left at most.
    digits: f64,
}

impl Limits {
    /// Those of a field that is no solution.
    pub fn of(solution: &Solution<'_>) -> Self {
        let part = |left: f64| (left / solution.residual()).powi(2);
        let allowed = Some(part(solution.allowed())).filter(|floor| *floor <= FLOOR).unwrap_or(0.0);
        let digits = part(solution.rounding / solution.scale);
        Limits { floor: allowed.max((TYPICAL * digits).min(FEW_DIGITS)), digits: digits.min(BY_DIGITS) }
    }

    /// The trials but those that drop the equations of whole places, where a mistake of a few numbers leaves no more than the digits of
    /// the file may.
    pub fn without_places(&self, mut trials: Vec<Trial>) -> Vec<Trial> {
        if trials.iter().any(|trial| trial.rank < PLACES && trial.left <= self.digits) {
            trials.retain(|trial| trial.rank < PLACES);
        }
        trials
    }

    /// The simplest of the trials that leave next to nothing, or all of them where none does.
    pub fn simplest(&self, mut trials: Vec<Trial>) -> Result<Trial, Vec<Trial>> {
        let best = trials.iter().map(|t| t.left).fold(f64::INFINITY, f64::min);
        if best > LEFT.max(self.floor) {
            return Err(trials);
        }
        let enough = (AS_GOOD * best).max(self.floor).max(1e-2 * LEFT);
        trials.retain(|t| t.left <= enough);
        let key = |t: &Trial| (t.rank, t.left);
        trials
            .into_iter()
            .min_by(|a, b| key(a).0.cmp(&key(b).0).then(key(a).1.total_cmp(&key(b).1)))
            .ok_or_else(Vec::new)
    }
}

/// The simplest of the trials that leave about as little as any, where that is enough to be named: two where nothing tells them apart.
pub fn nearest(mut trials: Vec<Trial>) -> Vec<Trial> {
    let best = trials.iter().map(|t| t.left).fold(f64::INFINITY, f64::min);
    let enough = |t: &Trial| 1.0 - t.left >= if t.rank >= PLACES { NAMED_PLACE } else { NAMED };
    trials.retain(|t| t.left <= ABOUT * best && enough(t));
    trials.sort_by(|a, b| a.rank.cmp(&b.rank).then(a.left.total_cmp(&b.left)));
    let rank = trials.first().map(|t| t.rank);
    trials.retain(|t| Some(t.rank) == rank);
    trials.truncate(2);
    trials
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::Finding;

    const LIMITS: Limits = Limits { floor: 1e-8, digits: 1e-3 };

    fn trials(all: &[(usize, f64)]) -> Vec<Trial> {
        let of = |(rank, left): &(usize, f64)| {
            let findings = vec![Finding::new(format!("{rank} {left:e}"), None, None, "")];
            Trial { rank: *rank, left: *left, findings }
        };
        all.iter().map(of).collect()
    }

    #[test]
    fn a_boundary_is_named_only_where_no_mistake_of_a_few_numbers_explains_as_much_to_the_digits() {
        let left = |all: &[(usize, f64)]| LIMITS.without_places(trials(all)).len();
        assert_eq!(left(&[(PLACES, 1e-5), (1, 5e-4), (2, 0.5)]), 2);
        assert_eq!(left(&[(PLACES, 1e-5), (1, 5e-3), (2, 0.5)]), 3);
    }

    #[test]
    fn the_simplest_of_those_that_leave_next_to_nothing_is_named() {
        let found = LIMITS.simplest(trials(&[(2, 1e-12), (1, 5e-9), (0, 2e-5)])).ok().expect("one that explains all");
        assert_eq!(found.rank, 1);
        assert_eq!(LIMITS.simplest(trials(&[(0, 2e-3), (1, 2e-4)])).err().map(|all| all.len()), Some(2));
    }

    #[test]
    fn the_nearest_are_two_where_nothing_tells_them_apart() {
        let ranks = |all: &[(usize, f64)]| nearest(trials(all)).iter().map(|t| t.rank).collect::<Vec<_>>();
        assert_eq!(ranks(&[(2, 1e-2), (1, 1.1e-2), (1, 2e-2), (1, 0.2)]), [1, 1]);
        assert_eq!(ranks(&[(0, 0.9), (4, 0.2)]), [4]);
        assert!(ranks(&[(PLACES, 0.3)]).is_empty());
    }
}
