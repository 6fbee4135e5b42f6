//! The two sides of a contact, edge against edge.

use std::collections::HashMap;

use super::along::pair_along;
use super::{Bow, ContactPair, Direction, Interface, Note, ProblemError};
use crate::mesh::Triangulation;
use crate::mesh::error::at;
use crate::mesh::polyline::{Link, chain, key, same};
use crate::scene::{Contact, ContactSides, Gap, Scene};

/// Pairs the edges of `contact`; they must coincide bit for bit, see [`crate::mesh::glue`].
pub(super) fn pair_up(
    contact: &Contact,
    scene: &Scene,
    mesh: &Triangulation,
    notes: &mut Vec<Note>,
) -> Result<Interface, ProblemError> {
    if let (ContactSides::Between(names), Some(direction)) = (&contact.sides, contact.direction) {
        return pair_along(contact, names, direction, scene, mesh, notes);
    }
    let fault = |what: String, remedy: &str| ProblemError::Contact {
        contact: contact.name(),
        what,
        remedy: remedy.to_string(),
    };
    let ends = |e: usize| mesh.edges[e].vertices.map(|v| mesh.points[v]);
    let first = mesh.boundary(contact.first());
    let side: Vec<[[f64; 2]; 2]> = first.iter().map(|&e| ends(e)).collect();
    let links = chain(&side).map_err(|p| {
        let what = format!("more than two edges of '{}' meet at {}", contact.first(), at(scene, p));
        fault(what, "a contact side is a curve without branches")
    })?;
    let mut facing: HashMap<_, usize> = HashMap::new();
    if let ContactSides::Between([_, second]) = &contact.sides {
        for e in mesh.boundary(second) {
            facing.insert(ends(e).map(key), e);
        }
    }
    // A vertex a rounding error from a break point is that point.
    let (breaks, close) = (contact.gap.breaks(), same(&links));
    let on_break = |s: f64| breaks.iter().copied().find(|b| (b - s).abs() <= close).unwrap_or(s);
    let mut pairs = Vec::with_capacity(links.len());
    for link in &links {
        let e = first[link.edge];
        let [a, b] = ends(e);
        let opposite = match &contact.sides {
            ContactSides::Rigid(_) => None,
            ContactSides::Between([_, second]) => Some(facing.remove(&[key(b), key(a)]).ok_or_else(|| {
                let place = format!("{} to {}", at(scene, a), at(scene, b));
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
            direction: Direction::constant(normal),
            length,
            arc: link.arc,
            gap: link.arc.map(|s| contact.gap.at(on_break(s))),
            bow: Bow::of(&contact.gap, link.arc.map(on_break)),
        });
    }
    if let Some(e) = facing.values().min() {
        let [a, b] = ends(*e).map(|p| at(scene, p));
        let what = format!("the edge {a} to {b} of the second side has no edge of '{}' opposite", contact.first());
        return Err(fault(what, "make the two sides coincide"));
    }
    notes.extend(unresolved_gap(contact, &links));
    Ok(Interface { name: contact.name(), pairs })
}

/// A remark when the gap bends inside an edge, or when the mesh begins to see the kinks of a table that stands for a curve.
pub(super) fn unresolved_gap(contact: &Contact, links: &[Link]) -> Option<Note> {
    let Gap::Table(rows) = &contact.gap else { return None };
    let close = same(links);
    let inside = |s: f64| links.iter().any(|link| s - link.arc[0] > close && link.arc[1] - s > close);
    let missed: Vec<String> = rows.iter().filter(|r| inside(r[0])).map(|r| r[0].to_string()).collect();
    let name = contact.name();
    if !missed.is_empty() {
        let text = format!(
            "contact {name}: the break points of the gap at s = {} are no vertices; the bounds are for the gap interpolated \
             linearly on every edge",
            missed.join(", ")
        );
        return Some(Note { weakens_guarantee: true, text });
    }
    let slopes: Vec<f64> = rows.windows(2).map(|w| (w[1][1] - w[0][1]) / (w[1][0] - w[0][0])).collect();
    let curve = slopes.len() >= LIKE_A_CURVE && slopes.windows(2).all(|w| w[1] > w[0]);
    let divided = |w: &&[[f64; 2]]| links.iter().any(|l| l.arc[0] - w[0][0] > close && w[1][0] - l.arc[1] > close);
    let seen = rows.windows(2).filter(divided).count();
    (curve && 2 * seen > slopes.len()).then(|| Note {
        weakens_guarantee: false,
        text: format!(
            "contact {name}: edges are shorter than the steps of the gap table, and the pressure begins to show its kinks; if \
             it stands for a curve, write gap = {{ circle = R, at = s }} or {{ parabola = R, at = s }}"
        ),
    })
}

/// A convex table with this many steps stands for a curve.
const LIKE_A_CURVE: usize = 4;
