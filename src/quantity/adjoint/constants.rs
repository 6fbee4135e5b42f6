//! Constants of the inequalities of Korn, Poincaré and traces on a triangle.

use std::f64::consts::PI;

/// Constants of a triangle: ‖w'‖ ≤ `of_load` ‖e(w)‖, for w' = w less a rigid motion.
pub struct Constants {
    area: f64,
    diameter: f64,
    /// For loads without resultant and moment on the triangle.
    pub of_load: f64,
    of_gradient: f64,
}

impl Constants {
    /// Those of the triangle with these corners.
    pub fn new(corners: [[f64; 2]; 3]) -> Self {
        let side = |i: usize| {
            let [a, b] = [corners[(i + 1) % 3], corners[(i + 2) % 3]];
            (b[0] - a[0]).hypot(b[1] - a[1])
        };
        let sides = [0, 1, 2].map(side);
        let around: f64 = sides.iter().sum();
        let area = 3.0 * crate::element::geometry::sub_area(corners);
        let inner = 2.0 * area / around;
        let centre = [0, 1].map(|c| (0..3).map(|i| sides[i] * (corners[i][c] - corners[0][c])).sum::<f64>() / around);
        let reach = |p: [f64; 2]| (p[0] - corners[0][0] - centre[0]).hypot(p[1] - corners[0][1] - centre[1]);
        let outer = corners.into_iter().map(reach).fold(0.0, f64::max);
        let diameter = sides.into_iter().fold(0.0, f64::max);
        let beta = 0.5 * inner / outer;
        let of_gradient = (1.0 + 2.0 / (beta * beta)).sqrt();
        Constants { area, diameter, of_load: diameter / PI * of_gradient, of_gradient }
    }

    /// ‖w'‖ on a side of this length over ‖e(w)‖.
    pub fn of_traction(&self, length: f64) -> f64 {
        let square = self.of_load * self.of_load + self.diameter * self.of_load * self.of_gradient;
        (length / self.area * square).sqrt()
    }
}
