//! Energy checks: the bracket, its order, and the identities that a solution satisfies.

use super::balance::Balance;
use super::candidate::{ADMISSIBLE, Candidate, Judged};
use super::ceiling::{Allowance, Ceilings, MISTAKE, PART};
use super::name::{FREE_BOUND, Name, OfField, OfRun, of_order};
use super::solution::{Site, Sites};
use super::tolerance::chosen;
use super::{Basis, Check};
use crate::bounds::energy::initial_work;
use crate::bounds::{Bracket, UpperBound, Violation, holds, work_of_remainders};
use crate::dual::DualSolution;
use crate::problem::{Problem, Scales};

/// Round-off allowed in an identity between energies, relative to 𝒮(λ_h).
const IDENTITY: f64 = 1e-9;
/// Change of a penetration, relative to the largest displacement, by rounding to single precision: a coefficient of the
/// jump is a combination of six rounded values with weights that add up to six.
const SINGLE: f64 = 6.0 * f32::EPSILON as f64;
/// Error that an iterative solver may leave in the identities of a minimiser, relative to 𝒮(λ_h).
const SOLVER: f64 = 1e-7;

/// Checks on the dual solution and its own bracket.
pub fn dual_checks(
    problem: &Problem,
    scales: &Scales,
    (dual, bracket): (&DualSolution, &Bracket),
    best_upper: f64,
) -> Vec<Check> {
    let mut checks = vec![sharpness(bracket, best_upper)];
    checks.push(Check::at_most(
        OfRun::DualEquilibrium.name(),
        dual.equilibrium.residual(),
        0.0,
        dual.accuracy,
        Basis::RoundOff,
        "Tractions are continuous, match the loads, and contacts only push: measured on the stresses, relative to the \
         applied load. What is left of equilibrium has been taken off the lower bound.",
    ));
    match &bracket.free {
        Ok(free) => {
            checks.push(order(FREE_BOUND, bracket, free.upper()));
            checks.push(two_ways(problem, scales, (dual, bracket), FREE_BOUND, free));
        }
        Err(reason) => checks.push(Check::not_made(
            &OfField::LowerBelow.of(FREE_BOUND),
            0.0,
            Basis::Guaranteed,
            format!("No admissible displacement could be built from the dual solution: {reason}."),
        )),
    }
    checks
}

/// Checks on one displacement solution.
pub fn primal_checks(
    problem: &Problem,
    (scales, ceilings): (&Scales, &Ceilings),
    (dual, bracket): (&DualSolution, &Bracket),
    judged: &Judged,
) -> Vec<Check> {
    let who = judged.candidate.name.as_str();
    let own = judged.own;
    let (strain, scale) = (bracket.complementary.stored(), bracket.complementary.stored().max(own.magnitude));
    let rounding = energy_rounding(scales, judged);
    let mut checks = Vec::new();
    let name = OfField::Admissible.of(who);
    let Violation { support, penetration, at_vertices } = judged.violation;
    // Where the direction of contact turns or the gap is a curve, the minimiser of P1 bounds the jump at vertices alone.
    let at_vertices_alone = linear_where_jumps_bend(problem, judged);
    let (depth, where_to) = match at_vertices_alone {
        true => {
            (at_vertices, format!("at vertices (by {at_vertices:.1e}; by {penetration:.1e} between them, drawn back)"))
        }
        false => (penetration, format!("between nodes too (by {penetration:.1e})")),
    };
    let why = format!(
        "An admissible displacement meets its supports (off by {support:.1e}) and penetrates nowhere, {where_to}, \
         relative to the largest displacement.{}",
        deepest(problem, &judged.candidate)
    );
    let basis = if judged.candidate.is_solution { Basis::RoundOff } else { Basis::Claimed };
    let admissible = |allowed| Check::at_most(&name, support.max(depth), 0.0, allowed, basis, why.as_str());
    checks.push(of_admissible(judged).check_of_large(admissible));
    checks.push(order(who, bracket, judged.admissible.upper()));
    let admissible = &judged.admissible;
    checks.push(two_ways(problem, scales, (dual, bracket), who, admissible));
    let claims = [
        (OfField::Recomputed, judged.candidate.reported, own.total()),
        (OfField::Strain, judged.candidate.reported_strain, own.stored()),
    ];
    for (what, reported, found) in claims {
        let Some(reported) = reported else { continue };
        let why = format!(
            "The energy that the displacement program reports against the energy of its field, integrated here. {}",
            lost_digits(rounding, IDENTITY * scale)
        );
        let name = what.of(who);
        let equal = |allowed| Check::equal(&name, reported, found, allowed, Basis::RoundOff, why.as_str());
        checks.push(of_energy(ceilings, IDENTITY * strain, IDENTITY * scale + rounding).check_of_large(equal));
    }
    if !judged.candidate.is_solution {
        let name = OfField::EnergyError.of(who);
        checks.push(Check::at_most(
            &name,
            judged.relative_error(bracket),
            0.0,
            chosen("energy-error"),
            Basis::Chosen,
            "The guaranteed relative energy-norm error of the stress of this field, made admissible where it was not: \
             √((𝓛(v) + Π(λ_h)) / 𝒮(λ_h)).",
        ));
    }
    if judged.candidate.is_solution && problem.is_cone() && has_identity(problem, judged) {
        let name = OfField::Identity.of(who);
        let initial = initial_work(problem, &judged.field.displacement);
        let why = if initial == 0.0 {
            "With zero gap and zero prescribed displacement the admissible set is a cone, and its minimiser satisfies \
             𝓛(u_h) = −𝒮(τ(u_h))."
        } else {
            "With zero gap and zero prescribed displacement the admissible set is a cone, and its minimiser satisfies \
             𝓛(u_h) = −𝒮(τ(u_h)) − ∫τ(u_h):ε0 with the initial strain ε0."
        };
        let equal = |allowed| Check::equal(&name, own.total(), -own.stored() - initial, allowed, Basis::RoundOff, why);
        checks.push(of_energy(ceilings, SOLVER * strain, SOLVER * scale + rounding).check_of_large(equal));
    }
    if let Some(balance) = &judged.balance {
        checks.push(in_its_own_space(who, (scales, ceilings), balance, own.stored()));
        checks.extend(judged.candidate.reactions.as_ref().map(|_| reactions(who, (scales, ceilings), balance)));
    }
    let gap = (admissible.upper() - bracket.lower()).max(0.0);
    let name = OfField::StressDifference.of(who);
    let difference: f64 = admissible.local.triangles.iter().sum();
    let why = "‖λ_h − σ(u_h)‖ in the energy norm: two fields that enclose the same energy cannot be further apart than \
         √(2·gap).";
    let apart = |slack: f64| (2.0 * gap).sqrt() * (1.0 + IDENTITY) + (2.0 * slack).sqrt();
    let differs = |slack| Check::at_most(&name, (2.0 * difference).sqrt(), 0.0, apart(slack), Basis::Guaranteed, why);
    let slack = [strain, scale].map(|scale| IDENTITY * scale + scales.round_off.energy);
    checks.push(of_energy(ceilings, slack[0], slack[1]).check_of_large(differs));
    if !judged.candidate.is_polynomial() {
        use OfField::{GapTwoWays, LowerBelow, StressDifference};
        let of_another = |check: &&mut Check| {
            matches!(Name::read(&check.name), Name::Field(LowerBelow | GapTwoWays | StressDifference, _))
        };
        checks.iter_mut().filter(of_another).for_each(|check| {
            check.why.push_str(" Of the polynomials on triangles that have the values of this field.")
        });
    }
    checks
}

/// True if the energy identity holds for the field as represented: on quadrilaterals initial strains are integrated by another rule.
fn has_identity(problem: &Problem, judged: &Judged) -> bool {
    judged.candidate.is_polynomial() || problem.scene.bodies.iter().all(|body| body.initial.is_none())
}

/// Allowed error of an energy: `exact` for a field of the size that the problem allows, `all` for this field.
fn of_energy(ceilings: &Ceilings, exact: f64, all: f64) -> Allowance {
    Allowance { exact, digits: (all - exact).max(0.0), ceiling: ceilings.energy }
}

/// Allowed violation of supports and contact by an admissible field, relative to its largest displacement.
fn of_admissible(judged: &Judged) -> Allowance {
    let exact = ADMISSIBLE / judged.larger;
    let rounded = !judged.candidate.is_solution && judged.candidate.precision >= f64::from(f32::EPSILON);
    let all = if rounded { SINGLE } else { ADMISSIBLE };
    Allowance { exact, digits: all - exact, ceiling: PART * MISTAKE / judged.larger }
}

/// A sentence on the contact and node with the deepest penetration; empty if no node penetrates.
fn deepest(problem: &Problem, candidate: &Candidate) -> String {
    let Ok(holds) = holds(problem) else { return String::new() };
    let sites = Sites::new(problem, candidate.degree, &holds);
    let depth = |site: &Site| site.excess(|node| candidate.value(node));
    let deepest = sites.list.iter().max_by(|a, b| depth(a).total_cmp(&depth(b)));
    let Some(site) = deepest.filter(|site| depth(site) > ADMISSIBLE * candidate.largest()) else {
        return String::new();
    };
    let (contact, place) = (&problem.interfaces[site.interface].name, candidate.named(problem, site.first));
    format!(" Contact {contact} is penetrated most, by {:.3e}, at {place}.", depth(site))
}

/// True if a field is a P1 solution of a problem in which the direction of contact turns along edges or gaps are curved.
fn linear_where_jumps_bend(problem: &Problem, judged: &Judged) -> bool {
    judged.candidate.is_solution && judged.candidate.degree == 1 && problem.jumps_bend()
}

/// The larger space has the smaller energy: one check for each degree and the next on the same cells.
pub fn degree_order(
    problem: &Problem,
    (scales, ceilings): (&Scales, &Ceilings),
    judged: &[Judged],
    bracket: &Bracket,
) -> Vec<Check> {
    let solutions = |letter: char| {
        let of = |j: &&Judged| j.candidate.is_solution && j.candidate.letter() == letter;
        let mut solutions: Vec<&Judged> = judged.iter().filter(of).collect();
        solutions.sort_by_key(|j| j.candidate.degree);
        solutions
    };
    let check = |letter: char, pair: &[&Judged]| {
        let [low, high] = [pair[0], pair[1]];
        let [p, q] = [low, high].map(|j| j.candidate.degree);
        let magnitude = low.own.magnitude.max(high.own.magnitude);
        let strain = bracket.complementary.stored();
        let (lower, rounding) = (high.own.total(), energy_rounding(scales, low) + energy_rounding(scales, high));
        let upper = if linear_where_jumps_bend(problem, low) { low.admissible.upper() } else { low.own.total() };
        let why = format!(
            "Every admissible {letter}{p} field is an admissible {letter}{q} field, so the {letter}{q} minimum cannot be higher."
        );
        let name = of_order(letter, p, q);
        let ordered = |allowed| Check::at_most(&name, lower, upper, allowed, Basis::RoundOff, why.as_str());
        of_energy(ceilings, SOLVER * strain, SOLVER * strain.max(magnitude) + rounding).check_of_large(ordered)
    };
    // Drawn back between its vertices, a Q1 field is none of Q2.
    let nested = |letter: char, low: &Judged| letter == 'P' || !linear_where_jumps_bend(problem, low);
    let of_letter = |letter: char| {
        let solutions = solutions(letter);
        let rises = |pair: &&[&Judged]| pair[0].candidate.degree < pair[1].candidate.degree;
        let rising = solutions.windows(2).filter(rises).filter(|pair| nested(letter, pair[0]));
        rising.map(|pair| check(letter, pair)).collect::<Vec<Check>>()
    };
    ['P', 'Q'].into_iter().flat_map(of_letter).collect()
}

/// Check that a bracket is narrow enough to tell two models apart.
pub fn sharpness(bracket: &Bracket, best_upper: f64) -> Check {
    Check::at_most(
        OfRun::Sharpness.name(),
        bracket.relative_error(best_upper),
        0.0,
        chosen("sharpness"),
        Basis::Chosen,
        "The guaranteed relative energy-norm error has to be small enough for the comparison to mean something.",
    )
}

/// Check of −Π(λ_h) ≤ 𝓛(v).
pub fn order(who: &str, bracket: &Bracket, upper: f64) -> Check {
    let name = OfField::LowerBelow.of(who);
    if !upper.is_finite() {
        let why = format!(
            "The energy of {who} is no finite number: its displacement is too large for numbers in double precision."
        );
        return Check::not_made(&name, 0.0, Basis::Guaranteed, why);
    }
    Check::at_most(
        &name,
        bracket.lower(),
        upper,
        0.0,
        Basis::Guaranteed,
        "−Π(λ_h) ≤ 𝓛(u) ≤ 𝓛(v) for every equilibrated stress and every admissible displacement; both sides already \
         contain what rounding can have cost.",
    )
}

fn two_ways(
    problem: &Problem,
    scales: &Scales,
    (dual, bracket): (&DualSolution, &Bracket),
    who: &str,
    upper: &UpperBound,
) -> Check {
    let name = OfField::GapTwoWays.of(who);
    let scale = bracket.complementary.stored().max(upper.potential.magnitude);
    let gap = upper.potential.total() - bracket.complementary.lower();
    let mut allowed = IDENTITY * scale + bracket.lower_widening + upper.widening + scales.round_off.energy;
    if (gap - upper.local.total).abs() > allowed {
        // The lower bound weighs what is left of equilibrium with the displacement of the dual solution, the identity with
        // this one.
        allowed += work_of_remainders(problem, dual, &upper.displacement);
    }
    Check::equal(
        &name,
        gap,
        upper.local.total,
        allowed,
        Basis::RoundOff,
        "The gap from the two energies, and from local integration of the constitutive error and the contact \
         complementarity.",
    )
}

/// Equilibrium of a solution in its own space.
fn in_its_own_space(who: &str, (scales, ceilings): (&Scales, &Ceilings), balance: &Balance, strain: f64) -> Check {
    // Forces that could hold no more energy than rounding of the data are none.
    let none = (2.0 * scales.round_off.energy).sqrt();
    let scale = balance.scale.max(none);
    let relative = |left: f64| if scale > 0.0 { left / scale } else { left };
    let place = balance.worst.map_or(String::new(), |([x, y], _)| format!(" Most is left at ({x:.6}, {y:.6})."));
    let name = OfField::Equilibrium.of(who);
    let why = format!(
        "A displacement solution balances the loads on every basis function of its space, with supports and with \
         contacts that push where they are closed: what is left of the nodal forces, integrated here, relative to \
         all of them.{place} {}",
        lost_digits(relative(balance.rounding), SOLVER)
    );
    let left = |allowed| Check::at_most(&name, relative(balance.left), 0.0, allowed, Basis::RoundOff, why.as_str());
    let ceiling = ceilings.extent.rounding_of_forces(balance.load, balance.supported, strain) + ceilings.of_data;
    Allowance { exact: SOLVER + relative(none), digits: relative(balance.rounding), ceiling: relative(ceiling) }
        .check_of_large(left)
}

/// Check of reported reactions against those in equilibrium with the displacement, on the interface with the largest excess.
fn reactions(who: &str, (scales, ceilings): (&Scales, &Ceilings), balance: &Balance) -> Check {
    let allowed = |i: usize| SOLVER * balance.carried[i] + balance.reaction_tolerance(i) + scales.round_off.force;
    let excess = |i: usize| balance.reactions[i] - allowed(i);
    let worst = (0..balance.reactions.len()).max_by(|&i, &j| excess(i).total_cmp(&excess(j)));
    let name = OfField::Reactions.of(who);
    let value = worst.map_or(0.0, |i| balance.reactions[i]);
    let all = worst.map_or(0.0, allowed);
    let exact = all.min(SOLVER * ceilings.force + scales.round_off.force);
    let why = "Every contact reaction that the displacement program reports is the one its stresses ask for, where a single contact \
         acts on a vertex, and the reported resultant is their sum.";
    Allowance { exact, digits: all - exact, ceiling: ceilings.force }
        .check_of_large(|allowed| Check::at_most(&name, value, 0.0, allowed, Basis::RoundOff, why))
}

/// Possible error of an energy of the displacement program by rounding of its displacements.
fn energy_rounding(scales: &Scales, judged: &Judged) -> f64 {
    judged.balance.as_ref().map_or(0.0, |balance| balance.energy_rounding) + scales.round_off.energy
}

/// A sentence for the case that the displacement side has lost digits, otherwise empty.
fn lost_digits(rounding: f64, usual: f64) -> &'static str {
    if rounding > usual {
        "Most of the allowance is rounding of the displacements, which are large beside what they strain the bodies by, or \
         nearly incompressible: the displacement side has lost digits here."
    } else {
        ""
    }
}
