//! Contact resultants of the two models.

use super::candidate::Judged;
use super::tolerance::Allowances;
use super::{Basis, Check};
use crate::bounds::strain::strains;
use crate::bounds::{Bracket, Sum};
use crate::dual::modes::materials;
use crate::element::Displacement;
use crate::problem::{Condition, Interface, Problem};
use crate::statics::Components;

/// Round-off and solver accuracy of a resultant, relative to the forces on the body.
const RESULTANT: f64 = 1e-7;

/// Resultants can differ only as far as λ_h − σ(u_h) does work on a motion of the first side:
/// (R_dual − R_primal)·d = ∫(λ_h − σ(u_h)):e(w) ≤ ‖λ_h − σ(u_h)‖ ‖e(w)‖ for an admissible w that is d on the contact.
pub fn resultant_check(
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
pub fn forces(problem: &Problem) -> f64 {
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
