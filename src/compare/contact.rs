//! Contact checks, interface by interface.

use super::candidate::Judged;
use super::nodal::{self, NodalDifference, nodal_pressures};
use super::outcome::{ContactSummary, Profile, TwoSides};
use super::pressure::{
    Piece, contact_ends, disagreement, dual_pressure, l2, maximum, open_length, profile, reaction_moment,
    reaction_pressure, resultant, trace_pressure,
};
use super::resultant::{forces, resultant_check};
use super::tolerance::Allowances;
use super::{Basis, Check};
use crate::bounds::Bracket;
use crate::dual::DualSolution;
use crate::problem::{Interface, Problem};

/// Pressures below this fraction of the largest count as none.
const NO_PRESSURE: f64 = 1e-9;
/// Reactions below this fraction of the largest are what a solver leaves of zero.
const NO_REACTION: f64 = 1e-7;
/// A trace scatters around zero where the bodies are apart, by a few per cent of the largest pressure.
const NO_TRACE: f64 = 0.05;
/// Edges on which the models may disagree about contact, at its end.
const SETTLED: f64 = 3.0;
/// Round-off and solver accuracy of a single reaction, relative to all forces.
const REACTION: f64 = 1e-8;

/// Compares the contacts; `best` is the displacement solution to compare with, `all` those to draw.
pub fn compare(
    problem: &Problem,
    dual: &DualSolution,
    bracket: &Bracket,
    best: Option<&Judged>,
    all: &[Judged],
    allow: &Allowances,
) -> (Vec<ContactSummary>, Vec<Check>) {
    let (mut summaries, mut checks) = (Vec::new(), Vec::new());
    for (index, interface) in problem.interfaces.iter().enumerate() {
        let own = dual_pressure(dual, index);
        let length: f64 = interface.pairs.iter().map(|p| p.length).sum();
        let (force, moment) = resultant(problem, interface, &own);
        let (largest, at) = maximum(problem, interface, &own);
        let threshold = NO_PRESSURE * largest;
        let mut summary = ContactSummary {
            name: interface.name.clone(),
            resultant: TwoSides { dual: force, primal: None },
            moment: TwoSides { dual: moment, primal: None },
            pressure_max: TwoSides { dual: largest, primal: None },
            pressure_max_at: TwoSides { dual: at, primal: None },
            open_fraction: open_length(interface, &own, threshold) / length,
            open_fraction_primal: None,
            contact_ends: contact_ends(interface, &own, threshold),
            pressure_l2_difference: None,
            length,
            profiles: vec![Profile { model: "dual".to_string(), points: profile(interface, &own, false) }],
        };
        for judged in all {
            let name = &judged.candidate.name;
            if let Some(reactions) = judged.candidate.reactions.as_ref().and_then(|r| r.get(index)) {
                let pieces = reaction_pressure(problem, interface, reactions);
                summary.profiles.push(Profile {
                    model: format!("{name} reactions"),
                    points: profile(interface, &pieces, reactions.edge.is_some()),
                });
            }
            let pieces = trace_pressure(problem, interface, judged);
            summary
                .profiles
                .push(Profile { model: format!("{name} trace"), points: profile(interface, &pieces, false) });
        }
        if let Some(best) = best {
            primal_side(problem, dual, bracket, best, (index, interface), &own, allow, &mut summary, &mut checks);
        }
        summaries.push(summary);
    }
    (summaries, checks)
}

#[allow(clippy::too_many_arguments)]
fn primal_side(
    problem: &Problem,
    dual: &DualSolution,
    bracket: &Bracket,
    best: &Judged,
    (index, interface): (usize, &Interface),
    own: &[Piece],
    allow: &Allowances,
    summary: &mut ContactSummary,
    checks: &mut Vec<Check>,
) {
    let reactions = best.candidate.reactions.as_ref().and_then(|r| r.get(index));
    let pieces = match reactions {
        Some(reactions) => reaction_pressure(problem, interface, reactions),
        None => trace_pressure(problem, interface, best),
    };
    let (force, moment) = resultant(problem, interface, &pieces);
    let force = reactions.map_or(force, |r| r.resultant);
    let moment = reactions.map_or(moment, |r| reaction_moment(problem, interface, r));
    let (largest, at) = maximum(problem, interface, &pieces);
    let (norm, difference) = l2(interface, own, &pieces);
    // Reactions are zero or not; a trace is never quite zero.
    let threshold = largest * if reactions.is_some() { NO_REACTION } else { NO_TRACE };
    summary.resultant.primal = Some(force);
    summary.moment.primal = Some(moment);
    summary.pressure_max.primal = Some(largest);
    summary.pressure_max_at.primal = Some(at);
    summary.open_fraction_primal = Some(open_length(interface, &pieces, threshold) / summary.length);
    summary.pressure_l2_difference = (norm > 0.0).then(|| difference / norm);

    let solution = reactions.filter(|_| best.candidate.is_solution);
    if solution.is_some() {
        checks.push(resultant_check(problem, bracket, best, interface, summary.resultant.dual, force, allow));
    }
    // A field that solves nothing promises no pressure; its trace is shown, and judged by the energy alone.
    if !best.candidate.is_solution || summary.pressure_max.dual <= 0.0 {
        return;
    }
    let nodes = solution.map(|r| nodal_pressures(problem, (index, interface), own, dual, best, r)).unwrap_or_default();
    match nodal::difference(&nodes) {
        Some(difference) => checks.extend(bounded_pressure(problem, interface, &difference, allow)),
        None => checks.extend(chosen_pressure(summary, allow)),
    }
    let disagree = disagreement(interface, (own, NO_PRESSURE * summary.pressure_max.dual), (&pieces, threshold));
    let name = format!("contact/{}/open-length", interface.name);
    let pressed = 1.0 - summary.open_fraction;
    checks.push(Check::with_difference(
        &name,
        summary.open_fraction,
        summary.open_fraction_primal.unwrap_or(f64::NAN),
        disagree.length / summary.length,
        (allow.chosen(&name) * pressed).max(SETTLED * disagree.longest / summary.length),
        Basis::Chosen,
        "Fraction of the contact that carries no pressure; what only one model calls open may be a tenth of what \
         carries pressure, or three edges.",
    ));
}

/// Pressures averaged at each vertex of Γ_K, which differ only as far as the stresses next to it do.
fn bounded_pressure(
    problem: &Problem,
    interface: &Interface,
    nodes: &NodalDifference,
    allow: &Allowances,
) -> [Check; 3] {
    let name = |last: &str| format!("contact/{}/{last}", interface.name);
    let shortest = interface.pairs.iter().map(|p| p.length).fold(f64::INFINITY, f64::min);
    let length: f64 = interface.pairs.iter().map(|p| p.length).sum();
    let (l2_name, max_name, reactions_name) = (name("pressure-l2"), name("pressure-max"), name("reactions"));
    let thickness = problem.scene.thickness;
    let norm = nodes.norm.max(f64::MIN_POSITIVE);
    let largest = nodes.largest[0].max(f64::MIN_POSITIVE);
    let round_off = REACTION * forces(problem).max(thickness * norm * length.sqrt());
    // A force known to round-off is a pressure known to round-off over the length it acts on.
    let pressure_off = round_off / (thickness * shortest);
    [
        Check::at_most(
            &reactions_name,
            thickness * nodes.unexplained,
            0.0,
            allow.get(&reactions_name, round_off),
            Basis::RoundOff,
            "Every reaction of the displacement model differs from the dual force at its vertex by exactly the work of \
             λ_h − σ(u_h) on moving this vertex alone; the largest remainder.",
        ),
        Check::at_most(
            &l2_name,
            nodes.l2 / norm,
            0.0,
            allow.get(&l2_name, (nodes.l2_allowed + pressure_off * length.sqrt()) / norm),
            Basis::Guaranteed,
            "Contact pressures averaged with the hat function of each vertex, L² difference relative to the dual ones: \
             the reaction at a vertex differs at most by what λ_h − σ(u_h) around it does on moving this vertex alone.",
        ),
        Check::with_difference(
            &max_name,
            nodes.largest[0],
            nodes.largest[1],
            (nodes.largest[0] - nodes.largest[1]).abs() / largest,
            allow.get(&max_name, (nodes.largest_allowed + pressure_off) / largest),
            Basis::Guaranteed,
            "Largest of the contact pressures averaged with the hat function of each vertex, relative difference: \
             limited by λ_h − σ(u_h) around that vertex.",
        ),
    ]
}

/// Pressures of a field that brings no reactions: theory does not limit their difference.
fn chosen_pressure(summary: &ContactSummary, allow: &Allowances) -> Vec<Check> {
    let name = |last: &str| format!("contact/{}/{last}", summary.name);
    let (l2_name, max_name) = (name("pressure-l2"), name("pressure-max"));
    let l2 = summary.pressure_l2_difference.map(|relative| {
        Check::at_most(
            &l2_name,
            relative,
            0.0,
            allow.chosen(&l2_name),
            Basis::Chosen,
            "L² difference of the contact pressures relative to the dual one; the energy bound does not control it.",
        )
    });
    let (dual, primal) = (summary.pressure_max.dual, summary.pressure_max.primal.unwrap_or(f64::NAN));
    let max = Check::with_difference(
        &max_name,
        dual,
        primal,
        (dual - primal).abs() / dual,
        allow.chosen(&max_name),
        Basis::Chosen,
        "Largest contact pressure, relative difference; a maximum is not controlled by the energy bound.",
    );
    l2.into_iter().chain([max]).collect()
}
