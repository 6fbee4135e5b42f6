//! Two equal bodies that touch on part of a line and gape on the rest, in closed form.
//!
//! Westergaard's stress function about the line x = 0, with ζ = y + i|x|:
//!
//! τ11 = Re Z + |x| Im Z′, τ22 = Re Z − |x| Im Z′, τ12 = −x Re Z′, 2μ u1 = ±((κ+1)/2 Im Ẑ − |x| Re Z),
//! 2μ u2 = (κ−1)/2 Re Ẑ − |x| Im Z, Ẑ′ = Z.
//!
//! Z = −7 ζ (ζ² − c²)^{5/2} has Ẑ = −(ζ² − c²)^{7/2}. On x = 0 it is real and negative for y > c: pressure, no jump.
//! For 0 < y < c it is imaginary: no traction, and the bodies part by Im Ẑ = (c² − y²)^{7/2} > 0. T_n falls to zero like
//! (y − c)^{5/2}, so it is in H². On y = 0, u2 = 0 and τ12 = 0: a roller.

use std::f64::consts::PI;

/// Exponent of the contact end: Z = −(2q + 2) ζ (ζ² − c²)^q with q + 1/2 an odd whole number.
#[derive(Debug, Clone, Copy)]
pub struct Westergaard {
    /// q: 5/2 for a contact pressure in H², 1/2 for the contact end that a g = 0 contact has in general.
    pub exponent: f64,
    /// Contact ends at y = c.
    pub tip: f64,
    pub young: f64,
    pub poisson: f64,
}

/// r^p (cos pθ, sin pθ) of a number in the closed upper half plane.
fn power([re, im]: [f64; 2], p: f64) -> [f64; 2] {
    let (r, angle) = (re.hypot(im), im.atan2(re).clamp(0.0, PI));
    let size = r.powf(p);
    [size * (p * angle).cos(), size * (p * angle).sin()]
}

fn times(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

impl Westergaard {
    /// Ẑ, Z, Z′ at (|x|, y).
    fn functions(&self, [x, y]: [f64; 2]) -> [[f64; 2]; 3] {
        let q = self.exponent;
        let zeta = [y, x];
        let square = times(zeta, zeta);
        let w = [square[0] - self.tip * self.tip, square[1].max(0.0)];
        let hat = power(w, q + 1.0).map(|v| -v);
        let root = power(w, q);
        let z = times(zeta, root).map(|v| -(2.0 * q + 2.0) * v);
        let slope = times(square, power(w, q - 1.0));
        let derivative = [0, 1].map(|c| -(2.0 * q + 2.0) * (root[c] + 2.0 * q * slope[c]));
        [hat, z, derivative]
    }

    pub fn stress(&self, [x, y]: [f64; 2]) -> [f64; 3] {
        let [_, z, d] = self.functions([x.abs(), y]);
        [z[0] + x.abs() * d[1], z[0] - x.abs() * d[1], -x * d[0]]
    }

    /// Displacement in plane strain; `body` is 0 on the left of x = 0, 1 on the right.
    pub fn displacement(&self, body: usize, [x, y]: [f64; 2]) -> [f64; 2] {
        let [hat, z, _] = self.functions([x.abs(), y]);
        let kappa = 3.0 - 4.0 * self.poisson;
        let twice_mu = self.young / (1.0 + self.poisson);
        let sign = if body == 0 { -1.0 } else { 1.0 };
        [
            sign * (0.5 * (kappa + 1.0) * hat[1] - x.abs() * z[0]) / twice_mu,
            (0.5 * (kappa - 1.0) * hat[0] - x.abs() * z[1]) / twice_mu,
        ]
    }
}
