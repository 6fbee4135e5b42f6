//! The two sides of a contact, edge against edge.
pub(super) mod along;
pub(super) mod around;
pub(super) mod bow;
pub(super) mod coulomb;
pub(super) mod curves;
pub(super) mod direction;
pub(super) mod friction;
pub(super) mod normals;
pub(super) mod softened;

use std::collections::HashMap;

use super::{Bow, ContactPair, Direction, Interface, Note, ProblemError};
use crate::mesh::Triangulation;
use crate::mesh::error::at;
use crate::mesh::sides::polyline::{Link, chain, key, same};
use crate::scene::{Contact, ContactSides, Gap, Obstacle, Scene};
use along::pair_along;
use around::pair_around;

/// Cosine of the angle between the direction to an obstacle and a normal below which an edge does not face it.
const GRAZING: f64 = 0.05;

/// Pairs the edges of `contact`; they must coincide bit for bit, see [`crate::mesh::sides::glue`], unless they are matched along a
/// direction or along the rays of a `centre`.
pub(in crate::problem) fn pair_up(
    contact: &Contact,
    scene: &Scene,
    mesh: &Triangulation,
    centre: Option<[f64; 2]>,
    notes: &mut Vec<Note>,
) -> Result<Interface, ProblemError> {
    if let (ContactSides::Between(names), Some(centre)) = (&contact.sides, centre) {
        return pair_around(contact, names, centre, scene, mesh, notes);
    }
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
    let mut averted = 0;
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
        let first = ordered(mesh.edges[e].vertices, link.reversed);
        let (mut direction, mut gap) = (Direction::constant(normal), link.arc.map(|s| contact.gap.at(on_break(s))));
        if let Some(obstacle) = &contact.obstacle {
            let [Some(from), Some(to)] = first.map(|v| obstacle.seen_from(mesh.points[v])) else {
                let what = format!("the centre of its obstacle lies on '{}'", contact.first());
                return Err(fault(what, "correct the centre, or the boundary"));
            };
            let facing = |n: [f64; 2]| n[0] * normal[0] + n[1] * normal[1] > GRAZING;
            if !facing(from.0) || !facing(to.0) {
                averted += 1;
                continue;
            }
            (direction.ends, gap) = ([from.0, to.0], [from.1, to.1]);
        }
        pairs.push(ContactPair {
            edges: [Some(e), opposite],
            first,
            second: opposite.map(|f| ordered(mesh.edges[f].vertices, !link.reversed)),
            normal,
            direction,
            length,
            arc: link.arc,
            gap,
            bow: Bow::of(&contact.gap, link.arc.map(on_break)),
            friction: None,
            stiffness: contact.stiffness,
        });
    }
    if let Some(e) = facing.values().min() {
        let [a, b] = ends(*e).map(|p| at(scene, p));
        let what = format!("the edge {a} to {b} of the second side has no edge of '{}' opposite", contact.first());
        return Err(fault(what, "make the two sides coincide"));
    }
    if let Some(obstacle) = &contact.obstacle {
        if pairs.is_empty() {
            let what = format!("no edge of '{}' faces its obstacle", contact.first());
            return Err(fault(what, "a line has the body on its left, and a circle on its `side`"));
        }
        notes.extend(around_obstacle(contact, obstacle, averted > 0));
    }
    notes.extend(unresolved_gap(contact, &links));
    Ok(Interface { name: contact.name(), pairs, centre: None })
}

/// Remarks on an obstacle with a place of its own.
fn around_obstacle(contact: &Contact, obstacle: &Obstacle, averted: bool) -> Vec<Note> {
    let (name, on) = (contact.name(), contact.first());
    let note = |weakens_guarantee, text| Note { weakens_guarantee, text };
    let mut notes = Vec::new();
    if averted {
        notes.push(note(false, format!("contact {name}: edges of '{on}' that do not face the obstacle are free")));
    }
    if !obstacle.is_straight() {
        let text = format!(
            "contact {name}: direction and distance of the circle are taken at the vertices of this mesh, and linear between: \
             the bounds are for these"
        );
        notes.push(note(true, text));
    }
    notes
}

/// A remark when the gap bends inside an edge, or when the mesh begins to see the kinks of a table that stands for a curve.
pub(in crate::problem) fn unresolved_gap(contact: &Contact, links: &[Link]) -> Option<Note> {
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
