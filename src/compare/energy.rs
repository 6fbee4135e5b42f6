//! Energy checks: the bracket, its order, and the identities a solution satisfies.

use super::candidate::{ADMISSIBLE, Judged};
use super::tolerance::Allowances;
use super::{Basis, Check};
use crate::bounds::Bracket;
use crate::dual::DualSolution;
use crate::problem::Problem;

/// Round-off allowed in an identity between energies, relative to 𝒮(λ_h).
const IDENTITY: f64 = 1e-9;
/// What an iterative solver may leave in the identities of a minimiser, relative to 𝒮(λ_h).
const SOLVER: f64 = 1e-7;

/// Checks on the dual solution and its own bracket.
pub fn dual_checks(dual: &DualSolution, bracket: &Bracket, best_upper: f64, allow: &Allowances) -> Vec<Check> {
    let name = "bracket/sharpness";
    let mut checks = vec![Check::at_most(
        name,
        bracket.relative_error(best_upper),
        0.0,
        allow.chosen(name),
        Basis::Chosen,
        "The guaranteed relative energy-norm error has to be small enough for the comparison to mean something.",
    )];
    let name = "dual/equilibrium";
    checks.push(Check::at_most(
        name,
        dual.equilibrium.residual(),
        0.0,
        allow.get(name, dual.accuracy),
        Basis::RoundOff,
        "Tractions are continuous, match the loads, and contacts only push: measured on the stresses, relative to the \
         applied load. What is left of equilibrium has been taken off the lower bound.",
    ));
    match &bracket.free {
        Ok(free) => {
            checks.push(order("free bound", bracket, free.upper(), allow));
            checks.push(two_ways("free bound", bracket, free.potential.total(), free.local.total, allow));
        }
        Err(reason) => checks.push(Check::not_made(
            "energy/lower-below/free bound",
            0.0,
            Basis::Guaranteed,
            format!("No admissible displacement could be built from the dual solution: {reason}."),
        )),
    }
    checks
}

/// Checks on one displacement solution.
pub fn primal_checks(problem: &Problem, bracket: &Bracket, judged: &Judged, allow: &Allowances) -> Vec<Check> {
    let who = judged.candidate.name.as_str();
    let scale = bracket.complementary.strain;
    let own = judged.field.potential;
    let mut checks = Vec::new();
    let name = format!("admissible/{who}");
    checks.push(Check::at_most(
        &name,
        judged.violation.largest(),
        0.0,
        allow.get(&name, ADMISSIBLE),
        Basis::RoundOff,
        format!(
            "Supports are met (off by {:.1e}) and nothing penetrates, between nodes too (by {:.1e}), relative to the \
             largest displacement.",
            judged.violation.support, judged.violation.penetration
        ),
    ));
    checks.push(order(who, bracket, judged.admissible.upper(), allow));
    let admissible = &judged.admissible;
    checks.push(two_ways(who, bracket, admissible.potential.total(), admissible.local.total, allow));
    if let Some(reported) = judged.candidate.reported {
        let name = format!("energy/recomputed/{who}");
        checks.push(Check::equal(
            &name,
            reported,
            own.total(),
            allow.get(&name, IDENTITY * scale.max(own.magnitude)),
            Basis::RoundOff,
            "The energy that the displacement program reports against the energy of its field, integrated here.",
        ));
    }
    if !judged.candidate.is_solution {
        let name = format!("certified/{who}/energy-error");
        checks.push(Check::at_most(
            &name,
            judged.relative_error(bracket),
            0.0,
            allow.chosen(&name),
            Basis::Chosen,
            "The guaranteed relative energy-norm error of the stress of this field, made admissible where it was not: \
             √((𝓛(v) + Π(λ_h)) / 𝒮(λ_h)).",
        ));
    }
    if judged.candidate.is_solution && problem.is_cone() {
        let name = format!("energy/identity/{who}");
        checks.push(Check::equal(
            &name,
            own.total(),
            -own.strain,
            allow.get(&name, SOLVER * scale),
            Basis::RoundOff,
            "With zero gap and zero prescribed displacement the admissible set is a cone, and its minimiser satisfies \
             𝓛(u_h) = −𝒮(τ(u_h)).",
        ));
    }
    let gap = (admissible.potential.total() - bracket.complementary.lower()).max(0.0);
    let name = format!("stress/difference/{who}");
    let difference: f64 = admissible.local.triangles.iter().sum();
    checks.push(Check::at_most(
        &name,
        (2.0 * difference).sqrt(),
        0.0,
        allow.get(&name, (2.0 * gap).sqrt() * (1.0 + IDENTITY) + (2.0 * IDENTITY * scale).sqrt()),
        Basis::Guaranteed,
        "‖λ_h − σ(u_h)‖ in the energy norm: two fields that enclose the same energy cannot be further apart than \
         √(2·gap).",
    ));
    checks
}

/// The larger space has the smaller energy.
pub fn degree_order(judged: &[Judged], bracket: &Bracket, allow: &Allowances) -> Option<Check> {
    let of = |degree: usize| judged.iter().find(|j| j.candidate.degree == degree && j.candidate.is_solution);
    let (p1, p2) = (of(1)?, of(2)?);
    let name = "energy/p1-above-p2";
    let scale = bracket.complementary.strain;
    Some(Check::at_most(
        name,
        p2.field.potential.total(),
        p1.field.potential.total(),
        allow.get(name, SOLVER * scale),
        Basis::RoundOff,
        "Every admissible P1 field is an admissible P2 field, so the P2 minimum cannot be higher.",
    ))
}

fn order(who: &str, bracket: &Bracket, upper: f64, allow: &Allowances) -> Check {
    let name = format!("energy/lower-below/{who}");
    Check::at_most(
        &name,
        bracket.lower(),
        upper,
        allow.get(&name, 0.0),
        Basis::Guaranteed,
        "−Π(λ_h) ≤ 𝓛(u) ≤ 𝓛(v) for every equilibrated stress and every admissible displacement; both sides already \
         contain what rounding can have cost.",
    )
}

fn two_ways(who: &str, bracket: &Bracket, upper: f64, local: f64, allow: &Allowances) -> Check {
    let name = format!("energy/gap-two-ways/{who}");
    Check::equal(
        &name,
        upper - bracket.complementary.lower(),
        local,
        allow.get(&name, IDENTITY * bracket.complementary.strain + bracket.lower_widening),
        Basis::RoundOff,
        "The gap from the two energies, and from local integration of the constitutive error and the contact \
         complementarity.",
    )
}
