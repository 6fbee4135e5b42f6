//! Contact that is no unilateral, frictionless contact: penalties, gaps, friction, glue.

use super::space::Space;
use super::words::number;
use super::{Energies, Finding, Trial};
use crate::compare::Solution;
use crate::compare::solution::SOLVER;

/// Forces this small beside all others are none.
const NO_FORCE: f64 = 1e-6;
/// How well forces have to follow penetrations for a penalty, or penetrations a constant for another gap.
const FOLLOWS: f64 = 0.1;
const CONSTANT: f64 = 1e-3;

/// What the forces along each contact say where it penetrates, pulls or pushes while open.
pub fn findings(solution: &Solution<'_>, energies: Energies) -> Vec<Finding> {
    let interfaces = 0..solution.problem.interfaces.len();
    interfaces.filter_map(|index| Along::new(solution, index).finding(energies)).collect()
}

/// The nodes of one contact.
struct Along<'a> {
    solution: &'a Solution<'a>,
    name: &'a str,
    sites: Vec<usize>,
    /// What counts as closed.
    enough: f64,
    /// What counts as a force.
    least: f64,
}

impl<'a> Along<'a> {
    fn new(solution: &'a Solution<'a>, index: usize) -> Self {
        let sites = (0..solution.sites.list.len()).filter(|s| solution.sites.list[*s].interface == index).collect();
        let total = solution.applied().max(solution.carried(index));
        Along {
            solution,
            name: &solution.problem.interfaces[index].name,
            sites,
            enough: 2.0 * (SOLVER + solution.candidate.precision) * solution.largest,
            least: (NO_FORCE + solution.rounding / solution.scale) * total,
        }
    }

    fn pressing(&self, site: usize) -> f64 {
        self.solution.pressing[site]
    }

    fn depth(&self, site: usize) -> f64 {
        self.solution.excess[site]
    }

    fn finding(&self, energies: Energies) -> Option<Finding> {
        let name = |what: &str| format!("contact/{}/{what}", self.name);
        let deepest = self.sites.iter().copied().max_by(|a, b| self.depth(*a).total_cmp(&self.depth(*b)))?;
        let depth = self.depth(deepest);
        let place = self.solution.named(self.solution.sites.list[deepest].first);
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
            let sentence =
                format!("contact {} penetrates by up to {} at {place}{}", self.name, number(depth), self.turned(depth));
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
                "contact {} pulls, as if glued, at {} nodes with {} together, most at {}",
                self.name,
                pulling.len(),
                number(sum),
                self.solution.named(self.solution.sites.list[most].first)
            );
            return Some(Finding::new(name("glued"), Some(sum), Some(0.0), sentence));
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
                "contact {} pushes at {} open nodes, at {} over a distance of {}{}",
                self.name,
                open.len(),
                self.solution.named(self.solution.sites.list[widest].first),
                number(-self.depth(widest)),
                self.turned(self.depth(widest))
            ),
        };
        let found = self.constant_gap(&open).map(|_| "gap").unwrap_or("open");
        Some(Finding::new(name(found), Some(self.depth(widest)), Some(0.0), sentence))
    }

    /// What a distance suggests that is no more than the square of the displacements over the length of the contact.
    fn turned(&self, distance: f64) -> String {
        let ends = self.solution.sites.spans.iter().filter(|span| self.sites.binary_search(&span.ends[0]).is_ok());
        let length: f64 = ends.map(|span| span.length).sum();
        let turn = self.solution.largest / length;
        // A turn of a tenth is no small one, and no program that takes it for one has anything to do with it.
        if turn < 0.1 && distance.abs() <= turn * self.solution.largest {
            let square = number(turn * self.solution.largest);
            return format!(
                "; that is within {square}, the square of the displacements over the length of the contact, as where contact turns with the \
                 sides: ask that program for small displacements, or load it less"
            );
        }
        String::new()
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

    /// The penalty whose force follows the penetration best.
    fn penalty(&self, carrying: &[usize]) -> Option<Penalty> {
        let thickness = self.solution.problem.scene.thickness;
        let lumped = |s: usize| thickness * self.solution.sites.list[s].weight * self.depth(s).max(0.0);
        let alone = |s: usize| self.depth(s).max(0.0);
        let fit = |of: &dyn Fn(usize) -> f64| {
            let (mut square, mut product, mut size) = (0.0, 0.0, 0.0);
            for s in carrying {
                let (x, f) = (of(*s), self.pressing(*s));
                square += x * x;
                product += x * f;
                size += f * f;
            }
            let slope = product / square;
            let miss: f64 = carrying.iter().map(|s| (self.pressing(*s) - slope * of(*s)).powi(2)).sum();
            (slope, (miss / size).sqrt())
        };
        let mass = self.consistent();
        let consistent = |s: usize| self.sites.binary_search(&s).map_or(0.0, |place| thickness * mass[place]);
        let kinds = [(Kind::Area, fit(&lumped)), (Kind::Area, fit(&consistent)), (Kind::Node, fit(&alone))];
        // Nothing follows a list of zeros.
        let known = kinds.into_iter().filter(|(_, (_, miss))| miss.is_finite());
        let (kind, (stiffness, miss)) = known.min_by(|a, b| a.1.1.total_cmp(&b.1.1))?;
        (miss <= FOLLOWS && stiffness > 0.0).then_some(Penalty { kind, stiffness })
    }

    /// ∫ d φ ds at every node of this contact, d the penetration interpolated between nodes that penetrate.
    fn consistent(&self) -> Vec<f64> {
        let mut sums = vec![0.0; self.sites.len()];
        let depth = |s: usize| self.depth(s).max(0.0);
        let place = |s: usize| self.sites.binary_search(&s).ok();
        for span in &self.solution.sites.spans {
            let [a, b] = span.ends.map(depth);
            let parts = match span.middle.map(depth) {
                Some(m) => [4.0 * a + 2.0 * m - b, -a + 2.0 * m + 4.0 * b, 2.0 * a + 16.0 * m + 2.0 * b],
                None => [10.0 * a + 5.0 * b, 5.0 * a + 10.0 * b, 0.0],
            };
            for (site, part) in span.ends.into_iter().chain(span.middle).zip(parts) {
                if let Some(at) = place(site) {
                    sums[at] += span.length / 30.0 * part;
                }
            }
        }
        sums
    }

    /// The area that a node stands for, where all but those at the ends stand for the same.
    fn area_inside(&self) -> Option<f64> {
        let areas = self.sites.iter().map(|s| self.solution.sites.list[*s].weight);
        let largest = areas.clone().fold(0.0, f64::max);
        let others = areas.filter(|area| (area - largest).abs() > 1e-6 * largest).count();
        (largest > 0.0 && others <= 2).then_some(self.solution.problem.scene.thickness * largest)
    }

    /// A penalty and what it costs.
    fn told_penalty(&self, name: String, penalty: &Penalty, deepest: usize, energies: Energies) -> Finding {
        let work: f64 = self.sites.iter().map(|s| self.pressing(*s) * self.depth(*s).max(0.0)).sum();
        // 𝓛(u_h) ≥ 𝓛(u) + Σ R d + ½|u_h − u|² for the constrained solution u_h of the same space, whose energy is at most that
        // of any admissible field there.
        let most = energies.admissible.map(|admissible| admissible - energies.own).filter(|most| *most >= work);
        let costs = match most {
            Some(most) => {
                let stress = ((most - work) / self.solution.strain.max(f64::MIN_POSITIVE)).sqrt();
                format!(
                    "lowers the energy by {} to {} and changes the stresses by at most {} % in the energy norm",
                    number(work),
                    number(most),
                    number(100.0 * stress)
                )
            }
            None => format!("lowers the energy by {} or more", number(work)),
        };
        let unit = match penalty.kind {
            Kind::Area => "for each unit of area".to_string(),
            Kind::Node => match self.area_inside() {
                Some(area) => {
                    format!("for each node ({} for each unit of area, ends apart)", number(penalty.stiffness / area))
                }
                None => "for each node".to_string(),
            },
        };
        let sentence = format!(
            "contact {} is a penalty with the stiffness {} {unit}; it gives way by up to {} ({:.1e} of the largest displacement) at {}, \
             {costs}",
            self.name,
            number(penalty.stiffness),
            number(self.depth(deepest)),
            self.depth(deepest) / self.solution.largest,
            self.solution.named(self.solution.sites.list[deepest].first)
        );
        Finding::new(name, Some(penalty.stiffness), None, sentence)
    }
}

struct Penalty {
    kind: Kind,
    stiffness: f64,
}

#[derive(Clone, Copy)]
enum Kind {
    Area,
    Node,
}

/// Forces along the contacts, equal and opposite on their two sides: friction, or glue.
pub fn trials(space: &Space<'_>) -> Vec<Trial> {
    let solution = space.solution;
    (0..solution.problem.interfaces.len())
        .map(|index| {
            let along = Along::new(solution, index);
            let mut inside = 0.0;
            for s in &along.sites {
                let site = &solution.sites.list[*s];
                // The force τ t on the first node and −τ t on the second that leaves least.
                let tangent = [-site.normal[1], site.normal[0]];
                let (mut product, mut square) = (0.0, 0.0);
                for (node, sign) in [(Some(site.first), 1.0), (site.second, -1.0)] {
                    let Some(node) = node else { continue };
                    let ([x, y], [tx, ty]) = (solution.rest[node], solution.hold(node).project(tangent));
                    product += sign * (x * tx + y * ty) / solution.forces.stiffness[node];
                    square += (tx * tx + ty * ty) / solution.forces.stiffness[node];
                }
                inside += if square > 0.0 { product * product / square } else { 0.0 };
            }
            let left = (1.0 - inside / space.square).max(0.0);
            Trial { rank: 3, left, findings: vec![along.tangential()] }
        })
        .collect()
}

impl Along<'_> {
    /// What forces along a contact are: those of glue where the sides do not slide, of friction where they do.
    fn tangential(&self) -> Finding {
        let list = &self.solution.sites.list;
        let (mut tangent, mut pressed, mut slip, mut ratio) = (0.0, 0.0, 0.0_f64, 0.0_f64);
        for s in &self.sites {
            let site = &list[*s];
            let force = self.solution.rest[site.first];
            let size = force[0].hypot(force[1]);
            tangent += size;
            pressed += self.pressing(*s).max(0.0);
            if self.pressing(*s) > 1e-3 * self.solution.carried(site.interface) {
                ratio = ratio.max(size / self.pressing(*s));
            }
            let u = self.solution.candidate.value(site.first);
            let other = site.second.map_or([0.0; 2], |n| self.solution.candidate.value(n));
            let jump = [u[0] - other[0], u[1] - other[1]];
            if size > self.least {
                slip = slip.max((jump[0] * site.normal[1] - jump[1] * site.normal[0]).abs());
            }
        }
        let glued = self.sites.iter().any(|s| self.pressing(*s) < -self.least);
        if slip <= 0.5 * self.enough {
            let how = if glued { "tied: it pulls as well, and" } else { "tied along its sides:" };
            let sentence = format!(
                "contact {} is {how} the sides do not slide, with forces of {} along them",
                self.name,
                number(tangent)
            );
            return Finding::new(format!("contact/{}/tied", self.name), Some(tangent), Some(0.0), sentence);
        }
        let sentence = format!(
            "contact {} has friction: forces along it are {} of those that press it, at most {} times the pressing force of a node",
            self.name,
            number(tangent / pressed.max(f64::MIN_POSITIVE)),
            number(ratio)
        );
        Finding::new(format!("contact/{}/friction", self.name), Some(ratio), Some(0.0), sentence)
    }
}
