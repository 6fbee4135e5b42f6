//! Quadrature on triangles beside an axis, with the integrals of q/r enclosed from above.
//!
//! In a body of revolution energies are integrals of q/r + s with polynomials q and s, r being the distance from the axis. The vertical
//! through the corner of middle radius cuts the triangle into two, each with one side on which r is constant; seen from the corner
//! opposite that side, r is linear in one coordinate alone. On [r_0, r_1] with the midpoint in the origin of x(r),
//!
//! M(r) = (1 + ε(r))/r, ε(r) = (1 − T_m(x(r)))/(T_m(x(0)) − 1) with m even
//!
//! is a polynomial of degree m − 1, for its numerator vanishes at r = 0, and 0 ≤ ε ≤ 2/(T_m(x(0)) − 1) on the interval: a majorant of 1/r
//! that is as near as m makes it. Gauss rules of sufficient degree integrate q M exactly, and where q ≥ 0 the result is no less than
//! ∫ q/r. Intervals whose ends have very different radii are divided. Where a triangle has a corner or a side on the axis, q is divisible by
//! what makes q/r a polynomial in the coordinates of that part, and ε = 0.

use crate::element::polynomial::quadrature::segment_rule;

/// Largest ratio of the radii at the ends of an interval that is not divided.
const RATIO: f64 = 3.0;
/// Most intervals of one part: a ratio of 10^45.
const MOST_INTERVALS: usize = 96;
/// Largest degree m.
const MOST: usize = 32;

/// A point of a rule.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Barycentric coordinates.
    pub bary: [f64; 3],
    /// Weight; all weights sum to one.
    pub weight: f64,
    /// Distance from the axis.
    pub radius: f64,
    /// ε, by which the majorant of 1/r lies above it, relative to it.
    pub excess: f64,
}

/// A rule on a triangle whose corners have these distances from the axis, exact for polynomials of degree `degree` and for q M where q is
/// one; ε is at most `near`.
pub fn rule(radii: [f64; 3], degree: usize, near: f64) -> Vec<Point> {
    let mut order = [0, 1, 2];
    order.sort_by(|a, b| radii[*a].total_cmp(&radii[*b]));
    let [low, middle, high] = order;
    let span = radii[high] - radii[low];
    let part = if span > 0.0 { (radii[middle] - radii[low]) / span } else { 0.0 };
    let corner = |i: usize| {
        let mut bary = [0.0; 3];
        bary[i] = 1.0;
        bary
    };
    let mut opposite = [0.0; 3];
    (opposite[low], opposite[high]) = (1.0 - part, part);
    let mut points = Vec::new();
    for (apex, share) in [(low, part), (high, 1.0 - part)] {
        if share > 0.0 {
            let half = Half {
                corners: [corner(apex), corner(middle), opposite],
                radii: [radii[apex], radii[middle]],
                share,
                degree,
                near,
            };
            half.points(&mut points);
        }
    }
    points
}

/// A point of a rule on an edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SidePoint {
    /// The place on the edge, from 0 to 1.
    pub at: f64,
    /// Weight; all weights sum to one.
    pub weight: f64,
    /// Distance from the axis.
    pub radius: f64,
    /// As [`Point::excess`].
    pub excess: f64,
}

/// As [`rule`], on an edge whose ends have these distances from the axis.
pub fn side_rule([first, last]: [f64; 2], degree: usize, near: f64) -> Vec<SidePoint> {
    let (least, most) = (first.min(last), first.max(last));
    let intervals = if least > 0.0 && most > least { intervals(most / least) } else { 1 };
    let at = |s: f64| first + s * (last - first);
    let mut points = Vec::new();
    let mut from = 0.0;
    for i in 1..=intervals {
        let part = i as f64 / intervals as f64;
        let to = if i == intervals { 1.0 } else { (first * (last / first).powf(part) - first) / (last - first) };
        let majorant = Majorant::on(at(from), at(to), near);
        for &(s, weight) in segment_rule(degree + majorant.degree) {
            let s = from + s * (to - from);
            let radius = at(s);
            points.push(SidePoint { at: s, weight: weight * (to - from), radius, excess: majorant.excess(radius) });
        }
        from = to;
    }
    points
}

/// One of the two parts of a triangle: a corner, and the side opposite, on which r is constant.
struct Half {
    corners: [[f64; 3]; 3],
    /// At the corner and on the side.
    radii: [f64; 2],
    /// Its area relative to the triangle.
    share: f64,
    degree: usize,
    near: f64,
}

impl Half {
    fn points(&self, out: &mut Vec<Point>) {
        let [apex, base] = self.radii;
        let across = segment_rule(self.degree);
        let (least, most) = (apex.min(base), apex.max(base));
        let intervals = if least > 0.0 { intervals(most / least) } else { 1 };
        let mut from = 0.0;
        for i in 1..=intervals {
            // Radii at the ends of the intervals are a geometric sequence.
            let part = i as f64 / intervals as f64;
            let to = if i == intervals { 1.0 } else { (apex * (base / apex).powf(part) - apex) / (base - apex) };
            let at = |s: f64| apex + s * (base - apex);
            let majorant = Majorant::on(at(from), at(to), self.near);
            // q M times the width, which is linear.
            for &(s, weight) in segment_rule(self.degree + majorant.degree + 1) {
                let s = from + s * (to - from);
                let radius = at(s);
                let weight = self.share * weight * (to - from) * 2.0 * s;
                let excess = majorant.excess(radius);
                for &(t, of_width) in across {
                    let along = |i: usize| (1.0 - t) * self.corners[1][i] + t * self.corners[2][i];
                    let bary = [0, 1, 2].map(|i| (1.0 - s) * self.corners[0][i] + s * along(i));
                    out.push(Point { bary, weight: weight * of_width, radius, excess });
                }
            }
            from = to;
        }
    }
}

fn intervals(ratio: f64) -> usize {
    ((ratio.ln() / RATIO.ln()).ceil().max(1.0) as usize).min(MOST_INTERVALS)
}

/// M on one interval.
struct Majorant {
    degree: usize,
    middle: f64,
    half: f64,
    /// T_m(x(0)) − 1; infinite where M is not needed.
    scale: f64,
}

impl Majorant {
    fn on(a: f64, b: f64, near: f64) -> Self {
        let (middle, half) = (0.5 * (a + b), 0.5 * (a - b).abs());
        let least = a.min(b);
        if least <= 0.0 || half == 0.0 {
            return Majorant { degree: 0, middle, half: 0.0, scale: f64::INFINITY };
        }
        let x = middle / half;
        let scale = |m: usize| (m as f64 * x.acosh()).cosh() - 1.0;
        let degree = (2..MOST).step_by(2).find(|m| 2.0 / scale(*m) <= near).unwrap_or(MOST);
        Majorant { degree, middle, half, scale: scale(degree) }
    }

    fn excess(&self, radius: f64) -> f64 {
        if self.degree == 0 {
            return 0.0;
        }
        let x = ((radius - self.middle) / self.half).clamp(-1.0, 1.0);
        (1.0 - (self.degree as f64 * x.acos()).cos()) / self.scale
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ∫ q/r for q = 1 over a triangle, relative to its area, by divisions of the interval of r: the width is piecewise linear.
    fn mean_of_inverse(radii: [f64; 3]) -> f64 {
        let mut r = radii;
        r.sort_by(f64::total_cmp);
        let [a, b, c] = r;
        // The width is linear from 0 at a to w at b, and to 0 at c, with w (c − a)/2 = 1.
        let w = 2.0 / (c - a);
        let rising = |lo: f64, hi: f64, zero: f64, slope: f64| slope * ((hi - lo) - zero * (hi / lo).ln());
        let first = if b > a { rising(a, b, a, w / (b - a)) } else { 0.0 };
        let second = if c > b { rising(b, c, c, -w / (c - b)) } else { 0.0 };
        first + second
    }

    #[test]
    fn inverse_radii_are_integrated_from_above_and_closely() {
        for radii in [[1.0, 2.0, 1.5], [1.0, 1.0, 3.0], [2.0, 0.5, 2.0], [1e-4, 1.0, 0.7], [10.0, 11.0, 10.2]] {
            let exact = mean_of_inverse(radii);
            for near in [1e-3, 1e-6, 1e-14] {
                let found: f64 = rule(radii, 0, near).iter().map(|p| p.weight * (1.0 + p.excess) / p.radius).sum();
                let rounding = 1e-13 * exact;
                assert!(found >= exact - rounding, "{radii:?}: {found} is below {exact}");
                assert!(found <= exact * (1.0 + near) + rounding, "{radii:?}: {found} is far above {exact}");
            }
        }
    }

    #[test]
    fn inverse_radii_are_integrated_from_above_on_edges_too() {
        for [a, b] in [[1.0, 2.0], [3.0, 1.0], [1e-4, 1.0], [2.0, 2.0], [10.0, 10.5]] {
            let exact = if a == b { 1.0 / a } else { f64::ln(b / a) / (b - a) };
            let found: f64 = side_rule([a, b], 0, 1e-14).iter().map(|p| p.weight * (1.0 + p.excess) / p.radius).sum();
            assert!(found >= exact * (1.0 - 1e-13) && found <= exact * (1.0 + 1e-13), "{a} {b}: {found} {exact}");
        }
        // Divisible by r where that vanishes.
        let found: f64 = side_rule([0.0, 2.0], 4, 1e-14).iter().map(|p| p.weight * p.at.powi(4) / p.radius).sum();
        assert!((found - 0.125).abs() < 1e-15);
    }

    #[test]
    fn polynomials_are_integrated_exactly_and_points_lie_inside() {
        for radii in [[1.0, 2.0, 1.5], [0.0, 1.0, 0.4], [0.0, 0.0, 1.0], [1.0, 1.0, 3.0], [1e-6, 1.0, 0.2]] {
            for degree in 0..8 {
                let points = rule(radii, degree, 1e-9);
                for i in 0..=degree {
                    let j = degree - i;
                    let factorial = |n: usize| (1..=n).map(|k| k as f64).product::<f64>();
                    let exact = 2.0 * factorial(i) * factorial(j) / factorial(degree + 2);
                    let found: f64 =
                        points.iter().map(|p| p.weight * p.bary[0].powi(i as i32) * p.bary[2].powi(j as i32)).sum();
                    assert!((found - exact).abs() < 1e-13, "{radii:?} {degree}: {found} is not {exact}");
                }
                for p in points {
                    let radius: f64 = (0..3).map(|i| p.bary[i] * radii[i]).sum();
                    assert!(p.radius > 0.0 && (radius - p.radius).abs() < 1e-14 * radii[1].max(radii[2]) * 4.0);
                    assert!(p.bary.iter().all(|l| (-1e-15..=1.0).contains(l)) && p.excess >= 0.0);
                }
            }
        }
    }
}
