//! The directions of contact of an interface, from the edges of its first side.
//!
//! Facets with normals of their own are another problem than the curve that they stand for, and refining does not lead
//! back: two bodies that touch along both facets at a vertex cannot slide there. One direction at the vertex lets them.

use std::collections::HashMap;

use super::direction::unit;
use crate::mesh::{CORNER, Curved};
use crate::problem::{ContactPair, Interface, Note, Refinement};
use crate::scene::counted;

/// Sine below which two edges are in line.
const IN_LINE: f64 = 1e-6;
/// An edge this many times as long as its neighbour is no part of the same curve, but a straight side that it runs into.
const MUCH_LONGER: f64 = 4.0;

/// Gives the pairs of a first mesh their directions: at a vertex between two edges the normal of the circle through it and
/// its two neighbours, at the end of a curve that of the last such circle. A vertex where the edges turn by more than 30°
/// keeps both normals, and what is straight the normal that it has.
pub(in crate::problem) fn smooth(pairs: &mut [ContactPair]) {
    let joined: Vec<Option<usize>> = (0..pairs.len()).map(|k| next(pairs, k)).collect();
    let mut turned: Vec<[Option<[f64; 2]>; 2]> = vec![[None; 2]; pairs.len()];
    for (k, next) in joined.iter().enumerate() {
        let Some(next) = *next else { continue };
        if let Some(n) = between(&pairs[k], &pairs[next]) {
            turned[k][1] = Some(n);
            turned[next][0] = Some(n);
        }
    }
    let ends_at: Vec<[bool; 2]> = (0..pairs.len()).map(|k| [!joined.contains(&Some(k)), joined[k].is_none()]).collect();
    for ((pair, turned), last) in pairs.iter_mut().zip(&turned).zip(ends_at) {
        let [a, b] = *turned;
        // Where the curve ends, the arc goes on as it came: the mirror image about the normal of the edge.
        let end = |own: Option<[f64; 2]>, other: Option<[f64; 2]>, last: bool| match (own, other) {
            (Some(n), _) => n,
            (None, Some(m)) if last => mirrored(m, pair.normal),
            (None, _) => pair.normal,
        };
        pair.direction.ends = [end(a, b, last[0]), end(b, a, last[1])];
    }
}

/// The pair that follows on pair `k` along the first side.
fn next(pairs: &[ContactPair], k: usize) -> Option<usize> {
    let here = pairs[k].first[1];
    match pairs.get(k + 1) {
        Some(after) if after.first[0] == here => Some(k + 1),
        // A closed curve ends where it began.
        _ => (0..=k).find(|&j| pairs[j].first[0] == here && j != k),
    }
}

/// The common normal at the vertex between two edges; `None` where they are in line or make a corner.
fn between(before: &ContactPair, after: &ContactPair) -> Option<[f64; 2]> {
    let (m, n) = (before.normal, after.normal);
    let (sine, cosine) = (m[0] * n[1] - m[1] * n[0], m[0] * n[0] + m[1] * n[1]);
    if cosine < CORNER || sine.abs() <= IN_LINE {
        return None;
    }
    let (p, q) = (before.length, after.length);
    // A chord turns away from the tangent by half the angle that it stands for.
    let [at_m, at_n] = if p.max(q) > MUCH_LONGER * p.min(q) { [p, q] } else { [q, p] };
    Some(unit([at_m * m[0] + at_n * n[0], at_m * m[1] + at_n * n[1]]))
}

/// The reflection of a unit vector about another one.
fn mirrored(m: [f64; 2], n: [f64; 2]) -> [f64; 2] {
    let along = 2.0 * (m[0] * n[0] + m[1] * n[1]);
    unit([along * n[0] - m[0], along * n[1] - m[1]])
}

/// The mesh that a finer one was made of by dividing edges once.
pub(in crate::problem) struct Coarser<'a> {
    /// Its contacts.
    pub interfaces: &'a [Interface],
    /// Its number of vertices, which keep their index.
    pub vertices: usize,
    /// The edges that were divided on a circle.
    pub curved: &'a Curved,
    /// Its treatment of curves in refinement.
    pub refinement: Refinement,
}

impl<'a> Coarser<'a> {
    /// Finds the coarser pairs of an interface that finer ones are parts of: every part has an end in common with the whole.
    pub fn parents(&self, interface: usize) -> impl Fn(&ContactPair) -> Option<&'a ContactPair> + use<'a> {
        let pairs = self.interfaces.get(interface).map_or(&[][..], |coarse| &coarse.pairs);
        let starting: HashMap<usize, usize> = pairs.iter().enumerate().map(|(k, p)| (p.first[0], k)).collect();
        let ending: HashMap<usize, usize> = pairs.iter().enumerate().map(|(k, p)| (p.first[1], k)).collect();
        let vertices = self.vertices;
        move |pair| {
            let [a, b] = pair.first;
            let parent = if a < vertices { starting.get(&a) } else { ending.get(&b) };
            parent.map(|k| &pairs[*k])
        }
    }
}

/// Gives the pairs of a finer mesh the directions of the coarser pairs that they are parts of: a vertex put on an edge lies
/// between its ends, and so does its direction; one put on a circle has the normal of that.
pub(in crate::problem) fn inherit(pairs: &mut [ContactPair], points: &[[f64; 2]], coarser: &Coarser, interface: usize) {
    let parent = coarser.parents(interface);
    for pair in pairs {
        let [a, b] = pair.first;
        let Some(parent) = parent(pair).filter(|p| !p.direction.is_constant()) else { continue };
        let circle = parent.edges[0].and_then(|e| coarser.curved.get(&e));
        let kept = |end: usize, v: usize| (v == parent.first[end]).then_some(parent.direction.ends[end]);
        let new = |v: usize| match circle {
            Some(circle) => {
                let n = circle.outward(points[v]);
                let sign = (n[0] * pair.normal[0] + n[1] * pair.normal[1]).signum();
                n.map(|x| sign * x)
            }
            None => parent.direction.at(0.5),
        };
        pair.direction.ends = [kept(0, a).unwrap_or_else(|| new(a)), kept(1, b).unwrap_or_else(|| new(b))];
    }
}

/// Gives the pairs of a finer mesh the gap of the coarser pairs that they are parts of, where it is linear along these.
pub(in crate::problem) fn keep_gap(pairs: &mut Vec<ContactPair>, coarser: &Coarser, interface: usize) {
    let parent = coarser.parents(interface);
    pairs.retain(|pair| parent(pair).is_some());
    for pair in pairs {
        let Some(parent) = parent(pair).filter(|parent| parent.bow.is_none()) else { continue };
        let [first, last] = parent.gap;
        let of = |end: usize| {
            let whole = pair.first[end] == parent.first[end];
            if whole { parent.gap[end] } else { 0.5 * (first + last) }
        };
        pair.gap = [of(0), of(1)];
    }
}

/// How far facets that stand for curves lie from these, for contacts whose direction turns.
///
/// A chord of length l between directions that differ by θ lies l θ/8 from its arc.
fn facets(interface: &Interface) -> Option<Note> {
    let turning: Vec<&ContactPair> = interface.pairs.iter().filter(|pair| !pair.direction.is_constant()).collect();
    if turning.is_empty() {
        return None;
    }
    let away = turning.iter().map(|pair| {
        let [m, n] = pair.direction.ends;
        let turn = (m[0] * n[1] - m[1] * n[0]).atan2(m[0] * n[0] + m[1] * n[1]);
        pair.length * turn.abs() / 8.0
    });
    let farthest = away.fold(0.0, f64::max);
    let length: f64 = interface.pairs.iter().map(|pair| pair.length).sum();
    Some(Note {
        weakens_guarantee: false,
        text: format!(
            "{}: {} {} for a curve; they lie up to {farthest:.1e} from it, {:.1e} of the length of the contact. The \
             bounds are for these edges with the direction of contact of the curve",
            beginning(interface),
            counted(turning.len(), "edge"),
            if turning.len() == 1 { "stands" } else { "stand" },
            farthest / length
        ),
    })
}

/// The beginning of the notes on an interface, by which that of the mesh before is found.
fn beginning(interface: &Interface) -> String {
    format!("curved contact {}", interface.name)
}

/// Puts the note of a mesh in place of that of the mesh before.
pub(in crate::problem) fn replace(notes: &mut Vec<Note>, interface: &Interface) {
    let Some(note) = facets(interface) else { return };
    let beginning = beginning(interface) + ":";
    notes.retain(|old| !old.text.starts_with(&beginning));
    notes.push(note);
}
