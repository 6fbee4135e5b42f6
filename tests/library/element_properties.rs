//! Properties that every equilibrium element must have, checked with quadrature and finite differences of their own.

use hypercircle::element::{Block, Compliance, EquilibriumElement, Modes, StressField};
use hypercircle::scene::Kinematics;
use proptest::prelude::*;

const ELEMENTS: [&dyn EquilibriumElement; 1] = [&Block];

/// Seven-point rule of degree 5 (Radon): shares no point with the midpoint rule of the library.
fn radon() -> Vec<([f64; 3], f64)> {
    let r = 15.0_f64.sqrt();
    let mut rule = vec![([1.0 / 3.0; 3], 9.0 / 40.0)];
    for (a, w) in [((6.0 - r) / 21.0, (155.0 - r) / 1200.0), ((6.0 + r) / 21.0, (155.0 + r) / 1200.0)] {
        let b = 1.0 - 2.0 * a;
        rule.extend([([b, a, a], w), ([a, b, a], w), ([a, a, b], w)]);
    }
    rule
}

/// a λ:μ straight from α, β, γ after (3.2).
fn product(kinematics: Kinematics, e: f64, nu: f64, l: [f64; 3], m: [f64; 3]) -> f64 {
    let (alpha, beta) = match kinematics {
        Kinematics::PlaneStress => (1.0, -nu),
        Kinematics::PlaneStrain => (1.0 - nu * nu, -nu * (1.0 + nu)),
    };
    let gamma = 2.0 * (1.0 + nu);
    (alpha * (l[0] * m[0] + l[1] * m[1]) + beta * (l[0] * m[1] + l[1] * m[0]) + gamma * l[2] * m[2]) / e
}

fn sub_corners(p: [[f64; 2]; 3], sub: usize) -> [[f64; 2]; 3] {
    let g = [(p[0][0] + p[1][0] + p[2][0]) / 3.0, (p[0][1] + p[1][1] + p[2][1]) / 3.0];
    [p[(sub + 1) % 3], p[(sub + 2) % 3], g]
}

fn area(p: [[f64; 2]; 3]) -> f64 {
    0.5 * ((p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]))
}

fn field_of(element: &dyn EquilibriumElement, values: &[[f64; 3]]) -> StressField {
    let mut field = StressField::zeros(element.degree(), 1);
    field.block_mut(0).copy_from_slice(values);
    field
}

fn mode_fields(element: &dyn EquilibriumElement, p: [[f64; 2]; 3], modes: &Modes<'_>) -> Vec<StressField> {
    element.mode_stresses(p, modes).iter().map(|values| field_of(element, values)).collect()
}

fn particular_field(element: &dyn EquilibriumElement, p: [[f64; 2]; 3], f: [f64; 2], modes: &Modes<'_>) -> StressField {
    let mut field = StressField::zeros(element.degree(), 1);
    element.stresses(p, f, modes, &vec![0.0; element.parameters()], 1.0, field.block_mut(0));
    field
}

/// div τ on subtriangle `sub` from three values of a linear field, or the mean of it for higher degrees.
fn divergence(field: &StressField, p: [[f64; 2]; 3], sub: usize) -> [f64; 2] {
    // ∫ div τ = ∮ τ n, with Gauss points on the three sides.
    let q = sub_corners(p, sub);
    let mut flux = [0.0; 2];
    for side in 0..3 {
        let (i, j) = ((side + 1) % 3, (side + 2) % 3);
        let (dx, dy) = (q[j][0] - q[i][0], q[j][1] - q[i][1]);
        for x in [-0.774_596_669_241_483_4, 0.0, 0.774_596_669_241_483_4_f64] {
            let w = if x == 0.0 { 8.0 / 18.0 } else { 5.0 / 18.0 };
            let mut bary = [0.0; 3];
            bary[i] = 0.5 * (1.0 - x);
            bary[j] = 0.5 * (1.0 + x);
            let t = field.at(0, sub, bary);
            flux[0] += w * (t[0] * dy - t[2] * dx);
            flux[1] += w * (t[2] * dy - t[1] * dx);
        }
    }
    [flux[0] / area(q), flux[1] / area(q)]
}

fn traction_at(field: &StressField, p: [[f64; 2]; 3], sub: usize, at: f64) -> [f64; 2] {
    let (a, b) = (p[(sub + 1) % 3], p[(sub + 2) % 3]);
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let l = dx.hypot(dy);
    let t = field.at(0, sub, [1.0 - at, at, 0.0]);
    [(t[0] * dy - t[2] * dx) / l, (t[2] * dy - t[1] * dx) / l]
}

fn triangle() -> impl Strategy<Value = [[f64; 2]; 3]> {
    (prop::array::uniform6(-1.0..1.0_f64), -3.0..3.0_f64, 0.0..6.3_f64)
        .prop_filter_map("too flat", |(v, log_scale, angle)| {
            let mut p = [[v[0], v[1]], [v[2], v[3]], [v[4], v[5]]];
            if area(p) < 0.0 {
                p.swap(1, 2);
            }
            let longest =
                (0..3).map(|i| (p[i][0] - p[(i + 1) % 3][0]).hypot(p[i][1] - p[(i + 1) % 3][1])).fold(0.0, f64::max);
            let (c, s, f) = (angle.cos(), angle.sin(), 10.0_f64.powf(log_scale));
            (area(p) > 1e-3 * longest * longest).then(|| p.map(|[x, y]| [f * (c * x - s * y), f * (s * x + c * y)]))
        })
        .boxed()
}

fn material() -> impl Strategy<Value = (Kinematics, f64, f64)> {
    (prop::bool::ANY, -3.0..11.0_f64, -0.9..0.49_f64).prop_map(|(strain, e, nu)| {
        (if strain { Kinematics::PlaneStrain } else { Kinematics::PlaneStress }, 10.0_f64.powf(e), nu)
    })
}

proptest! {
    #[test]
    fn modes_are_energy_orthonormal(p in triangle(), (kin, e, nu) in material(), f in prop::array::uniform2(-1.0..1.0_f64)) {
        for element in ELEMENTS {
            let modes = element.modes(p, &Compliance::new(kin, e, nu), f);
            let n = element.parameters();
            let fields = mode_fields(element, p, &modes);
            let particular = particular_field(element, p, f, &modes);
            let inner = |l: &StressField, m: &StressField| {
                (0..3).map(|s| radon().iter().map(|&(b, w)| w * area(sub_corners(p, s))
                    * product(kin, e, nu, l.at(0, s, b), m.at(0, s, b))).sum::<f64>()).sum::<f64>()
            };
            for i in 0..n {
                for j in 0..n {
                    let expected = if i == j { 1.0 } else { 0.0 };
                    prop_assert!((inner(&fields[i], &fields[j]) - expected).abs() < 1e-8);
                }
                let scale = modes.particular_energy().sqrt().max(1e-300);
                prop_assert!(inner(&fields[i], &particular).abs() < 1e-8 * scale.max(inner(&particular, &particular).sqrt()));
            }
            prop_assert!((inner(&particular, &particular) - modes.particular_energy()).abs() <= 1e-8 * modes.particular_energy());
        }
    }

    #[test]
    fn modes_are_self_equilibrated(p in triangle(), (kin, e, nu) in material(), f in prop::array::uniform2(-1.0..1.0_f64)) {
        for element in ELEMENTS {
            let modes = element.modes(p, &Compliance::new(kin, e, nu), f);
            for field in mode_fields(element, p, &modes) {
                let largest = field.block(0).iter().flatten().fold(0.0_f64, |m, v| m.max(v.abs()));
                for sub in 0..3 {
                    let d = divergence(&field, p, sub);
                    let h = area(p).sqrt();
                    prop_assert!(d[0].hypot(d[1]) * h < 1e-9 * largest, "div {d:?}");
                    // Traction is continuous across 0a_j: seen from both subtriangles.
                    let (i, j) = ((sub + 1) % 3, (sub + 2) % 3);
                    let q = sub_corners(p, sub);
                    let (dx, dy) = (q[2][0] - p[j][0], q[2][1] - p[j][1]);
                    for at in [0.0, 0.3, 1.0] {
                        // Subtriangle `sub` has a_j as its second corner, subtriangle `i` has it as its first.
                        let l = field.at(0, sub, [0.0, 1.0 - at, at]);
                        let m = field.at(0, i, [1.0 - at, 0.0, at]);
                        let jump = [(l[0] - m[0]) * dy - (l[2] - m[2]) * dx, (l[2] - m[2]) * dy - (l[1] - m[1]) * dx];
                        prop_assert!(jump[0].hypot(jump[1]) < 1e-10 * largest * dx.hypot(dy), "jump {jump:?}");
                    }
                }
            }
            let particular = particular_field(element, p, f, &modes);
            for sub in 0..3 {
                let d = divergence(&particular, p, sub);
                prop_assert!((d[0] + f[0]).abs() < 1e-7 && (d[1] + f[1]).abs() < 1e-7, "div {d:?} for {f:?}");
            }
        }
    }

    #[test]
    fn traction_values_belong_to_the_stresses(p in triangle(), (kin, e, nu) in material(), f in prop::array::uniform2(-1.0..1.0_f64)) {
        for element in ELEMENTS {
            let modes = element.modes(p, &Compliance::new(kin, e, nu), f);
            let (n, degree) = (element.parameters(), element.degree());
            let mut fields = mode_fields(element, p, &modes);
            fields.push(particular_field(element, p, f, &modes));
            for (k, field) in fields.iter().enumerate() {
                let largest = field.block(0).iter().flatten().fold(0.0_f64, |m, v| m.max(v.abs()));
                for sub in 0..3 {
                    for node in 0..=degree {
                        let t = traction_at(field, p, sub, node as f64 / degree as f64);
                        for (c, &value) in t.iter().enumerate() {
                            let row = 2 * (sub * (degree + 1) + node) + c;
                            let stored = if k < n { modes.traction()[k * element.tractions() + row] } else { modes.particular_traction()[row] };
                            prop_assert!((value - stored).abs() <= 1e-10 * largest);
                        }
                    }
                }
            }
        }
    }

    /// K annihilates rigid motions and nothing else: rank 6(p+1) − 3 (Theorem 2.1: existence and uniqueness).
    #[test]
    fn stiffness_has_exactly_the_rigid_null_space(p in triangle(), (kin, e, nu) in material()) {
        for element in ELEMENTS {
            let modes = element.modes(p, &Compliance::new(kin, e, nu), [0.0; 2]);
            let (n, rows) = (element.parameters(), element.tractions());
            let t = nalgebra::DMatrix::from_column_slice(rows, n, modes.traction());
            let lengths: Vec<f64> = (0..3).map(|s| {
                let (a, b) = (p[(s + 1) % 3], p[(s + 2) % 3]);
                (b[0] - a[0]).hypot(b[1] - a[1])
            }).collect();
            // Scale traction values to forces so that rows compare.
            let force = nalgebra::DMatrix::from_fn(rows, n, |i, k| t[(i, k)] * lengths[i / (rows / 3)]);
            let s = force.singular_values();
            let (max, min) = (s.max(), s.min());
            prop_assert!(min > 1e-7 * max, "spurious mode: {min} of {max}");
            prop_assert_eq!(n, rows - 3);
            if element.degree() == 1 {
                let h = area(p).sqrt();
                let (gx, gy) = ((p[0][0] + p[1][0] + p[2][0]) / 3.0, (p[0][1] + p[1][1] + p[2][1]) / 3.0);
                for motion in 0..3 {
                    let u = |q: [f64; 2]| match motion { 0 => [1.0, 0.0], 1 => [0.0, 1.0], _ => [-(q[1] - gy) / h, (q[0] - gx) / h] };
                    for k in 0..n {
                        let mut work = 0.0;
                        for side in 0..3 {
                            let (a, b) = (u(p[(side + 1) % 3]), u(p[(side + 2) % 3]));
                            for c in 0..2 {
                                let (ta, tb) = (t[(4 * side + c, k)], t[(4 * side + 2 + c, k)]);
                                work += lengths[side] / 6.0 * (2.0 * ta * a[c] + ta * b[c] + tb * a[c] + 2.0 * tb * b[c]);
                            }
                        }
                        prop_assert!(work.abs() < 1e-11 * max * 10.0);
                    }
                }
            }
        }
    }
}
