//! The contact state of one mesh as a first guess on the next.

use crate::problem::Problem;

/// First guess of the closed contact ends of `fine`, from the state `closed` of `coarse` at the same arc length: two
/// flags per pair, interface by interface.
///
/// The guess decides the path to the contact state, not the state: that is the unique solution of a convex problem.
pub fn closed_ends(coarse: &Problem, closed: &[bool], fine: &Problem) -> Vec<bool> {
    let mut guess = Vec::with_capacity(2 * fine.interfaces.iter().map(|i| i.pairs.len()).sum::<usize>());
    let mut first = 0;
    for (old, new) in coarse.interfaces.iter().zip(&fine.interfaces) {
        let flags = &closed[first..first + 2 * old.pairs.len()];
        first += flags.len();
        let mut k = 0;
        for pair in &new.pairs {
            let middle = 0.5 * (pair.arc[0] + pair.arc[1]);
            while k + 1 < old.pairs.len() && old.pairs[k].arc[1] <= middle {
                k += 1;
            }
            let [from, to] = old.pairs[k].arc;
            guess.extend(pair.arc.map(|s| {
                let t = (s - from) / (to - from);
                let [near, far] = [flags[2 * k], flags[2 * k + 1]];
                // Half-way between an open and a closed end: closed, from where every problem can be solved.
                if (t - 0.5).abs() < 1e-6 {
                    near || far
                } else if t < 0.5 {
                    near
                } else {
                    far
                }
            }));
        }
    }
    guess
}
