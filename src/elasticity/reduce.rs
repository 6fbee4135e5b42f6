//! From six directions to the plane, and to a half-plane through an axis of revolution.

use super::Elasticity;
use super::matrix::{Square, cholesky, congruent, inverse_upper, values};
use super::twofold::Twofold;

/// Hooke's law in the plane, in axes x and y.
///
/// Stresses are counted as mean m = (σ_xx + σ_yy)/2, deviator d = (σ_xx − σ_yy)/2 and shear s = σ_xy. The strains that do work on
/// them are the trace, ε_xx − ε_yy and 2 ε_xy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// R of a = RᵀR, for (m, d, s): upper triangular, small in its first row where the body is nearly incompressible.
    pub factor: [[f64; 3]; 3],
    /// R⁻ᵀ, lower triangular, for (trace, ε_xx − ε_yy, 2 ε_xy).
    pub inverse: [[f64; 3]; 3],
    /// σ_33 for a unit of m, d, s; nothing in plane stress.
    pub transverse: [f64; 3],
    /// σ_33 for a unit of initial strain ε0_33 is minus this; nothing in plane stress.
    pub transverse_stiffness: f64,
    /// ε_33 for a unit of m, d, s, without σ_33.
    pub cross: [f64; 3],
}

/// Hooke's law of a body of revolution, in axes r and z.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Revolution {
    /// Compliance of the strains (rr, zz, tt, rz), the last one 2 ε_rz, under stresses of the same order.
    pub compliance: [[f64; 4]; 4],
    /// R of a = RᵀR, for the unknowns of [`Revolution::unknowns`]: upper triangular, the pressure first.
    pub factor: [[f64; 4]; 4],
    /// R⁻ᵀ, for the strains of [`Revolution::strains`].
    pub inverse: [[f64; 4]; 4],
}

impl Revolution {
    /// Pressure p = (rr + zz + tt)/3, q = (rr + zz − 2 tt)/6, d = (rr − zz)/2 and s = rz of a stress (rr, zz, tt, rz).
    pub fn unknowns([rr, zz, tt, rz]: [f64; 4]) -> [f64; 4] {
        [(rr + zz + tt) / 3.0, ((rr - tt) + (zz - tt)) / 6.0, 0.5 * (rr - zz), rz]
    }

    /// The strains that do work on them: the trace, rr + zz − 2 tt, rr − zz and 2 rz of a strain (rr, zz, tt, rz).
    pub fn strains([rr, zz, tt, rz]: [f64; 4]) -> [f64; 4] {
        [rr + zz + tt, (rr - tt) + (zz - tt), rr - zz, 2.0 * rz]
    }

    /// The strain (rr, zz, tt, rz) that has these for its work on [`Revolution::unknowns`].
    pub fn components([trace, across, apart, shear]: [f64; 4]) -> [f64; 4] {
        let plane = (2.0 * trace + across) / 3.0;
        [0.5 * (plane + apart), 0.5 * (plane - apart), (trace - across) / 3.0, 0.5 * shear]
    }
}

impl Elasticity {
    /// The law in plane strain or plane stress; `None` where it is not positive definite, or a matrix for plane stress alone is asked
    /// for plane strain.
    pub fn plane(&self, strain: bool) -> Option<Plane> {
        let a = self.compliance_mdsz()?;
        let (one, zero) = (Twofold::from(1.0), Twofold::ZERO);
        if strain && a[3][3].value() <= 0.0 {
            return None;
        }
        // −s_3j/s_33.
        let transverse: [Twofold; 3] = std::array::from_fn(|j| if strain { -(a[3][j] / a[3][3]) } else { zero });
        let reduced: Square<3> = std::array::from_fn(|i| std::array::from_fn(|j| a[i][j] + a[i][3] * transverse[j]));
        let factor = cholesky(&reduced).ok()?;
        let inverse = inverse_upper(&factor);
        let inverse: Square<3> = std::array::from_fn(|i| std::array::from_fn(|j| inverse[j][i]));
        Some(Plane {
            factor: values(&factor),
            inverse: values(&inverse),
            transverse: transverse.map(Twofold::value),
            cross: [0, 1, 2].map(|j| a[3][j].value()),
            transverse_stiffness: if strain { (one / a[3][3]).value() } else { 0.0 },
        })
    }

    /// The law of a body of revolution; `None` where it is not positive definite or knows nothing of axis 3.
    pub fn revolution(&self) -> Option<Revolution> {
        let a = self.compliance_mdsz()?;
        let of = |x: f64| Twofold::from(x);
        // m = p + q, d, s, z = p − 2q.
        let basis: Square<4> =
            [[1.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0], [1.0, -2.0, 0.0, 0.0]]
                .map(|row| row.map(of));
        let factor = cholesky(&congruent(&a, &basis)).ok()?;
        let inverse = inverse_upper(&factor);
        let inverse: Square<4> = std::array::from_fn(|i| std::array::from_fn(|j| inverse[j][i]));
        // m = (rr + zz)/2, d = (rr − zz)/2, s = rz, z = tt.
        let components: Square<4> =
            [[0.5, 0.5, 0.0, 0.0], [0.5, -0.5, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 0.0]]
                .map(|row| row.map(of));
        Some(Revolution {
            compliance: values(&congruent(&a, &components)),
            factor: values(&factor),
            inverse: values(&inverse),
        })
    }

    /// The form a σ:σ of m, d, s and σ_33 in axes x and y.
    fn compliance_mdsz(&self) -> Option<Square<4>> {
        let own = self.compliance().ok()?;
        let of = |x: f64| Twofold::from(x);
        let [c, s] = self.double_angle().map(of);
        let length = (c * c + s * s).sqrt();
        let (c, s, zero, one) = (c / length, s / length, Twofold::ZERO, of(1.0));
        // Stresses 11, 22, 33, 12 along the axes of the material: 11 = m + c d + s τ, 12 = c τ − s d.
        let basis = [[one, c, s, zero], [one, -c, -s, zero], [zero, zero, zero, one], [zero, -s, c, zero]];
        Some(congruent(&own, &basis))
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Anisotropic, Matrix, MatrixKind, Orthotropic};
    use super::*;

    const PLY: Orthotropic =
        Orthotropic { young: [140.0, 10.0, 9.0], poisson: [0.3, 0.25, 0.45], shear: 5.0, angle: 0.0 };

    fn near(a: f64, b: f64, size: f64) -> bool {
        (a - b).abs() < 1e-13 * size
    }

    #[test]
    fn an_isotropic_body_has_pressure_and_deviator_apart() {
        for nu in [0.3, 0.499_999_999_9, -0.7] {
            let plane = Elasticity::Isotropic { young: 2.0, poisson: nu }.plane(true).expect("definite");
            let [first, second, third] = plane.factor;
            // 4κ/E and γ/E.
            let (kappa, gamma) = (0.5 * (1.0 + nu) * (1.0 - 2.0 * nu), 2.0 * (1.0 + nu));
            assert!((first[0] * first[0] / (2.0 * kappa) - 1.0).abs() < 1e-14, "ν = {nu}");
            assert!((second[1] * second[1] / (0.5 * gamma) - 1.0).abs() < 1e-14);
            assert!((third[2] * third[2] / (0.5 * gamma) - 1.0).abs() < 1e-14);
            assert!([first[1], first[2], second[2]].iter().all(|x| x.abs() < 1e-14 * first[0]));
            assert!(near(plane.transverse[0], 2.0 * nu, 1.0) && plane.transverse[1].abs() < 1e-15);
        }
    }

    #[test]
    fn plane_stress_along_the_axes_has_the_engineering_constants() {
        let plane = Elasticity::Orthotropic(PLY).plane(false).expect("definite");
        let energy = |[xx, yy, xy]: [f64; 3]| -> f64 {
            let x = [0.5 * (xx + yy), 0.5 * (xx - yy), xy];
            plane.factor.iter().map(|row| row.iter().zip(x).map(|(r, x)| r * x).sum::<f64>().powi(2)).sum()
        };
        assert!(near(energy([1.0, 0.0, 0.0]), 1.0 / 140.0, 1.0));
        assert!(near(energy([0.0, 1.0, 0.0]), 0.1, 1.0));
        assert!(near(energy([0.0, 0.0, 1.0]), 0.2, 1.0));
        assert!(near(energy([1.0, 1.0, 0.0]) - energy([1.0, -1.0, 0.0]), -4.0 * 0.3 / 140.0, 1.0));
    }

    #[test]
    fn a_quarter_turn_exchanges_the_axes() {
        let turned = Elasticity::Orthotropic(Orthotropic { angle: 90.0, ..PLY });
        let revolution = |e: Elasticity| e.revolution().expect("definite").compliance;
        let (a, b) = (revolution(Elasticity::Orthotropic(PLY)), revolution(turned));
        let swap = [1, 0, 2, 3];
        for i in 0..4 {
            for j in 0..4 {
                assert!(near(b[i][j], a[swap[i]][swap[j]], 1.0), "{i} {j}");
            }
        }
        assert!(near(a[0][2], -0.25 / 140.0, 1.0) && near(a[1][2], -0.045, 1.0));
    }

    #[test]
    fn a_matrix_and_its_inverse_are_one_material() {
        let s = Elasticity::Orthotropic(PLY).compliance().expect("definite");
        let c = super::super::matrix::inverse(&s).expect("definite");
        let six = |a: &Square<4>| {
            let mut rows = [[0.0; 6]; 6];
            for (i, p) in super::super::IN_PLANE.into_iter().enumerate() {
                for (j, q) in super::super::IN_PLANE.into_iter().enumerate() {
                    rows[p][q] = a[i][j].value();
                }
            }
            (rows[3][3], rows[4][4]) = (1.0, 1.0);
            Matrix::Six(rows)
        };
        let made = |kind, matrix| Elasticity::Anisotropic(Anisotropic { kind, matrix, angle: 25.0 });
        let exact = Elasticity::Orthotropic(Orthotropic { angle: 25.0, ..PLY }).plane(true).expect("definite");
        for found in [made(MatrixKind::Compliance, six(&s)), made(MatrixKind::Stiffness, six(&c))] {
            let found = found.plane(true).expect("definite");
            for (a, b) in found.factor.as_flattened().iter().zip(exact.factor.as_flattened()) {
                assert!(near(*a, *b, 1.0));
            }
        }
    }

    #[test]
    fn factors_are_inverse_to_each_other() {
        let law = Elasticity::Orthotropic(Orthotropic { angle: 33.0, ..PLY });
        let plane = law.plane(true).expect("definite");
        for i in 0..3 {
            for j in 0..3 {
                let product: f64 = (0..3).map(|k| plane.factor[i][k] * plane.inverse[j][k]).sum();
                assert!(near(product, f64::from(i == j), 1.0));
            }
        }
        let of = law.revolution().expect("definite");
        let stress = [0.3, -1.0, 0.7, 0.4];
        let own = Revolution::unknowns(stress);
        let by_factor: f64 =
            of.factor.iter().map(|row| row.iter().zip(own).map(|(r, x)| r * x).sum::<f64>().powi(2)).sum();
        let by_matrix: f64 = (0..4)
            .flat_map(|i| (0..4).map(move |j| (i, j)))
            .map(|(i, j)| of.compliance[i][j] * stress[i] * stress[j])
            .sum();
        assert!(near(by_factor, by_matrix, 1.0));
    }
}
