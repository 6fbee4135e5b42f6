//! The outcome of a check in a sentence, with different wording for checks that passed, failed or were not made.

use crate::compare::Check;

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

/// Splits the name of a check into its family and the two parts of the rest; names of contacts, quantities and files may
/// contain slashes.
fn parts(name: &str) -> (&str, &str, &str) {
    let (first, rest) = name.split_once('/').unwrap_or((name, ""));
    let (rest, first) = match rest.strip_prefix("contact/").filter(|_| first == "solution") {
        Some(rest) => (rest, "contact"),
        None => (rest, first),
    };
    let by_end = matches!(first, "contact" | "quantity" | "certified");
    let (middle, last) = if by_end { rest.rsplit_once('/') } else { rest.split_once('/') }.unwrap_or((rest, ""));
    (first, middle, last)
}

fn failed(check: &Check) -> String {
    let [value, reference, difference] = [check.value, check.reference, check.difference].map(number);
    let allowed = number(Some(check.allowed));
    let (first, middle, last) = parts(&check.name);
    match (first, middle, last) {
        ("admissible", who, _) => format!(
            "{who} misses a support or penetrates a contact by {value} of its largest displacement; {allowed} would be round-off."
        ),
        ("energy", "lower-below", who) => format!(
            "The lower bound {value} lies above the energy {reference} of {who} made admissible, by {difference}: one of the two is wrong."
        ),
        ("energy", "coulomb", who) => format!(
            "The energy {value} of {who} with Coulomb friction lies below {reference}, the lower bound without friction, by {difference}: one \
             of the two is wrong."
        ),
        ("coulomb", who, _) => format!(
            "With limits from its own reactions {who} has the force of friction {reference}, and the stresses have {value}: a difference \
             of {difference} of what friction can carry; {allowed} was chosen as the most."
        ),
        ("energy", "gap-two-ways", who) => format!(
            "The gap to {who} is {value} from the two energies and {reference} integrated triangle by triangle; the two are not equal."
        ),
        ("energy", "recomputed", who) => {
            format!("{who} reports the energy {value}, and its displacement has {reference}.")
        }
        ("energy", "strain", who) => {
            format!("{who} reports the strain energy {value}, and its displacement has {reference}.")
        }
        ("energy", "identity", who) => {
            format!("The energy {value} of {who} is not minus its strain energy, {reference}: it is not the minimum.")
        }
        ("energy", order, _) if order.contains("-above-") => {
            let [low, high] = order.split_once("-above-").map_or(["", ""], |(p, q)| [p, q]).map(str::to_uppercase);
            format!("The energy {value} of {high} lies above that of {low}, {reference}, which {high} can represent.")
        }
        ("primal", "equilibrium", who) => {
            format!("{value} of the nodal forces of {who} is left unbalanced, where a solver leaves {allowed}.")
        }
        ("primal", "reactions", who) => format!(
            "A contact reaction that {who} reports is off by {value} from the one its stresses ask for; {allowed} would be round-off."
        ),
        ("stress", "difference", who) => format!(
            "The stresses of {who} are {value} from those in equilibrium, and the two energies leave no more than {allowed}."
        ),
        ("dual", "equilibrium", _) => {
            format!("The stresses miss equilibrium by {value} of the applied load, where {allowed} is round-off.")
        }
        ("contact", name, "reactions") => {
            format!(
                "A reaction on {name} is off by {value} from the one that stresses ask for; {allowed} would be round-off."
            )
        }
        ("contact", name, "resultant") => format!(
            "The force on {name} is {value} in stresses and {reference} in displacements: {difference} apart, {allowed} at most."
        ),
        ("contact", name, "pressure-l2") => {
            format!("The pressures on {name} are {value} apart, relative to the dual one; {allowed} at most.")
        }
        ("contact", name, "pressure-max") => format!(
            "The largest pressure on {name} is {value} in stresses and {reference} in displacements: {difference} apart, {allowed} at most."
        ),
        // Its reason names the places.
        ("contact", name, "peak-pressure") => {
            format!("On {name} the largest pressures differ by a factor of {difference}. {}", check.why)
        }
        ("contact", name, "open-length") => format!(
            "The models disagree on {difference} of the length of {name} whether it is open; {allowed} at most."
        ),
        ("bracket", "sharpness" | "tolerance", _) => {
            format!("The guaranteed relative error is {value}, and {allowed} was to be reached.")
        }
        ("certified", who, _) => format!("The stresses of {who} may be wrong by {value}; {allowed} at most."),
        ("solution", "guaranteed-error", _) => {
            format!(
                "All stresses of the field may be wrong: its guaranteed relative error is {value}, above {allowed}."
            )
        }
        ("solution", "residual", _) => {
            format!("{value} of the nodal forces is left unbalanced, where a solution leaves {allowed}.")
        }
        ("solution", "supports", _) => {
            format!("Prescribed displacements are missed by {value} of the largest displacement; {allowed} at most.")
        }
        ("solution", "reactions", _) => {
            format!("Forces of supports and contacts miss the loads by {value}; {allowed} at most.")
        }
        ("solution", "energy-identity", _) => {
            format!("Twice the strain energy is {value} and the work done is {reference}; they are not equal.")
        }
        ("contact", name, "penetration") => {
            format!("A node of {name} penetrates by {value} of the largest displacement; {allowed} at most.")
        }
        ("contact", name, "penetration-at-nodes") => {
            format!("A node of {name}, which holds in the mean, penetrates by {value} of the largest displacement.")
        }
        ("contact", name, "friction") => {
            format!("Along {name} friction misses its law by {value} of all forces; {allowed} at most.")
        }
        ("contact", name, "pulling") => format!("Contact {name} pulls with {value} of all forces; {allowed} at most."),
        ("contact", name, "pressure-where-open") => {
            format!("Contact {name} pushes with {value} of all forces where it is open; {allowed} at most.")
        }
        ("quantity", name, "tolerance") => {
            format!(
                "The half-width of the interval of {name} is {value} of its value, and {allowed} was to be reached."
            )
        }
        ("quantity", name, source) => {
            let own = if check.allowed > 0.0 {
                format!(", and its own error and rounding explain {allowed} at most")
            } else {
                String::new()
            };
            format!(
                "The value {value} of {name} ({source}) is {difference} beyond the end {reference} of its interval{own}."
            )
        }
        ("baseline", ..) => {
            let what = check.name.strip_prefix("baseline/").unwrap_or(&check.name);
            format!("{what} is {value} and was {reference}: {difference} apart, {allowed} at most.")
        }
        _ => format!("{}: {value} against {reference}, {difference} apart, {allowed} at most.", check.name),
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
