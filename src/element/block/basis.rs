//! Nine fields that span N(K), with their energies and tractions.

use super::{COMMON, N};
use crate::element::Material;
use crate::element::frame::Frame;
use crate::element::geometry::from_centroid;
use crate::element::polynomial::quadrature::triangle_rule;
use crate::element::subtriangle::{Matrix, Moments, flexibility, side_map};

/// Numbers of which the energy of a field is the sum of the squares: three at each of three points of each subtriangle.
const ROWS: usize = 27;

/// A basis of N(K), in the parameters (3.1) about the centroid of the block.
///
/// Uniform pressure, the two pure shears along and across the axes of the frame, the four linear fields, and two that are
/// piecewise linear. Nearly incompressible material makes the first soft, and nothing else.
pub struct BlockBasis {
    /// The frame of the triangle.
    pub frame: Frame,
    local: [[f64; 2]; 3],
    /// S4 … S7 of the two piecewise fields, by field and subtriangle. Their S1, S2, S3 vanish.
    piecewise: [[[f64; 4]; 3]; 2],
}

impl BlockBasis {
    /// The basis on a counter-clockwise triangle.
    pub fn new(corners: [[f64; 2]; 3]) -> Self {
        let frame = Frame::new(corners);
        let local = from_centroid(corners).map(|p| frame.to_local(p));
        BlockBasis { piecewise: piecewise_parameters(local), frame, local }
    }

    /// Corners of subtriangle `sub`, the centroid last.
    fn sub(&self, sub: usize) -> [[f64; 2]; 3] {
        [self.local[(sub + 1) % 3], self.local[(sub + 2) % 3], [0.0; 2]]
    }

    /// Nodal stresses of Σ c_k τ_k, in the order of [`crate::element::StressField::block`].
    pub fn field(&self, c: &[f64; N]) -> [[f64; 3]; 9] {
        let mut out = [[0.0; 3]; 9];
        for sub in 0..3 {
            let s = self.parameters(c, sub);
            for (node, point) in self.sub(sub).into_iter().enumerate() {
                out[3 * sub + node] = self.frame.tensor_to_global(stress(&s, point));
            }
        }
        out
    }

    /// F_9 of an isotropic material in local units, summed separately over trace and deviator.
    pub fn flexibility(&self, material: &Material) -> Option<[[f64; N]; N]> {
        let [kappa, gamma] = material.pressure_and_shear()?;
        let whole = Moments::new(self.local);
        let subs = [0, 1, 2].map(|sub| Moments::new(self.sub(sub)));
        let of = |constants: [f64; 3]| {
            let own = flexibility(&whole, constants);
            let parts = subs.map(|moments| (moments.centre, flexibility(&moments, constants)));
            self.form(&own, &parts)
        };
        let (trace, mut deviator) = (of([1.0, 1.0, 0.0]), of([0.25, -0.25, 1.0]));
        // The pressure has no deviator: what rounding leaves in its row would drown κ.
        deviator[0] = [0.0; N];
        deviator.iter_mut().for_each(|row| row[0] = 0.0);
        let mut out = trace;
        for (out, deviator) in out.as_flattened_mut().iter_mut().zip(deviator.as_flattened()) {
            *out = kappa * *out + gamma * deviator;
        }
        Some(out)
    }

    /// L⁻ᵀ of F_9 = L Lᵀ of any material, column by column, from the Householder factor of the fields in their energy.
    pub fn inverse_factor(&self, material: &Material) -> [[f64; N]; N] {
        let roots = self.frame.roots(material);
        let rule = triangle_rule(2);
        let mut measured = Matrix::<ROWS, N>::zeros();
        for k in 0..N {
            let unit = std::array::from_fn(|i| f64::from(i == k));
            let mut row = 0;
            for sub in 0..3 {
                let s = self.parameters(&unit, sub);
                let corners = self.sub(sub);
                let third = 0.5 * (corners[0][0] * corners[1][1] - corners[0][1] * corners[1][0]);
                for &(l, weight) in rule {
                    let point = [0, 1].map(|c| l[0] * corners[0][c] + l[1] * corners[1][c]);
                    let size = self.frame.scale * (weight * third / material.unit()).sqrt();
                    for part in roots.apply(stress(&s, point)) {
                        measured[(row, k)] = size * part;
                        row += 1;
                    }
                }
            }
        }
        let r = measured.qr().r();
        let mut inverse = [[0.0; N]; N];
        for (k, column) in inverse.iter_mut().enumerate() {
            for i in (0..=k).rev() {
                let unit = if i == k { 1.0 } else { 0.0 };
                let sum: f64 = (i + 1..=k).map(|j| r[(i, j)] * column[j]).sum();
                column[i] = (unit - sum) / r[(i, i)];
            }
        }
        inverse
    }

    /// S of Σ c_k τ_k on a subtriangle.
    fn parameters(&self, c: &[f64; N], sub: usize) -> [f64; 7] {
        let mut s = [c[0] + c[1], c[0] - c[1], c[2], c[3], c[4], c[5], c[6]];
        for (c, piecewise) in c[COMMON..].iter().zip(&self.piecewise) {
            s[3..].iter_mut().zip(&piecewise[sub]).for_each(|(s, p)| *s += c * p);
        }
        s
    }

    /// Σ Q_iᵀ f_i Q_i, with the flexibilities of the whole triangle and, about their centres, of the subtriangles.
    fn form(&self, whole: &Matrix<7, 7>, parts: &[([f64; 2], Matrix<7, 7>); 3]) -> [[f64; N]; N] {
        let mut out = [[0.0; N]; N];
        // Both factors common: the moments about the centroid couple no constant with a linear field.
        out[0][0] = whole[(0, 0)] + 2.0 * whole[(0, 1)] + whole[(1, 1)];
        out[1][1] = whole[(0, 0)] - 2.0 * whole[(0, 1)] + whole[(1, 1)];
        out[2][2] = whole[(2, 2)];
        for (i, row) in out.iter_mut().enumerate().take(COMMON).skip(3) {
            for (j, value) in row.iter_mut().enumerate().take(COMMON).skip(3) {
                *value = whole[(i, j)];
            }
        }
        for (sub, (centre, f)) in parts.iter().enumerate() {
            // About the centre of the subtriangle a piecewise field has a constant part too.
            let own = self.piecewise.map(|piecewise| about(*centre, &piecewise[sub]));
            let answer = own.map(|s| times(f, &s));
            for (k, answer) in answer.iter().enumerate() {
                // The common fields against it: those about the centroid from those about the centre, transposed.
                let [a, b, c, ..] = *answer;
                let [x, y] = *centre;
                let linear = [b * x, a * x - c * y, b * y - c * x, a * y];
                let values = [a + b, a - b, c].into_iter();
                let values = values.chain(linear.iter().zip(&answer[3..]).map(|(l, s)| l + s));
                for (i, value) in values.enumerate() {
                    out[i][COMMON + k] += value;
                    out[COMMON + k][i] += value;
                }
                for (l, own) in own.iter().enumerate() {
                    out[COMMON + l][COMMON + k] += own.iter().zip(answer).map(|(s, f)| s * f).sum::<f64>();
                }
            }
        }
        out
    }

    /// Traction values of the basis fields, each as in [`crate::element::Modes::traction`].
    pub fn tractions(&self) -> [[f64; 12]; N] {
        let mut out = [[0.0; 12]; N];
        for sub in 0..3 {
            let [a, b, _] = self.sub(sub);
            let map = side_map(a, b);
            let columns: [[f64; 4]; COMMON] = std::array::from_fn(|k| std::array::from_fn(|i| map[(i, k)]));
            let sum = |sign: f64| std::array::from_fn(|i| columns[0][i] + sign * columns[1][i]);
            let mut sides = [[0.0; 4]; N];
            (sides[0], sides[1]) = (sum(1.0), sum(-1.0));
            sides[2..COMMON].copy_from_slice(&columns[2..]);
            for (side, piecewise) in sides[COMMON..].iter_mut().zip(&self.piecewise) {
                for (column, p) in columns[3..].iter().zip(&piecewise[sub]) {
                    side.iter_mut().zip(column).for_each(|(s, c)| *s += p * c);
                }
            }
            for (out, side) in out.iter_mut().zip(&sides) {
                // End values from mean and half difference.
                let first = self.frame.vector_to_global([side[0] - side[1], side[2] - side[3]]);
                let second = self.frame.vector_to_global([side[0] + side[1], side[2] + side[3]]);
                out[4 * sub..4 * sub + 4].copy_from_slice(&[first[0], first[1], second[0], second[1]]);
            }
        }
        out
    }
}

/// (3.1): the stress with parameters `s` at a point.
fn stress(s: &[f64; 7], [x, y]: [f64; 2]) -> [f64; 3] {
    [s[0] + s[4] * x + s[6] * y, s[1] + s[3] * x + s[5] * y, s[2] - s[5] * x - s[4] * y]
}

/// All seven parameters about `centre` of a field with the given S4 … S7 whose stress vanishes at the origin.
fn about(centre: [f64; 2], linear: &[f64; 4]) -> [f64; 7] {
    let mut s = [0.0; 7];
    s[3..].copy_from_slice(linear);
    let constant = stress(&s, centre);
    s[..3].copy_from_slice(&constant);
    s
}

fn times(f: &Matrix<7, 7>, s: &[f64; 7]) -> [f64; 7] {
    let mut out = [0.0; 7];
    for (column, s) in f.as_slice().chunks_exact(7).zip(s) {
        out.iter_mut().zip(column).for_each(|(o, f)| *o += f * s);
    }
    out
}

/// S4 … S7 of the two piecewise fields, by field and subtriangle.
fn piecewise_parameters(local: [[f64; 2]; 3]) -> [[[f64; 4]; 3]; 2] {
    // Gradient of d_k = μ_{k+1} − μ_{k+2}; 2 area = 2 in local units.
    let mu = [0, 1, 2].map(|i: usize| {
        let (a, b) = (local[(i + 1) % 3], local[(i + 2) % 3]);
        [0.5 * (a[1] - b[1]), 0.5 * (b[0] - a[0])]
    });
    let d = [0, 1, 2].map(|k: usize| {
        let (p, q) = (mu[(k + 1) % 3], mu[(k + 2) % 3]);
        [p[0] - q[0], p[1] - q[1]]
    });
    let combine = |a: f64, b: f64| [a * d[0][0] + b * d[1][0], a * d[0][1] + b * d[1][1]];
    [(1.0, 0.0), (0.0, 1.0)].map(|(c1, c2)| {
        // ℓ_1 and ℓ_2 of the solution with ℓ_2 = c1 d_0 + c2 d_1.
        let l1 = combine(-(c1 + 2.0 * c2), -c2);
        let l2 = combine(c1, c2);
        // φ_0 = 0, φ_1 = −d_2² ℓ_2, φ_2 = d_1² ℓ_1.
        let field = [[0.0; 4], airy_parameters(d[2], l2, -1.0), airy_parameters(d[1], l1, 1.0)];
        let largest = field.iter().flatten().fold(0.0_f64, |m, v| m.max(v.abs()));
        field.map(|sub| sub.map(|v| v / largest))
    })
}

/// S4 … S7 of the stress with Airy function sign · (d·x)² (ℓ·x).
fn airy_parameters(d: [f64; 2], l: [f64; 2], sign: f64) -> [f64; 4] {
    // A x³ + B x²y + C xy² + D y³
    let a = sign * d[0] * d[0] * l[0];
    let b = sign * d[0] * (d[0] * l[1] + 2.0 * d[1] * l[0]);
    let c = sign * d[1] * (d[1] * l[0] + 2.0 * d[0] * l[1]);
    let e = sign * d[1] * d[1] * l[1];
    [6.0 * a, 2.0 * c, 2.0 * b, 6.0 * e]
}
