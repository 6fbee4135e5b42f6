//! The closed forms of Section 3, (3.1), (3.2) and (3.4), against quadrature and point evaluation.

use crate::support::theory::quadrature;
use hypercircle::element::subtriangle::{Moments, flexibility, shift, side_map, stress_map};
use nalgebra::SVector;
use proptest::prelude::*;

type Parameters = SVector<f64, 7>;

/// The field (3.1) with A = 1, E = E_0, written out.
fn stress(s: &Parameters, [x, y]: [f64; 2]) -> [f64; 3] {
    [s[0] + s[4] * x + s[6] * y, s[1] + s[3] * x + s[5] * y, s[2] - s[5] * x - s[4] * y]
}

/// Counter-clockwise triangles of any size up to an aspect ratio of about a thousand.
fn triangle() -> impl Strategy<Value = [[f64; 2]; 3]> {
    (prop::array::uniform6(-1.0..1.0_f64), -2.0..2.0_f64).prop_filter_map("too flat", |(v, size)| {
        let scale = 10.0_f64.powf(size);
        let mut p = [[v[0], v[1]], [v[2], v[3]], [v[4], v[5]]].map(|q| q.map(|x| x * scale));
        if quadrature::area(p) < 0.0 {
            p.swap(0, 1);
        }
        (quadrature::area(p) > 1e-3 * scale * scale).then_some(p)
    })
}

fn parameters() -> impl Strategy<Value = Parameters> {
    prop::array::uniform7(-1.0..1.0_f64).prop_map(|v| Parameters::from_column_slice(&v))
}

proptest! {
    #[test]
    fn the_fields_balance_themselves(s in parameters(), p in prop::array::uniform2(-5.0..5.0_f64)) {
        let d = 0.5;
        let at = |dx: f64, dy: f64| stress(&s, [p[0] + dx, p[1] + dy]);
        // Differences of linear functions are exact.
        let (x, y) = ([at(d, 0.0), at(-d, 0.0)], [at(0.0, d), at(0.0, -d)]);
        prop_assert!((x[0][0] - x[1][0] + y[0][2] - y[1][2]).abs() < 1e-13);
        prop_assert!((x[0][2] - x[1][2] + y[0][1] - y[1][1]).abs() < 1e-13);
        let mapped = stress_map(p) * s;
        for (c, value) in stress(&s, p).into_iter().enumerate() {
            prop_assert!((mapped[c] - value).abs() < 1e-13 * 12.0);
        }
    }

    #[test]
    fn flexibility_is_the_integral_it_stands_for(
        p in triangle(), s in parameters(), t in parameters(), nu in -0.9..0.49_f64, strain in prop::bool::ANY,
    ) {
        let (alpha, beta) = if strain { (1.0 - nu * nu, -nu * (1.0 + nu)) } else { (1.0, -nu) };
        let gamma = 2.0 * (1.0 + nu);
        let moments = Moments::new(p);
        // Parameters about the centre of gravity, as (3.2) wants them.
        let centre = [0, 1].map(|c| (p[0][c] + p[1][c] + p[2][c]) / 3.0);
        let (mut expected, mut size) = (0.0, 0.0);
        for (bary, w) in quadrature::triangle(4) {
            let x = quadrature::point(p, bary);
            let at = [x[0] - centre[0], x[1] - centre[1]];
            let (l, m) = (stress(&s, at), stress(&t, at));
            let density = alpha * (l[0] * m[0] + l[1] * m[1]) + beta * (l[0] * m[1] + l[1] * m[0]) + gamma * l[2] * m[2];
            expected += w * quadrature::area(p) * density;
            size += w * quadrature::area(p) * (l.map(f64::abs).iter().sum::<f64>() * m.map(f64::abs).iter().sum::<f64>());
        }
        let f = flexibility(&moments, [alpha, beta, gamma]);
        prop_assert!(((s.transpose() * f * t)[0] - expected).abs() < 1e-11 * 4.0 * size);
    }

    #[test]
    fn shifted_parameters_describe_the_same_field(
        s in parameters(), origin in prop::array::uniform2(-3.0..3.0_f64), p in prop::array::uniform2(-3.0..3.0_f64),
    ) {
        let own = shift(origin) * s;
        let (about, direct) = (stress(&own, [p[0] - origin[0], p[1] - origin[1]]), stress(&s, p));
        for c in 0..3 {
            prop_assert!((about[c] - direct[c]).abs() < 1e-12);
        }
    }

    #[test]
    fn side_parameters_are_the_traction(p in triangle(), s in parameters()) {
        for side in 0..3 {
            let (a, b) = (p[(side + 1) % 3], p[(side + 2) % 3]);
            let length = (b[0] - a[0]).hypot(b[1] - a[1]);
            let n = [(b[1] - a[1]) / length, (a[0] - b[0]) / length];
            let star = side_map(a, b) * s;
            for at in [-1.0, -0.3, 0.6, 1.0] {
                let x = [0, 1].map(|c| 0.5 * ((1.0 - at) * a[c] + (1.0 + at) * b[c]));
                let tau = stress(&s, x);
                let size = 4.0 * (1.0 + a[0].abs() + a[1].abs() + b[0].abs() + b[1].abs());
                let t = [tau[0] * n[0] + tau[2] * n[1], tau[2] * n[0] + tau[1] * n[1]];
                prop_assert!((star[0] + star[1] * at - t[0]).abs() < 1e-12 * size);
                prop_assert!((star[2] + star[3] * at - t[1]).abs() < 1e-12 * size);
            }
        }
    }
}

/// The paper prints −2(X2 − X3)(Y2 − Y3) in row 2, column 5 of C. With S5 alone, τ11 = x1 and τ12 = −x2: on the side
/// from (0, 0) to (1, 1) with n = (1, −1)/√2 the traction T1 is √2 x1, so S2* = 1/√2; the printed sign gives −1/√2.
#[test]
fn the_printed_sign_in_row_two_column_five_is_wrong() {
    let c = side_map([0.0, 0.0], [1.0, 1.0]);
    let half_root = 0.5_f64.sqrt();
    assert!((c[(1, 4)] - half_root).abs() < 1e-15);
    let printed = -2.0 * (0.0 - 1.0) * (0.0 - 1.0) / (2.0 * 2.0_f64.sqrt());
    assert!((printed + half_root).abs() < 1e-15);
}
