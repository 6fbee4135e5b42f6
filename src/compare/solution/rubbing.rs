//! The law of friction at the nodes of a field: a force along the contact no larger than its bound, and equal to it against the slip.
//!
//! A method may impose it at its nodes, in Bernstein coefficients, or under the integral of τ̄|j_t|: along an edge whose jump keeps its
//! sign these agree in coefficients of its degree, and where the sign changes the integral may ask for less. Each of them
//! is accepted. Coulomb's law bounds the friction of a place by its own contact force.

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

/// The form in which a method imposes the law.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ask {
    /// At every node with its share of τ̄.
    AtNodes,
    /// In Bernstein coefficients.
    InCoefficients,
}

impl Solution<'_> {
    /// Jumps along the contact below which the sides stick.
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
        let sticks = self.sticks_below();
        let count = self.sites.list.len();
        let (mut least, mut most, mut limit) = (vec![0.0; count], vec![0.0; count], vec![0.0; count]);
        for (site, share) in self.limits_by_pressing(interface, ask) {
            let against = -share * slip[site].signum();
            limit[site] = share;
            [least[site], most[site]] = if slip[site].abs() > sticks { [against; 2] } else { [-share, share] };
        }
        let given = self.sites.edges.iter().filter(|span| self.coefficient(span.interface).is_none());
        for span in given.filter(|span| span.interface == interface) {
            let pair = &self.problem.interfaces[interface].pairs[span.pair];
            let shares = self.shares(span, pair, ask);
            let any = |sign: f64| shares.iter().any(|(site, _)| sign * slip[*site] > sticks);
            let turns = any(1.0) && any(-1.0);
            for (site, share) in shares {
                limit[site] += share;
                let slides = slip[site].abs() > sticks;
                let against = -share * slip[site].signum();
                let [low, high] = if slides && !turns { [against; 2] } else { [-share, share] };
                least[site] += low;
                most[site] += high;
            }
        }
        let rubs = |s: &usize| {
            limit[*s] > 0.0 || (self.coefficient(interface).is_some() && self.sites.list[*s].interface == interface)
        };
        let own = (0..count).filter(|s| rubs(s) && self.sites.rubs_alone(*s));
        let rubbed = |site: usize| Rubbed {
            site,
            force: force[site],
            slip: slip[site],
            limit: limit[site],
            miss: (least[site] - force[site]).max(force[site] - most[site]).max(0.0),
        };
        own.map(rubbed).collect()
    }

    /// Coulomb's coefficient along contact `interface`, where the field is held to its own contact forces.
    pub fn coefficient(&self, interface: usize) -> Option<f64> {
        self.problem.interfaces[interface].pairs.iter().find_map(|pair| pair.friction?.coefficient)
    }

    /// Coulomb's coefficient times the forces that press the sides together at the places of contact `interface`; none where the bound of
    /// friction is given.
    fn limits_by_pressing(&self, interface: usize, ask: Ask) -> Vec<(usize, f64)> {
        let Some(mu) = self.coefficient(interface) else { return Vec::new() };
        let pressing = match ask {
            Ask::AtNodes => self.pressing.clone(),
            Ask::InCoefficients => self.sites.in_coefficients(&self.pressing, &self.excess).0,
        };
        let own = (0..pressing.len()).filter(|s| self.sites.list[*s].interface == interface);
        own.map(|s| (s, mu * pressing[s].max(0.0))).collect()
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
