//! Friction that is not that of the scene: left out, along the slip, of another bound, a spring, or smoothed.

use std::f64::consts::FRAC_2_PI;

use super::Along;
use crate::compare::solution::{Ask, Rubbed, Shape};
use crate::diagnose::Finding;
use crate::diagnose::words::number;
use crate::scene::counted;

/// How well forces have to follow a law, relative to all of them.
const FOLLOWS: f64 = 0.03;
/// Degrees of the rules by which other programs may integrate a law.
const RULES: [usize; 3] = [2, 4, 8];
/// Values of a parameter that are tried between the smallest and the largest slip, and how far beyond them.
const TRIED: usize = 120;
/// Decades beyond.
const BEYOND: f64 = 3.0;
/// A force this far above the bound, relative to it, is more than friction carries.
pub(super) const ABOVE: f64 = 1e-3;
/// Of what the law of the scene misses, what a smooth one may miss.
const BETTER: f64 = 0.5;

/// A tangential force per area as a function of the slip, with one parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Smooth {
    /// min(k |j|, τ̄), k = τ̄ of the whole contact over the parameter: a spring up to the bound.
    Spring,
    /// τ̄ tanh(j/ε).
    Tanh,
    /// τ̄ j/√(j² + ε²).
    Root,
    /// τ̄ (2/π) arctan(j/ε).
    Arctan,
}

impl Smooth {
    const ALL: [Smooth; 4] = [Smooth::Spring, Smooth::Tanh, Smooth::Root, Smooth::Arctan];

    /// The force against a slip `j` where the bound is `bound`; the spring has the stiffness `top`/`parameter`.
    fn force(self, j: f64, bound: f64, top: f64, parameter: f64) -> f64 {
        let x = j / parameter;
        -match self {
            Smooth::Spring => (top * x).clamp(-bound, bound),
            Smooth::Tanh => bound * x.tanh(),
            Smooth::Root => bound * x / (1.0 + x * x).sqrt(),
            Smooth::Arctan => bound * FRAC_2_PI * x.atan(),
        }
    }

    fn in_words(self) -> &'static str {
        match self {
            Smooth::Spring => "a spring",
            Smooth::Tanh => "τ̄ tanh(j/ε)",
            Smooth::Root => "τ̄ j/√(j² + ε²)",
            Smooth::Arctan => "τ̄ (2/π) arctan(j/ε)",
        }
    }
}

/// A law with the parameter that fits best.
struct Fit {
    law: Smooth,
    parameter: f64,
    miss: f64,
}

impl Along<'_> {
    /// The mistake in the friction of this contact; `None` where there is no mistake, or no friction.
    pub(super) fn friction(&self) -> Option<Finding> {
        let rubbed = self.solution.rubbed(self.interface);
        let missed: f64 = rubbed.iter().map(|r| r.miss).sum();
        if self.solution.is_pushed() || missed <= self.least {
            return None;
        }
        Some(self.wrong_friction(&rubbed).at(Rubbed::worst(&rubbed).map(|r| self.node(r.site))))
    }

    fn wrong_friction(&self, rubbed: &[Rubbed]) -> Finding {
        let sticks = self.solution.sticks_below();
        let sliding: Vec<&Rubbed> = rubbed.iter().filter(|r| r.slip.abs() > sticks).collect();
        let total: f64 = rubbed.iter().map(|r| r.force.abs()).sum();
        if total <= self.least {
            let sentence = format!(
                "friction of contact {} is left out: it carries no force along its sides, which slide at {} of {} nodes",
                self.name,
                sliding.len(),
                rubbed.len()
            );
            return self.found("frictionless", Some(0.0), None, sentence);
        }
        let over: Vec<&Rubbed> = rubbed.iter().filter(|r| r.force.abs() > (1.0 + ABOVE) * r.limit).collect();
        if sliding.is_empty() {
            let most = over.iter().map(|r| r.force.abs() / r.limit).fold(0.0, f64::max);
            let most_in_words =
                if most.is_finite() { format!(", up to {} times", number(most)) } else { String::new() };
            let sentence = format!(
                "contact {} sticks where it should slide: nowhere do its sides slide, and at {} the force along them is larger than friction \
                 carries{most_in_words}",
                self.name,
                counted(over.len(), "node"),
            );
            return self.found("sticks", Some(most), Some(1.0), sentence);
        }
        let smooth = || {
            let nodes = self.solution.rubbed_as(self.interface, Ask::AtNodes);
            // With a parameter that vanishes every smooth law is that of the scene.
            let better = BETTER * self.missed_by_own(&nodes, sticks);
            self.smooth(&nodes).filter(|fit| fit.miss <= better).map(|fit| self.told(&fit, &nodes))
        };
        self.wrong_bound(sticks).or_else(smooth).unwrap_or_else(|| self.unlike(rubbed))
    }

    pub(super) fn found(&self, what: &str, value: Option<f64>, expected: Option<f64>, sentence: String) -> Finding {
        Finding::new(format!("contact/{}/{what}", self.name), value, expected, sentence)
    }

    /// The smooth law, with its parameter, that the forces follow best.
    fn smooth(&self, rubbed: &[Rubbed]) -> Option<Fit> {
        let slips = rubbed.iter().map(|r| r.slip.abs()).filter(|j| *j > 0.0);
        let (low, high) = slips.fold((f64::INFINITY, 0.0_f64), |(a, b), j| (a.min(j), b.max(j)));
        let decades = (high / low).log10().min(12.0) + 2.0 * BEYOND;
        let at = |i: f64| high * 10f64.powf(BEYOND - decades * i / TRIED as f64);
        let mut best: Option<Fit> = None;
        for law in Smooth::ALL {
            // Pressures are known at nodes alone.
            let rules = if self.follows_coulomb() { &[][..] } else { &RULES };
            for rule in [None].into_iter().chain(rules.iter().copied().map(Some)) {
                let miss = |parameter: f64| self.missed(rubbed, law, parameter, rule);
                let coarse = (0..=TRIED).map(|i| (i as f64, miss(at(i as f64)))).min_by(|a, b| a.1.total_cmp(&b.1))?;
                let (place, left) = sharpened(coarse, |i| miss(at(i)));
                if best.as_ref().is_none_or(|fit| left < fit.miss) {
                    best = Some(Fit { law, parameter: at(place), miss: left });
                }
            }
        }
        best.filter(|fit| fit.miss <= FOLLOWS)
    }

    /// Misfit of forces and a law, relative to all forces: at the nodes, or integrated by a rule.
    fn missed(&self, rubbed: &[Rubbed], law: Smooth, parameter: f64, rule: Option<usize>) -> f64 {
        let solution = self.solution;
        let top = self.largest_bound(rubbed);
        let mut made = vec![0.0; solution.sites.list.len()];
        match rule {
            None => {
                for r in rubbed {
                    let area = self.area(r.site);
                    made[r.site] = law.force(solution.slip[r.site], r.limit / area, top, parameter) * area;
                }
            }
            Some(degree) => {
                for station in solution.stations(self.interface, degree, Shape::Chords) {
                    let span = &solution.sites.edges[station.edge];
                    let friction = solution.problem.interfaces[self.interface].pairs[span.pair].friction;
                    let bound = friction.map_or(0.0, |f| f.bound[0] + station.at * (f.bound[1] - f.bound[0]));
                    let slip: f64 = station.sites.iter().map(|(site, value)| value * solution.slip[*site]).sum();
                    let force = station.weight * law.force(slip, bound, top, parameter);
                    station.sites.iter().for_each(|(site, value)| made[*site] += value * force);
                }
            }
        }
        let (mut miss, mut size) = (0.0, 0.0);
        for r in rubbed {
            let force = solution.rubbing[r.site];
            miss += (force - made[r.site]).powi(2);
            size += force * force;
        }
        (miss / size).sqrt()
    }

    pub(super) fn follows_coulomb(&self) -> bool {
        self.solution.coefficient(self.interface).is_some()
    }

    /// The largest bound, of Coulomb's law at the places that were looked at.
    fn largest_bound(&self, rubbed: &[Rubbed]) -> f64 {
        let pairs = &self.solution.problem.interfaces[self.interface].pairs;
        if self.follows_coulomb() {
            return rubbed.iter().map(|r| r.limit / self.area(r.site)).fold(0.0, f64::max);
        }
        pairs.iter().filter_map(|pair| pair.friction).map(|friction| friction.largest()).fold(0.0, f64::max)
    }

    /// The area for which a place of contact stands.
    fn area(&self, site: usize) -> f64 {
        self.solution.problem.scene.thickness * self.solution.sites.list[site].weight
    }

    fn told(&self, fit: &Fit, rubbed: &[Rubbed]) -> Finding {
        let gives = rubbed.iter().filter(|r| r.force.abs() < 0.99 * r.limit).map(|r| r.slip.abs()).fold(0.0, f64::max);
        let gives = format!("below the bound it gives way by up to {}", number(gives));
        if fit.law == Smooth::Spring {
            let stiffness = self.largest_bound(rubbed) / fit.parameter;
            let sentence = format!(
                "contact {} is held along its sides by a penalty with the stiffness {} for each unit of area; {gives}",
                self.name,
                number(stiffness)
            );
            return self.found("tangential-penalty", Some(stiffness), None, sentence);
        }
        let sentence = format!(
            "friction of contact {} is regularised: its force follows {} with ε = {}; {gives}",
            self.name,
            fit.law.in_words(),
            number(fit.parameter)
        );
        self.found("regularised", Some(fit.parameter), Some(0.0), sentence)
    }

    /// The finding where no law is recognised.
    fn unlike(&self, rubbed: &[Rubbed]) -> Finding {
        let worst = Rubbed::worst(rubbed);
        let place = worst.map_or(String::new(), |r| {
            format!(
                ", most at {}: the force along the sides is {} where friction carries {}, and they slide by {}",
                self.solution.named(self.node(r.site)),
                number(r.force),
                number(r.limit),
                number(r.slip)
            )
        });
        let sentence = format!("friction of contact {} does not follow its law{place}", self.name);
        self.found("friction-law", worst.map(|r| r.miss), Some(0.0), sentence)
    }
}

/// The lowest of a function near a place on a grid of steps of one, by golden sections.
fn sharpened((place, value): (f64, f64), f: impl Fn(f64) -> f64) -> (f64, f64) {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let (mut low, mut high) = (place - 1.0, place + 1.0);
    for _ in 0..30 {
        let [a, b] = [high - GOLDEN * (high - low), low + GOLDEN * (high - low)];
        if f(a) < f(b) { high = b } else { low = a }
    }
    let found = 0.5 * (low + high);
    let left = f(found);
    if left < value { (found, left) } else { (place, value) }
}
