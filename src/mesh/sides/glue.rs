//! Sides of contacts and bonds that coincide as curves get coinciding vertices.
//!
//! Every vertex of one side is put into the edges of the other, break points of the gap and of windows into both. What is left is
//! the condition of the scene: two coinciding polylines.

use std::collections::HashMap;

use super::along::{match_along, move_onto};
use super::bonded::bond;
use super::bulge::Curvatures;
use super::concentric::{Concentric, match_around};
use super::nearby::{CLOSE, ROUND_OFF, distance_to, extent, side_vertices, snap};
use super::polyline::{chain, inner_points, key};
use crate::mesh::error::at;
use crate::mesh::topology::boxes::{BoxTree, around};
use crate::mesh::{MeshError, Triangulation, Uncut};
use crate::scene::{ContactSides, Joint, Note, Scene, counted};

/// A mesh whose contact sides match and whose bonds are closed.
#[derive(Debug, Clone)]
pub struct Glued {
    /// The mesh.
    pub mesh: Triangulation,
    /// Notes on the changes that made sides match.
    pub notes: Vec<Note>,
    /// The mesh before; `None` where nothing was done to it.
    pub uncut: Option<Uncut>,
}

/// Changes of a mesh.
pub(in crate::mesh) struct Record {
    /// In words.
    pub notes: Vec<Note>,
    /// Of every triangle, the one before that it was cut out of.
    pub parent: Vec<usize>,
}

/// Makes the two sides of every contact of `scene` match vertex for vertex, bit for bit, and those of every rigid bond one.
///
/// # Errors
/// [`MeshError::Contact`] with the place where two sides do not lie on one polyline or where only one goes on.
pub fn glue(before: Triangulation, scene: &Scene) -> Result<Glued, MeshError> {
    let mut record = Record { notes: Vec::new(), parent: (0..before.triangles.len()).collect() };
    let mut mesh = before.clone();
    let (along, others): (Vec<usize>, Vec<usize>) =
        (0..scene.contacts.len()).partition(|&index| scene.contacts[index].direction.is_some());
    // What the other side gets of them is put there with its vertices.
    for index in along {
        mesh = insert_breaks(mesh, scene, index, &mut record)?;
    }
    snap(&mut mesh, scene, &mut record.notes);
    for joint in scene.joints() {
        mesh = match (joint.direction, concentric(&mesh, joint)) {
            (Some(direction), _) => {
                let matched = match_along(mesh, scene, joint, direction, &mut record)?;
                match joint.is_bond() {
                    true => move_onto(matched, scene, joint, direction, &mut record)?,
                    false => matched,
                }
            }
            (None, Some(circles)) => match_around(mesh, scene, joint, circles, &mut record)?,
            (None, None) => match_vertices(mesh, scene, joint, &mut record)?,
        };
    }
    for index in others {
        mesh = insert_breaks(mesh, scene, index, &mut record)?;
    }
    let changed = mesh.points != before.points;
    let (mesh, vertex) = bond(mesh, scene)?;
    let Record { notes, parent } = record;
    Ok(Glued { mesh, notes, uncut: changed.then(|| Uncut::new(before, parent, vertex)) })
}

/// The circles of sides with a distance between them, along whose rays they are matched.
fn concentric(mesh: &Triangulation, joint: Joint) -> Option<Concentric> {
    let [first, second] = joint.sides;
    joint.turns.then(|| Concentric::of(mesh, [first, second]))?
}

/// Puts the vertices of each side into the edges of the other, or beside them where the curve passes that they stand for.
fn match_vertices(
    mesh: Triangulation,
    scene: &Scene,
    joint: Joint,
    record: &mut Record,
) -> Result<Triangulation, MeshError> {
    let names = joint.sides;
    let mut inserted = Vec::new();
    let mut counts = [0, 0];
    let (mut moved, mut beside) = (0.0_f64, 0.0_f64);
    let curvatures = names.each_ref().map(|name| Curvatures::of(&mesh, name));
    for (from, into) in [(0, 1), (1, 0)] {
        let edges = mesh.boundary(&names[into]);
        let ends = |e: usize| mesh.edges[e].vertices.map(|v| mesh.points[v]);
        let margin = |e: usize| CLOSE * mesh.edge_frame(e).0;
        // A curve whose edges make no corners stays within an eighth of their length.
        let tree = BoxTree::new(edges.iter().map(|&e| around(&ends(e), 0.125 * mesh.edge_frame(e).0)).collect());
        let present: Vec<_> = edges.iter().flat_map(|&e| ends(e).map(key)).collect();
        let present: std::collections::HashSet<_> = present.into_iter().collect();
        for v in side_vertices(&mesh, &names[from]) {
            let p = mesh.points[v.vertex];
            if present.contains(&key(p)) {
                continue;
            }
            let near: Vec<usize> = tree.meeting(&[p, p]).into_iter().map(|i| edges[i]).collect();
            let nearest = near
                .iter()
                .map(|&e| (distance_to(p, ends(e)), e))
                .filter(|(d, e)| *d <= margin(*e))
                .min_by(|x, y| x.0.total_cmp(&y.0));
            if let Some((off, edge)) = nearest {
                moved = moved.max(off);
                counts[from] += 1;
                inserted.push((edge, p));
                continue;
            }
            let passing = near
                .iter()
                .filter_map(|&e| Some((curvatures[into].passes(e, p, &curvatures[from], v.vertex)?, e)))
                .min_by(|x, y| x.0.total_cmp(&y.0));
            let Some((off, edge)) = passing else {
                let what =
                    format!("the vertex {} of '{}' does not lie on '{}'", at(scene, p), names[from], names[into]);
                let remedy = "the two sides must be coinciding polylines, or divide one curve, with the same ends: divide the \
                              longer one there and name the common part only, or give both sides the same points; sides that lie \
                              apart are matched along the rays of their centre where they are arcs about one, and along a \
                              `direction` otherwise, with a `gap` beside their distance where there is one";
                return Err(MeshError::contact(scene, joint.quoted(), what, remedy));
            };
            beside = beside.max(off);
            counts[from] += 1;
            inserted.push((edge, p));
        }
    }
    if inserted.is_empty() {
        return Ok(mesh);
    }
    let size = extent(&mesh);
    let mesh = mesh.with_inserted(&inserted, &mut record.parent).map_err(|p| too_flat(scene, joint.quoted(), p))?;
    let parts: Vec<String> = [(0, 1), (1, 0)]
        .into_iter()
        .filter(|(from, _)| counts[*from] > 0)
        .map(|(from, into)| {
            format!("{} of '{}' inserted into '{}'", counted(counts[from], "vertex"), names[from], names[into])
        })
        .collect();
    record.notes.push(Note { weakens_guarantee: false, text: format!("{}: {}", joint.name(), parts.join(", ")) });
    if beside > 0.0 {
        record.notes.push(Note {
            weakens_guarantee: true,
            text: format!(
                "{}: both sides stand for one curve, and their vertices lie up to {beside:.1e} beside the edges of the other \
                 side; these now pass through them. The bounds are for the bodies with these edges",
                joint.name()
            ),
        });
    }
    if moved > ROUND_OFF * size {
        record.notes.push(Note {
            weakens_guarantee: true,
            text: format!("{}: the sides deviate by {moved:.1e} and were made to coincide", joint.name()),
        });
    }
    Ok(mesh)
}

fn too_flat(scene: &Scene, joint: String, p: [f64; 2]) -> MeshError {
    let what = format!("the triangle at {} is too flat to take a vertex of the other side", at(scene, p));
    MeshError::contact(scene, joint, what, "mesh both sides with the same points")
}

/// Puts the break points of a contact into its sides, so that the gap and the weights of quantities are linear on every
/// edge.
fn insert_breaks(
    mesh: Triangulation,
    scene: &Scene,
    index: usize,
    record: &mut Record,
) -> Result<Triangulation, MeshError> {
    let (contact, breaks) = (&scene.contacts[index], scene.contact_breaks(index));
    if breaks.is_empty() {
        return Ok(mesh);
    }
    let ends = |e: usize| mesh.edges[e].vertices.map(|v| mesh.points[v]);
    let first = mesh.boundary(contact.first());
    let side: Vec<[[f64; 2]; 2]> = first.iter().map(|&e| ends(e)).collect();
    // A side that branches is reported when the contact is paired.
    let Ok(links) = chain(&side) else { return Ok(mesh) };
    let points = inner_points(&side, &links, &breaks);
    if points.is_empty() {
        return Ok(mesh);
    }
    let mut inserted: Vec<(usize, [f64; 2])> = points.iter().map(|(i, p)| (first[*i], *p)).collect();
    if let ContactSides::Between([_, second]) = &contact.sides {
        let facing: HashMap<_, usize> = mesh.boundary(second).into_iter().map(|e| (ends(e).map(key), e)).collect();
        let opposite = |i: usize| facing.get(&[key(side[i][1]), key(side[i][0])]);
        inserted.extend(points.iter().filter_map(|(i, p)| Some((*opposite(*i)?, *p))));
    }
    let mesh = mesh
        .with_inserted(&inserted, &mut record.parent)
        .map_err(|p| too_flat(scene, format!("contact '{}'", contact.name()), p))?;
    let of_gap = inner_points(&side, &links, &contact.gap.breaks()).len();
    let mut of_friction = contact.gap.breaks();
    of_friction.extend(scene.friction_breaks(index));
    let with_friction = inner_points(&side, &links, &of_friction).len();
    for (count, place) in [
        (of_gap, "the gap bends or touches"),
        (with_friction - of_gap, "the friction bound bends"),
        (points.len() - with_friction, "windows of quantities bend"),
    ] {
        if count > 0 {
            let text = format!("contact {}: {} inserted where {place}", contact.name(), counted(count, "vertex"));
            record.notes.push(Note { weakens_guarantee: false, text });
        }
    }
    Ok(mesh)
}
