//! Coulomb friction in a report: numbers and sentences.

use super::{Coulomb, End, From, Start, in_words};
use crate::compare::ContactSummary;
use crate::report::text::number::{at_most_percent, digits_to_tell, percent, significant};
use crate::report::{CoulombOutcome, CoulombStart, CoulombSummary, Energy};
use crate::scene::counted;

impl Coulomb {
    /// For a report on `energy`, the bracket for the bound that was used.
    pub fn summary(&self, energy: Option<&Energy>) -> CoulombSummary {
        CoulombSummary {
            energy_range: [self.lowest, self.highest],
            starts: self.starts.iter().map(start).collect(),
            bounds_differ: self.apart,
            several_solutions: self.has_several(),
            wedging: self.wedged.iter().map(in_words).collect(),
            statements: [self.of_every_solution(), self.of_the_bound(energy), self.of_how_many()],
        }
    }

    /// Puts into the summaries of contacts what is known of their friction.
    pub fn complete(&self, contacts: &mut [ContactSummary]) {
        for (contact, distance) in contacts.iter_mut().zip(&self.distances) {
            let (Some(friction), Some(distance)) = (&mut contact.friction, distance) else { continue };
            friction.iterations = self.iterations();
            friction.bound_distance = Some(*distance);
        }
    }

    /// By how much of the force of friction the bound is off, on the contact where that is most.
    pub fn farthest(&self) -> f64 {
        self.distances.iter().flatten().fold(0.0, |most, distance| distance.relative.max(most))
    }

    fn of_every_solution(&self) -> String {
        let digits = self.lowest.zip(self.highest).map_or(6, |(low, high)| digits_to_tell(low, high));
        match [self.lowest, self.highest].map(|end| end.map(|end| significant(end, digits))) {
            [Some(low), Some(high)] => format!(
                "Every solution of Coulomb's law has an energy between {low} and {high}, guaranteed: the ends are those without friction \
                 and with sides that stick."
            ),
            [None, Some(high)] => format!(
                "Every solution of Coulomb's law has an energy of at most {high}, guaranteed: that of sides that stick. There is no lower \
                 end, since nothing holds the bodies without friction."
            ),
            [Some(low), None] => {
                format!("Every solution of Coulomb's law has an energy of at least {low}, guaranteed.")
            }
            [None, None] => "No bounds were found for the energy of all solutions of Coulomb's law.".to_string(),
        }
    }

    fn of_the_bound(&self, energy: Option<&Energy>) -> String {
        let error = energy.map_or(String::new(), |energy| {
            format!(
                ", and the stresses are within {} of its exact solution, guaranteed",
                at_most_percent(energy.relative_error_bound)
            )
        });
        let worst = self.distances.iter().flatten().max_by(|a, b| a.relative.total_cmp(&b.relative));
        let distance = worst.map_or(String::new(), |distance| {
            format!(
                " It differs from the coefficient times the pressure of these stresses by {} of the force that friction can carry, and by \
                 at most {} of its largest value at a point.",
                percent(distance.relative),
                percent(distance.largest_relative)
            )
        });
        format!("The friction bound was found after {}{error}.{distance}", counted(self.iterations(), "solution"))
    }

    fn of_how_many(&self) -> String {
        if self.has_several() {
            return format!(
                "There are several solutions: the search from sides that stick and that without friction arrived at bounds that differ by \
                 {} of their size. This report is on the first.",
                percent(self.apart.unwrap_or(0.0))
            );
        }
        let found = if self.apart.is_some() {
            "Both searches, from sides that stick and without friction, arrived at the same bound; whether"
        } else {
            "One search alone arrived; whether"
        };
        format!(
            "{found} there are other solutions is not known, nor how near these fields are to one of Coulomb's law."
        )
    }
}

/// Sentences of a verdict beside the bracket for the bound that was used.
pub fn in_verdict(coulomb: &CoulombSummary) -> String {
    let [of_every_solution, _, of_how_many] = &coulomb.statements;
    let all = [of_every_solution, of_how_many].into_iter().chain(&coulomb.wedging);
    all.map(|sentence| format!(" {sentence}")).collect()
}

fn start(start: &Start) -> CoulombStart {
    let (outcome, iterations) = match start.end {
        End::Arrived(count) => (CoulombOutcome::Arrived, Some(count)),
        End::NoEquilibrium(_) => (CoulombOutcome::NoEquilibrium, None),
        End::Wanders(count, _) => (CoulombOutcome::NotConverged, Some(count)),
    };
    let from = match start.from {
        From::Sticking => "sticking",
        From::Frictionless => "frictionless",
    };
    CoulombStart { from: from.to_string(), outcome, iterations }
}
