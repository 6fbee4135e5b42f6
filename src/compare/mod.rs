//! The dual solution against displacement models: energies, contact pressure, stresses, verdict.

mod balance;
mod candidate;
mod ceiling;
mod check;
pub mod contact;
mod energy;
pub mod forces;
pub mod name;
mod on_quadrilaterals;
mod outcome;
mod revolved;
pub mod solution;
mod stress;
mod tolerance;

pub use balance::Balance;
pub use candidate::{ADMISSIBLE, Candidate, FrictionForces, Judged, Reactions};
pub use ceiling::Extent;
pub use check::{Basis, Check};
pub use contact::friction::{BoundDistance, FrictionState, FrictionSummary, FrictionZone};
pub use contact::mean::MeanPressure;
pub use contact::pressure::weighted_reactions;
pub use forces::NodalForces;
pub use name::{Name, names_of_checks};
pub use on_quadrilaterals::QuadrilateralSolution;
pub use outcome::{ComponentDifference, ContactSummary, Profile, StressSummary, TwoSides};
pub use solution::{Nonmatching, Numbering, Solution};
pub use stress::{primal_means, von_mises_map, von_mises_of, von_mises_of_field, von_mises_of_means};
pub use tolerance::{Allowances, BLUNT, CHOSEN, SHARP, chosen};

use ceiling::Ceilings;
use name::OfField;

use crate::bounds::{Bracket, UpperBound};
use crate::dual::DualSolution;
use crate::problem::{Problem, Scales};

/// The results of a comparison.
#[derive(Debug, Clone)]
pub struct Comparison {
    /// The candidates, evaluated.
    pub judged: Vec<Judged>,
    /// Index of the best candidate: the lowest admissible energy among those that are admissible as delivered, or among
    /// all if none is.
    pub best: Option<usize>,
    /// Contact, interface by interface.
    pub contacts: Vec<ContactSummary>,
    /// Stress against the best candidate.
    pub stress: Option<StressSummary>,
    /// Every check.
    pub checks: Vec<Check>,
}

impl Comparison {
    /// True if every deciding check passed.
    pub fn agrees(&self) -> bool {
        self.checks.iter().all(|c| c.passed || !c.decides())
    }

    /// Also compares the energies of the candidates with the lower bound of a finer mesh, on which their displacements are defined too.
    pub fn against_finer(&mut self, finer: &Bracket, allow: &Allowances) {
        let upper = self.upper(finer).map_or(f64::INFINITY, |(upper, _)| upper.upper());
        let sharper =
            self.judged.iter().map(|judged| energy::order(&judged.candidate.name, finer, judged.admissible.upper()));
        let mut sharper: Vec<Check> = sharper.chain([energy::sharpness(finer, upper)]).collect();
        allow.apply(&mut sharper);
        for new in sharper {
            if let Some(check) = self.checks.iter_mut().find(|check| check.name == new.name) {
                *check = new;
            }
        }
    }

    /// The best upper bound with the name of the field it comes from.
    pub fn upper<'a>(&'a self, bracket: &'a Bracket) -> Option<(&'a UpperBound, &'a str)> {
        let free = bracket.free.iter().map(|f| (f, "free"));
        // What is no polynomial on triangles is bounded by the energy of another field.
        let own = self.judged.iter().filter(|j| j.candidate.is_polynomial());
        let delivered = own.map(|j| (&j.admissible, j.candidate.name.as_str()));
        free.chain(delivered).min_by(|a, b| a.0.upper().total_cmp(&b.0.upper()))
    }
}

/// Compares the dual solution with any number of displacement fields.
pub fn compare(
    problem: &Problem,
    dual: &DualSolution,
    bracket: &Bracket,
    candidates: Vec<Candidate>,
    allow: &Allowances,
) -> Comparison {
    // To displacements elastic contact is springs that do not pull.
    let soft = &*problem.softened();
    let scales = Scales::new(problem).from_closed_contacts(problem);
    let ceilings = Ceilings::new(problem, &scales, (dual, bracket));
    let mut refused = Vec::new();
    let mut judged = Vec::new();
    for candidate in candidates {
        let name = candidate.name.clone();
        match Judged::new(soft, dual, candidate, ceilings.extent) {
            Ok(j) => judged.push(j),
            Err(reason) => refused.push(Check::not_made(
                &OfField::Admissible.of(&name),
                ADMISSIBLE,
                Basis::RoundOff,
                format!("No admissible displacement is near this field: {reason}."),
            )),
        }
    }
    let rank = |j: &Judged| (!j.is_admissible(), j.admissible.upper());
    let best = (0..judged.len()).min_by(|&a, &b| {
        let (a, b) = (rank(&judged[a]), rank(&judged[b]));
        a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
    });
    let mut comparison = Comparison { judged, best, contacts: Vec::new(), stress: None, checks: Vec::new() };
    let upper = comparison.upper(bracket).map_or(f64::INFINITY, |(u, _)| u.upper());
    comparison.checks = energy::dual_checks(problem, &scales, (dual, bracket), upper);
    comparison.checks.extend(refused);
    for judged in &comparison.judged {
        comparison.checks.extend(energy::primal_checks(soft, (&scales, &ceilings), (dual, bracket), judged));
    }
    comparison.checks.extend(energy::degree_order(soft, (&scales, &ceilings), &comparison.judged, bracket));
    let best = comparison.best.map(|b| &comparison.judged[b]);
    let gap = (upper - bracket.lower()).max(0.0);
    let sides = contact::Sides { problem, scales: &scales, ceilings: &ceilings, dual, gap, best };
    let (contacts, checks) = sides.compare(&comparison.judged);
    comparison.stress = best.map(|b| stress::compare(problem, dual, bracket.complementary.strain, b));
    comparison.contacts = contacts;
    comparison.checks.extend(checks);
    allow.apply(&mut comparison.checks);
    comparison
}
