//! Contact sides that are matched along a direction and need not coincide.
//!
//! A side is seen from the direction: its edges that face the other side, each with the interval that it covers across the
//! direction. Every vertex of one side is put into the edge of the other that it is projected onto; edges of both sides
//! then cover the same intervals, and forces along the direction act at equal projected positions.

use super::glue::Record;
use super::polyline::SAME;
use crate::mesh::error::at;
use crate::mesh::{MeshError, Triangulation};
use crate::scene::{Joint, Note, Scene, counted};

/// Cosine of the angle between the direction and a normal below which an edge does not face the other side.
const GRAZING: f64 = 0.05;

/// Part of an interval within which two positions across the direction are one.
const CLOSE: f64 = 1e-8;

/// Part of an interval within which its ends are those of another one.
const MATCHED: f64 = 1e-6;

/// Of the longest edge of a side, what its vertices may be moved by: two meshes of one curve lie no farther apart.
const NEAR: f64 = 0.25;

/// Triangles that a side which is moved leaves with less than this part of their area are no longer those of the body.
const SQUEEZED: f64 = 0.1;

/// An edge that faces the other side.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Facing {
    /// The edge.
    pub edge: usize,
    /// Its vertices by their position across the direction.
    pub vertices: [usize; 2],
    /// These positions, ascending.
    pub span: [f64; 2],
}

/// The position of a point across a direction.
pub(crate) fn across(d: [f64; 2], p: [f64; 2]) -> f64 {
    p[1] * d[0] - p[0] * d[1]
}

/// The edges of boundary `name` whose outward normal points along `d`, ordered across it.
pub(crate) fn facing(mesh: &Triangulation, name: &str, d: [f64; 2]) -> Vec<Facing> {
    let edges = mesh.boundary(name).into_iter().filter(|&e| {
        let (_, n) = mesh.edge_frame(e);
        n[0] * d[0] + n[1] * d[1] > GRAZING
    });
    let mut all: Vec<Facing> = edges
        .map(|edge| {
            let [v, w] = mesh.edges[edge].vertices;
            let [s, t] = [v, w].map(|v| across(d, mesh.points[v]));
            if s <= t {
                Facing { edge, vertices: [v, w], span: [s, t] }
            } else {
                Facing { edge, vertices: [w, v], span: [t, s] }
            }
        })
        .collect();
    all.sort_by(|a, b| a.span[0].total_cmp(&b.span[0]).then(a.edge.cmp(&b.edge)));
    all
}

/// The direction of `contact` out of its first side, towards the second: the one given, or its opposite where only that
/// leads from one side to the other.
pub(crate) fn outward(mesh: &Triangulation, names: [&str; 2], given: [f64; 2]) -> [f64; 2] {
    let back = given.map(|x| -x);
    let meets = |d: [f64; 2]| {
        let (first, second) = (facing(mesh, names[0], d), facing(mesh, names[1], d.map(|x| -x)));
        // Seen the other way, positions change their sign.
        first.iter().any(|f| second.iter().any(|s| f.span[0] < -s.span[0] && -s.span[1] < f.span[1]))
    };
    if !meets(given) && meets(back) { back } else { given }
}

/// Puts the vertices of each side into the edges of the other that they are projected onto.
///
/// # Errors
/// [`MeshError::Contact`] where a side folds over itself, seen along the direction, or the sides do not face each other.
pub(in crate::mesh) fn match_along(
    mesh: Triangulation,
    scene: &Scene,
    joint: Joint,
    given: [f64; 2],
    record: &mut Record,
) -> Result<Triangulation, MeshError> {
    let names = joint.sides;
    let d = outward(&mesh, [&names[0], &names[1]], given);
    // Both sides are seen along d, so that positions agree.
    let sides = [facing(&mesh, &names[0], d), turned(facing(&mesh, &names[1], d.map(|x| -x)))];
    for (side, name) in sides.iter().zip(names) {
        if let Some(w) = side.windows(2).find(|w| w[1].span[0] < w[0].span[1] - CLOSE * (w[0].span[1] - w[0].span[0])) {
            let what = format!("'{name}' folds over itself at {}", at(scene, mesh.points[w[1].vertices[0]]));
            let remedy = "seen along `direction` a contact side has to be a single curve: name the part that can touch";
            return Err(MeshError::contact(scene, joint.quoted(), what, remedy));
        }
    }
    let mut inserted = Vec::new();
    let mut counts = [0, 0];
    for (from, into) in [(0, 1), (1, 0)] {
        // Each with the shorter of its edges: what is put nowhere has to be an end of that one, too.
        let long = |f: &Facing| f.span[1] - f.span[0];
        let mut positions: Vec<(f64, f64)> = sides[from].iter().flat_map(|f| f.span.map(|s| (s, long(f)))).collect();
        positions.sort_by(|a, b| a.0.total_cmp(&b.0));
        positions.dedup_by(|a, b| {
            let is_same = (a.0 - b.0).abs() <= SAME * b.0.abs();
            b.1 = if is_same { b.1.min(a.1) } else { b.1 };
            is_same
        });
        for (position, shortest) in positions {
            let Some(other) = sides[into].iter().find(|f| f.span[0] < position && position < f.span[1]) else {
                continue;
            };
            let t = (position - other.span[0]) / (other.span[1] - other.span[0]);
            let close = CLOSE * (shortest / long(other)).min(1.0);
            if t > close && t < 1.0 - close {
                let [p, q] = other.vertices.map(|v| mesh.points[v]);
                inserted.push((other.edge, [0, 1].map(|c| p[c] + t * (q[c] - p[c]))));
                counts[from] += 1;
            }
        }
    }
    let overlap = sides[0].iter().any(|f| sides[1].iter().any(|s| f.span[0] < s.span[1] && s.span[0] < f.span[1]));
    if !overlap {
        let what = format!("seen along its direction, '{}' and '{}' do not face each other", names[0], names[1]);
        let remedy = "the direction has to lead from one side to the other: correct `direction`, or the names";
        return Err(MeshError::contact(scene, joint.quoted(), what, remedy));
    }
    if inserted.is_empty() {
        return Ok(mesh);
    }
    let flat = |p: [f64; 2]| {
        let what = format!("the triangle at {} is too flat to take a vertex of the other side", at(scene, p));
        MeshError::contact(scene, joint.quoted(), what, "mesh both sides with about the same edge lengths")
    };
    let mesh = mesh.with_inserted(&inserted, &mut record.parent).map_err(flat)?;
    let [a, b] = [0, 1].map(|i| format!("{} of '{}'", counted(counts[i], "vertex"), names[i]));
    let text = format!("{}: along its direction, {a} and {b} were inserted into the other side", joint.name());
    record.notes.push(Note { weakens_guarantee: false, text });
    Ok(mesh)
}

/// The edges of a side as seen from the other side.
pub(crate) fn turned(side: Vec<Facing>) -> Vec<Facing> {
    let turn =
        |f: Facing| Facing { edge: f.edge, vertices: [f.vertices[1], f.vertices[0]], span: [-f.span[1], -f.span[0]] };
    side.into_iter().rev().map(turn).collect()
}

/// The edge of the other side that covers the same interval.
pub(crate) fn opposite(own: &Facing, side: &[Facing]) -> Option<Facing> {
    let close = MATCHED * (own.span[1] - own.span[0]);
    let from = side.partition_point(|f| f.span[0] < own.span[0] - close);
    let near = |f: &&Facing| (0..2).all(|k| (f.span[k] - own.span[k]).abs() <= close);
    side[from..].iter().take(2).find(near).copied()
}

/// The edges of the first side of a joint, each with that of the second that covers the same interval along `given`.
fn matched(mesh: &Triangulation, names: &[String; 2], given: [f64; 2]) -> Vec<[Facing; 2]> {
    let d = outward(mesh, [&names[0], &names[1]], given);
    let second = turned(facing(mesh, &names[1], d.map(|x| -x)));
    let first = facing(mesh, &names[0], d).into_iter();
    first.filter_map(|own| Some([own, opposite(&own, &second)?])).collect()
}

/// Moves the vertices of the second side of a bond onto those of the first that they face along `given`, where both sides have
/// vertices at the same positions.
///
/// # Errors
/// [`MeshError::Contact`] where the triangles beside the second side cannot follow.
pub(in crate::mesh) fn move_onto(
    mut mesh: Triangulation,
    scene: &Scene,
    joint: Joint,
    given: [f64; 2],
    record: &mut Record,
) -> Result<Triangulation, MeshError> {
    let pairs = matched(&mesh, joint.sides, given);
    let before: Vec<f64> = (0..mesh.triangles.len()).map(|t| mesh.area(t)).collect();
    let fault = |what: String| {
        let remedy =
            "draw the sides closer, mesh the second one more coarsely, or fill the space between them with a body";
        Err(MeshError::contact(scene, joint.quoted(), what, remedy))
    };
    let (mut farthest, mut moved) = (0.0_f64, vec![false; mesh.points.len()]);
    let length = pairs.iter().map(|[_, other]| mesh.edge_frame(other.edge).0).fold(0.0, f64::max);
    for [own, other] in &pairs {
        let apart = |k: usize| {
            let [[x, y], [a, b]] = [own.vertices[k], other.vertices[k]].map(|v| mesh.points[v]);
            if moved[other.vertices[k]] { 0.0 } else { (x - a).hypot(y - b) }
        };
        if let Some(k) = [0, 1].into_iter().find(|k| apart(*k) > NEAR * length) {
            let [p, q] = [own.vertices[k], other.vertices[k]].map(|v| at(scene, mesh.points[v]));
            return fault(format!(
                "{q} lies {:.3e} from {p}, more than two meshes of one curve with edges of {length:.3e} do",
                apart(k)
            ));
        }
        for (v, w) in own.vertices.into_iter().zip(other.vertices) {
            let ([x, y], [a, b]) = (mesh.points[v], mesh.points[w]);
            farthest = farthest.max((x - a).hypot(y - b));
            mesh.points[w] = [x, y];
            moved[w] = true;
        }
    }
    let flat = |t: &usize| mesh.triangles[*t].iter().any(|v| moved[*v]) && mesh.area(*t) < SQUEEZED * before[*t];
    if let Some(t) = (0..mesh.triangles.len()).find(flat) {
        return fault(format!(
            "the sides lie up to {farthest:.3e} apart, and the triangle at {} cannot follow where they are drawn together",
            at(scene, mesh.points[mesh.triangles[t][0]])
        ));
    }
    if farthest > 0.0 {
        let text = format!(
            "{}: vertices of '{}' were moved by up to {farthest:.3e} onto '{}'; the bounds are for the bodies so drawn",
            joint.name(),
            joint.sides[1],
            joint.sides[0]
        );
        record.notes.push(Note { weakens_guarantee: false, text });
    }
    Ok(mesh)
}
