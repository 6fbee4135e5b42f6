//! The block element of Watwood and Hartz, Section 2.1 of the paper: linear stresses on the three subtriangles.
//!
//! N(K) has nine dimensions. Seven are the linear self-equilibrated fields on the whole triangle; the other two are
//! second derivatives of piecewise cubic Airy functions that are C¹ across the segments 0a_k. With barycentric
//! coordinates μ_k of the triangle and d_k = μ_{k+1} − μ_{k+2}, which vanishes on 0a_k, two cubics match to first order
//! there exactly if they differ by d_k² ℓ_k with a linear ℓ_k; going round the centroid requires Σ d_k² ℓ_k = 0, and
//! for ℓ_k that are combinations of the d_k this has two solutions.

use super::subtriangle::{Matrix, Moments, flexibility, shift, side_map, stress_map};
use super::{Compliance, EquilibriumElement, ModesMut};

/// The element of the paper: p = 1, nine parameters.
#[derive(Debug, Clone, Copy, Default)]
pub struct Block;

impl EquilibriumElement for Block {
    fn name(&self) -> &'static str {
        "Watwood–Hartz block, p = 1"
    }

    fn degree(&self) -> usize {
        1
    }

    fn parameters(&self) -> usize {
        9
    }

    fn compute(&self, corners: [[f64; 2]; 3], material: &Compliance, body_force: [f64; 2], out: ModesMut<'_>) {
        let frame = Frame::new(corners);
        let local = corners.map(|p| frame.to_local(p));
        let basis = balanced_parameters(local);
        let flexibility = block_flexibility(local, &basis, material) * (frame.scale * frame.scale / material.young);
        let inverse = inverse_factor(&flexibility);

        let mut traction = Matrix::<12, 9>::zeros();
        let mut stress = Matrix::<27, 9>::zeros();
        for sub in 0..3 {
            let (a, b) = (local[(sub + 1) % 3], local[(sub + 2) % 3]);
            // End values from mean and half difference.
            let side = side_map(a, b) * basis[sub];
            for k in 0..9 {
                let ends = [
                    [side[(0, k)] - side[(1, k)], side[(2, k)] - side[(3, k)]],
                    [side[(0, k)] + side[(1, k)], side[(2, k)] + side[(3, k)]],
                ];
                for (end, local_traction) in ends.into_iter().enumerate() {
                    let global = frame.vector_to_global(local_traction);
                    traction[(4 * sub + 2 * end, k)] = global[0];
                    traction[(4 * sub + 2 * end + 1, k)] = global[1];
                }
            }
            for (node, point) in [a, b, [0.0, 0.0]].into_iter().enumerate() {
                let values = stress_map(point) * basis[sub];
                for k in 0..9 {
                    let global = frame.tensor_to_global([values[(0, k)], values[(1, k)], values[(2, k)]]);
                    for c in 0..3 {
                        stress[((3 * sub + node) * 3 + c, k)] = global[c];
                    }
                }
            }
        }
        let (traction, stress) = (traction * inverse, stress * inverse);
        let particular = Particular::new(corners, material, body_force, &traction, &stress);
        out.traction.copy_from_slice(traction.transpose().as_slice());
        out.stress.copy_from_slice(stress.transpose().as_slice());
        out.particular_traction.copy_from_slice(&particular.traction);
        out.particular_stress.copy_from_slice(particular.stress.as_flattened());
        *out.particular_energy = particular.energy;
    }
}

/// Local coordinates: origin in the centroid, first axis along the longest side, lengths in units of √area.
///
/// Along the longest side the modes of a stretched triangle keep apart by themselves (stress along it, across it, shear),
/// which keeps their Gram matrix well conditioned.
struct Frame {
    centre: [f64; 2],
    axis: [f64; 2],
    scale: f64,
}

impl Frame {
    fn new(corners: [[f64; 2]; 3]) -> Self {
        let sides = [0, 1, 2].map(|i: usize| {
            let (a, b) = (corners[(i + 1) % 3], corners[(i + 2) % 3]);
            [b[0] - a[0], b[1] - a[1]]
        });
        let length = |s: [f64; 2]| s[0].hypot(s[1]);
        let longest = sides.into_iter().reduce(|l, s| if length(s) > length(l) { s } else { l }).unwrap_or(sides[0]);
        let area = 0.5 * (sides[0][0] * sides[1][1] - sides[0][1] * sides[1][0]);
        // Differences from a corner: no digits are lost far from the origin.
        let from = corners[0];
        let centre = [0, 1].map(|c| from[c] + ((corners[1][c] - from[c]) + (corners[2][c] - from[c])) / 3.0);
        let l = length(longest);
        Frame { centre, axis: [longest[0] / l, longest[1] / l], scale: area.sqrt() }
    }

    fn to_local(&self, p: [f64; 2]) -> [f64; 2] {
        let (x, y) = ((p[0] - self.centre[0]) / self.scale, (p[1] - self.centre[1]) / self.scale);
        let [c, s] = self.axis;
        [c * x + s * y, c * y - s * x]
    }

    fn vector_to_global(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [c, s] = self.axis;
        [c * x - s * y, s * x + c * y]
    }

    fn tensor_to_global(&self, [xx, yy, xy]: [f64; 3]) -> [f64; 3] {
        let [c, s] = self.axis;
        let (mean, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
        let (cos2, sin2) = ((c - s) * (c + s), 2.0 * c * s);
        let (d, t) = (half * cos2 - xy * sin2, half * sin2 + xy * cos2);
        [mean + d, mean - d, t]
    }
}

/// A basis of N(K) in the parameters (3.1) of each subtriangle, about the centroid of the block: three 7 × 9 matrices.
///
/// The first field is the uniform pressure. Nearly incompressible material makes it soft, and nothing else.
pub fn balanced_parameters(local: [[f64; 2]; 3]) -> [Matrix<7, 9>; 3] {
    let mut common = Matrix::<7, 9>::zeros();
    // Pressure, pure shear along and across the axes.
    common[(0, 0)] = 1.0;
    common[(1, 0)] = 1.0;
    common[(0, 1)] = 1.0;
    common[(1, 1)] = -1.0;
    common[(2, 2)] = 1.0;
    for k in 3..7 {
        common[(k, k)] = 1.0;
    }
    let mut basis = [common; 3];
    for (sub, piecewise) in piecewise_parameters(local).into_iter().enumerate() {
        for (k, parameters) in piecewise.into_iter().enumerate() {
            for row in 0..7 {
                basis[sub][(row, 7 + k)] = parameters[row];
            }
        }
    }
    basis
}

/// Parameters of the two piecewise fields on each subtriangle.
fn piecewise_parameters(local: [[f64; 2]; 3]) -> [[[f64; 7]; 2]; 3] {
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
    let mut out = [[[0.0; 7]; 2]; 3];
    for (k, (c1, c2)) in [(1.0, 0.0), (0.0, 1.0)].into_iter().enumerate() {
        // ℓ_1 and ℓ_2 of the solution with ℓ_2 = c1 d_0 + c2 d_1.
        let l1 = combine(-(c1 + 2.0 * c2), -c2);
        let l2 = combine(c1, c2);
        // φ_0 = 0, φ_1 = −d_2² ℓ_2, φ_2 = d_1² ℓ_1.
        out[1][k] = airy_parameters(d[2], l2, -1.0);
        out[2][k] = airy_parameters(d[1], l1, 1.0);
        let largest = out.iter().flat_map(|s| s[k]).fold(0.0_f64, |m, v| m.max(v.abs()));
        for sub in &mut out {
            for value in &mut sub[k] {
                *value /= largest;
            }
        }
    }
    out
}

/// Parameters of the stress with Airy function sign · (d·x)² (ℓ·x).
fn airy_parameters(d: [f64; 2], l: [f64; 2], sign: f64) -> [f64; 7] {
    // A x³ + B x²y + C xy² + D y³
    let a = sign * d[0] * d[0] * l[0];
    let b = sign * d[0] * (d[0] * l[1] + 2.0 * d[1] * l[0]);
    let c = sign * d[1] * (d[1] * l[0] + 2.0 * d[0] * l[1]);
    let e = sign * d[1] * d[1] * l[1];
    [0.0, 0.0, 0.0, 6.0 * a, 2.0 * c, 2.0 * b, 6.0 * e]
}

/// F_9 = Σ Q_iᵀ f_i Q_i in local units for E = 1, summed separately over trace and deviator.
fn block_flexibility(local: [[f64; 2]; 3], basis: &[Matrix<7, 9>; 3], material: &Compliance) -> Matrix<9, 9> {
    let (mut trace, mut deviator) = (Matrix::<9, 9>::zeros(), Matrix::<9, 9>::zeros());
    for sub in 0..3 {
        let moments = Moments::new([local[(sub + 1) % 3], local[(sub + 2) % 3], [0.0, 0.0]]);
        let own = shift(moments.centre) * basis[sub];
        trace += own.transpose() * flexibility(&moments, [1.0, 1.0, 0.0]) * own;
        deviator += own.transpose() * flexibility(&moments, [0.25, -0.25, 1.0]) * own;
    }
    // The pressure has no deviator: what rounding leaves in its row would drown κ.
    for k in 0..9 {
        deviator[(0, k)] = 0.0;
        deviator[(k, 0)] = 0.0;
    }
    trace * material.kappa + deviator * material.gamma
}

/// L⁻ᵀ of F = L Lᵀ: turns the modes into energy-orthonormal ones, the pressure first.
fn inverse_factor(f: &Matrix<9, 9>) -> Matrix<9, 9> {
    let mut factor = Matrix::<9, 9>::zeros();
    for j in 0..9 {
        for i in j..9 {
            let sum: f64 = (0..j).map(|k| factor[(i, k)] * factor[(j, k)]).sum();
            let value = f[(i, j)] - sum;
            // Positive for every triangle that is one; the floor only keeps NaN out of a degenerate block.
            factor[(i, j)] = if i == j { value.max(f64::MIN_POSITIVE).sqrt() } else { value / factor[(j, j)] };
        }
    }
    let mut inverse = Matrix::<9, 9>::zeros();
    for column in 0..9 {
        for i in (0..=column).rev() {
            let unit = if i == column { 1.0 } else { 0.0 };
            let sum: f64 = (i + 1..=column).map(|k| factor[(k, i)] * inverse[(k, column)]).sum();
            inverse[(i, column)] = (unit - sum) / factor[(i, i)];
        }
    }
    inverse
}

/// The particular field (−F1 x, −F2 y, 0), made energy-orthogonal to the modes.
struct Particular {
    traction: [f64; 12],
    stress: [[f64; 3]; 9],
    energy: f64,
}

impl Particular {
    fn new(
        corners: [[f64; 2]; 3],
        material: &Compliance,
        force: [f64; 2],
        mode_traction: &Matrix<12, 9>,
        mode_stress: &Matrix<27, 9>,
    ) -> Self {
        let mut particular = Particular { traction: [0.0; 12], stress: [[0.0; 3]; 9], energy: 0.0 };
        if force == [0.0, 0.0] {
            return particular;
        }
        let (b, c) = (
            [corners[1][0] - corners[0][0], corners[1][1] - corners[0][1]],
            [corners[2][0] - corners[0][0], corners[2][1] - corners[0][1]],
        );
        let sub_area = (b[0] * c[1] - b[1] * c[0]) / 6.0;
        let centre = [corners[0][0] + (b[0] + c[0]) / 3.0, corners[0][1] + (b[1] + c[1]) / 3.0];
        let value = |p: [f64; 2]| [-force[0] * (p[0] - centre[0]), -force[1] * (p[1] - centre[1]), 0.0];
        for sub in 0..3 {
            let (a, b) = (corners[(sub + 1) % 3], corners[(sub + 2) % 3]);
            let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
            let length = dx.hypot(dy);
            for (end, p) in [a, b].into_iter().enumerate() {
                let tau = value(p);
                particular.traction[4 * sub + 2 * end] = tau[0] * dy / length;
                particular.traction[4 * sub + 2 * end + 1] = -tau[1] * dx / length;
                particular.stress[3 * sub + end] = tau;
            }
        }
        // ∫ a σ:τ of two fields linear on each subtriangle, from their corner values.
        let energy = |l: &dyn Fn(usize) -> [f64; 3], m: &dyn Fn(usize) -> [f64; 3]| {
            let mut sum = 0.0;
            for sub in 0..3 {
                for i in 0..3 {
                    for j in 0..3 {
                        let weight = if i == j { 1.0 / 6.0 } else { 1.0 / 12.0 };
                        sum += weight * sub_area * material.product(l(3 * sub + i), m(3 * sub + j));
                    }
                }
            }
            sum
        };
        let stress = particular.stress;
        for k in 0..9 {
            let mode = |n: usize| [0, 1, 2].map(|c| mode_stress[(3 * n + c, k)]);
            let overlap = energy(&|n| stress[n], &mode);
            for n in 0..9 {
                for (value, m) in particular.stress[n].iter_mut().zip(mode(n)) {
                    *value -= overlap * m;
                }
            }
            for i in 0..12 {
                particular.traction[i] -= overlap * mode_traction[(i, k)];
            }
        }
        let stress = particular.stress;
        particular.energy = energy(&|n| stress[n], &|n| stress[n]);
        particular
    }
}
