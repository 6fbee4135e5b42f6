//! The law of friction at the nodes of a field: a force along the contact no larger than its bound, and equal to it against the slip.
//!
//! A method may impose it at its nodes, in Bernstein coefficients, or under the integral of τ̄|j_t|, which it may take at points: along an edge
//! whose jump keeps its sign these agree in coefficients of its degree, and where the sign changes they do not. Each of them
//! is accepted, as a whole. Coulomb's law bounds the friction of a place by its own contact force.

use std::collections::BTreeMap;

use super::{SOLVER, Solution, Span};
use crate::compare::Check;
use crate::compare::contact::slides::limits;
use crate::element::polynomial::quadrature::segment_rule;
use crate::element::polynomial::side;
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

impl Rubbed {
    /// The place of `all` where the law is missed most; `None` where it holds at all of them.
    pub fn worst(all: &[Rubbed]) -> Option<&Rubbed> {
        all.iter().max_by(|a, b| a.miss.total_cmp(&b.miss)).filter(|r| r.miss > 0.0)
    }
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
    /// Under the integral of τ̄|j_t|, by so many points along each edge, or exactly.
    InTheIntegral(Option<usize>),
}

/// All forms, the points those of usual rules.
const ASKED: [Ask; 7] = [
    Ask::AtNodes,
    Ask::InCoefficients,
    Ask::InTheIntegral(None),
    Ask::InTheIntegral(Some(2)),
    Ask::InTheIntegral(Some(3)),
    Ask::InTheIntegral(Some(4)),
    Ask::InTheIntegral(Some(5)),
];

/// Points between two changes of sign, enough for a bound and functions of degree 4 together.
const BETWEEN: usize = 5;

impl Solution<'_> {
    /// Jumps below which sides stick along a contact, or touch across it.
    pub fn sticks_below(&self) -> f64 {
        let rounding = self.of_displacements(1.0);
        2.0 * (SOLVER + rounding.digits.min(rounding.ceiling)) * self.reference
    }

    /// Friction along contact `interface` in the form that is nearest to the law; only at places where nothing else shares
    /// its force.
    pub fn rubbed(&self, interface: usize) -> Vec<Rubbed> {
        let missed = |list: &Vec<Rubbed>| list.iter().map(|r| r.miss).sum::<f64>();
        // Where the direction turns nodes have no coefficients of their own: those are all held against the field together.
        let turns = self.problem.interfaces[interface].pairs.iter().any(|pair| !pair.direction.is_constant());
        let asked = ASKED.into_iter().filter(|ask| !turns || *ask != Ask::InCoefficients);
        let asked = asked.map(|ask| self.rubbed_as(interface, ask));
        asked.min_by(|a, b| missed(a).total_cmp(&missed(b))).unwrap_or_default()
    }

    /// Friction along contact `interface`, compared with the law in the form `ask`.
    pub fn rubbed_as(&self, interface: usize, ask: Ask) -> Vec<Rubbed> {
        let (mut force, mut slip) = (self.rubbing.clone(), self.slip.clone());
        if ask == Ask::InCoefficients {
            (force, slip) = self.sites.in_coefficients(&self.rubbing, &self.slip);
        }
        let laws = match self.coefficient(interface) {
            Some(mu) => self.by_pressing(interface, mu, (&slip, ask)),
            None => self.by_bound(interface, &slip, ask),
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
    fn by_bound(&self, interface: usize, slip: &[f64], ask: Ask) -> BTreeMap<usize, Law> {
        let sticks = self.sticks_below();
        let mut laws = BTreeMap::<usize, Law>::new();
        for span in self.sites.edges.iter().filter(|span| span.interface == interface) {
            let pair = &self.problem.interfaces[interface].pairs[span.pair];
            let of_edge = match ask {
                Ask::InTheIntegral(points) => self.by_integral(span, pair, points),
                _ => {
                    let slides = |site: usize| slip[site].abs() > sticks;
                    let shares = self.shares(span, pair, ask).into_iter();
                    shares.map(|(site, share)| (site, Law::of(share, slip[site], slides(site)))).collect()
                }
            };
            for (site, own) in of_edge {
                let law = laws.entry(site).or_default();
                *law = Law { least: law.least + own.least, most: law.most + own.most, limit: law.limit + own.limit };
            }
        }
        laws.retain(|_, law| law.limit > 0.0);
        laws
    }

    /// −∫ τ̄ sign(j) φ for the functions of the nodes of an edge, and all between ±∫ τ̄ |φ| where its jump j is none.
    fn by_integral(&self, span: &Span, pair: &ContactPair, points: Option<usize>) -> Vec<(usize, Law)> {
        let Some(friction) = pair.friction else { return Vec::new() };
        let sites: Vec<usize> = [Some(span.ends[0]), span.middle, Some(span.ends[1])].into_iter().flatten().collect();
        let (whole, bound) = (self.problem.scene.thickness * pair.length, friction.weighted());
        let jump: Vec<f64> = sites.iter().map(|site| self.slip[*site]).collect();
        let functions = |s: f64| match jump.len() {
            2 => vec![1.0 - s, s],
            _ => vec![(1.0 - s) * (1.0 - 2.0 * s), 4.0 * s * (1.0 - s), s * (2.0 * s - 1.0)],
        };
        let at = |s: f64| functions(s).iter().zip(&jump).map(|(f, j)| f * j).sum::<f64>();
        let pieces: Vec<[f64; 2]> = match points {
            Some(_) => vec![[0.0, 1.0]],
            None => {
                let ends = [vec![0.0], changes_of_sign(&jump), vec![1.0]].concat();
                ends.windows(2).map(|pair| [pair[0], pair[1]]).collect()
            }
        };
        let sticks = self.sticks_below();
        let mut laws = vec![Law::default(); sites.len()];
        for [from, to] in pieces {
            for (s, weight) in segment_rule(2 * points.unwrap_or(BETWEEN) - 1) {
                let s = from + s * (to - from);
                let share = whole * weight * (to - from) * side::value(&bound, s);
                let slides = at(s).abs() > sticks;
                for (law, value) in laws.iter_mut().zip(functions(s)) {
                    let own = Law::of(share * value.abs(), at(s) * value.signum(), slides);
                    *law =
                        Law { least: law.least + own.least, most: law.most + own.most, limit: law.limit + own.limit };
                }
            }
        }
        sites.into_iter().zip(laws).collect()
    }

    /// The law at the places of contact `interface` whose friction is bounded by `mu` times the forces that press the sides together.
    fn by_pressing(&self, interface: usize, mu: f64, (slip, ask): (&[f64], Ask)) -> BTreeMap<usize, Law> {
        let sticks = self.sticks_below();
        let pressing = match ask {
            Ask::AtNodes | Ask::InTheIntegral(_) => self.pressing.clone(),
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
        let place = Rubbed::worst(&rubbed).map_or(String::new(), |r| {
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

/// The places between 0 and 1 at which a function changes its sign that has these values at its two or three nodes.
fn changes_of_sign(values: &[f64]) -> Vec<f64> {
    let [a, m, b] = match values {
        [a, b] => [*a, 0.5 * (a + b), *b],
        [a, m, b] => [*a, *m, *b],
        _ => return Vec::new(),
    };
    // a + p s + q s².
    let (p, q) = (4.0 * m - 3.0 * a - b, 2.0 * (a + b) - 4.0 * m);
    let root = (p * p - 4.0 * q * a).max(0.0).sqrt();
    let half = -0.5 * (p + p.signum() * root);
    let mut places: Vec<f64> = [half / q, a / half].into_iter().filter(|s| 0.0 < *s && *s < 1.0).collect();
    places.sort_by(f64::total_cmp);
    places
}
