//! The block of Section 3 on random triangles, against quadrature and against the independent basis of N(K).

use hypercircle::dual::paper::BlockMatrices;
use hypercircle::element::subtriangle::{Matrix, Moments, flexibility, shift, side_map, stress_map};
use hypercircle::element::{Block, EquilibriumElement, Material, Section};
use hypercircle::load::BodyForce;
use hypercircle::scene::Kinematics;
use nalgebra::DMatrix;
use proptest::prelude::*;

use crate::support::element::triangle;
use crate::support::theory::quadrature::{self, area};

proptest! {
    #[test]
    fn compensation_separates_the_continuity(corners in triangle(0.05)) {
        let block = BlockMatrices::new(corners, &Material::isotropic(Kinematics::PlaneStrain, 2.0, 0.3));
        let product = block.continuity * block.compensation;
        for i in 0..12 {
            for j in 0..21 {
                let expected = if i == j { 1.0 } else { 0.0 };
                prop_assert!((product[(i, j)] - expected).abs() < 1e-11);
            }
        }
        // Scaled coordinates: condition depends on the shape alone.
        let moved = corners.map(|p| [16.0 * p[0] + 3.0, 16.0 * p[1] - 5.0]);
        let other = BlockMatrices::new(moved, &Material::isotropic(Kinematics::PlaneStrain, 2e11, 0.3));
        for (a, b) in block.condition_numbers().into_iter().zip(other.condition_numbers()) {
            prop_assert!(a >= 1.0 && (a - b).abs() < 1e-6 * a, "{a} and {b}");
        }
    }

    #[test]
    fn q1_spans_the_block_element(corners in triangle(0.05)) {
        let material = Material::isotropic(Kinematics::PlaneStress, 3.0, 0.2);
        let block = BlockMatrices::new(corners, &material);
        let modes = Block.modes(corners, &material, &BodyForce::NONE);
        let q1 = block.q1();
        // Nodal stresses of both bases, 27 × 9.
        let mut own = DMatrix::<f64>::zeros(27, 9);
        for sub in 0..3 {
            for (node, point) in [corners[(sub + 1) % 3], corners[(sub + 2) % 3], block.centre].into_iter().enumerate() {
                for k in 0..9 {
                    let tau = block.stress(sub, point, &q1.column(k).into_owned());
                    for c in 0..3 {
                        own[((3 * sub + node) * 3 + c, k)] = tau[c];
                    }
                }
            }
        }
        let fields = Section::Slice.mode_stresses(&Block, corners, &modes);
        let other = DMatrix::from_fn(27, 9, |i, k| fields[k][i / 3][i % 3]);
        let svd = own.clone().svd(true, true);
        prop_assert!(svd.singular_values.min() > 1e-3 * svd.singular_values.max(), "nine independent fields");
        let coefficients = svd.solve(&other, 1e-12).unwrap();
        prop_assert!((own * coefficients - &other).amax() < 1e-10 * other.amax());
    }

    #[test]
    fn flexibility_is_the_energy(corners in triangle(0.05), nu in -0.9..0.49_f64, strain in any::<bool>()) {
        let kinematics = if strain { Kinematics::PlaneStrain } else { Kinematics::PlaneStress };
        let (alpha, beta) = if strain { (1.0 - nu * nu, -nu * (1.0 + nu)) } else { (1.0, -nu) };
        let gamma = 2.0 * (1.0 + nu);
        let product = |l: [f64; 3], m: [f64; 3]| {
            (alpha * (l[0] * m[0] + l[1] * m[1]) + beta * (l[0] * m[1] + l[1] * m[0]) + gamma * l[2] * m[2]) / 7.0
        };
        let block = BlockMatrices::new(corners, &Material::isotropic(kinematics, 7.0, nu));
        let mut by_quadrature = Matrix::<21, 21>::zeros();
        for sub in 0..3 {
            let q = [corners[(sub + 1) % 3], corners[(sub + 2) % 3], block.centre];
            for (bary, w) in quadrature::triangle(4) {
                let x = [0, 1].map(|c| (0..3).map(|i| bary[i] * q[i][c]).sum());
                let unit = |k: usize| block.stress(sub, x, &Matrix::<21, 1>::from_fn(|i, _| f64::from(i == k)));
                for i in 7 * sub..7 * sub + 7 {
                    for j in 7 * sub..7 * sub + 7 {
                        by_quadrature[(i, j)] += w * area(q) * product(unit(i), unit(j));
                    }
                }
            }
        }
        prop_assert!((by_quadrature - block.flexibility).amax() < 1e-12 * block.flexibility.amax());
    }

    #[test]
    fn printed_flexibility_is_about_the_centre_of_gravity(corners in triangle(0.05)) {
        // f of (3.2) as printed, against quadrature of M of (3.1) about the centre of the subtriangle.
        let constants = [0.91, -0.39, 2.6];
        let moments = Moments::new(corners);
        let f = flexibility(&moments, constants);
        let mut by_quadrature = Matrix::<7, 7>::zeros();
        let law = nalgebra::Matrix3::new(constants[0], constants[1], 0.0, constants[1], constants[0], 0.0, 0.0, 0.0, constants[2]);
        for (bary, w) in quadrature::triangle(4) {
            let x = [0, 1].map(|c| (0..3).map(|i| bary[i] * corners[i][c]).sum::<f64>() - moments.centre[c]);
            by_quadrature += stress_map(x).transpose() * law * stress_map(x) * (w * area(corners));
        }
        prop_assert!((by_quadrature - f).amax() < 1e-12 * f.amax());
        // Moving the origin there and back changes nothing.
        let [x, y] = moments.centre;
        prop_assert!((shift([x, y]) * shift([-x, -y]) - Matrix::<7, 7>::identity()).amax() < 1e-12 * (1.0 + x.abs().max(y.abs())));
    }

    #[test]
    fn side_parameters_are_the_traction(a in prop::array::uniform2(-1.0..1.0_f64), b in prop::array::uniform2(-1.0..1.0_f64),
                                        s in prop::array::uniform7(-1.0..1.0_f64), p in -1.0..1.0_f64) {
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let length = dx.hypot(dy);
        prop_assume!(length > 0.05);
        let s = Matrix::<7, 1>::from_column_slice(&s);
        let side = side_map(a, b) * s;
        let x = [0, 1].map(|c| 0.5 * (1.0 - p) * a[c] + 0.5 * (1.0 + p) * b[c]);
        let tau = stress_map(x) * s;
        let n = [dy / length, -dx / length];
        prop_assert!((side[0] + side[1] * p - (tau[0] * n[0] + tau[2] * n[1])).abs() < 1e-12);
        prop_assert!((side[2] + side[3] * p - (tau[2] * n[0] + tau[1] * n[1])).abs() < 1e-12);
    }
}
