//! The part of each triangle that lies in a polygon, for integrals of polynomials over it.
//!
//! The polygon is clipped by every subtriangle (Sutherland & Hodgman 1974) and cut into a fan about its first corner. Where
//! it is not convex, clipping leaves edges that are run through in both directions and fans that turn back: their signed
//! areas cancel, and the integral of a polynomial is exact all the same.

use crate::element::geometry::sub_corners;
use crate::problem::Problem;

/// A triangle of the fan on a subtriangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// The subtriangle.
    pub sub: usize,
    /// Barycentric coordinates, in the subtriangle, of the three corners.
    pub corners: [[f64; 3]; 3],
    /// Signed area.
    pub area: f64,
}

/// A triangle that is cut.
#[derive(Debug, Clone, PartialEq)]
pub struct Cut {
    /// The triangle.
    pub triangle: usize,
    /// The part of it in the region; empty if that is all of it.
    pub pieces: Vec<Piece>,
    /// The part of its area that lies in the region.
    pub part: f64,
}

/// Parts of a triangle's area that differ from none, or from all of it, by less are rounding.
const WHOLE: f64 = 1e-12;

/// The triangles of body `body` that `polygon`, counter-clockwise, has a part of, and the area of these parts.
pub fn cut(problem: &Problem, body: usize, polygon: &[[f64; 2]]) -> (Vec<Cut>, f64) {
    let mesh = &problem.mesh;
    let bound = |points: &[[f64; 2]], c: usize| {
        points.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], p| [low.min(p[c]), high.max(p[c])])
    };
    let whole = [0, 1].map(|c| bound(polygon, c));
    let mut cuts = Vec::new();
    let mut total = 0.0;
    for t in (0..mesh.triangles.len()).filter(|&t| mesh.body[t] == body) {
        let corners = mesh.corners(t);
        let apart = |c: usize| {
            let own = bound(&corners, c);
            own[1] <= whole[c][0] || own[0] >= whole[c][1]
        };
        if apart(0) || apart(1) {
            continue;
        }
        let pieces: Vec<Piece> = (0..3).flat_map(|sub| pieces(polygon, sub_corners(corners, sub), sub)).collect();
        let area: f64 = pieces.iter().map(|piece| piece.area).sum();
        let part = area / mesh.area(t);
        if part <= WHOLE {
            continue;
        }
        let inside = part >= 1.0 - WHOLE;
        total += if inside { mesh.area(t) } else { area };
        cuts.push(Cut {
            triangle: t,
            pieces: if inside { Vec::new() } else { pieces },
            part: if inside { 1.0 } else { part },
        });
    }
    (cuts, total)
}

/// Twice the signed area of a triangle.
fn cross(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Twice the signed area of a polygon, counter-clockwise positive.
pub fn twice_area(polygon: &[[f64; 2]]) -> f64 {
    (1..polygon.len().saturating_sub(1)).map(|i| cross(polygon[0], polygon[i], polygon[i + 1])).sum()
}

/// The fan of the polygon clipped by a triangle.
fn pieces(polygon: &[[f64; 2]], triangle: [[f64; 2]; 3], sub: usize) -> Vec<Piece> {
    let mut points = polygon.to_vec();
    for i in 0..3 {
        points = clipped(&points, triangle[i], triangle[(i + 1) % 3]);
    }
    let twice = cross(triangle[0], triangle[1], triangle[2]);
    let bary = |p: [f64; 2]| {
        let [l, m] = [cross(p, triangle[1], triangle[2]) / twice, cross(triangle[0], p, triangle[2]) / twice];
        [l, m, 1.0 - l - m]
    };
    let fan = 1..points.len().saturating_sub(1);
    let piece = |i: usize| {
        let corners = [points[0], points[i], points[i + 1]];
        Piece { sub, corners: corners.map(bary), area: 0.5 * cross(corners[0], corners[1], corners[2]) }
    };
    fan.map(piece).filter(|piece| piece.area != 0.0).collect()
}

/// The part of a polygon to the left of the line from `a` to `b`.
fn clipped(points: &[[f64; 2]], a: [f64; 2], b: [f64; 2]) -> Vec<[f64; 2]> {
    let side = |p: [f64; 2]| cross(a, b, p);
    let mut out = Vec::with_capacity(points.len() + 2);
    for (i, &p) in points.iter().enumerate() {
        let q = points[(i + 1) % points.len()];
        let (s, r) = (side(p), side(q));
        if s >= 0.0 {
            out.push(p);
        }
        if (s > 0.0 && r < 0.0) || (s < 0.0 && r > 0.0) {
            let part = s / (s - r);
            out.push([0, 1].map(|c| p[c] + part * (q[c] - p[c])));
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ∫ x y over the fan, the midpoint rule being exact for quadratics.
    fn moment(pieces: &[Piece], triangle: [[f64; 2]; 3]) -> f64 {
        let at = |l: [f64; 3]| [0, 1].map(|c| (0..3).map(|i| l[i] * triangle[i][c]).sum::<f64>());
        let middle = |p: &Piece, i: usize| [0, 1, 2].map(|c| 0.5 * (p.corners[i][c] + p.corners[(i + 1) % 3][c]));
        let of = |p: &Piece| (0..3).map(|i| at(middle(p, i))).map(|[x, y]| x * y).sum::<f64>() * p.area / 3.0;
        pieces.iter().map(of).sum()
    }

    #[test]
    fn a_polygon_that_is_not_convex_is_cut_exactly() {
        // An L of three unit squares, within a triangle with room around it: ∫ x y = 1/4 (1 + 3 + 3).
        let polygon = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
        let triangle = [[-3.0, -1.0], [9.0, -1.0], [-1.0, 9.0]];
        let found = pieces(&polygon, triangle, 0);
        assert!((found.iter().map(|p| p.area).sum::<f64>() - 3.0).abs() < 1e-13);
        assert!((moment(&found, triangle) - 0.25 * 7.0).abs() < 1e-12);
        // The line x + y = 2 cuts half of two squares off.
        let corner = [[-1.0, -1.0], [3.0, -1.0], [-1.0, 3.0]];
        let found = pieces(&polygon, corner, 0);
        assert!((found.iter().map(|p| p.area).sum::<f64>() - 2.0).abs() < 1e-13);
    }

    #[test]
    fn a_triangle_that_cuts_both_arms_leaves_two_parts() {
        // A U; a triangle that holds the ends of its arms but not its bottom.
        let polygon = [[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [2.0, 3.0], [2.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]];
        let triangle = [[-9.0, 2.0], [12.0, 2.0], [1.5, 30.0]];
        let found = pieces(&polygon, triangle, 0);
        assert!((found.iter().map(|p| p.area).sum::<f64>() - 2.0).abs() < 1e-12);
        // ∫ x y over [0, 1] × [2, 3] and [2, 3] × [2, 3].
        assert!((moment(&found, triangle) - 0.5 * (1.0 + 5.0) * 0.5 * 5.0).abs() < 1e-11);
    }
}
