//! The two sides of a contact, edge against edge.

use std::collections::HashMap;

use super::{ContactPair, Interface, Note, ProblemError};
use crate::mesh::Triangulation;
use crate::mesh::error::at;
use crate::mesh::polyline::{Link, SAME, chain, key};
use crate::scene::{Contact, ContactSides, Gap};

/// Pairs the edges of `contact`; they must coincide bit for bit, see [`crate::mesh::glue`].
pub(super) fn pair_up(
    contact: &Contact,
    mesh: &Triangulation,
    notes: &mut Vec<Note>,
) -> Result<Interface, ProblemError> {
    let fault = |what: String, remedy: &str| ProblemError::Contact {
        contact: contact.name(),
        what,
        remedy: remedy.to_string(),
    };
    let ends = |e: usize| mesh.edges[e].vertices.map(|v| mesh.points[v]);
    let first = mesh.boundary(contact.first());
    let side: Vec<[[f64; 2]; 2]> = first.iter().map(|&e| ends(e)).collect();
    let links = chain(&side).map_err(|p| {
        let what = format!("more than two edges of '{}' meet at {}", contact.first(), at(p));
        fault(what, "a contact side is a curve without branches")
    })?;
    let mut facing: HashMap<_, usize> = HashMap::new();
    if let ContactSides::Between([_, second]) = &contact.sides {
        for e in mesh.boundary(second) {
            facing.insert(ends(e).map(key), e);
        }
    }
    let mut pairs = Vec::with_capacity(links.len());
    for link in &links {
        let e = first[link.edge];
        let [a, b] = ends(e);
        let opposite = match &contact.sides {
            ContactSides::Rigid(_) => None,
            ContactSides::Between([_, second]) => Some(facing.remove(&[key(b), key(a)]).ok_or_else(|| {
                let place = format!("{} to {}", at(a), at(b));
                if facing.contains_key(&[key(a), key(b)]) {
                    let what = format!("both bodies lie on the same side of the edge {place}");
                    return fault(what, "the bodies of a contact face each other and do not overlap");
                }
                let what = format!("'{second}' has no edge opposite {place} of '{}'", contact.first());
                fault(what, "make the two sides coincide")
            })?),
        };
        let ordered = |[p, q]: [usize; 2], turned: bool| if turned { [q, p] } else { [p, q] };
        let (length, normal) = mesh.edge_frame(e);
        pairs.push(ContactPair {
            edges: [Some(e), opposite],
            first: ordered(mesh.edges[e].vertices, link.reversed),
            second: opposite.map(|f| ordered(mesh.edges[f].vertices, !link.reversed)),
            normal,
            length,
            arc: link.arc,
            gap: link.arc.map(|s| contact.gap.at(s)),
        });
    }
    if let Some(e) = facing.values().min() {
        let [a, b] = ends(*e).map(at);
        let what = format!("the edge {a} to {b} of the second side has no edge of '{}' opposite", contact.first());
        return Err(fault(what, "make the two sides coincide"));
    }
    notes.extend(unresolved_gap(contact, &links));
    Ok(Interface { name: contact.name(), pairs })
}

/// A remark when the gap bends inside an edge.
fn unresolved_gap(contact: &Contact, links: &[Link]) -> Option<Note> {
    let Gap::Table(rows) = &contact.gap else { return None };
    let inside = |s: f64| {
        links.iter().any(|link| {
            let t = (s - link.arc[0]) / (link.arc[1] - link.arc[0]);
            t > SAME && t < 1.0 - SAME
        })
    };
    let missed: Vec<String> = rows.iter().filter(|r| inside(r[0])).map(|r| r[0].to_string()).collect();
    (!missed.is_empty()).then(|| Note {
        weakens_guarantee: true,
        text: format!(
            "contact {}: the break points of the gap at s = {} are no vertices; the bounds are for the gap interpolated \
             linearly on every edge",
            contact.name(),
            missed.join(", ")
        ),
    })
}
