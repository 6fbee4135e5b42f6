//! The coordinates in which the stresses of an element are written.

use super::{Material, Roots};
use crate::load::Affine;

/// Local coordinates: origin in the centroid, first axis along the longest side, lengths in units of √area.
///
/// Along the longest side the modes of a stretched triangle keep apart by themselves (stress along it, across it, shear),
/// which keeps their Gram matrix well conditioned.
pub struct Frame {
    axis: [f64; 2],
    /// The longest side, by the corner opposite.
    pub base: usize,
    /// √area.
    pub scale: f64,
}

impl Frame {
    /// The frame of a counter-clockwise triangle.
    pub fn new(corners: [[f64; 2]; 3]) -> Self {
        let sides = [0, 1, 2].map(|i: usize| {
            let (a, b) = (corners[(i + 1) % 3], corners[(i + 2) % 3]);
            [b[0] - a[0], b[1] - a[1]]
        });
        let length = |s: [f64; 2]| s[0].hypot(s[1]);
        let base = (1..3).fold(0, |longest, i| if length(sides[i]) > length(sides[longest]) { i } else { longest });
        let longest = sides[base];
        let area = 0.5 * (sides[0][0] * sides[1][1] - sides[0][1] * sides[1][0]);
        let l = length(longest);
        Frame { axis: [longest[0] / l, longest[1] / l], base, scale: area.sqrt() }
    }

    /// R of a = RᵀR for stresses in its components.
    pub fn roots(&self, material: &Material) -> Roots {
        material.in_frame(self.axis).roots()
    }

    /// A point in it, from where it is as seen from the centroid.
    pub fn to_local(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        self.vector_to_local([x / self.scale, y / self.scale])
    }

    /// A vector in its components.
    pub fn vector_to_local(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [c, s] = self.axis;
        [c * x + s * y, c * y - s * x]
    }

    /// A force per volume in it, times its unit of length, from what it is about the centroid.
    pub fn force_to_local(&self, Affine { value, gradient }: Affine) -> Affine {
        let value = self.vector_to_local(value).map(|f| f * self.scale);
        let [c, s] = self.axis;
        // The columns of the gradient along the axes of the frame, in its components.
        let column = |d: [f64; 2]| {
            let slope = gradient.map(|row| row[0] * d[0] + row[1] * d[1]);
            self.vector_to_local(slope).map(|f| f * self.scale * self.scale)
        };
        let [x, y] = [column([c, s]), column([-s, c])];
        Affine { value, gradient: [[x[0], y[0]], [x[1], y[1]]] }
    }

    /// A vector of it in global components.
    pub fn vector_to_global(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [c, s] = self.axis;
        [c * x - s * y, s * x + c * y]
    }

    /// A stress (xx, yy, xy) of it in global components.
    pub fn tensor_to_global(&self, [xx, yy, xy]: [f64; 3]) -> [f64; 3] {
        let [c, s] = self.axis;
        let (mean, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
        let (cos2, sin2) = ((c - s) * (c + s), 2.0 * c * s);
        let (d, t) = (half * cos2 - xy * sin2, half * sin2 + xy * cos2);
        [mean + d, mean - d, t]
    }
}
