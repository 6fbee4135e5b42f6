//! The block element as the paper makes it: 21 stress parameters, continuity inside, compensation by Q.
//!
//! Coordinates are local, x = (X − centroid)/√area of the block, and all three subtriangles keep their parameters (3.1)
//! about the centroid: S = (S of K_0, S of K_1, S of K_2) ∈ ℝ²¹. Parameters are stresses; areas and moduli enter the
//! flexibility only.

use crate::element::Material;
use crate::element::subtriangle::{Matrix, Moments, flexibility, flexibility_of, shift, side_map, stress_map};

/// One triangle of the mesh in the parameters of Section 3.
#[derive(Debug, Clone)]
pub struct BlockMatrices {
    /// Centroid of the block.
    pub centre: [f64; 2],
    /// Unit of length √area.
    pub scale: f64,
    /// Corners in local coordinates.
    pub local: [[f64; 2]; 3],
    /// A_u of (3.9), 12 × 21: rows 4k … 4k + 3 are the jumps of T1 (mean, slope) and T2 (mean, slope) across 0a_k.
    pub continuity: Matrix<12, 21>,
    /// Q = [Q_0 Q_1] of (3.10), 21 × 21, with A_u Q = [I 0]. The columns of Q_1 are orthonormal.
    pub compensation: Matrix<21, 21>,
    /// F, 21 × 21: the flexibilities f of (3.2) of the three subtriangles on the diagonal, in physical units.
    pub flexibility: Matrix<21, 21>,
    /// Side parameters of the block, 12 × 21: rows 4i … 4i + 3 are (S1*, S2*, S3*, S4*) of (3.4) on side a_{i+1}a_{i+2},
    /// the mean and slope of T1 and of T2 with p from −1 at a_{i+1} to 1 at a_{i+2}.
    pub side: Matrix<12, 21>,
}

impl BlockMatrices {
    /// Sets up the block on the counter-clockwise triangle `corners`.
    pub fn new(corners: [[f64; 2]; 3], material: &Material) -> Self {
        let (centre, scale) = frame(corners);
        let local = corners.map(|p| [(p[0] - centre[0]) / scale, (p[1] - centre[1]) / scale]);
        let continuity = continuity(local);
        let mut side = Matrix::<12, 21>::zeros();
        let mut full = Matrix::<21, 21>::zeros();
        for sub in 0..3 {
            let (a, b) = (local[(sub + 1) % 3], local[(sub + 2) % 3]);
            side.fixed_view_mut::<4, 7>(4 * sub, 7 * sub).copy_from(&side_map(a, b));
            let moments = Moments::new([a, b, [0.0, 0.0]]);
            let to_centre = shift(moments.centre);
            let own = match material.pressure_and_shear() {
                Some([kappa, gamma]) => flexibility(&moments, [kappa + 0.25 * gamma, kappa - 0.25 * gamma, gamma]),
                None => flexibility_of(&moments, material.matrix()),
            };
            let f = to_centre.transpose() * own * to_centre;
            full.fixed_view_mut::<7, 7>(7 * sub, 7 * sub).copy_from(&(f * (scale * scale / material.unit())));
        }
        BlockMatrices {
            centre,
            scale,
            local,
            continuity,
            compensation: compensation(&continuity),
            flexibility: full,
            side,
        }
    }

    /// Q_1 of (3.12), 21 × 9.
    pub fn q1(&self) -> Matrix<21, 9> {
        self.compensation.fixed_view::<21, 9>(0, 12).into_owned()
    }

    /// Q_1ᵀ F Q_1, 9 × 9: this block's part of A.
    pub fn condensed(&self) -> Matrix<9, 9> {
        let q1 = self.q1();
        let a = q1.transpose() * self.flexibility * q1;
        0.5 * (a + a.transpose())
    }

    /// Side parameters of the nine independent fields, 12 × 9.
    pub fn external(&self) -> Matrix<12, 9> {
        self.side * self.q1()
    }

    /// Stress (xx, yy, xy) at a global point of subtriangle `sub`, from the 21 parameters.
    pub fn stress(&self, sub: usize, point: [f64; 2], s: &Matrix<21, 1>) -> [f64; 3] {
        let x = [0, 1].map(|c| (point[c] - self.centre[c]) / self.scale);
        let own = s.fixed_view::<7, 1>(7 * sub, 0);
        let tau = stress_map(x) * own;
        [tau[0], tau[1], tau[2]]
    }

    /// Condition numbers of A_u and of Q_1ᵀ F Q_1 in the Euclidean norm.
    ///
    /// The first grows with the aspect ratio of the triangle; the second also as ν → ½ in plane strain.
    pub fn condition_numbers(&self) -> [f64; 2] {
        let ratio = |values: &[f64]| {
            let (low, high) =
                values.iter().fold((f64::INFINITY, 0.0_f64), |(l, h), v| (l.min(v.abs()), h.max(v.abs())));
            high / low
        };
        let continuity = self.continuity.transpose().svd(false, false).singular_values;
        [ratio(continuity.as_slice()), ratio(self.condensed().symmetric_eigenvalues().as_slice())]
    }
}

/// Centroid and √area.
fn frame([a, b, c]: [[f64; 2]; 3]) -> ([f64; 2], f64) {
    let (u, v) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
    let centre = [0, 1].map(|k| a[k] + (u[k] + v[k]) / 3.0);
    (centre, (0.5 * (u[0] * v[1] - u[1] * v[0])).sqrt())
}

/// A_u: (3.5) on the segments 0a_k. Subtriangle k + 1 has the segment from a_k to 0, subtriangle k + 2 from 0 to a_k,
/// where p runs the other way and the slopes change sign.
fn continuity(local: [[f64; 2]; 3]) -> Matrix<12, 21> {
    let mut a_u = Matrix::<12, 21>::zeros();
    for (k, &corner) in local.iter().enumerate() {
        let (one, other) = ((k + 1) % 3, (k + 2) % 3);
        let inward = side_map(corner, [0.0, 0.0]);
        let mut outward = side_map([0.0, 0.0], corner);
        for slope in [1, 3] {
            for j in 0..7 {
                outward[(slope, j)] = -outward[(slope, j)];
            }
        }
        a_u.fixed_view_mut::<4, 7>(4 * k, 7 * one).copy_from(&inward);
        a_u.fixed_view_mut::<4, 7>(4 * k, 7 * other).copy_from(&outward);
    }
    a_u
}

/// Q from A_uᵀ = Y R by Householder reflections: Q_0 = Y_12 R⁻ᵀ is a right inverse of A_u, the other columns of the full
/// orthogonal Y span its null space.
fn compensation(a_u: &Matrix<12, 21>) -> Matrix<21, 21> {
    let qr = a_u.transpose().qr();
    let mut reflected = Matrix::<21, 21>::identity();
    qr.q_tr_mul(&mut reflected);
    let mut q = reflected.transpose();
    let leading = q.fixed_view::<21, 12>(0, 0).transpose();
    // R is regular for every triangle that is one: rank A_u = 12.
    if let Some(q0) = qr.r().solve_upper_triangular(&leading) {
        q.fixed_view_mut::<21, 12>(0, 0).copy_from(&q0.transpose());
    }
    q
}
