//! Displacement models that solve Coulomb friction themselves, with limits from their own reactions, beside the bound of the stress side.

use super::Coulomb;
use crate::compare::name::OfField;
use crate::compare::{Basis, Check, ContactSummary, chosen};
use crate::primal::{PrimalCoulomb, PrimalSolution, Space};
use crate::problem::Problem;

/// Part of the energy at stake that rounding may leave of a model's.
const ROUNDING: f64 = 1e-9;

impl Coulomb {
    /// The checks of what models found of Coulomb friction on `problem`; `contacts` are those of the stress side.
    pub fn of_models(
        &self,
        problem: &Problem,
        solutions: &[PrimalSolution],
        contacts: &[ContactSummary],
    ) -> Vec<Check> {
        let own = |solution: &PrimalSolution| {
            let name = format!("{} {}", solution.solver, Space { cells: solution.cells, degree: solution.degree });
            let coulomb = solution.coulomb.as_ref()?;
            Some([self.no_less(problem, &name, solution, coulomb), Some(friction(&name, coulomb, contacts))])
        };
        solutions.iter().filter_map(own).flatten().flatten().collect()
    }

    /// The energy of a model with any limits is no less than that without friction.
    fn no_less(
        &self,
        problem: &Problem,
        name: &str,
        solution: &PrimalSolution,
        coulomb: &PrimalCoulomb,
    ) -> Option<Check> {
        let (lowest, energy) = (self.lowest?, coulomb.energy?);
        let rounding = solution.energy_rounding.unwrap_or(0.0) + ROUNDING * lowest.abs().max(energy.abs());
        // Linear fields meet contact at vertices, and may penetrate between them where it bends.
        let admissible = solution.admissible.unwrap_or(false) && (solution.degree > 1 || !problem.jumps_bend());
        admissible.then(|| {
            Check::with_difference(
                &OfField::Coulomb.of(name),
                energy,
                lowest,
                (lowest - energy).max(0.0),
                rounding,
                Basis::Guaranteed,
                "The energy of every Coulomb solution, and of every displacement model of one, is no less than the lower bound without \
                 friction.",
            )
        })
    }
}

/// The forces of friction of the model's own solution and of the stresses.
fn friction(name: &str, coulomb: &PrimalCoulomb, contacts: &[ContactSummary]) -> Check {
    let (name, allowed) = (OfField::FrictionForce.of(name), chosen("friction-force"));
    if !coulomb.converged {
        let why = format!(
            "The displacement model found no limits of friction that go with its own reactions: after {} solutions they still changed{}.",
            coulomb.iterations,
            coulomb.change.map_or(String::new(), |change| format!(" by {change:.1e} of their size"))
        );
        return Check::not_made(&name, allowed, Basis::Chosen, why);
    }
    let pairs = coulomb.contacts.iter().zip(contacts).filter_map(|(model, own)| {
        let friction = own.friction.as_ref().filter(|friction| friction.coefficient.is_some())?;
        let most = friction.coefficient? * model.pressure;
        Some((friction.force, model.friction, most))
    });
    let off = |&(own, model, most): &(f64, f64, f64)| if own == model { 0.0 } else { (own - model).abs() / most };
    let (own, model, most) = pairs.max_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or((0.0, 0.0, 0.0));
    Check::with_difference(
        &name,
        own,
        model,
        off(&(own, model, most)),
        allowed,
        Basis::Chosen,
        "The force of friction of the stresses and of the displacement model with limits from its own reactions, relative to the most that \
         friction can carry, on the contact where they differ most. Nothing bounds this difference.",
    )
}
