//! Contact checks, interface by interface.

use super::candidate::Judged;
use super::outcome::{ContactSummary, Profile, TwoSides};
use super::pressure::{
    Piece, contact_ends, dual_pressure, l2, maximum, open_length, profile, reaction_pressure, resultant, trace_pressure,
};
use super::tolerance::Allowances;
use super::{Basis, Check};
use crate::bounds::strain::strains;
use crate::bounds::{Bracket, Sum};
use crate::dual::DualSolution;
use crate::dual::modes::materials;
use crate::element::Displacement;
use crate::problem::{Condition, Interface, Problem};
use crate::statics::Components;

/// Pressures below this fraction of the largest count as none.
const NO_PRESSURE: f64 = 1e-9;
/// Round-off and solver accuracy of a resultant, relative to the forces on the body.
const RESULTANT: f64 = 1e-7;

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
            primal_side(problem, bracket, best, (index, interface), &own, allow, &mut summary, &mut checks);
        }
        summaries.push(summary);
    }
    (summaries, checks)
}

#[allow(clippy::too_many_arguments)]
fn primal_side(
    problem: &Problem,
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
    let (largest, at) = maximum(problem, interface, &pieces);
    let (norm, difference) = l2(interface, own, &pieces);
    let open = open_length(interface, &pieces, 1e-7 * largest) / summary.length;
    summary.resultant.primal = Some(force);
    summary.moment.primal = Some(moment);
    summary.pressure_max.primal = Some(largest);
    summary.pressure_max_at.primal = Some(at);
    summary.open_fraction_primal = Some(open);
    let relative = (norm > 0.0).then(|| difference / norm);
    summary.pressure_l2_difference = relative;

    if reactions.is_some() && best.candidate.is_solution {
        checks.push(resultant_check(problem, bracket, best, interface, summary.resultant.dual, force, allow));
    }
    let name = |last: &str| format!("contact/{}/{last}", interface.name);
    if summary.pressure_max.dual <= 0.0 {
        return;
    }
    let l2_name = name("pressure-l2");
    if let Some(relative) = relative {
        checks.push(Check::at_most(
            &l2_name,
            relative,
            0.0,
            allow.chosen(&l2_name),
            Basis::Chosen,
            "L² difference of the contact pressures relative to the dual one; the energy bound does not control it.",
        ));
    }
    let max_name = name("pressure-max");
    checks.push(Check::with_difference(
        &max_name,
        summary.pressure_max.dual,
        largest,
        (summary.pressure_max.dual - largest).abs() / summary.pressure_max.dual,
        allow.chosen(&max_name),
        Basis::Chosen,
        "Largest contact pressure, relative difference; a maximum is not controlled by the energy bound.",
    ));
    let open_name = name("open-length");
    checks.push(Check::equal(
        &open_name,
        summary.open_fraction,
        open,
        allow.chosen(&open_name).max(3.0 * longest(interface) / summary.length),
        Basis::Chosen,
        "Fraction of the contact that carries no pressure, to a tenth or three edges, whichever is larger.",
    ));
}

/// Resultants can differ only as far as λ_h − σ(u_h) does work on a motion of the first side:
/// (R_dual − R_primal)·d = ∫(λ_h − σ(u_h)):e(w) ≤ ‖λ_h − σ(u_h)‖ ‖e(w)‖ for an admissible w that is d on the contact.
fn resultant_check(
    problem: &Problem,
    bracket: &Bracket,
    best: &Judged,
    interface: &Interface,
    dual: [f64; 2],
    primal: [f64; 2],
    allow: &Allowances,
) -> Check {
    let name = format!("contact/{}/resultant", interface.name);
    let difference = (dual[0] - primal[0]).hypot(dual[1] - primal[1]);
    let gap = (best.field.potential.total() - bracket.complementary.lower()).max(0.0);
    let scale = forces(problem);
    let round_off = RESULTANT * scale.max(dual[0].hypot(dual[1]));
    let (allowed, basis, why) = match translation_norm(problem, interface, dual, primal) {
        Some(norm) => (
            (2.0 * gap).sqrt() * norm + round_off,
            Basis::Guaranteed,
            "Contact resultants of the two models: they differ at most by √(2·gap) times the energy norm of a \
             displacement that moves the first side of the contact as a whole; zero where equilibrium fixes the resultant.",
        ),
        None => (
            0.05 * dual[0].hypot(dual[1]) + round_off,
            Basis::Chosen,
            "Contact resultants of the two models, to five per cent: supports at the contact leave theory no bound.",
        ),
    };
    Check::with_difference(
        &name,
        dual[0].hypot(dual[1]),
        primal[0].hypot(primal[1]),
        difference,
        allow.get(&name, allowed),
        basis,
        why,
    )
}

/// ‖e(w)‖ for a continuous piecewise linear w that is a unit translation along the difference of the resultants on the
/// first side of the interface, as far into its piece as supports and other contacts allow, and zero elsewhere.
fn translation_norm(problem: &Problem, interface: &Interface, dual: [f64; 2], primal: [f64; 2]) -> Option<f64> {
    let mesh = &problem.mesh;
    let off = [dual[0] - primal[0], dual[1] - primal[1]];
    let size = off[0].hypot(off[1]);
    if size == 0.0 {
        return Some(0.0);
    }
    let d = [off[0] / size, off[1] / size];
    let components = Components::new(problem);
    let piece = components.of_vertex[interface.pairs.first()?.first[0]];
    let mut w: Vec<[f64; 2]> = components.of_vertex.iter().map(|&c| if c == piece { d } else { [0.0; 2] }).collect();
    let on_contact: std::collections::HashSet<usize> = interface.pairs.iter().flat_map(|p| p.first).collect();
    for (e, condition) in problem.conditions.iter().enumerate() {
        let (_, n) = mesh.edge_frame(e);
        for v in mesh.edges[e].vertices {
            let held = match condition {
                Condition::Clamped(_) => [0.0; 2],
                Condition::Roller => along(w[v], n),
                // Other contacts of the piece must not be moved in their normal direction.
                Condition::Contact { .. } if !on_contact.contains(&v) => along(w[v], n),
                _ => continue,
            };
            if on_contact.contains(&v) && (held[0] - d[0]).hypot(held[1] - d[1]) > 1e-9 {
                return None;
            }
            w[v] = held;
        }
    }
    // A component of w lost to one condition may be needed by an earlier one only where two of them meet.
    let field = Displacement::from_p1(mesh, &w);
    let materials = materials(problem);
    let sum: Sum = (0..mesh.triangles.len())
        .map(|t| {
            let e = strains(mesh.corners(t), 0, &field.sub(t, 0))[0];
            mesh.area(t) * materials[mesh.body[t]].strain_product(e, e)
        })
        .collect();
    Some((problem.scene.thickness * sum.value()).sqrt())
}

fn along(w: [f64; 2], n: [f64; 2]) -> [f64; 2] {
    let off = w[0] * n[0] + w[1] * n[1];
    [w[0] - off * n[0], w[1] - off * n[1]]
}

/// Sum of the magnitudes of all applied forces.
fn forces(problem: &Problem) -> f64 {
    let mesh = &problem.mesh;
    let mut sum = 0.0;
    for (e, condition) in problem.conditions.iter().enumerate() {
        if let Condition::Traction([a, b]) = condition {
            sum += 0.5 * mesh.edge_frame(e).0 * (a[0].hypot(a[1]) + b[0].hypot(b[1]));
        }
    }
    for t in 0..mesh.triangles.len() {
        let f = problem.scene.bodies[mesh.body[t]].body_force;
        sum += mesh.area(t) * f[0].hypot(f[1]);
    }
    problem.scene.thickness * sum
}

fn longest(interface: &Interface) -> f64 {
    interface.pairs.iter().map(|p| p.length).fold(0.0, f64::max)
}
