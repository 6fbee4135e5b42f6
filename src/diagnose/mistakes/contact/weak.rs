//! Contact in the mean: what it costs that nodes penetrate.

use super::Along;
use crate::compare::Solution;
use crate::compare::solution::Weak;
use crate::diagnose::words::number;
use crate::diagnose::{Energies, Finding};

/// One sentence for each contact of `solution` that holds in the mean and not at the nodes.
pub fn in_the_mean(solution: &Solution<'_>, energies: impl Fn() -> Energies) -> Vec<String> {
    let interfaces = 0..solution.problem.interfaces.len();
    let told = |index: usize| Some(Along::new(solution, index).in_the_mean(solution.holds_weakly(index)?, energies()));
    interfaces.filter_map(told).map(|sentence| format!("In {} {sentence}.", solution.candidate.name)).collect()
}

impl Along<'_> {
    /// A law that is met too roughly to be taken as such without a claim.
    pub(super) fn weak(&self, energies: Energies) -> Option<Finding> {
        let weak = self.solution.nearly_weak(self.interface)?;
        let sentence = format!(
            "{}; contact forces follow this law but for {:.1e} of them",
            self.in_the_mean(weak, energies),
            weak.misfit
        );
        let depth = self.solution.deepest(self.interface).map(|site| self.depth(site).max(0.0));
        Some(Finding::new(format!("contact/{}/weak", self.name), depth, Some(0.0), sentence))
    }

    fn in_the_mean(&self, weak: &Weak, energies: Energies) -> String {
        let law = weak.in_words();
        let Some(deepest) = self.solution.deepest(self.interface) else { return law };
        let depth = self.depth(deepest).max(0.0);
        let costs = match energies.admissible.map(|admissible| admissible - energies.own) {
            Some(most) => format!(
                ", and the energy is {} lower than that of the field made admissible ({:.1e} of the strain energy)",
                number(most.max(0.0)),
                most.max(0.0) / self.solution.strain.max(f64::MIN_POSITIVE)
            ),
            None => String::new(),
        };
        format!(
            "contact {} holds {law}, and not at the nodes: it penetrates by up to {} ({:.1e} of the largest displacement) at {}{costs}",
            self.name,
            number(depth),
            depth / self.solution.largest.max(f64::MIN_POSITIVE),
            self.solution.named(self.node(deepest)),
        )
    }
}
