//! Forces along a contact: friction, or glue.

use super::Along;
use crate::diagnose::space::Space;
use crate::diagnose::words::number;
use crate::diagnose::{Finding, Trial};

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
    /// Classifies forces along a contact: as glue where the sides do not slide, as friction where they do.
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
