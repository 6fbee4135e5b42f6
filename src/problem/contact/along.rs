//! The two sides of a contact that acts along a given direction, edge against edge.

use std::collections::HashMap;
use std::f64::consts::FRAC_PI_2;

use super::unresolved_gap;
use crate::mesh::Triangulation;
use crate::mesh::error::at;
use crate::mesh::sides::along::{Facing, facing, opposite, outward, turned};
use crate::mesh::sides::polyline::{Link, chain};
use crate::problem::{Bow, ContactPair, Direction, Interface, Note, ProblemError};
use crate::scene::{Contact, Gap, Scene};

/// Radians by which the normals of a straight side may differ …
const STRAIGHT: f64 = 1e-6;
/// … and beyond which a direction is another one than the normal: a tangential part of a tenth.
const OBLIQUE: f64 = 0.1;
/// Part of the size of the mesh by which sides may cross for round-off.
const ROUND_OFF: f64 = 1e-10;

/// Pairs the edges of both sides that cover the same interval across the direction; see [`crate::mesh::sides::along`]. What has
/// nothing opposite is free. The gap is the distance along the direction and that of the scene.
pub(in crate::problem) fn pair_along(
    contact: &Contact,
    names: &[String; 2],
    given: [f64; 2],
    scene: &Scene,
    mesh: &Triangulation,
    notes: &mut Vec<Note>,
) -> Result<Interface, ProblemError> {
    let fault = |what: String, remedy: &str| ProblemError::Contact {
        contact: contact.name(),
        what,
        remedy: remedy.to_string(),
    };
    let d = outward(mesh, [&names[0], &names[1]], given);
    let first = facing(mesh, &names[0], d);
    let second = turned(facing(mesh, &names[1], d.map(|x| -x)));
    let edges = mesh.boundary(&names[0]);
    let side: Vec<[[f64; 2]; 2]> = edges.iter().map(|&e| mesh.edges[e].vertices.map(|v| mesh.points[v])).collect();
    let links = chain(&side).map_err(|p| {
        let what = format!("more than two edges of '{}' meet at {}", names[0], at(scene, p));
        fault(what, "a contact side is a curve without branches")
    })?;
    let matched: HashMap<usize, (Facing, Facing)> =
        first.iter().filter_map(|own| Some((own.edge, (*own, opposite(own, &second)?)))).collect();
    let extent = mesh.points.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
    let interference = matches!(contact.gap, Gap::Constant(g) if g < 0.0);
    let mut pairs = Vec::with_capacity(matched.len());
    for link in &links {
        let Some((own, other)) = matched.get(&edges[link.edge]) else { continue };
        let (length, normal) = mesh.edge_frame(own.edge);
        let vertices = mesh.edges[own.edge].vertices;
        let along = if link.reversed { [vertices[1], vertices[0]] } else { vertices };
        let second = if along == own.vertices { other.vertices } else { [other.vertices[1], other.vertices[0]] };
        let mut gap = [0.0; 2];
        for (end, gap) in gap.iter_mut().enumerate() {
            let [p, q] = [along[end], second[end]].map(|v| mesh.points[v]);
            let apart = (q[0] - p[0]) * d[0] + (q[1] - p[1]) * d[1] + contact.gap.at(link.arc[end]);
            if apart < -ROUND_OFF * extent && !interference {
                let what = format!("the sides cross at {}, by {:.3e} along the direction", at(scene, p), -apart);
                return Err(fault(
                    what,
                    "move the bodies apart, or write the depth of an interference fit as a negative gap",
                ));
            }
            *gap = if interference { apart } else { apart.max(0.0) };
        }
        let covered = own.span[1] - own.span[0];
        let shares = [length, mesh.edge_frame(other.edge).0].map(|length| covered / length);
        pairs.push(ContactPair {
            edges: [Some(own.edge), Some(other.edge)],
            first: along,
            second: Some(second),
            normal,
            direction: Direction { ends: [d; 2], shares },
            length: covered,
            arc: link.arc,
            gap,
            bow: Bow::of(&contact.gap, link.arc),
            friction: None,
            stiffness: contact.stiffness,
        });
    }
    if pairs.is_empty() {
        let what = format!("seen along its direction, '{}' and '{}' do not face each other", names[0], names[1]);
        return Err(fault(what, "correct `direction`, or the names"));
    }
    let facing: Vec<Link> = links.iter().filter(|link| matched.contains_key(&edges[link.edge])).copied().collect();
    notes.extend(unresolved_gap(contact, &facing));
    notes.extend(oblique(contact, &pairs, d));
    Ok(Interface { name: contact.name(), pairs, centre: None })
}

/// A remark where contact acts along a direction that is not the normal of a straight side: its forces have a tangential part.
fn oblique(contact: &Contact, pairs: &[ContactPair], d: [f64; 2]) -> Option<Note> {
    let off = |pair: &ContactPair| {
        let [nx, ny] = pair.normal;
        (nx * d[1] - ny * d[0]).atan2(nx * d[0] + ny * d[1])
    };
    let angles = || pairs.iter().map(off);
    let [least, most] = [angles().fold(f64::INFINITY, f64::min), angles().fold(f64::NEG_INFINITY, f64::max)];
    let is_straight = most - least <= STRAIGHT;
    (is_straight && most.abs() > OBLIQUE && most.abs() < FRAC_PI_2).then(|| Note {
        weakens_guarantee: false,
        text: format!(
            "contact {}: `direction` is {:.0}° off the normal of its straight first side. Contact acts along `direction`, so its \
             forces have a tangential part of {:.2} times the normal one, which a frictionless contact along the normal has not; \
             give the normal where that is meant",
            contact.name(),
            most.abs().to_degrees(),
            most.abs().tan()
        ),
    })
}
