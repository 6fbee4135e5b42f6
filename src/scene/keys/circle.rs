//! Circles that edges stand for.

/// A circle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Circle {
    /// Centre.
    pub centre: [f64; 2],
    /// Radius.
    pub radius: f64,
}

impl Circle {
    /// The circle through three points; `None` where they are in line.
    pub fn through(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> Option<Self> {
        let (p, q) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
        let twice = 2.0 * (p[0] * q[1] - p[1] * q[0]);
        let (pp, qq) = (p[0] * p[0] + p[1] * p[1], q[0] * q[0] + q[1] * q[1]);
        let centre = [(q[1] * pp - p[1] * qq) / twice, (p[0] * qq - q[0] * pp) / twice];
        let radius = centre[0].hypot(centre[1]);
        let straight = twice.abs() <= 1e-9 * (pp * qq).sqrt();
        (!straight && radius.is_finite()).then_some(Circle { centre: [a[0] + centre[0], a[1] + centre[1]], radius })
    }

    /// True if a point is no farther from the circle than `part` of its radius.
    pub fn holds(&self, p: [f64; 2], part: f64) -> bool {
        (self.distance(p) - self.radius).abs() <= part * self.radius
    }

    /// The nearest point of the circle.
    pub fn nearest(&self, p: [f64; 2]) -> [f64; 2] {
        let factor = self.radius / self.distance(p);
        [0, 1].map(|k| self.centre[k] + factor * (p[k] - self.centre[k]))
    }

    /// The unit vector from the centre to a point.
    pub fn outward(&self, p: [f64; 2]) -> [f64; 2] {
        let distance = self.distance(p);
        [0, 1].map(|k| (p[k] - self.centre[k]) / distance)
    }

    fn distance(&self, p: [f64; 2]) -> f64 {
        (p[0] - self.centre[0]).hypot(p[1] - self.centre[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_points_make_a_circle_and_points_in_line_none() {
        let circle = Circle::through([3.0, 1.0], [2.0, 2.0], [1.0, 1.0]).expect("not in line");
        assert!((circle.centre[0] - 2.0).abs() < 1e-15 && (circle.centre[1] - 1.0).abs() < 1e-15);
        assert!((circle.radius - 1.0).abs() < 1e-15 && circle.holds([2.0, 0.0], 1e-12));
        assert!(!circle.holds([2.0, 0.1], 1e-2));
        assert_eq!(circle.nearest([2.0, 7.0]), [2.0, 2.0]);
        assert_eq!(Circle::through([0.0, 0.0], [1.0, 1.0], [3.0, 3.0]), None);
    }
}
