//! The two sides of a contact on circles about one centre, edge against edge.

use std::collections::HashMap;
use std::f64::consts::TAU;

use super::unresolved_gap;
use crate::mesh::Triangulation;
use crate::mesh::error::at;
use crate::mesh::sides::concentric::{Seen, seen};
use crate::mesh::sides::polyline::{Link, chain};
use crate::problem::{Bow, ContactPair, Direction, Interface, Note, ProblemError};
use crate::scene::{Contact, Gap, Scene};

/// Part of an interval of angles within which its ends are those of another one.
const MATCHED: f64 = 1e-5;
/// Part of the size of the mesh by which sides may cross for round-off.
const ROUND_OFF: f64 = 1e-10;

/// Pairs the edges of both sides that cover the same angles about `centre`; see [`crate::mesh::sides::concentric`]. What has
/// nothing opposite is free. The gap is the distance along the rays and that of the scene.
pub(in crate::problem) fn pair_around(
    contact: &Contact,
    names: &[String; 2],
    centre: [f64; 2],
    scene: &Scene,
    mesh: &Triangulation,
    notes: &mut Vec<Note>,
) -> Result<Interface, ProblemError> {
    let fault = |what: String, remedy: &str| ProblemError::Contact {
        contact: contact.name(),
        what,
        remedy: remedy.to_string(),
    };
    let edges = mesh.boundary(&names[0]);
    let side: Vec<[[f64; 2]; 2]> = edges.iter().map(|&e| mesh.edges[e].vertices.map(|v| mesh.points[v])).collect();
    let links = chain(&side).map_err(|p| {
        let what = format!("more than two edges of '{}' meet at {}", names[0], at(scene, p));
        fault(what, "a contact side is a curve without branches")
    })?;
    let own: HashMap<usize, Seen> = seen(mesh, &names[0], centre).into_iter().map(|s| (s.edge, s)).collect();
    let mut others = seen(mesh, &names[1], centre);
    others.sort_by(|a, b| a.from.total_cmp(&b.from));
    let extent = mesh.points.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
    let interference = matches!(contact.gap, Gap::Constant(g) if g < 0.0);
    let (mut pairs, mut faced): (Vec<ContactPair>, Vec<Link>) = Default::default();
    for link in &links {
        let Some((own, other)) = own.get(&edges[link.edge]).and_then(|own| Some((own, opposite(own, &others)?))) else {
            continue;
        };
        let (length, normal) = mesh.edge_frame(own.edge);
        let vertices = mesh.edges[own.edge].vertices;
        let along = if link.reversed { [vertices[1], vertices[0]] } else { vertices };
        let second = if along == own.vertices { other.vertices } else { [other.vertices[1], other.vertices[0]] };
        let (mut ends, mut gap) = ([[0.0; 2]; 2], [0.0; 2]);
        for end in 0..2 {
            let [p, q] = [along[end], second[end]].map(|v| mesh.points[v]);
            let ray = super::direction::unit([p[0] - centre[0], p[1] - centre[1]]);
            let sign = (ray[0] * normal[0] + ray[1] * normal[1]).signum();
            let d = ray.map(|x| sign * x);
            let apart = (q[0] - p[0]) * d[0] + (q[1] - p[1]) * d[1] + contact.gap.at(link.arc[end]);
            if apart < -ROUND_OFF * extent && !interference {
                let what =
                    format!("the sides cross at {}, by {:.3e} along the ray of their centre", at(scene, p), -apart);
                return Err(fault(
                    what,
                    "correct the radii, or write the depth of an interference fit as a negative gap, beside that of the mesh",
                ));
            }
            ends[end] = d;
            gap[end] = if interference { apart } else { apart.max(0.0) };
        }
        pairs.push(ContactPair {
            edges: [Some(own.edge), Some(other.edge)],
            first: along,
            second: Some(second),
            normal,
            direction: Direction { ends, shares: [1.0, length / mesh.edge_frame(other.edge).0] },
            length,
            arc: link.arc,
            gap,
            bow: Bow::of(&contact.gap, link.arc),
            friction: None,
            stiffness: contact.stiffness,
        });
        faced.push(*link);
    }
    if pairs.is_empty() {
        let what = format!("seen from their centre, '{}' and '{}' do not face each other", names[0], names[1]);
        return Err(fault(what, "correct the names, or the places of the bodies"));
    }
    notes.extend(unresolved_gap(contact, &faced));
    Ok(Interface { name: contact.name(), pairs, centre: Some(centre) })
}

/// The edge of the other side, ordered by angles, that covers the same ones.
fn opposite(own: &Seen, side: &[Seen]) -> Option<Seen> {
    let close = MATCHED * own.width;
    let apart = |a: f64, b: f64| {
        let turn = (a - b).rem_euclid(TAU);
        turn.min(TAU - turn)
    };
    let same = |s: &Seen| apart(s.from, own.from) <= close && (s.width - own.width).abs() <= close;
    let n = side.len();
    let from = side.partition_point(|s| s.from < own.from - close);
    // Angles go round: an interval may begin at the other end of the list.
    (0..3).map(|k| side[(from + k + n - 1) % n]).find(same)
}
