//! Contact held by springs, at nodes or at quadrature points: their stiffness, and what they cost.

use super::Along;
use crate::compare::solution::Shape;
use crate::diagnose::words::number;
use crate::diagnose::{Energies, Finding};

/// Degrees of the rules by which other programs may integrate a penalty.
const RULES: [usize; 5] = [0, 2, 4, 6, 30];
/// Of the largest displacement, what a penalty has to give way by: less is rounding.
const ROUNDED: f64 = 1e-9;
/// How well forces have to follow penetrations.
const FOLLOWS: f64 = 0.1;

/// Springs along a contact.
pub(super) struct Penalty {
    kind: Kind,
    stiffness: f64,
}

/// The extent that one spring stands for.
#[derive(Clone, Copy)]
enum Kind {
    Area,
    Node,
}

impl Along<'_> {
    /// The penalty whose force follows the penetration best.
    pub(super) fn penalty(&self, carrying: &[usize]) -> Option<Penalty> {
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
        let mut kinds = vec![(Kind::Area, fit(&lumped)), (Kind::Area, fit(&consistent)), (Kind::Node, fit(&alone))];
        let shapes = if self.solution.is_curved(self.interface) {
            vec![Shape::Chords, Shape::Curve]
        } else {
            vec![Shape::Chords]
        };
        for (shape, rule) in shapes.into_iter().flat_map(|shape| RULES.map(|rule| (shape, rule))) {
            let sums = self.integrated(shape, rule);
            kinds.push((Kind::Area, fit(&|s| self.sites.binary_search(&s).map_or(0.0, |place| sums[place]))));
        }
        // Nothing follows a list of zeros.
        let known = kinds.into_iter().filter(|(_, (_, miss))| miss.is_finite());
        let (kind, (stiffness, miss)) = known.min_by(|a, b| a.1.1.total_cmp(&b.1.1))?;
        let share = |s: usize| match kind {
            Kind::Area => thickness * self.solution.sites.list[s].weight,
            Kind::Node => 1.0,
        };
        let gives = carrying.iter().map(|s| self.pressing(*s) / (stiffness * share(*s))).fold(0.0, f64::max);
        let is_one = miss <= FOLLOWS && stiffness > 0.0 && gives > ROUNDED * self.solution.reference;
        is_one.then_some(Penalty { kind, stiffness })
    }

    /// ∫ [d]₊ φ ds times the thickness at every node of this contact, as a rule for integrands of degree `rule` has it, d the
    /// penetration at its points.
    fn integrated(&self, shape: Shape, rule: usize) -> Vec<f64> {
        let mut sums = vec![0.0; self.sites.len()];
        for station in self.solution.stations(self.interface, rule, shape) {
            for (site, value) in station.sites {
                if let Ok(place) = self.sites.binary_search(&site) {
                    sums[place] += station.weight * station.excess.max(0.0) * value;
                }
            }
        }
        sums
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
    pub(super) fn told_penalty(&self, name: String, penalty: &Penalty, deepest: usize, energies: Energies) -> Finding {
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
        let depth = self.depth(deepest);
        let gives = match depth > 0.0 {
            true => format!(
                "gives way by up to {} ({:.1e} of the largest displacement) at {}",
                number(depth),
                depth / self.solution.largest,
                self.solution.named(self.node(deepest))
            ),
            false => "gives way between the nodes, which are open".to_string(),
        };
        let sentence = format!(
            "contact {} is a penalty with the stiffness {} {unit}; it {gives}, {costs}",
            self.name,
            number(penalty.stiffness),
        );
        Finding::new(name, Some(penalty.stiffness), None, sentence)
    }
}
