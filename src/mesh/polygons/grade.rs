//! Outlines without a size: long pieces beside short ones are halved.
//!
//! A polygon that draws a curve as facets has short pieces beside long ones. Filled as it is, scores of sharp angles meet in
//! the corners opposite the curve, and bisection leaves every one of them.

use std::collections::HashSet;

use super::outline::Piece;
use crate::mesh::refinement::quarter::middle;
use crate::mesh::sides::polyline::key;
use crate::mesh::topology::labels::contact_names;
use crate::scene::{Circle, Polygon, Scene};

/// A piece more than this many times as long as the next is halved.
const LONGER: f64 = 4.0;
/// Each round halves a piece once: those beside pieces this many times halved stay longer.
const MOST_ROUNDS: usize = 20;

/// Halves pieces until none is much longer than the one before or after it, on every polygon that has them. Pieces of a
/// contact and of an arc stay whole: their vertices say which curve they stand for.
pub(super) fn grade(outlines: &mut [Vec<Piece>], scene: &Scene, polygons: &[Polygon]) {
    let sides: HashSet<&str> = contact_names(scene).into_iter().collect();
    let circles = circles(polygons);
    let whole = |piece: &Piece| {
        sides.contains(piece.name.as_str())
            || circles.iter().any(|circle| piece.ends.iter().all(|p| circle.holds(*p, ON_CIRCLE)))
    };
    for _ in 0..MOST_ROUNDS {
        let mut long = HashSet::new();
        for outline in outlines.iter() {
            for (i, piece) in outline.iter().enumerate() {
                let next = &outline[(i + 1) % outline.len()];
                for [one, other] in [[piece, next], [next, piece]] {
                    if length(one) > LONGER * length(other) && !whole(one) {
                        long.insert(unordered(one));
                    }
                }
            }
        }
        if long.is_empty() {
            return;
        }
        for outline in outlines.iter_mut() {
            let halves = |piece: &Piece| {
                let [a, b] = piece.ends;
                let at = if long.contains(&unordered(piece)) { vec![a, middle(a, b), b] } else { vec![a, b] };
                at.windows(2).map(|w| Piece { ends: [w[0], w[1]], name: piece.name.clone() }).collect::<Vec<_>>()
            };
            *outline = outline.iter().flat_map(halves).collect();
        }
    }
}

/// Part of the radius within which the ends of a piece lie on an arc.
const ON_CIRCLE: f64 = 1e-9;

/// The circles of all arcs.
fn circles(polygons: &[Polygon]) -> Vec<Circle> {
    let of = |polygon: &Polygon| -> Vec<Circle> {
        let points = &polygon.points;
        let circle = |edge: usize, through| Circle::through(points[edge], through, points[(edge + 1) % points.len()]);
        polygon.arcs.iter().filter_map(|arc| circle(arc.edge, arc.through)).collect()
    };
    polygons.iter().flat_map(of).collect()
}

fn length(piece: &Piece) -> f64 {
    let [a, b] = piece.ends;
    (b[0] - a[0]).hypot(b[1] - a[1])
}

/// A key that a piece shares with its reverse.
fn unordered(piece: &Piece) -> [[u64; 2]; 2] {
    let [a, b] = piece.ends.map(key);
    if a < b { [a, b] } else { [b, a] }
}
