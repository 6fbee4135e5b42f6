//! The part of each triangle that lies in a disc, by points and weights that integrate polynomials over it.
//!
//! A subtriangle and the disc are convex, and so is what they share: its outline is made of chords and of arcs of the circle. The
//! polygon through the corners is cut into a fan; between an arc and its chord lies the image of a square, on which the integrand is a
//! polynomial in one direction and, arcs being no longer than 15°, so nearly one in the other that twelve points and half the degree leave
//! less than rounding.

use std::f64::consts::PI;

use crate::element::geometry::{sub_area, sub_corners};
use crate::element::polynomial::quadrature::{segment_rule, triangle_rule};

/// The circle is made of so many arcs.
const ARCS: usize = 24;

/// Points along an arc beside half of the degree.
const ALONG: usize = 12;

/// A point of a triangle with the area that it stands for.
#[derive(Debug, Clone, Copy)]
pub struct Spot {
    /// The subtriangle.
    pub sub: usize,
    /// Barycentric coordinates in the subtriangle.
    pub l: [f64; 3],
    /// As seen from the middle of the disc.
    pub from_middle: [f64; 2],
    /// Area.
    pub weight: f64,
}

/// How a triangle lies to the disc.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// Apart from it.
    Outside,
    /// In it.
    Inside,
    /// Partly in it.
    Cut,
}

/// A disc.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disc {
    /// Its middle.
    pub middle: [f64; 2],
    /// Its radius.
    pub radius: f64,
}

impl Disc {
    /// The corners as seen from the middle.
    fn seen(&self, corners: [[f64; 2]; 3]) -> [[f64; 2]; 3] {
        corners.map(|p| [p[0] - self.middle[0], p[1] - self.middle[1]])
    }

    /// How a triangle lies to it.
    pub fn place(&self, corners: [[f64; 2]; 3]) -> Place {
        let corners = self.seen(corners);
        let near = |p: [f64; 2]| p[0].hypot(p[1]) <= self.radius;
        if corners.into_iter().all(near) {
            return Place::Inside;
        }
        let holds_middle = (0..3).all(|i| cross(corners[i], corners[(i + 1) % 3]) >= 0.0);
        let meets = holds_middle || (0..3).any(|i| distance(corners[i], corners[(i + 1) % 3]) < self.radius);
        if meets { Place::Cut } else { Place::Outside }
    }

    /// Points of the part of a triangle that lies in the disc, for polynomials up to `degree`.
    pub fn spots(&self, corners: [[f64; 2]; 3], degree: usize) -> Vec<Spot> {
        match self.place(corners) {
            Place::Outside => Vec::new(),
            Place::Inside => self.all(corners, degree),
            Place::Cut => (0..3).flat_map(|sub| self.part(corners, sub, degree)).collect(),
        }
    }

    /// Points of all of a triangle.
    pub fn all(&self, corners: [[f64; 2]; 3], degree: usize) -> Vec<Spot> {
        let area = sub_area(corners);
        let seen = self.seen(corners);
        let on = |sub: usize| {
            let own = sub_corners(seen, sub);
            triangle_rule(degree).iter().map(move |(l, weight)| {
                let from_middle = [0, 1].map(|c| (0..3).map(|i| l[i] * own[i][c]).sum());
                Spot { sub, l: *l, from_middle, weight: weight * area }
            })
        };
        (0..3).flat_map(on).collect()
    }

    /// Points of the part of subtriangle `sub`.
    fn part(&self, corners: [[f64; 2]; 3], sub: usize, degree: usize) -> Vec<Spot> {
        let own = sub_corners(self.seen(corners), sub);
        let mut outline: Vec<Piece> = (0..ARCS).map(|i| Piece::Arc([i, i + 1].map(angle))).collect();
        for i in 0..3 {
            outline = self.clipped(outline, own[i], own[(i + 1) % 3]);
        }
        let Some(first) = outline.first().map(|piece| piece.ends(self.radius)[0]) else { return Vec::new() };
        let twice = cross(sub_of(own[1], own[0]), sub_of(own[2], own[0]));
        let spot = |from_middle: [f64; 2], weight: f64| {
            let p = from_middle;
            let l = [cross(sub_of(own[1], p), sub_of(own[2], p)), cross(sub_of(own[2], p), sub_of(own[0], p))];
            let [l, m] = l.map(|l| l / twice);
            Spot { sub, l: [l, m, 1.0 - l - m], from_middle, weight }
        };
        let mut spots = Vec::new();
        for piece in &outline {
            let [a, b] = piece.ends(self.radius);
            let area = 0.5 * cross(sub_of(a, first), sub_of(b, first));
            if area != 0.0 {
                for (l, weight) in triangle_rule(degree) {
                    let at = [0, 1].map(|c| l[0] * first[c] + l[1] * a[c] + l[2] * b[c]);
                    spots.push(spot(at, weight * area));
                }
            }
            if let Piece::Arc(arc) = *piece {
                self.segment(arc, degree, |at, weight| spots.push(spot(at, weight)));
            }
        }
        spots
    }

    /// Points between an arc and its chord.
    fn segment(&self, [from, to]: [f64; 2], degree: usize, mut each: impl FnMut([f64; 2], f64)) {
        let [a, b] = [from, to].map(|angle| self.at(angle));
        let chord = sub_of(b, a);
        for (t, along) in segment_rule(2 * (degree / 2 + ALONG) - 1) {
            let angle = from + t * (to - from);
            let arc = self.at(angle);
            let on_chord = [0, 1].map(|c| a[c] + t * chord[c]);
            let out = sub_of(arc, on_chord);
            let turning = [-arc[1] * (to - from), arc[0] * (to - from)];
            for (s, across) in segment_rule(degree + 1) {
                let at = [0, 1].map(|c| on_chord[c] + s * out[c]);
                let running = [0, 1].map(|c| (1.0 - s) * chord[c] + s * turning[c]);
                each(at, along * across * cross(out, running));
            }
        }
    }

    fn at(&self, angle: f64) -> [f64; 2] {
        [self.radius * angle.cos(), self.radius * angle.sin()]
    }

    /// The part of an outline to the left of the line from `a` to `b`.
    fn clipped(&self, outline: Vec<Piece>, a: [f64; 2], b: [f64; 2]) -> Vec<Piece> {
        let along = sub_of(b, a);
        let length = along[0].hypot(along[1]);
        let normal = [-along[1] / length, along[0] / length];
        let offset = -(normal[0] * a[0] + normal[1] * a[1]);
        let side = |p: [f64; 2]| normal[0] * p[0] + normal[1] * p[1] + offset;
        let mut kept: Vec<Piece> = Vec::with_capacity(outline.len() + 2);
        for piece in outline {
            match piece {
                Piece::Chord([p, q]) => {
                    let (s, r) = (side(p), side(q));
                    let crossing = || {
                        let part = s / (s - r);
                        [0, 1].map(|c| p[c] + part * (q[c] - p[c]))
                    };
                    match (s >= 0.0, r >= 0.0) {
                        (true, true) => kept.push(piece),
                        (true, false) => kept.push(Piece::Chord([p, crossing()])),
                        (false, true) => kept.push(Piece::Chord([crossing(), q])),
                        (false, false) => {}
                    }
                }
                Piece::Arc([from, to]) => {
                    let mut ends = vec![from];
                    ends.extend(self.crossings(normal, offset, [from, to]));
                    ends.push(to);
                    for pair in ends.windows(2) {
                        if pair[1] > pair[0] && side(self.at(0.5 * (pair[0] + pair[1]))) > 0.0 {
                            kept.push(Piece::Arc([pair[0], pair[1]]));
                        }
                    }
                }
            }
        }
        self.closed(kept)
    }

    /// The angles inside an arc at which the circle crosses a line, in order.
    fn crossings(&self, normal: [f64; 2], offset: f64, [from, to]: [f64; 2]) -> Vec<f64> {
        let cosine = -offset / self.radius;
        if cosine.abs() >= 1.0 {
            return Vec::new();
        }
        let (middle, half) = (normal[1].atan2(normal[0]), cosine.acos());
        let mut found: Vec<f64> = [middle - half, middle + half]
            .into_iter()
            .map(|angle| from + (angle - from).rem_euclid(2.0 * PI))
            .filter(|angle| *angle > from && *angle < to)
            .collect();
        found.sort_by(f64::total_cmp);
        found
    }

    /// Pieces with a chord wherever one does not begin where the one before it ends.
    fn closed(&self, pieces: Vec<Piece>) -> Vec<Piece> {
        let count = pieces.len();
        let mut out = Vec::with_capacity(count + 1);
        for (i, piece) in pieces.iter().enumerate() {
            out.push(*piece);
            let (end, next) = (piece.ends(self.radius)[1], pieces[(i + 1) % count].ends(self.radius)[0]);
            if end != next {
                out.push(Piece::Chord([end, next]));
            }
        }
        out
    }
}

/// A piece of an outline, counter-clockwise.
#[derive(Debug, Clone, Copy)]
enum Piece {
    /// Between two points.
    Chord([[f64; 2]; 2]),
    /// Of the circle, between two angles.
    Arc([f64; 2]),
}

impl Piece {
    fn ends(&self, radius: f64) -> [[f64; 2]; 2] {
        match *self {
            Piece::Chord(ends) => ends,
            Piece::Arc(angles) => angles.map(|angle| [radius * angle.cos(), radius * angle.sin()]),
        }
    }
}

fn angle(i: usize) -> f64 {
    2.0 * PI * i as f64 / ARCS as f64
}

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn sub_of(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

/// The distance of the origin from the segment between two points.
pub fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    let d = sub_of(b, a);
    let part = -(a[0] * d[0] + a[1] * d[1]) / (d[0] * d[0] + d[1] * d[1]);
    let part = part.clamp(0.0, 1.0);
    (a[0] + part * d[0]).hypot(a[1] + part * d[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ∫ xⁱ yʲ over a disc of radius r about the origin.
    fn moment(r: f64, i: i32, j: i32) -> f64 {
        let steps = 400;
        let sum: f64 = (0..steps)
            .map(|k| 2.0 * PI * f64::from(k) / f64::from(steps))
            .map(|a| a.cos().powi(i) * a.sin().powi(j))
            .sum();
        2.0 * PI / f64::from(steps) * sum * r.powi(i + j + 2) / f64::from(i + j + 2)
    }

    #[test]
    fn triangles_share_the_disc_among_them() {
        // Triangles of every size, from ones that hold all of it to ones that it holds.
        for (n, radius) in [(1, 0.3), (2, 0.45), (3, 0.71), (7, 0.9), (20, 0.2), (2, 0.01)] {
            let disc = Disc { middle: [0.013, -0.021], radius };
            let at = |i: usize, j: usize| {
                let x = [i, j].map(|k| -1.0 + 2.0 * k as f64 / n as f64);
                // A mesh without right angles.
                [x[0] + 0.1 * x[1] * (1.0 - x[0] * x[0]), x[1] - 0.07 * x[0] * (1.0 - x[1] * x[1])]
            };
            let mut sums = [0.0; 15];
            for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
                let square = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                for corners in [[square[0], square[1], square[2]], [square[0], square[2], square[3]]] {
                    for spot in disc.spots(corners, 14) {
                        let own = sub_corners(corners, spot.sub);
                        for c in [0, 1] {
                            let back: f64 = spot.l.iter().zip(&own).map(|(l, corner)| l * corner[c]).sum();
                            assert!((back - disc.middle[c] - spot.from_middle[c]).abs() < 1e-13);
                        }
                        for (d, sum) in sums.iter_mut().enumerate() {
                            let [x, y] = spot.from_middle;
                            *sum += spot.weight * x.powi(d as i32 / 2 * 2) * y.powi((14 - d as i32) / 2 * 2);
                        }
                    }
                }
            }
            for (d, sum) in sums.iter().enumerate() {
                let exact = moment(radius, d as i32 / 2 * 2, (14 - d as i32) / 2 * 2);
                assert!((sum / exact - 1.0).abs() < 1e-12, "{n} {radius} {d}: {sum} {exact}");
            }
        }
    }

    #[test]
    fn a_disc_that_a_triangle_cuts_twice_leaves_a_strip() {
        // The half of the unit disc right of x = 0 and above y = −0.6, in a triangle that is long.
        let disc = Disc { middle: [0.0; 2], radius: 1.0 };
        let spots = disc.spots([[0.0, -0.6], [60.0, -0.6], [0.0, 60.0]], 4);
        let area: f64 = spots.iter().map(|spot| spot.weight).sum();
        let exact = 0.25 * PI + 0.5 * (0.6 * 0.8 + 0.6_f64.asin());
        assert!((area - exact).abs() < 1e-11, "{area} {exact}");
    }
}
