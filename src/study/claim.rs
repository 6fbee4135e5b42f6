//! Fields that claim to be discrete solutions: their checks, and what explains a claim that does not hold.

use crate::bounds::{NoUpperBound, lifted_within, potential};
use crate::compare::{Allowances, Check, Comparison, Judged, Solution};
use crate::diagnose::{Diagnosis, Energies, diagnose};
use crate::problem::{Problem, Scales};

/// What holding a field to its claim gives.
#[derive(Debug, Clone, PartialEq)]
pub struct Claim {
    /// One check for each property of a discrete solution.
    pub checks: Vec<Check>,
    /// What explains those that fail; `None` where none does.
    pub diagnosis: Option<Diagnosis>,
    /// The residual, triangle by triangle.
    pub residual: Vec<f64>,
}

/// Holds a field against everything that is true of a discrete solution of its degree on its mesh.
///
/// # Errors
/// [`NoUpperBound`] where supports contradict each other.
pub fn claim(problem: &Problem, judged: &Judged, allow: &Allowances) -> Result<Claim, NoUpperBound> {
    let solution = Solution::new(problem, &judged.candidate, judged.field.potential.strain)?;
    let checks = solution.checks(&Scales::new(problem).from_closed_contacts(problem), allow);
    let diagnosis =
        checks.iter().any(|c| !c.passed || c.excused).then(|| diagnose(&solution, energies(problem, judged)));
    Ok(Claim { diagnosis: diagnosis.flatten(), residual: solution.by_triangle(), checks })
}

/// What explains the solutions of a displacement model that checks of their own say are none; of those of degree 1 and 2, whose
/// nodal forces the hypotheses are fitted to.
pub fn diagnoses(problem: &Problem, comparison: &Comparison) -> Vec<Diagnosis> {
    let wrong = |judged: &&Judged| {
        let name = &judged.candidate.name;
        let own = |check: &&Check| check.name.ends_with(name.as_str());
        let failed = comparison.checks.iter().filter(own).any(|check| !check.passed && check.decides());
        failed && judged.candidate.is_solution && judged.candidate.higher.is_none()
    };
    let explained = |judged: &Judged| {
        let solution = Solution::new(problem, &judged.candidate, judged.field.potential.strain).ok()?;
        diagnose(&solution, energies(problem, judged))
    };
    comparison.judged.iter().filter(wrong).filter_map(explained).collect()
}

fn energies(problem: &Problem, judged: &Judged) -> Energies {
    let own = judged.field.potential;
    let candidate = &judged.candidate;
    let reported = candidate.reported.zip(candidate.reported_strain);
    let lifted =
        || lifted_within(problem, &candidate.vertex, &candidate.middle, candidate.degree.min(2)).ok().flatten();
    // What is admissible already is changed by nothing.
    let lifted = if judged.is_admissible() { None } else { lifted() };
    Energies {
        own: own.total(),
        admissible: lifted.map(|field| potential(problem, &field).total()),
        reported: reported.map(|(whole, strain)| [whole / own.total(), strain / own.strain]),
    }
}
