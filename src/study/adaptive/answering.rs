//! The time that the quantities of the last mesh take, which a limit of seconds counts.

use std::time::Instant;

use super::Goal;
use crate::dual::Options;
use crate::study::answers::answers;
use crate::study::certified::Certified;

/// Seconds that the interval of a quantity takes, in those of a mesh, where none was measured …
const ANSWER: f64 = 2.0;
/// … as on meshes that take no more than this part of the seconds that there are, or on which the quantities are expected to.
const SMALL: f64 = 0.02;
/// From one measurement to the next the time may grow so many times as fast as that of the mesh, and is expected to go on.
const GROWTH: [f64; 2] = [1.0, 2.0];

/// What all quantities of a scene take, in seconds of the mesh that they are found on.
pub struct Answering {
    factor: f64,
    measured: Option<f64>,
}

impl Answering {
    /// Of so many quantities. A run that only sharpens the lower bound of another, whose upper bound is known, finds none.
    pub fn new(goal: &Goal, quantities: usize) -> Self {
        let factor = if goal.known_upper.is_none() { ANSWER * quantities as f64 } else { 0.0 };
        Answering { factor, measured: None }
    }

    /// The seconds of a mesh that took `took`, with the quantities of a report on it: measured where that takes little.
    pub fn seconds(&mut self, took: f64, certified: &Certified, options: &Options, goal: &Goal) -> f64 {
        let is_little =
            |most: f64| took <= SMALL * most || self.measured.is_some() && self.factor * took <= 2.0 * SMALL * most;
        if self.factor > 0.0 && took > 0.0 && goal.max_seconds.is_some_and(is_little) {
            let asked = Instant::now();
            answers(certified, options, |_| true);
            let now = asked.elapsed().as_secs_f64().max(f64::MIN_POSITIVE) / took;
            let growth = self.measured.map_or(1.0, |before| (now / before).clamp(GROWTH[0], GROWTH[1]));
            (self.factor, self.measured) = (growth * now, Some(now));
        }
        (1.0 + self.factor) * took
    }
}
