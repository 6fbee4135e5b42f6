//! The outcome of a check in a sentence, with different wording for checks that passed, failed or were not made.

use crate::compare::name::{OfContact, OfField, OfRun, OfSolutionContact, WIDTH};
use crate::compare::{Check, Name};

/// The outcome of a check: passed, failed or not made.
pub fn outcome(check: &Check) -> &'static str {
    match (check.passed, check.difference) {
        (true, _) => "passed",
        (false, None) => "not made",
        (false, Some(_)) => "failed",
    }
}

/// The outcome of a check in a sentence; for a check that passed this is its reason.
pub fn told(check: &Check) -> String {
    match outcome(check) {
        "passed" => check.why.clone(),
        "not made" => format!("It was not made: {}", check.why),
        _ => failed(check),
    }
}

/// A number with four digits, or a dash.
pub(super) fn number(x: Option<f64>) -> String {
    match x {
        None => "–".to_string(),
        Some(x) if x != 0.0 && !(1e-3..1e5).contains(&x.abs()) => format!("{x:.3e}"),
        Some(x) => format!("{}", format!("{x:.6e}").parse().unwrap_or(x)),
    }
}

fn failed(check: &Check) -> String {
    let [value, reference, difference] = [check.value, check.reference, check.difference].map(number);
    let allowed = number(Some(check.allowed));
    match Name::read(&check.name) {
        Name::Field(OfField::Admissible, who) => format!(
            "{who} misses a support or penetrates a contact by {value} of its largest displacement; {allowed} would be round-off."
        ),
        Name::Field(OfField::LowerBelow, who) => format!(
            "The lower bound {value} lies above the energy {reference} of {who} made admissible, by {difference}: one of the two is wrong."
        ),
        Name::Field(OfField::Coulomb, who) => format!(
            "The energy {value} of {who} with Coulomb friction lies below {reference}, the lower bound without friction, by {difference}: one \
             of the two is wrong."
        ),
        Name::Field(OfField::FrictionForce, who) => format!(
            "With limits from its own reactions {who} has the force of friction {reference}, and the stresses have {value}: a difference \
             of {difference} of what friction can carry; {allowed} was chosen as the most."
        ),
        Name::Field(OfField::GapTwoWays, who) => format!(
            "The gap to {who} is {value} from the two energies and {reference} integrated triangle by triangle; the two are not equal."
        ),
        Name::Field(OfField::Recomputed, who) => {
            format!("{who} reports the energy {value}, and its displacement has {reference}.")
        }
        Name::Field(OfField::Strain, who) => {
            format!("{who} reports the strain energy {value}, and its displacement has {reference}.")
        }
        Name::Field(OfField::Identity, who) => {
            format!("The energy {value} of {who} is not minus its strain energy, {reference}: it is not the minimum.")
        }
        Name::Order(low, high) => {
            let [low, high] = [low, high].map(str::to_uppercase);
            format!("The energy {value} of {high} lies above that of {low}, {reference}, which {high} can represent.")
        }
        Name::Field(OfField::Equilibrium, who) => {
            format!("{value} of the nodal forces of {who} is left unbalanced, where a solver leaves {allowed}.")
        }
        Name::Field(OfField::Reactions, who) => format!(
            "A contact reaction that {who} reports is off by {value} from the one its stresses ask for; {allowed} would be round-off."
        ),
        Name::Field(OfField::StressDifference, who) => format!(
            "The stresses of {who} are {value} from those in equilibrium, and the two energies leave no more than {allowed}."
        ),
        Name::Run(OfRun::DualEquilibrium) => {
            format!("The stresses miss equilibrium by {value} of the applied load, where {allowed} is round-off.")
        }
        Name::Contact(OfContact::Reactions, name) => {
            format!(
                "A reaction on {name} is off by {value} from the one that stresses ask for; {allowed} would be round-off."
            )
        }
        Name::Contact(OfContact::Resultant, name) => format!(
            "The force on {name} is {value} in stresses and {reference} in displacements: {difference} apart, {allowed} at most."
        ),
        Name::Contact(OfContact::PressureL2, name) => {
            format!("The pressures on {name} are {value} apart, relative to the dual one; {allowed} at most.")
        }
        Name::Contact(OfContact::PressureMax, name) => format!(
            "The largest pressure on {name} is {value} in stresses and {reference} in displacements: {difference} apart, {allowed} at most."
        ),
        // Its reason names the places.
        Name::Contact(OfContact::PeakPressure, name) => {
            format!("On {name} the largest pressures differ by a factor of {difference}. {}", check.why)
        }
        Name::Contact(OfContact::OpenLength, name) => format!(
            "The models disagree on {difference} of the length of {name} whether it is open; {allowed} at most."
        ),
        Name::Run(OfRun::Sharpness | OfRun::Tolerance) => {
            format!("The guaranteed relative error is {value}, and {allowed} was to be reached.")
        }
        Name::Field(OfField::EnergyError, who) => {
            format!("The stresses of {who} may be wrong by {value}; {allowed} at most.")
        }
        Name::Run(OfRun::GuaranteedError) => {
            format!(
                "All stresses of the field may be wrong: its guaranteed relative error is {value}, above {allowed}."
            )
        }
        Name::Run(OfRun::Residual) => {
            format!("{value} of the nodal forces is left unbalanced, where a solution leaves {allowed}.")
        }
        Name::Run(OfRun::Supports) => {
            format!("Prescribed displacements are missed by {value} of the largest displacement; {allowed} at most.")
        }
        Name::Run(OfRun::SolutionReactions) => {
            format!("Forces of supports and contacts miss the loads by {value}; {allowed} at most.")
        }
        Name::Run(OfRun::EnergyIdentity) => {
            format!("Twice the strain energy is {value} and the work done is {reference}; they are not equal.")
        }
        Name::SolutionContact(OfSolutionContact::Penetration, name) => {
            format!("A node of {name} penetrates by {value} of the largest displacement; {allowed} at most.")
        }
        Name::SolutionContact(OfSolutionContact::PenetrationAtNodes, name) => {
            format!("A node of {name}, which holds in the mean, penetrates by {value} of the largest displacement.")
        }
        Name::SolutionContact(OfSolutionContact::Friction, name) => {
            format!("Along {name} friction misses its law by {value} of all forces; {allowed} at most.")
        }
        Name::SolutionContact(OfSolutionContact::Pulling, name) => {
            format!("Contact {name} pulls with {value} of all forces; {allowed} at most.")
        }
        Name::SolutionContact(OfSolutionContact::PressureWhereOpen, name) => {
            format!("Contact {name} pushes with {value} of all forces where it is open; {allowed} at most.")
        }
        Name::Quantity(name, WIDTH) => {
            format!(
                "The half-width of the interval of {name} is {value} of its value, and {allowed} was to be reached."
            )
        }
        Name::Quantity(name, source) => {
            let own = if check.allowed > 0.0 {
                format!(", and its own error and rounding explain {allowed} at most")
            } else {
                String::new()
            };
            format!(
                "The value {value} of {name} ({source}) is {difference} beyond the end {reference} of its interval{own}."
            )
        }
        Name::Baseline(what) => {
            format!("{what} is {value} and was {reference}: {difference} apart, {allowed} at most.")
        }
        Name::Other => format!("{}: {value} against {reference}, {difference} apart, {allowed} at most.", check.name),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::{Basis, names_of_checks};

    #[test]
    fn passed_failed_and_not_made_are_three_sentences() {
        for name in names_of_checks(&["a|b".to_string()], &["X P2", "X P4"].map(String::from)) {
            let why = "Everything is well.";
            let passed = told(&Check::equal(&name, 1.0, 1.0, 0.5, Basis::RoundOff, why));
            let failed = told(&Check::equal(&name, 2.0, 1.0, 0.5, Basis::RoundOff, why));
            let not_made = told(&Check::not_made(&name, 0.5, Basis::RoundOff, "Nobody came."));
            assert_eq!(passed, why);
            assert!(
                (!failed.contains(why) || name.ends_with("/peak-pressure"))
                    && failed.contains(|c: char| c.is_ascii_digit()),
                "{failed}"
            );
            assert!(!failed.contains(&name), "{name} has no words of its own: {failed}");
            assert!(not_made.starts_with("It was not made"), "{not_made}");
        }
    }
}
