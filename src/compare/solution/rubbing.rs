//! The law of friction at the nodes of a field: a force along the contact no larger than its bound, and equal to it against the slip.
//!
//! A method may impose it at its nodes, in Bernstein coefficients, or under the integral of τ̄|j_t|: along an edge whose jump keeps its
//! sign these agree in coefficients of its degree, and where the sign changes the integral may ask for less. Each of them
//! is accepted. Coulomb's law bounds the friction of a place by its own contact force.

use std::collections::BTreeMap;

use super::{SOLVER, Solution, Span};
use crate::compare::Check;
use crate::compare::contact::slides::limits;
use crate::problem::ContactPair;

/// Friction force and slip at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rubbed {
    /// Index into [`super::Sites::list`].
    pub site: usize,
    /// Force on the first side along t̂, thickness included.
    pub force: f64,
    /// (v' − v'')·t̂.
    pub slip: f64,
    /// Largest friction force.
    pub limit: f64,
    /// Error of the force in the law.
    pub miss: f64,
}

/// The friction forces that a place may have, and the largest of them.
#[derive(Debug, Clone, Copy, Default)]
struct Law {
    least: f64,
    most: f64,
    limit: f64,
}

impl Law {
    /// Against the slip where the sides slide, and within `limit` where they stick.
    fn of(limit: f64, slip: f64, slides: bool) -> Self {
        let against = -limit * slip.signum();
        let [least, most] = if slides { [against; 2] } else { [-limit, limit] };
        Law { least, most, limit }
    }
}

/// The form in which a method imposes the law.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ask {
    /// At every node with its share of τ̄.
    AtNodes,
    /// In Bernstein coefficients.
    InCoefficients,
}

impl Solution<'_> {
    /// Jumps below which sides stick along a contact, or touch across it.
    pub fn sticks_below(&self) -> f64 {
        let rounding = self.of_displacements(1.0);
        2.0 * (SOLVER + rounding.digits.min(rounding.ceiling)) * self.reference
    }

    /// Friction along contact `interface` in the form that is nearest to the law; only at places where nothing else shares
    /// its force.
    pub fn rubbed(&self, interface: usize) -> Vec<Rubbed> {
        let asked = [Ask::AtNodes, Ask::InCoefficients].map(|ask| self.rubbed_as(interface, ask));
        let missed = |list: &[Rubbed]| list.iter().map(|r| r.miss).sum::<f64>();
        let [nodes, coefficients] = asked;
        if missed(&nodes) <= missed(&coefficients) { nodes } else { coefficients }
    }

    /// Friction along contact `interface`, compared with the law in the form `ask`.
    pub fn rubbed_as(&self, interface: usize, ask: Ask) -> Vec<Rubbed> {
        let (mut force, mut slip) = (self.rubbing.clone(), self.slip.clone());
        if ask == Ask::InCoefficients {
            (force, slip) = self.sites.in_coefficients(&self.rubbing, &self.slip);
        }
        let laws = match self.coefficient(interface) {
            Some(mu) => self.by_pressing(interface, mu, (&slip, ask)),
            None => self.by_bound(interface, (&slip, ask)),
        };
        let rubbed = |(site, Law { least, most, limit }): (usize, Law)| Rubbed {
            site,
            force: force[site],
            slip: slip[site],
            limit,
            miss: (least - force[site]).max(force[site] - most).max(0.0),
        };
        laws.into_iter().filter(|(site, _)| self.sites.rubs_alone(*site)).map(rubbed).collect()
    }

    /// The law at the places of contact `interface` where a bound of friction is given.
    fn by_bound(&self, interface: usize, (slip, ask): (&[f64], Ask)) -> BTreeMap<usize, Law> {
        let sticks = self.sticks_below();
        let mut laws = BTreeMap::<usize, Law>::new();
        for span in self.sites.edges.iter().filter(|span| span.interface == interface) {
            let pair = &self.problem.interfaces[interface].pairs[span.pair];
            let shares = self.shares(span, pair, ask);
            let any = |sign: f64| shares.iter().any(|(site, _)| sign * slip[*site] > sticks);
            let turns = any(1.0) && any(-1.0);
            for (site, share) in shares {
                let own = Law::of(share, slip[site], slip[site].abs() > sticks && !turns);
                let law = laws.entry(site).or_default();
                *law = Law { least: law.least + own.least, most: law.most + own.most, limit: law.limit + own.limit };
            }
        }
        laws.retain(|_, law| law.limit > 0.0);
        laws
    }

    /// The law at the places of contact `interface` whose friction is bounded by `mu` times the forces that press the sides together.
    fn by_pressing(&self, interface: usize, mu: f64, (slip, ask): (&[f64], Ask)) -> BTreeMap<usize, Law> {
        let sticks = self.sticks_below();
        let pressing = match ask {
            Ask::AtNodes => self.pressing.clone(),
            Ask::InCoefficients => self.sites.in_coefficients(&self.pressing, &self.excess).0,
        };
        let own = (0..pressing.len()).filter(|s| self.sites.list[*s].interface == interface);
        own.map(|s| (s, Law::of(mu * pressing[s].max(0.0), slip[s], slip[s].abs() > sticks))).collect()
    }

    /// Coulomb's coefficient along contact `interface`, where the field is held to its own contact forces.
    pub fn coefficient(&self, interface: usize) -> Option<f64> {
        self.problem.interfaces[interface].pairs.iter().find_map(|pair| pair.friction?.coefficient)
    }

    /// Largest friction forces at the places of a pair, thickness included.
    pub fn shares(&self, span: &Span, pair: &ContactPair, ask: Ask) -> Vec<(usize, f64)> {
        let degree = if span.middle.is_some() { 2 } else { 1 };
        let mut shares = limits(self.problem, pair, degree);
        if let ([a, m, b], Ask::AtNodes) = (&mut shares[..], ask) {
            // Simpson's rule.
            *a -= 0.5 * *m;
            *b -= 0.5 * *m;
            *m *= 2.0;
        }
        let sites = [Some(span.ends[0]), span.middle, Some(span.ends[1])].into_iter().flatten();
        sites.zip(shares).collect()
    }

    /// The check of the law along contact `interface`; `None` without friction.
    pub(super) fn friction_check(&self, interface: usize, name: &str) -> Option<Check> {
        let pairs = &self.problem.interfaces[interface].pairs;
        if pairs.iter().all(|pair| pair.friction.is_none()) {
            return None;
        }
        let rubbed = if self.is_pushed() { Vec::new() } else { self.rubbed(interface) };
        let total = self.applied().max(self.larger * self.carried(interface));
        let missed: f64 = rubbed.iter().map(|r| r.miss).sum();
        let worst = rubbed.iter().max_by(|a, b| a.miss.total_cmp(&b.miss)).filter(|r| r.miss > 0.0);
        let place = worst.map_or(String::new(), |r| {
            format!(
                " It is missed most at {}: a force of {:.3e} where friction carries at most {:.3e}, and the sides slide by {:.3e}.",
                self.named(self.sites.list[r.site].first),
                r.force,
                r.limit,
                r.slip
            )
        });
        let part = if total > 0.0 { missed / total } else { missed };
        let bound =
            self.coefficient(interface).map_or("its bound".to_string(), |mu| format!("{mu} times the contact force"));
        let why = format!(
            "Friction carries no more than {bound}, and that much against the slip where the sides slide: the sum of the nodal forces \
             that are missing or too many, relative to all forces.{place}"
        );
        Some(self.claimed(name, part, self.of_forces(), why))
    }
}
