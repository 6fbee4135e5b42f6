//! Contact that is no unilateral, frictionless contact: penalties, gaps, friction, glue.

mod bound;
mod penalty;
mod rubbing;
mod tangential;
mod turned;
mod weak;

use crate::compare::Solution;
use crate::compare::solution::SOLVER;
use crate::diagnose::words::number;
use crate::diagnose::{Energies, Finding};
use crate::scene::counted;

pub use tangential::trials;
pub use weak::in_the_mean;

/// Rounded displacements that meet in the force of a node: all may be off the same way.
const MEETING: f64 = 16.0;
/// Forces this small beside all others are none.
const NO_FORCE: f64 = 1e-6;
/// How well penetrations have to follow a constant for another gap.
const CONSTANT: f64 = 1e-3;

/// Findings from the forces along each contact where it penetrates, pulls or pushes while open.
pub fn findings(solution: &Solution<'_>, energies: Energies) -> Vec<Finding> {
    let interfaces = 0..solution.problem.interfaces.len();
    let of = |index: usize| {
        let along = Along::new(solution, index);
        [along.finding(energies), along.friction()]
    };
    interfaces.flat_map(of).flatten().collect()
}

/// The nodes of one contact.
struct Along<'a> {
    solution: &'a Solution<'a>,
    interface: usize,
    name: &'a str,
    sites: Vec<usize>,
    /// Distances up to this size count as closed.
    enough: f64,
    /// Forces up to this size count as none.
    least: f64,
}

impl<'a> Along<'a> {
    fn new(solution: &'a Solution<'a>, index: usize) -> Self {
        let sites = (0..solution.sites.list.len()).filter(|s| solution.sites.list[*s].interface == index).collect();
        let total = solution.applied().max(solution.carried(index));
        Along {
            solution,
            interface: index,
            name: &solution.problem.interfaces[index].name,
            sites,
            enough: 2.0 * (SOLVER + solution.candidate.precision) * solution.reference,
            least: (NO_FORCE + MEETING * solution.rounding / solution.scale) * total,
        }
    }

    fn pressing(&self, site: usize) -> f64 {
        self.solution.pressing[site]
    }

    fn depth(&self, site: usize) -> f64 {
        self.solution.excess[site]
    }

    /// The node of its first side.
    fn node(&self, site: usize) -> usize {
        self.solution.sites.list[site].first
    }

    fn finding(&self, energies: Energies) -> Option<Finding> {
        let name = |what: &str| format!("contact/{}/{what}", self.name);
        if self.solution.holds_weakly(self.interface).is_some() {
            return None;
        }
        let deepest = self.sites.iter().copied().max_by(|a, b| self.depth(*a).total_cmp(&self.depth(*b)))?;
        let depth = self.depth(deepest);
        let place = self.solution.named(self.node(deepest));
        let carrying: Vec<usize> =
            self.sites.iter().copied().filter(|s| self.pressing(*s).abs() > self.least).collect();
        if depth > 0.5 * self.enough {
            if carrying.is_empty() {
                let sentence = format!(
                    "contact {} is not applied: it carries no force, and the sides overlap by up to {} at {place}",
                    self.name,
                    number(depth)
                );
                return Some(Finding::new(name("missing"), Some(depth), Some(0.0), sentence));
            }
            if let Some(finding) = self.weak(energies) {
                return Some(finding);
            }
            if let Some(gap) = self.constant_gap(&carrying) {
                let sentence =
                    format!("contact {} closes {} too late: its gap is larger by that", self.name, number(gap));
                return Some(Finding::new(name("gap"), Some(gap), Some(0.0), sentence));
            }
            if let Some(free) = self.without_force() {
                let sentence = format!(
                    "contact {} does not act at {free} of {} nodes: no force keeps the sides apart at {place}, where they overlap by {}",
                    self.name,
                    self.sites.len(),
                    number(depth)
                );
                return Some(Finding::new(name("in-part"), Some(depth), Some(0.0), sentence));
            }
            if let Some(penalty) = self.penalty(&carrying) {
                return Some(self.told_penalty(name("penalty"), &penalty, deepest, energies));
            }
            let sentence = format!(
                "contact {} penetrates by up to {} at {place}{}",
                self.name,
                number(depth),
                self.turned(&carrying)
            );
            return Some(Finding::new(name("penetration"), Some(depth), Some(0.0), sentence));
        }
        if self.solution.is_pushed() {
            return None;
        }
        let (forces, distances) = self.solution.sites.in_coefficients(&self.solution.pressing, &self.solution.excess);
        let pulling: Vec<usize> = self.sites.iter().copied().filter(|s| forces[*s] < -self.least).collect();
        if let Some(most) = pulling.iter().copied().min_by(|a, b| forces[*a].total_cmp(&forces[*b])) {
            let sum: f64 = pulling.iter().map(|s| -forces[*s]).sum();
            let sentence = format!(
                "contact {} pulls, as if glued, at {} with {} together, most at {}",
                self.name,
                counted(pulling.len(), "node"),
                number(sum),
                self.solution.named(self.node(most))
            );
            return Some(Finding::new(name("glued"), Some(sum), Some(0.0), sentence).at(Some(self.node(most))));
        }
        // Straight edges may overlap a curve between nodes that are open.
        if self.solution.is_curved(self.interface) && !carrying.is_empty() {
            if let Some(finding) = self.weak(energies) {
                return Some(finding);
            }
            if let Some(penalty) = self.penalty(&carrying) {
                return Some(self.told_penalty(name("penalty"), &penalty, deepest, energies));
            }
        }
        let pushes_open = |s: &usize| {
            let at_node = self.depth(*s) < -self.enough && self.pressing(*s) > self.least;
            at_node && distances[*s] < -self.enough && forces[*s] > self.least
        };
        let open: Vec<usize> = carrying.into_iter().filter(pushes_open).collect();
        let widest = open.iter().copied().min_by(|a, b| self.depth(*a).total_cmp(&self.depth(*b)))?;
        let sentence = match self.constant_gap(&open) {
            Some(gap) => format!("contact {} closes {} too early: its gap is smaller by that", self.name, number(-gap)),
            None => format!(
                "contact {} pushes at {}, at {} over a distance of {}{}",
                self.name,
                counted(open.len(), "open node"),
                self.solution.named(self.node(widest)),
                number(-self.depth(widest)),
                self.turned(&open)
            ),
        };
        let found = self.constant_gap(&open).map(|_| "gap").unwrap_or("open");
        Some(Finding::new(name(found), Some(self.depth(widest)), Some(0.0), sentence).at(Some(self.node(widest))))
    }

    /// How many penetrate without any force, where all that do have none: nodes, or Bernstein coefficients of the jump.
    fn without_force(&self) -> Option<usize> {
        let (forces, distances) = self.solution.sites.in_coefficients(&self.solution.pressing, &self.solution.excess);
        let count = |force: &[f64], depth: &[f64]| {
            let deep: Vec<usize> = self.sites.iter().copied().filter(|s| depth[*s] > 0.5 * self.enough).collect();
            let without = !deep.is_empty() && deep.iter().all(|s| force[*s].abs() <= self.least);
            without.then_some(deep.len())
        };
        count(&self.solution.pressing, &self.solution.excess).or_else(|| count(&forces, &distances))
    }

    /// By how much the gap is larger than that of the scene where every node that carries a force has the same distance.
    fn constant_gap(&self, carrying: &[usize]) -> Option<f64> {
        let values: Vec<f64> = carrying.iter().map(|s| self.depth(*s)).collect();
        let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
        let same = values.len() > 2
            && mean.abs() > 0.5 * self.enough
            && values.iter().all(|d| (d - mean).abs() <= CONSTANT * mean.abs());
        same.then_some(mean)
    }
}
