//! Fields that claim to be discrete solutions: their checks, and what explains a claim that does not hold.

use crate::bounds::{Bracket, NoUpperBound, lifted_within, potential};
use crate::compare::forces::cells;
use crate::compare::forces::turned::Kind;
use crate::compare::name::{Name, OfRun, OfSolutionContact};
use crate::compare::{
    ADMISSIBLE, Allowances, Basis, Candidate, Check, Comparison, Extent, Judged, Nonmatching, Solution,
};
use crate::diagnose::{Diagnosis, Energies, diagnose, in_the_mean};
use crate::problem::{Note, Problem, Scales, follows_coulomb};

/// The result of holding a field to its claim.
#[derive(Debug, Clone, PartialEq)]
pub struct Claim {
    /// One check for each property of a discrete solution.
    pub checks: Vec<Check>,
    /// The explanation of those that fail; `None` where there is none.
    pub diagnosis: Option<Diagnosis>,
    /// The residual, triangle by triangle.
    pub residual: Vec<f64>,
    /// One remark for each contact that holds in the mean and not at nodes.
    pub notes: Vec<Note>,
}

/// A field whose guaranteed relative error is larger than this is no solution of anything.
const NO_SOLUTION: f64 = 1.0;

/// What is said of a field that follows Coulomb's law with the pressure of the stresses in the place of its own.
const BOUNDED_BY_STRESSES: &str = "The friction of this field is bounded by the coefficient times the contact pressure of the stresses, as that of the \
    displacement models of `hypercircle verify` is, and not by its own contact forces: it is the discrete solution with that bound.";

/// Holds a field against everything that is true of a discrete solution of its degree on its mesh; `bracket` is that of the stress
/// side, which says how large a solution can be. With `weak` its contact claims to hold in the mean over edges.
///
/// # Errors
/// [`NoUpperBound`] where supports contradict each other.
pub fn claim(
    problem: &Problem,
    judged: &Judged,
    bracket: &Bracket,
    weak: bool,
    allow: &Allowances,
) -> Result<Claim, NoUpperBound> {
    let problem = &*problem.softened();
    let own = problem.bounded_by_contact_forces();
    let own = own.with_whole_tractions();
    let scales = Scales::new(problem).from_closed_contacts(problem);
    let held_to = |problem| {
        let solution = Solution::new(problem, &judged.candidate, judged.field.potential.stored())?;
        let solution = solution.within(Extent::of(problem, bracket)).with_weak_contact(weak);
        let checks = solution.checks(&scales, allow);
        Ok((solution, checks))
    };
    let (mut solution, mut checks) = held_to(&own)?;
    let holds = |checks: &[Check]| checks.iter().all(|check| check.passed || !check.decides());
    let bounded = problem.with_whole_tractions();
    let mut notes = Vec::new();
    if follows_coulomb(&problem.scene) && !holds(&checks) {
        let (other, others) = held_to(&bounded)?;
        if holds(&others) {
            (solution, checks) = (other, others);
            notes.push(Note { weakens_guarantee: false, text: BOUNDED_BY_STRESSES.to_string() });
        }
    }
    let diagnosis = checks
        .iter()
        .any(|c| (!c.passed && c.decides() && c.value.is_some()) || c.excused)
        .then(|| explained(solution.problem, judged, &solution, bracket));
    let weakly = weak_notes(&solution, || energies(problem, judged));
    let at_nodes = checks.iter_mut().filter(|check| {
        matches!(Name::read(&check.name), Name::SolutionContact(OfSolutionContact::PenetrationAtNodes, _))
    });
    at_nodes.zip(&weakly).for_each(|(check, note)| check.why.clone_from(&note.text));
    notes.extend(weakly);
    Ok(Claim { diagnosis: diagnosis.flatten(), residual: solution.by_triangle(), notes, checks })
}

/// A claim that is held against nothing, for this reason.
fn not_held(problem: &Problem, why: &str) -> Claim {
    Claim {
        checks: vec![Check::not_made(OfRun::Residual.name(), ADMISSIBLE, Basis::Claimed, why.to_string())],
        diagnosis: None,
        residual: vec![0.0; problem.mesh.triangles.len()],
        notes: Vec::new(),
    }
}

fn weak_notes(solution: &Solution<'_>, energies: impl Fn() -> Energies) -> Vec<Note> {
    let sentences = in_the_mean(solution, energies);
    sentences.into_iter().map(|text| Note { weakens_guarantee: false, text }).collect()
}

/// One remark for each contact of a field that claims to hold in the mean and not at nodes; `None` where a support or a contact of it
/// holds neither way.
pub fn weak_contact(problem: &Problem, judged: &Judged) -> Option<Vec<Note>> {
    let problem = &*problem.softened();
    let own = problem.with_whole_tractions();
    let solution =
        Solution::new(&own, &judged.candidate, judged.field.potential.stored()).ok()?.with_weak_contact(true);
    let contacts = (0..problem.interfaces.len()).all(|i| solution.is_met(i) || solution.holds_weakly(i).is_some());
    (judged.violation.support <= ADMISSIBLE && contacts).then(|| weak_notes(&solution, || energies(problem, judged)))
}

/// As [`claim`], for the solution of a method whose contact sides have different vertices: `own` is the solution on the triangles of
/// its file, those of `before`, from which `problem` was made. Nothing is fitted to it.
///
/// # Errors
/// As [`claim`].
pub fn claim_before_contact(
    problem: &Problem,
    (before, own): (&Problem, &Candidate),
    judged: &Judged,
    bracket: &Bracket,
    weak: bool,
    allow: &Allowances,
) -> Result<Claim, NoUpperBound> {
    if problem.has_elastic_contact() {
        let why = "Elastic contact of sides with different vertices is not held against the pressures that it asks for: export the field \
                   on the mesh of `hypercircle mesh`, where they match.";
        return Ok(not_held(problem, why));
    }
    let before = &*before.with_whole_tractions();
    // Which rule a program used on quadrilaterals shows once its contact forces are taken away.
    let made = |points| {
        let solution = Solution::by_rule(before, own, judged.field.potential.stored(), points)?
            .within(Extent::of(before, bracket));
        Ok(Nonmatching::new(solution.with_weak_contact(weak), problem))
    };
    let tried = cells::rules(own).into_iter().map(made).collect::<Result<Vec<_>, NoUpperBound>>()?;
    let best = tried.into_iter().min_by(|a, b| a.solution.residual().total_cmp(&b.solution.residual()));
    let solution = best.map_or_else(|| made(None), Ok)?;
    let checks = solution.checks(&Scales::new(problem).from_closed_contacts(problem), allow);
    Ok(Claim { checks, diagnosis: None, residual: solution.by_triangle(), notes: Vec::new() })
}

/// The part of the squared residual that a diagnosis explains, beyond which no other rule of integration is tried.
const EXPLAINED: f64 = 1.0 - 1e-8;

/// A rule of integration that leaves more than this many times the residual of the best one is not that of a program whose field this is.
const FAR: f64 = 10.0;

/// The best explanation of a field: on quadrilaterals by whichever rule its program may have used.
fn explained(problem: &Problem, judged: &Judged, solution: &Solution<'_>, bracket: &Bracket) -> Option<Diagnosis> {
    let energies = energies(problem, judged);
    let own = diagnose(solution, energies);
    let is_explained = |found: &Option<Diagnosis>| found.as_ref().is_none_or(|d| d.explained.is_none_or(|e| e > 0.0));
    if let Some(rule) = solution.rule {
        let share = |found: &Diagnosis| found.explained.unwrap_or(0.0);
        if own.as_ref().is_some_and(|own| share(own) > EXPLAINED) {
            return own;
        }
        // The rule with which a wrong field fits best need not be that of its program, with which one mistake explains all.
        let kinds = [Kind::Triangles, Kind::Quadrilaterals].into_iter();
        let others =
            kinds.flat_map(|kind| rule.others(problem, &judged.candidate, kind)).filter(|other| *other != rule);
        let by = |rule| {
            let other = Solution::turned(problem, &judged.candidate, rule).ok()?.within(Extent::of(problem, bracket));
            if other.residual() > FAR * solution.residual() {
                return None;
            }
            diagnose(&other, energies)
        };
        let best = others.filter_map(by).max_by(|a, b| share(a).total_cmp(&share(b)));
        return match (own, best) {
            (Some(own), Some(best)) if share(&best) > share(&own) => Some(best),
            (own, _) => own,
        };
    }
    if is_explained(&own) {
        return own;
    }
    let strain = judged.field.potential.stored();
    let others = cells::rules(&judged.candidate).into_iter().filter(|points| *points != solution.points);
    let by = |points| {
        let other =
            Solution::by_rule(problem, &judged.candidate, strain, points).ok()?.within(Extent::of(problem, bracket));
        diagnose(&other, energies).map(Some).filter(is_explained)
    };
    others.into_iter().find_map(by).unwrap_or(own)
}

/// Checks with the sharpest `bracket` of a run that a field may be called a solution at all: its guaranteed error is at most 100 %.
pub fn error_check(judged: &Judged, bracket: &Bracket, allow: &Allowances) -> Check {
    let mut checks = [Check::at_most(
        OfRun::GuaranteedError.name(),
        judged.relative_error(bracket),
        0.0,
        NO_SOLUTION,
        Basis::Claimed,
        "The guaranteed relative energy-norm error of the stress of the field, made admissible where it was not. Beyond 100 % a \
         stress of zero is closer to the truth, and the field is not called a solution: refine its mesh.",
    )];
    allow.apply(&mut checks);
    let [check] = checks;
    check
}

/// Explanations of solutions of a displacement model that fail checks of their own; only of degree 1 and 2, to whose nodal forces
/// the hypotheses are fitted. `bracket` is that of the stress side.
pub fn diagnoses(problem: &Problem, comparison: &Comparison, bracket: &Bracket) -> Vec<Diagnosis> {
    let problem = &*problem.softened();
    let wrong = |judged: &&Judged| {
        let name = &judged.candidate.name;
        let own = |check: &&Check| Name::read(&check.name).field() == Some(name);
        let failed = comparison.checks.iter().filter(own).any(|check| !check.passed && check.decides());
        failed && judged.candidate.is_solution && judged.candidate.higher.is_none()
    };
    let explained = |judged: &Judged| {
        let solution = Solution::new(problem, &judged.candidate, judged.field.potential.stored()).ok()?;
        let solution = solution.within(Extent::of(problem, bracket));
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
    // A field on quadrilaterals is changed in no space of triangles.
    let lifted = if judged.is_admissible() || !candidate.cells.is_empty() { None } else { lifted() };
    Energies {
        own: own.total(),
        admissible: lifted.map(|field| potential(problem, &field).total()),
        reported: reported.map(|(whole, strain)| [whole / own.total(), strain / own.stored()]),
    }
}
