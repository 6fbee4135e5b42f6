//! Digits that the basis of balanced modes keeps and the elimination of inner segments loses.

use hypercircle::element::subtriangle::{Moments, flexibility, side_map};
use hypercircle::element::{Block, EquilibriumElement, Material};
use hypercircle::load::BodyForce;
use hypercircle::scene::Kinematics;
use nalgebra::{DMatrix, DVector};

/// K of one triangle by eliminating the moments on its three inner segments from the stiffnesses of its subtriangles.
fn by_inner_segments(corners: [[f64; 2]; 3], material: &Material) -> DMatrix<f64> {
    let centre = [0, 1].map(|c| (corners[0][c] + corners[1][c] + corners[2][c]) / 3.0);
    let p = corners.map(|q| [q[0] - centre[0], q[1] - centre[1]]);
    let [kappa, gamma] = material.pressure_and_shear().expect("isotropic");
    let constants = [kappa + gamma / 4.0, kappa - gamma / 4.0, gamma];
    // Unknowns: 12 on the sides, then four on each segment 0a_k, from the centroid outwards.
    let mut k = DMatrix::<f64>::zeros(24, 24);
    for sub in 0..3 {
        let (j, l) = ((sub + 1) % 3, (sub + 2) % 3);
        let sides = [(p[j], p[l]), (p[l], [0.0; 2]), ([0.0; 2], p[j])];
        let moments = Moments::new([p[j], p[l], [0.0; 2]]);
        let mut traction = DMatrix::<f64>::zeros(12, 7);
        for (s, (a, b)) in sides.into_iter().enumerate() {
            let off = |q: [f64; 2]| [q[0] - moments.centre[0], q[1] - moments.centre[1]];
            let map = side_map(off(a), off(b));
            for column in 0..7 {
                for (end, sign) in [-1.0, 1.0].into_iter().enumerate() {
                    traction[(4 * s + 2 * end, column)] = map[(0, column)] + sign * map[(1, column)];
                    traction[(4 * s + 2 * end + 1, column)] = map[(2, column)] + sign * map[(3, column)];
                }
            }
        }
        let f = flexibility(&moments, constants) / material.unit();
        let f = DMatrix::from_fn(7, 7, |a, b| f[(a, b)]);
        let own = &traction * f.try_inverse().expect("regular") * traction.transpose();
        let place: Vec<usize> = (0..12)
            .map(|i| match i {
                0..4 => 4 * sub + i,
                // Side a_l → 0 runs inwards, side 0 → a_j outwards.
                4..8 => 12 + 4 * l + [2, 3, 0, 1][i - 4],
                _ => 12 + 4 * j + (i - 8),
            })
            .collect();
        for a in 0..12 {
            for b in 0..12 {
                k[(place[a], place[b])] += own[(a, b)];
            }
        }
    }
    let (outer, inner, mixed) = (k.view((0, 0), (12, 12)), k.view((12, 12), (12, 12)), k.view((12, 0), (12, 12)));
    let eliminated = inner.clone_owned().svd(true, true).solve(&mixed.clone_owned(), 1e-300).expect("solves");
    outer - mixed.transpose() * eliminated
}

#[test]
fn orthonormal_modes_keep_what_inner_segments_lose() {
    let corners = [[0.0, 0.0], [1.0, 0.1], [0.3, 0.8]];
    let area = 0.5 * (1.0 * 0.8 - 0.1 * 0.3);
    // A displacement without change of volume: its energy knows nothing of κ → 0.
    let isochoric = moments(corners, |[x, y]| [x, -y]);
    for nu in [0.3, 0.4999, 0.499999] {
        let material = Material::isotropic(Kinematics::PlaneStrain, 1.0, nu);
        let modes = Block.modes(corners, &material, &BodyForce::NONE);
        let t = DMatrix::from_column_slice(12, 9, modes.traction());
        let other = by_inner_segments(corners, &material);
        let apart = (&t * t.transpose() - &other).amax() / other.amax();
        assert!(apart < 1e-9, "the two are the same matrix");
        // Rigid motions give no stress.
        let rigid: [fn([f64; 2]) -> [f64; 2]; 3] = [|_| [1.0, 0.0], |_| [0.0, 1.0], |[x, y]| [-y, x]];
        for field in rigid {
            let r = moments(corners, field);
            assert!((t.transpose() * &r).amax() < 1e-15 * t.amax() * r.amax());
        }
        let energy = 4.0 * area / material.pressure_and_shear().expect("isotropic")[1];
        let own = ((t.transpose() * &isochoric).norm_squared() - energy).abs() / energy;
        let theirs = ((isochoric.transpose() * &other * &isochoric)[(0, 0)] - energy).abs() / energy;
        println!("ν = {nu}: energy off by {own:.1e} with modes, {theirs:.1e} by inner segments; K {apart:.1e} apart");
        assert!(own < 1e-14);
        if nu > 0.499 {
            assert!(theirs > 100.0 * own);
        }
    }
}

/// ∫ u q ds on the three sides, for a linear field u.
fn moments(corners: [[f64; 2]; 3], field: fn([f64; 2]) -> [f64; 2]) -> DVector<f64> {
    let mut m = DVector::zeros(12);
    for side in 0..3 {
        let (a, b) = (corners[(side + 1) % 3], corners[(side + 2) % 3]);
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        let (ua, ub) = (field(a), field(b));
        for c in 0..2 {
            m[4 * side + c] = length * (2.0 * ua[c] + ub[c]) / 6.0;
            m[4 * side + 2 + c] = length * (ua[c] + 2.0 * ub[c]) / 6.0;
        }
    }
    m
}
