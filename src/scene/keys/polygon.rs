//! Test that a list of corners bounds a region: the geometry behind the messages about polygons.

use std::cmp::Ordering;
use std::collections::HashMap;

use robust::{Coord, orient2d};

use crate::scene::reading::source::counted;

/// Largest extent, and reciprocal of the smallest, that double precision and the mesher handle without loss.
pub(in crate::scene) const EXTENT: f64 = 1e30;

/// Why corners do not bound a region; indices count from 0.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::scene) enum Defect {
    /// Fewer than three corners.
    TooFew,
    /// Corners i < j are the same point.
    Repeated(usize, usize),
    /// Coordinates or their spread leave the range of [`EXTENT`].
    Extent,
    /// All corners on one line, or an area below the rounding error of its computation.
    NoArea,
    /// The edges at corner i lie on top of each other.
    Spike(usize),
    /// Edges i < j cross or touch.
    Crossing(usize, usize),
}

impl Defect {
    /// The corner to point at, where there is one.
    pub fn corner(&self) -> Option<usize> {
        match *self {
            Defect::TooFew | Defect::Extent | Defect::NoArea => None,
            Defect::Spike(i) | Defect::Repeated(_, i) | Defect::Crossing(_, i) => Some(i),
        }
    }

    /// Describes the defect, as the rest of a sentence about the polygon; `edge` names an edge.
    pub fn problem(&self, points: &[[f64; 2]], edge: impl Fn(usize) -> String) -> String {
        let corner = |i: usize| format!("[{:?}, {:?}]", points[i][0], points[i][1]);
        match *self {
            Defect::TooFew => format!("has {}, but a region needs at least 3", counted(points.len(), "corner")),
            Defect::Repeated(0, j) if j + 1 == points.len() => {
                format!("repeats its first corner {} at the end", corner(0))
            }
            Defect::Repeated(i, j) => {
                format!("has corner {} twice, as number {} and number {}", corner(i), i + 1, j + 1)
            }
            Defect::Extent => format!("leaves the range of lengths from {:?} to {EXTENT:?}", 1.0 / EXTENT),
            Defect::NoArea => "has no area: its corners lie on one line".to_owned(),
            Defect::Spike(i) => format!("turns back on itself at corner {} {}", i + 1, corner(i)),
            Defect::Crossing(i, j) => {
                format!("crosses or touches itself: edges {} and {} meet", edge(i), edge(j))
            }
        }
    }

    /// The remedy for the defect.
    pub fn remedy(&self, points: &[[f64; 2]]) -> &'static str {
        match *self {
            Defect::TooFew => "add the missing corners",
            Defect::Repeated(0, j) if j + 1 == points.len() => "delete the last corner; a polygon closes by itself",
            Defect::Repeated(..) => "delete one of the two, or split the polygon where it touches itself",
            Defect::Extent => "choose another unit of length",
            Defect::NoArea => "correct the corners; listed in order they must go round a region",
            Defect::Spike(_) => "delete the corner, or move it off the line of its neighbours",
            Defect::Crossing(..) => {
                "list the corners in order round the region, or split it into several polygons of the same body"
            }
        }
    }
}

/// The first defect of the closed polygon through `points` (finite), or `None` if it is simple and has an area.
/// Orientation tests are exact, so corners on a straight edge are told from corners beside it.
pub(in crate::scene) fn defect(points: &[[f64; 2]]) -> Option<Defect> {
    let n = points.len();
    if n < 3 {
        return Some(Defect::TooFew);
    }
    repeated(points).or_else(|| extent(points)).or_else(|| {
        let straight = points.iter().skip(2).all(|&p| side(points[0], points[1], p) == 0);
        if straight {
            return Some(Defect::NoArea);
        }
        (0..n).find(|&i| spike(points, i)).map(Defect::Spike).or_else(|| crossing(points)).or_else(|| sliver(points))
    })
}

fn repeated(points: &[[f64; 2]]) -> Option<Defect> {
    let mut seen = HashMap::new();
    points.iter().enumerate().find_map(|(j, p)| {
        // Adding 0 makes −0 and 0 the same key.
        seen.insert(p.map(|x| (x + 0.0).to_bits()), j).map(|i| Defect::Repeated(i, j))
    })
}

fn spread(points: &[[f64; 2]]) -> f64 {
    let along = |k: usize| {
        let (low, high) =
            points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), p| (a.min(p[k]), b.max(p[k])));
        high - low
    };
    along(0).max(along(1))
}

fn extent(points: &[[f64; 2]]) -> Option<Defect> {
    let too_far = points.iter().flatten().any(|x| x.abs() > EXTENT);
    (too_far || spread(points) < 1.0 / EXTENT).then_some(Defect::Extent)
}

/// 1, 0, −1: c is left of, on, right of the line from a to b.
fn side(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> i8 {
    let [a, b, c] = [a, b, c].map(|[x, y]| Coord { x, y });
    match orient2d(a, b, c).partial_cmp(&0.0) {
        Some(Ordering::Greater) => 1,
        Some(Ordering::Less) => -1,
        _ => 0,
    }
}

fn spike(points: &[[f64; 2]], i: usize) -> bool {
    let n = points.len();
    let (before, corner, after) = (points[(i + n - 1) % n], points[i], points[(i + 1) % n]);
    let dot: f64 = (0..2).map(|k| (before[k] - corner[k]) * (after[k] - corner[k])).sum();
    side(before, corner, after) == 0 && dot > 0.0
}

/// True if the closed segments share a point.
fn meet([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]) -> bool {
    let in_box =
        |p: [f64; 2], q: [f64; 2], r: [f64; 2]| (0..2).all(|k| p[k].min(q[k]) <= r[k] && r[k] <= p[k].max(q[k]));
    let (ac, ad, ca, cb) = (side(a, b, c), side(a, b, d), side(c, d, a), side(c, d, b));
    (ac * ad < 0 && ca * cb < 0)
        || (ac == 0 && in_box(a, b, c))
        || (ad == 0 && in_box(a, b, d))
        || (ca == 0 && in_box(c, d, a))
        || (cb == 0 && in_box(c, d, b))
}

fn crossing(points: &[[f64; 2]]) -> Option<Defect> {
    let n = points.len();
    let edge = |i: usize| [points[i], points[(i + 1) % n]];
    let (low, high) = (|i: usize| edge(i)[0][0].min(edge(i)[1][0]), |i: usize| edge(i)[0][0].max(edge(i)[1][0]));
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&i, &j| low(i).total_cmp(&low(j)).then(i.cmp(&j)));
    for (k, &i) in order.iter().enumerate() {
        for &j in order[k + 1..].iter().take_while(|&&j| low(j) <= high(i)) {
            let neighbours = (i + 1) % n == j || (j + 1) % n == i;
            if !neighbours && meet(edge(i), edge(j)) {
                return Some(Defect::Crossing(i.min(j), i.max(j)));
            }
        }
    }
    None
}

fn sliver(points: &[[f64; 2]]) -> Option<Defect> {
    let rounding = points.len() as f64 * f64::EPSILON * spread(points).powi(2);
    (2.0 * area(points).abs() <= rounding).then_some(Defect::NoArea)
}

/// The area of a simple polygon, positive where its corners go round it counter-clockwise; it has at least one corner.
pub(crate) fn area(points: &[[f64; 2]]) -> f64 {
    let [x0, y0] = points[0];
    let twice = |w: &[[f64; 2]]| (w[0][0] - x0) * (w[1][1] - y0) - (w[1][0] - x0) * (w[0][1] - y0);
    0.5 * points.windows(2).map(twice).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

    #[test]
    fn accepts_both_orientations_and_corners_on_straight_edges() {
        assert_eq!(defect(&SQUARE), None);
        assert_eq!(defect(&[[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]]), None);
        assert_eq!(defect(&[[0.0, 0.0], [0.5, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]), None);
        // Re-entrant, and a long thin triangle.
        assert_eq!(defect(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 0.5], [0.0, 1.0]]), None);
        assert_eq!(defect(&[[0.0, 0.0], [1.0, 0.0], [0.5, 1e-9]]), None);
    }

    #[test]
    fn names_the_defect() {
        assert_eq!(defect(&SQUARE[..2]), Some(Defect::TooFew));
        assert_eq!(defect(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [-0.0, 0.0]]), Some(Defect::Repeated(0, 3)));
        assert_eq!(defect(&[[0.0, 0.0], [1.0, 1.0], [3.0, 3.0]]), Some(Defect::NoArea));
        assert_eq!(defect(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]), Some(Defect::Crossing(0, 2)));
        assert_eq!(defect(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [3.0, 1.0], [2.0, 1.0]]), Some(Defect::Repeated(2, 4)));
        assert_eq!(defect(&[[0.0, 0.0], [2.0, 0.0], [1.0, 0.0], [1.0, 1.0]]), Some(Defect::Spike(1)));
        assert_eq!(defect(&[[0.0, 0.0], [1e40, 0.0], [0.0, 1e40]]), Some(Defect::Extent));
        assert_eq!(defect(&[[0.0, 0.0], [1e-40, 0.0], [0.0, 1e-40]]), Some(Defect::Extent));
        assert_eq!(defect(&[[0.0, 0.0], [1.0, 0.0], [0.5, 1e-17]]), Some(Defect::NoArea));
    }

    #[test]
    fn a_corner_touching_another_edge_is_a_crossing() {
        let pinched = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 0.0], [0.0, 2.0]];
        assert!(matches!(defect(&pinched), Some(Defect::Crossing(0, 2 | 3))));
    }
}
