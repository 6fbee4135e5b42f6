//! The triangle as an image of the reference triangle, and what that does to stresses.

use crate::element::frame::Frame;

/// A triangle in its frame: longest side along the first axis, centroid in the origin, area one.
///
/// It is the image of the reference triangle under ((a, b), (0, c)), with the first corner (b, c) opposite the longest side.
pub struct Shape {
    /// The frame.
    pub frame: Frame,
    /// Half the longest side.
    pub half: f64,
    /// Coordinates of the corner opposite the longest side.
    pub apex: [f64; 2],
}

impl Shape {
    /// The shape of a counter-clockwise triangle.
    pub fn new(corners: [[f64; 2]; 3]) -> Self {
        let frame = Frame::new(corners);
        let [apex, start, end] = [0, 1, 2].map(|i| corners[(frame.base + i) % 3]);
        let from_start = |p: [f64; 2]| frame.vector_to_local([0, 1].map(|c| (p[c] - start[c]) / frame.scale));
        let (length, along) = (from_start(end)[0], from_start(apex)[0]);
        Shape { half: 0.5 * length, apex: [(2.0 * along - length) / 3.0, 4.0 / (3.0 * length)], frame }
    }

    /// a, half the longest side over half a side of the reference triangle.
    fn stretch(&self) -> f64 {
        self.half * (2.0 / 3.0_f64.sqrt())
    }

    /// Corners, from the one opposite the longest side.
    pub fn corners(&self) -> [[f64; 2]; 3] {
        let [b, c] = self.apex;
        [self.apex, [-0.5 * b - self.half, -0.5 * c], [-0.5 * b + self.half, -0.5 * c]]
    }

    /// The point with the given barycentric coordinates on subtriangle `sub`.
    pub fn point(&self, sub: usize, l: [f64; 3]) -> [f64; 2] {
        let corners = self.corners();
        let (p, q) = (corners[(sub + 1) % 3], corners[(sub + 2) % 3]);
        [0, 1].map(|c| l[0] * p[c] + l[1] * q[c])
    }

    /// Outward normal of side `side`, as long as the side.
    pub fn normal(&self, side: usize) -> [f64; 2] {
        let corners = self.corners();
        let (p, q) = (corners[(side + 1) % 3], corners[(side + 2) % 3]);
        [q[1] - p[1], p[0] - q[0]]
    }

    /// The stress A τ̂ Aᵀ, components (xx, yy, xy).
    pub fn stress(&self, [xx, yy, xy]: [f64; 3]) -> [f64; 3] {
        let (a, [b, c]) = (self.stretch(), self.apex);
        [a * a * xx + 2.0 * a * b * xy + b * b * yy, c * c * yy, a * c * xy + b * c * yy]
    }

    /// The traction of A τ̂ Aᵀ on side `side`, from that of τ̂.
    pub fn traction(&self, side: usize, [x, y]: [f64; 2]) -> [f64; 2] {
        let (a, [b, c]) = (self.stretch(), self.apex);
        let [p, q] = self.normal(side);
        let factor = 3.0_f64.sqrt() * a * c / p.hypot(q);
        [factor * (a * x + b * y), factor * c * y]
    }
}
