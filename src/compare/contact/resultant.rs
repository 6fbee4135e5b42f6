//! Contact resultants of the two models.

use super::Sides;
use crate::bounds::Sum;
use crate::compare::candidate::Judged;
use crate::compare::name::OfContact;
use crate::compare::on_quadrilaterals::strain_norm_squared;
use crate::compare::tolerance::chosen;
use crate::compare::{Basis, Check};
use crate::element::Displacement;
use crate::element::Strains;
use crate::problem::{Condition, ContactPair, Interface, Problem};
use crate::statics::Components;

/// Round-off and solver accuracy of a resultant, relative to the forces on the body.
const RESULTANT: f64 = 1e-7;

/// Resultants can differ only as far as λ_h − σ(u_h) does work on a motion of the first side:
/// (R_dual − R_primal)·d = ∫(λ_h − σ(u_h)):e(w) ≤ ‖λ_h − σ(u_h)‖ ‖e(w)‖ for an admissible w that is d on the contact.
pub fn resultant_check(
    sides: &Sides<'_>,
    best: &Judged,
    (index, interface): (usize, &Interface),
    dual: [f64; 2],
    primal: [f64; 2],
) -> Check {
    let name = OfContact::Resultant.of(&interface.name);
    let size = dual[0].hypot(dual[1]);
    let difference = (dual[0] - primal[0]).hypot(dual[1] - primal[1]);
    let apart: Sum = best.field.local.triangles.iter().copied().collect();
    let of_displacements = best.balance.as_ref().map(|b| b.reaction_tolerance(index));
    let round_off =
        RESULTANT * forces(sides.problem).max(size) + of_displacements.unwrap_or(0.0) + sides.scales.round_off.force;
    let norm = if best.candidate.is_polynomial() && !sides.problem.section().is_revolved() {
        translation_norm(sides.problem, (index, interface), dual, primal, best.candidate.on_quadrilaterals.is_some())
    } else {
        Err(Meets::Distorted)
    };
    let (allowed, basis, why) = match norm {
        Ok(norm) => (
            (2.0 * apart.value().max(0.0)).sqrt() * norm + round_off,
            Basis::Guaranteed,
            "Contact resultants of the two models: they differ at most by ‖λ_h − σ(u_h)‖ times the energy norm of a \
             displacement that moves the first side of the contact as a whole; zero where equilibrium fixes the resultant."
                .to_string(),
        ),
        Err(_) if difference <= round_off => (
            round_off,
            Basis::RoundOff,
            "Contact resultants of the two models, which differ by rounding alone.".to_string(),
        ),
        Err(meets) => (
            chosen("resultant") * size + round_off,
            Basis::Chosen,
            format!("Contact resultants of the two models. {} theory sets no bound.", meets.in_words()),
        ),
    };
    let found = primal[0].hypot(primal[1]);
    let made = |allowed| Check::with_difference(&name, size, found, difference, allowed, basis, why.clone());
    sides.of_reaction(best, index, allowed).check_of_large(made)
}

/// The reason why no displacement moves the first side of a contact alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Meets {
    /// A support meets it.
    Support,
    /// Another contact meets it.
    Contact,
    /// Conditions that meet elsewhere on the piece do not leave it free.
    Elsewhere,
    /// Both sides belong to one piece.
    Itself,
    /// The solution is one on quadrilaterals that are no parallelograms.
    Distorted,
}

impl Meets {
    fn in_words(self) -> &'static str {
        match self {
            Meets::Support => {
                "Supports meet this contact, and what passes at such a vertex through the support and what through the contact is \
                 not the same question for the two models:"
            }
            Meets::Contact => {
                "Another contact meets this one, and what passes at such a vertex through one and what through the other is not the \
                 same question for the two models:"
            }
            Meets::Elsewhere => {
                "Supports or other contacts that meet on the body of its first side leave no displacement that moves this side \
                 alone:"
            }
            Meets::Distorted => {
                "The displacement solution is one on quadrilaterals that are no parallelograms, in the integrals of its own Gauss rule:"
            }
            Meets::Itself => "Both sides belong to one piece, so that no displacement moves the first alone:",
        }
    }
}

/// ‖e(w)‖ for a continuous w, piecewise linear or of degree 1 on `quadrilaterals`, that is a unit translation along the difference of the resultants on the
/// first side of the interface, as far into its piece as supports and other contacts allow, and zero elsewhere.
fn translation_norm(
    problem: &Problem,
    (index, interface): (usize, &Interface),
    dual: [f64; 2],
    primal: [f64; 2],
    quadrilaterals: bool,
) -> Result<f64, Meets> {
    let mesh = &problem.mesh;
    let off = [dual[0] - primal[0], dual[1] - primal[1]];
    let size = off[0].hypot(off[1]);
    if size == 0.0 {
        return Ok(0.0);
    }
    let d = [off[0] / size, off[1] / size];
    let components = Components::new(problem);
    let Some(first) = interface.pairs.first() else { return Ok(0.0) };
    let piece = components.of_vertex[first.first[0]];
    // A piece that meets itself moves both sides.
    let second = interface.pairs.iter().filter_map(|pair| pair.second).flatten();
    if second.into_iter().any(|v| components.of_vertex[v] == piece) {
        return Err(Meets::Itself);
    }
    let mut w: Vec<[f64; 2]> = components.of_vertex.iter().map(|&c| if c == piece { d } else { [0.0; 2] }).collect();
    let on_contact: std::collections::HashSet<usize> = interface.pairs.iter().flat_map(|p| p.first).collect();
    for (e, condition) in problem.conditions.iter().enumerate() {
        for v in mesh.edges[e].vertices {
            let held = match condition {
                // The forces of springs differ between the models, too.
                Condition::Clamped(_) | Condition::Elastic { .. } => [0.0; 2],
                Condition::Roller { direction, .. } => along(w[v], *direction),
                // Other contacts of the piece must not be moved in their normal direction.
                Condition::Contact { interface, pair, .. } if *interface != index => {
                    let pair = &problem.interfaces[*interface].pairs[*pair];
                    // Nor along it, where there is friction.
                    if pair.friction.is_some() { [0.0; 2] } else { along(w[v], direction_at(pair, v)) }
                }
                _ => continue,
            };
            if on_contact.contains(&v) && (held[0] - d[0]).hypot(held[1] - d[1]) > 1e-9 {
                return Err(match condition {
                    Condition::Contact { .. } => Meets::Contact,
                    _ => Meets::Support,
                });
            }
            w[v] = held;
        }
    }
    // Where two conditions meet, what one of them takes of w another may have needed.
    let kept = |(e, condition): (usize, &Condition)| {
        mesh.edges[e].vertices.iter().all(|v| match condition {
            Condition::Clamped(_) | Condition::Elastic { .. } => w[*v] == [0.0; 2],
            Condition::Roller { direction: n, .. } => (w[*v][0] * n[0] + w[*v][1] * n[1]).abs() <= 1e-9,
            Condition::Contact { interface, pair, .. } if *interface != index => {
                let pair = &problem.interfaces[*interface].pairs[*pair];
                let n = direction_at(pair, *v);
                (w[*v][0] * n[0] + w[*v][1] * n[1]).abs() <= 1e-9 && (pair.friction.is_none() || w[*v] == [0.0; 2])
            }
            _ => true,
        })
    };
    if !problem.conditions.iter().enumerate().all(kept) {
        return Err(Meets::Elsewhere);
    }
    if quadrilaterals {
        return Ok((problem.scene.thickness * strain_norm_squared(problem, &w)).sqrt());
    }
    let field = Displacement::from_p1(mesh, &w);
    let materials = problem.materials();
    let mut strains = Strains::default();
    let sum: Sum = (0..mesh.triangles.len())
        .map(|t| {
            let e = strains.on(mesh.corners(t), &field, t, 0).at([1.0, 0.0, 0.0]);
            mesh.area(t) * materials[mesh.body[t]].strain_product(e, e)
        })
        .collect();
    Ok((problem.scene.thickness * sum.value()).sqrt())
}

/// The unit direction in which contact acts at a vertex of a pair.
fn direction_at(pair: &ContactPair, vertex: usize) -> [f64; 2] {
    let end = usize::from(pair.first[1] == vertex || pair.second.is_some_and(|second| second[1] == vertex));
    let n = pair.direction.ends[end];
    let length = n[0].hypot(n[1]);
    [n[0] / length, n[1] / length]
}

fn along(w: [f64; 2], n: [f64; 2]) -> [f64; 2] {
    let off = w[0] * n[0] + w[1] * n[1];
    [w[0] - off * n[0], w[1] - off * n[1]]
}

/// Sum of the magnitudes of all applied forces.
pub fn forces(problem: &Problem) -> f64 {
    let mesh = &problem.mesh;
    let mut sum = 0.0;
    for (e, condition) in problem.conditions.iter().enumerate() {
        if let Condition::Traction([a, b]) = condition {
            sum += problem.largest_weight(e) * 0.5 * mesh.edge_frame(e).0 * (a[0].hypot(a[1]) + b[0].hypot(b[1]));
        }
    }
    for t in 0..mesh.triangles.len() {
        let largest = problem.force_on(t).largest();
        let volume =
            if problem.section().is_revolved() { problem.section().volume(mesh.corners(t)) } else { mesh.area(t) };
        sum += volume * largest;
    }
    problem.scene.thickness * sum
}
