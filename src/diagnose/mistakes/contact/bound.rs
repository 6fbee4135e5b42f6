//! Friction with another bound than that of the scene.

use super::Along;
use super::rubbing::ABOVE;
use crate::compare::solution::{Ask, Rubbed, SOLVER};
use crate::diagnose::Finding;
use crate::diagnose::words::{near, times as in_words};
use crate::problem::{ContactPair, Friction};
use crate::scene::counted;

/// By how much more than what it leaves, or than a solver leaves, a small mistake of a bound has to explain.
const SURE: f64 = 10.0;

impl Along<'_> {
    /// The mistake in the bound of friction, imposed at nodes or in coefficients.
    pub(super) fn wrong_bound(&self, sticks: f64) -> Option<Finding> {
        let ways = [Ask::AtNodes, Ask::InCoefficients];
        ways.into_iter().find_map(|ask| self.other_bound(ask, sticks).or_else(|| self.turned_bound(ask, sticks)))
    }

    /// Part of the friction forces that is missed by the bound of the scene where the sides slide.
    pub(super) fn missed_by_own(&self, rubbed: &[Rubbed], sticks: f64) -> f64 {
        let sliding = rubbed.iter().filter(|r| r.slip.abs() > sticks);
        let (miss, size) = sliding.fold((0.0, 0.0), |(miss, size), r| {
            (miss + (r.force + r.limit * r.slip.signum()).powi(2), size + r.force * r.force)
        });
        (miss / size).sqrt()
    }

    /// Forces against the slip, or along it, that are one number times the bound wherever the sides slide, and no larger where they stick.
    fn other_bound(&self, ask: Ask, sticks: f64) -> Option<Finding> {
        let rubbed = self.solution.rubbed_as(self.interface, ask);
        let sliding: Vec<&Rubbed> = rubbed.iter().filter(|r| r.slip.abs() > sticks).collect();
        let against = |r: &Rubbed| r.limit * r.slip.signum();
        let (product, square) =
            sliding.iter().fold((0.0, 0.0), |(p, s), r| (p - r.force * against(r), s + r.limit * r.limit));
        let times = product / square;
        let miss: f64 = sliding.iter().map(|r| (r.force + times * against(r)).powi(2)).sum();
        let size: f64 = sliding.iter().map(|r| r.force * r.force).sum();
        let within = |r: &Rubbed| r.slip.abs() > sticks || r.force.abs() <= (times.abs() + ABOVE) * r.limit;
        let missed = (miss / size).sqrt();
        let follows = missed <= ABOVE && rubbed.iter().all(within);
        // A small mistake is one where nothing else is wrong, and it has to explain what is missed.
        let alone = self.solution.residual() <= self.solution.allowed();
        let least = if alone { SURE * missed.max(SOLVER) } else { ABOVE };
        if !follows || (times - 1.0).abs() <= least {
            return None;
        }
        if near(times, -1.0) {
            let sentence = format!(
                "friction of contact {} acts along the slip and not against it: its force has the opposite sign at {}",
                self.name,
                counted(sliding.len(), "sliding node")
            );
            return Some(self.found("friction-sign", Some(times), Some(1.0), sentence));
        }
        // No other number below zero is a bound.
        if times < 0.0 {
            return None;
        }
        let thousands = times.log10() / 3.0;
        let how = match () {
            () if near(times, 2.0) || near(times, 0.5) => ", as if one of the two sides counted twice or half",
            () if thousands.round() != 0.0 && (thousands - thousands.round()).abs() < ABOVE => {
                ", which is another unit"
            }
            () => "",
        };
        let bound = if self.follows_coulomb() { "coefficient of friction" } else { "friction bound" };
        let sentence =
            format!("the {bound} of contact {} is {} times what the scene says{how}", self.name, in_words(times));
        Some(self.found("friction-bound", Some(times), Some(1.0), sentence))
    }

    /// The bound of the scene counted from the other end of the contact, where that is another bound.
    fn turned_bound(&self, ask: Ask, sticks: f64) -> Option<Finding> {
        if self.follows_coulomb() {
            return None;
        }
        let rubbed = self.solution.rubbed_as(self.interface, ask);
        let sliding: Vec<&Rubbed> = rubbed.iter().filter(|r| r.slip.abs() > sticks).collect();
        let limit = self.turned_limits(ask)?;
        let length = |of: &dyn Fn(&Rubbed) -> f64| sliding.iter().map(|r| of(r).powi(2)).sum::<f64>().sqrt();
        let force = length(&|r| r.force);
        let apart = length(&|r| limit[r.site] - r.limit);
        let miss = length(&|r| r.force + limit[r.site] * r.slip.signum());
        // A bound that is the same from both ends cannot be counted from the wrong one.
        (miss <= ABOVE * force && apart > 2.0 * ABOVE * force).then(|| {
            let sentence =
                format!("the friction bound of contact {} is counted from the other end of its first side", self.name);
            self.found("friction-turned", None, None, sentence)
        })
    }

    /// Largest friction forces of all places of contact with the bound counted from the other end.
    fn turned_limits(&self, ask: Ask) -> Option<Vec<f64>> {
        let pairs = &self.solution.problem.interfaces[self.interface].pairs;
        let (begin, end) = (pairs.first()?.arc[0], pairs.last()?.arc[1]);
        let bound = |s: f64| {
            let pair = pairs.iter().find(|pair| pair.arc[0] <= s && s <= pair.arc[1])?;
            let [a, b] = pair.friction.map_or([0.0; 2], |friction| friction.bound);
            let part = (s - pair.arc[0]) / (pair.arc[1] - pair.arc[0]);
            Some(a + part * (b - a))
        };
        let mut limit = vec![0.0; self.solution.sites.list.len()];
        for span in self.solution.sites.edges.iter().filter(|span| span.interface == self.interface) {
            let pair = &pairs[span.pair];
            let bound = pair.arc.map(|s| bound(begin + end - s).unwrap_or(0.0));
            let friction = pair.friction.map(|friction| Friction { bound, ..friction });
            let turned = ContactPair { friction, ..*pair };
            self.solution.shares(span, &turned, ask).into_iter().for_each(|(site, share)| limit[site] += share);
        }
        Some(limit)
    }
}
