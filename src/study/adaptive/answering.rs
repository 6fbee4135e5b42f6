//! The time that the quantities of the last mesh take, which a limit of seconds counts.

use std::time::Instant;

use super::Goal;
use crate::dual::Options;
use crate::study::answers::answers;
use crate::study::certified::Certified;

/// Seconds that the interval of a quantity takes, in those of a mesh, where none was measured …
const ANSWER: f64 = 2.0;
/// … as on meshes that take no more than this part of the seconds that there are.
const SMALL: f64 = 0.02;

/// What all quantities of a scene take, in seconds of the mesh that they are found on.
pub struct Answering(f64);

impl Answering {
    /// Of so many quantities. A run that only sharpens the lower bound of another, whose upper bound is known, finds none.
    pub fn new(goal: &Goal, quantities: usize) -> Self {
        Answering(if goal.known_upper.is_none() { ANSWER * quantities as f64 } else { 0.0 })
    }

    /// The seconds of a mesh that took `took`, with the quantities of a report on it: measured where it is small.
    pub fn seconds(&mut self, took: f64, certified: &Certified, options: &Options, goal: &Goal) -> f64 {
        if self.0 > 0.0 && goal.max_seconds.is_some_and(|most| took <= SMALL * most) {
            let asked = Instant::now();
            answers(certified, options, |_| true);
            let seconds = asked.elapsed().as_secs_f64();
            if seconds > 0.0 && took > 0.0 {
                self.0 = seconds / took;
            }
        }
        (1.0 + self.0) * took
    }
}
