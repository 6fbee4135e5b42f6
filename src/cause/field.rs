//! Causes that lie in displacement fields: all failures of one field share a cause.

use super::advice::{self, Kind};
use super::place::{self, Place};
use super::{Cause, names, taken};
use crate::compare::name::{OfContact, OfField, OfRun};
use crate::compare::{Check, Comparison, Judged, Name};
use crate::diagnose::{Diagnosis, Finding};
use crate::problem::Problem;

/// A mistake in one field, with the checks that it explains.
struct Fault {
    /// Name of the field.
    field: String,
    kind: Kind,
    /// Name of the finding, or of the kind.
    name: String,
    /// The mistake in words, as the end of a sentence that begins with "In FIELD".
    what: String,
    /// True if that is a sentence of its own.
    is_sentence: bool,
    /// Further mistakes in the field, each in words.
    more: Vec<String>,
    place: Option<Place>,
    checks: Vec<String>,
}

/// One cause for every kind of fault, shared by the fields that have it. The checks it explains are removed from `failing`.
pub fn causes(
    problem: &Problem,
    comparison: &Comparison,
    diagnosis: &[Diagnosis],
    failing: &mut Vec<&Check>,
) -> Vec<Cause> {
    let best = comparison.best.map(|b| comparison.judged[b].candidate.name.as_str());
    let mut faults: Vec<Fault> = Vec::new();
    for judged in &comparison.judged {
        let who = judged.candidate.name.as_str();
        let mut own = taken(failing, |check| is_of(check, who) && check.difference.is_some());
        if own.is_empty() {
            continue;
        }
        if Some(who) == best {
            own.extend(taken(failing, |check| is_of_best(check) && check.difference.is_some()));
        }
        let told = diagnosis.iter().find(|d| d.field == who).map_or([].as_slice(), |d| d.findings.as_slice());
        faults.push(fault(problem, judged, told, &own));
    }
    // What compares the best field with the stresses alone is its own fault where no other check is.
    let is_of_contact = |check: &Check| matches!(Name::read(&check.name), Name::Contact(..));
    let of_contact = taken(failing, |check| is_of_contact(check) && check.difference.is_some());
    if let (Some(best), false) = (comparison.best.map(|b| &comparison.judged[b]), of_contact.is_empty()) {
        faults.push(fault(problem, best, &[], &of_contact));
    }
    together(faults)
}

/// True if a check asks about the field `who` alone.
fn is_of(check: &Check, who: &str) -> bool {
    let name = Name::read(&check.name);
    name.field() == Some(who) || name.is_of_solution()
}

/// True if a check asks about the best field without naming it.
fn is_of_best(check: &Check) -> bool {
    matches!(Name::read(&check.name), Name::Contact(..) | Name::Order(..))
}

fn fault(problem: &Problem, judged: &Judged, findings: &[Finding], own: &[&Check]) -> Fault {
    let candidate = &judged.candidate;
    let find = |is: &dyn Fn(Name<'_>) -> bool| own.iter().find(|check| is(Name::read(&check.name)));
    let has = |of: OfField| find(&|name| matches!(name, Name::Field(own, _) if own == of));
    let made = |kind, name: &str, what: String, place: Option<Place>| Fault {
        field: candidate.name.clone(),
        kind,
        name: name.to_string(),
        what,
        is_sentence: false,
        more: Vec::new(),
        place,
        checks: names(own),
    };
    if let Some(first) = findings.first() {
        let kind = Kind::of_finding(&first.name);
        let place = place::of_finding(problem, judged, first).filter(|_| kind.has_place());
        let mut fault = made(kind, &first.name, first.sentence.clone(), place);
        fault.more = findings[1..].iter().map(|finding| finding.sentence.clone()).collect();
        return fault;
    }
    let violation = judged.violation;
    if has(OfField::Admissible).is_some() && violation.support >= violation.penetration.max(violation.at_vertices) {
        let what = "supports do not have their prescribed displacements".to_string();
        return made(Kind::Support, "support", what, place::unbalanced(problem, judged));
    }
    if has(OfField::Admissible).is_some()
        && let Some((place, interface, depth)) = place::deepest(problem, candidate, None)
    {
        let contact = &problem.interfaces[interface].name;
        let what = format!("contact {contact} is penetrated by {depth:.2e}");
        return made(Kind::Contact, &format!("contact/{contact}/penetration"), what, Some(place));
    }
    if has(OfField::Equilibrium).or_else(|| find(&|name| name == Name::Run(OfRun::Residual))).is_some() {
        let what = "stresses do not balance the loads".to_string();
        let cut = candidate.numbering.as_ref().is_some_and(|numbering| numbering.uncut);
        let untried = candidate.higher.is_some() && candidate.cells.is_empty() || cut;
        let name = if untried { "equilibrium/untried" } else { "equilibrium" };
        return made(Kind::Equilibrium, name, what, place::unbalanced(problem, judged));
    }
    if let Some(check) = has(OfField::Recomputed).or_else(|| has(OfField::Strain)) {
        let what = format!(
            "the energy reported, {}, is not that of its displacement, {}",
            super::told::number(check.value),
            super::told::number(check.reference)
        );
        return made(Kind::Reported, "reported-energy", what, None);
    }
    let of_forces = |name: Name<'_>| {
        matches!(
            name,
            Name::Field(OfField::Reactions, _) | Name::Contact(OfContact::Reactions | OfContact::Resultant, _)
        )
    };
    if let Some(check) = find(&of_forces) {
        let contact = Name::read(&check.name).contact();
        let named = problem.interfaces.iter().position(|i| Some(i.name.as_str()) == contact);
        let interface = named.or((!problem.interfaces.is_empty()).then_some(0));
        let place = interface.and_then(|i| place::deepest(problem, candidate, Some(i))).map(|(place, ..)| place);
        let on = named.map_or(String::new(), |i| format!(" of contact {}", problem.interfaces[i].name));
        let what = format!("the forces{on} that are reported are not those of its stresses");
        return made(Kind::Reactions, "reported-reactions", what, place);
    }
    let first = own.first().map_or(String::new(), |check| super::told(check));
    let all = |is: &dyn Fn(Name<'_>) -> bool| own.iter().all(|check| is(Name::read(&check.name)));
    let (kind, name) = if all(&|name| name == Name::Run(OfRun::GuaranteedError)) {
        (Kind::Coarse, "coarse")
    } else if all(&|name| name == Name::Run(OfRun::EnergyIdentity)) {
        (Kind::Work, "work")
    } else if all(&|name| name == Name::Run(OfRun::SolutionReactions)) {
        (Kind::Equilibrium, "equilibrium")
    } else if all(&|name| name == Name::Run(OfRun::Supports)) {
        (Kind::Support, "support")
    } else if all(&|name| matches!(name, Name::SolutionContact(..))) {
        (Kind::Contact, "contact")
    } else if all(&|name| matches!(name, Name::Quantity(..) | Name::Field(OfField::EnergyError, _))) {
        (Kind::Value, "value")
    } else {
        (Kind::Bound, "bound")
    };
    Fault { is_sentence: true, ..made(kind, name, first.trim_end_matches('.').to_string(), None) }
}

/// Merges faults of the same name into one cause, at the place found for the field of highest degree, the last.
fn together(faults: Vec<Fault>) -> Vec<Cause> {
    let mut groups: Vec<Vec<Fault>> = Vec::new();
    for fault in faults {
        match groups.iter_mut().find(|group| group[0].name == fault.name && group[0].kind == fault.kind) {
            Some(group) => group.push(fault),
            None => groups.push(vec![fault]),
        }
    }
    let mut causes = Vec::new();
    for group in groups {
        let mut fields: Vec<&str> = group.iter().map(|fault| fault.field.as_str()).collect();
        fields.dedup();
        let fields = fields.join(" and ");
        let checks = group.iter().flat_map(|fault| fault.checks.clone()).collect();
        let Some(Fault { kind, name, what, is_sentence, more, place, .. }) = group.into_iter().next_back() else {
            continue;
        };
        let where_to = match &place {
            Some(_) if says_where(&what) => String::new(),
            Some(place) if kind.is_local() => format!(" {}", place.in_words()),
            Some(place) => format!(", most to be seen {}", place.in_words()),
            None if kind == Kind::Thickness => ", in the whole scene".to_string(),
            None => String::new(),
        };
        let also = match more.len() {
            0 => String::new(),
            1 | 2 => format!("; {}", more.join("; ")),
            n => format!("; {}, and {} more of the kind", more[0], n - 1),
        };
        let [suggests, remedy] = advice::of(kind, &name).map(str::to_string);
        causes.push(Cause {
            name,
            sentence: match is_sentence {
                true => format!("{fields}: {what}{where_to}{also}."),
                false => format!("In {fields} {what}{where_to}{also}."),
            },
            place,
            suggests,
            remedy,
            checks,
        });
    }
    causes
}

/// True if a sentence already names a place.
fn says_where(what: &str) -> bool {
    what.contains("at (") || what.contains("around (") || what.contains("corners") || what.contains("of the file")
}
