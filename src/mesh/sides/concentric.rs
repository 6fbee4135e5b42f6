//! Contact sides on two circles about one centre, however each is divided.
//!
//! Seen from the centre, every edge covers an interval of angles. The vertices of each side are put onto the circle of the
//! other at their own angles, so that edges of both sides cover the same intervals and are parallel, and the distance
//! along the rays is that of the circles.

use std::f64::consts::TAU;

use super::glue::Record;
use crate::mesh::error::at;
use crate::mesh::{MeshError, Triangulation};
use crate::scene::{Circle, Joint, Note, Scene, counted};
use crate::vector::distance;

/// Part of the radius within which vertices lie on a circle.
const ON_CIRCLE: f64 = 1e-6;
/// Part of an edge beside its ends in which no vertex is put.
const CLOSE: f64 = 1e-6;
/// The largest angle that an edge of a circle covers; a longer one is a straight side that happens to end on it.
const LONGEST: f64 = TAU / 8.0;

/// Two sides that lie on circles about one centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Concentric {
    /// The centre of both circles.
    pub centre: [f64; 2],
    /// Their radii.
    pub radii: [f64; 2],
}

/// An edge as seen from a centre.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Seen {
    /// The edge.
    pub edge: usize,
    /// Its vertices, anticlockwise about the centre.
    pub vertices: [usize; 2],
    /// The angle of the first vertex.
    pub from: f64,
    /// The angle that it covers.
    pub width: f64,
}

impl Seen {
    /// The part of the way from the first vertex to the second at which an angle lies, from 0 on.
    fn part(&self, angle: f64) -> f64 {
        (angle - self.from).rem_euclid(TAU) / self.width
    }
}

/// The angle of a point about a centre.
fn angle(centre: [f64; 2], p: [f64; 2]) -> f64 {
    (p[1] - centre[1]).atan2(p[0] - centre[0])
}

/// The edges of the boundary `name` as seen from `centre`.
pub(crate) fn seen(mesh: &Triangulation, name: &str, centre: [f64; 2]) -> Vec<Seen> {
    let of = |edge: usize| {
        let [v, w] = mesh.edges[edge].vertices;
        let [a, b] = [v, w].map(|v| angle(centre, mesh.points[v]));
        let turn = (b - a).rem_euclid(TAU);
        if turn <= 0.5 * TAU {
            Seen { edge, vertices: [v, w], from: a, width: turn }
        } else {
            Seen { edge, vertices: [w, v], from: b, width: TAU - turn }
        }
    };
    mesh.boundary(name).into_iter().map(of).collect()
}

impl Concentric {
    /// The circles of two boundaries that face each other across a distance; `None` where they lie on no such circles, or
    /// on one.
    pub fn of(mesh: &Triangulation, names: [&str; 2]) -> Option<Self> {
        let sides = names.map(|name| mesh.boundary(name));
        let points = |side: usize| {
            let mut vertices: Vec<usize> = sides[side].iter().flat_map(|&e| mesh.edges[e].vertices).collect();
            vertices.sort_unstable();
            vertices.dedup();
            vertices.into_iter().map(|v| mesh.points[v]).collect::<Vec<_>>()
        };
        let both = [points(0), points(1)];
        let [fewer, more] = if both[0].len() <= both[1].len() { [0, 1] } else { [1, 0] };
        if both[fewer].len() < 3 || both[more].len() < 4 {
            return None;
        }
        let circle = spread(&both[more])?;
        let centre = circle.centre;
        let mut radii = [0.0; 2];
        for (radius, points) in radii.iter_mut().zip(&both) {
            *radius = points.iter().map(|p| distance(*p, centre)).sum::<f64>() / points.len() as f64;
            let own = Circle { centre, radius: *radius };
            if !points.iter().all(|p| own.holds(*p, ON_CIRCLE)) {
                return None;
            }
        }
        let apart = (radii[0] - radii[1]).abs() > 2.0 * ON_CIRCLE * radii[0].max(radii[1]);
        let all_short = names.iter().all(|name| seen(mesh, name, centre).iter().all(|s| s.width <= LONGEST));
        (apart && all_short && facing(mesh, &sides, centre)).then_some(Concentric { centre, radii })
    }
}

/// True if one side is hollow and the other one round, all along.
fn facing(mesh: &Triangulation, sides: &[Vec<usize>; 2], centre: [f64; 2]) -> bool {
    let outwards = |&e: &usize| {
        let (_, n) = mesh.edge_frame(e);
        let p = mesh.points[mesh.edges[e].vertices[0]];
        n[0] * (p[0] - centre[0]) + n[1] * (p[1] - centre[1]) > 0.0
    };
    let [first, second] = sides;
    let round = first.first().is_some_and(outwards);
    first.iter().all(|e| outwards(e) == round) && second.iter().all(|e| outwards(e) != round)
}

/// The circle through three points far from each other.
fn spread(points: &[[f64; 2]]) -> Option<Circle> {
    let farthest = |from: &dyn Fn([f64; 2]) -> f64| points.iter().copied().max_by(|p, q| from(*p).total_cmp(&from(*q)));
    let a = *points.first()?;
    let b = farthest(&|p| distance(p, a))?;
    let c = farthest(&|p| ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])).abs())?;
    Circle::through(a, b, c)
}

/// Puts the vertices of each side onto the circle of the other at their angles.
///
/// # Errors
/// [`MeshError::Contact`] where a triangle is too flat to take one.
pub(in crate::mesh) fn match_around(
    mesh: Triangulation,
    scene: &Scene,
    joint: Joint,
    Concentric { centre, radii }: Concentric,
    record: &mut Record,
) -> Result<Triangulation, MeshError> {
    let names = joint.sides;
    let sides = [0, 1].map(|i| seen(&mesh, &names[i], centre));
    let mut inserted = Vec::new();
    let (mut counts, mut bulge) = ([0, 0], 0.0_f64);
    for (from, into) in [(0, 1), (1, 0)] {
        let mut angles: Vec<f64> =
            sides[from].iter().flat_map(|s| s.vertices).map(|v| angle(centre, mesh.points[v])).collect();
        angles.sort_by(f64::total_cmp);
        angles.dedup();
        for angle in angles {
            let inside = |s: &&Seen| (CLOSE..1.0 - CLOSE).contains(&s.part(angle));
            let Some(edge) = sides[into].iter().find(inside) else { continue };
            let (sine, cosine) = angle.sin_cos();
            inserted.push((edge.edge, [centre[0] + radii[into] * cosine, centre[1] + radii[into] * sine]));
            bulge = bulge.max(radii[into] * (1.0 - (0.5 * edge.width).cos()));
            counts[from] += 1;
        }
    }
    let mesh = if inserted.is_empty() {
        mesh
    } else {
        let flat = |p: [f64; 2]| {
            let what = format!("the triangle at {} is too flat to take a vertex on its circle", at(scene, p));
            MeshError::contact(scene, joint.quoted(), what, "give both sides the same number of edges, or more of them")
        };
        mesh.with_inserted(&inserted, &mut record.parent).map_err(flat)?
    };
    let gap = (radii[0] - radii[1]).abs();
    let mut text = format!(
        "{}: the sides lie on circles about {} with radii that differ by {gap:.3e}; they are matched along its rays, \
         and contact acts along these",
        joint.name(),
        at(scene, centre)
    );
    if !inserted.is_empty() {
        let [a, b] = [0, 1].map(|i| format!("{} of '{}'", counted(counts[i], "vertex"), names[i]));
        text += &format!(
            ". {a} and {b} were put onto the circle of the other side, up to {bulge:.1e} from its edges: the bounds are for \
             the bodies with these vertices"
        );
    }
    record.notes.push(Note { weakens_guarantee: bulge > 0.0, text });
    Ok(mesh)
}
