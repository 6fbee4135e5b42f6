//! The contact solutions that rates are measured against are what they claim to be.

use crate::support::theory::contact::Solution;
use crate::support::theory::meshes::Family;
use crate::support::theory::quadrature::{gauss, visit};
use crate::support::theory::rates::solutions;

const STEP: f64 = 1e-5;

fn points() -> Vec<(usize, [f64; 2])> {
    let places = [[0.13, 0.21], [0.4, 0.55], [0.71, 0.83], [0.05, 0.39], [0.9, 0.1]];
    places.into_iter().flat_map(|[x, y]| [(0, [-x, y]), (1, [x, y])]).collect()
}

/// Differences of the displacement, through Hooke's law in Lamé's form, are the stress; the stress has no divergence.
#[test]
fn displacement_and_stress_belong_together() {
    for (name, solution, _) in solutions() {
        for (body, p) in points() {
            let (e, nu) = solution.materials()[body];
            let (mu, lambda) = (e / (2.0 * (1.0 + nu)), e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)));
            let moved = |d: [f64; 2]| [p[0] + d[0], p[1] + d[1]];
            let slope = |f: &dyn Fn([f64; 2]) -> f64, axis: usize| {
                let mut d = [0.0; 2];
                d[axis] = STEP;
                (f(moved(d)) - f(moved(d.map(|v| -v)))) / (2.0 * STEP)
            };
            let u = |c: usize| move |x: [f64; 2]| solution.displacement(body, x)[c];
            let tau = |c: usize| move |x: [f64; 2]| solution.stress(body, x)[c];
            let e = [slope(&u(0), 0), slope(&u(1), 1), 0.5 * (slope(&u(0), 1) + slope(&u(1), 0))];
            let expected =
                [lambda * (e[0] + e[1]) + 2.0 * mu * e[0], lambda * (e[0] + e[1]) + 2.0 * mu * e[1], 2.0 * mu * e[2]];
            let stress = solution.stress(body, p);
            let size = 1.0 + stress.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
            for c in 0..3 {
                assert!((stress[c] - expected[c]).abs() < 1e-6 * size, "{name} at {p:?}: {stress:?}, {expected:?}");
            }
            for (a, b) in [((0, 0), (2, 1)), ((2, 0), (1, 1))] {
                let divergence = slope(&tau(a.0), a.1) + slope(&tau(b.0), b.1);
                assert!(divergence.abs() < 1e-5 * size, "{name} at {p:?}: div {divergence:e}");
            }
        }
    }
}

/// On Γ_K: T_t = 0, T_n' = T_n'' ≤ 0, v_n' + v_n'' ≤ 0, and one of the two vanishes. On Γ_0: u2 = 0, T_t = 0.
#[test]
fn supports_and_contact_are_met() {
    for (name, solution, _) in solutions() {
        let (mut closed, mut open) = (0, 0);
        for k in 0..100 {
            let y = (f64::from(k) + 0.5) / 100.0;
            let [left, right] = [0, 1].map(|b| solution.stress(b, [0.0, y]));
            let [u, v] = [0, 1].map(|b| solution.displacement(b, [0.0, y])[0]);
            let size = 1e-12 * 50.0;
            assert!(left[2].abs() < size && right[2].abs() < size, "{name}: shear at y = {y}");
            assert!((left[0] - right[0]).abs() < size && left[0] < size, "{name}: {} at y = {y}", left[0]);
            assert!(u - v < size, "{name}: penetration {} at y = {y}", u - v);
            assert!((left[0] * (u - v)).abs() < size, "{name}: pressure across a gap at y = {y}");
            closed += usize::from(left[0] < -1e-6);
            open += usize::from(u - v < -1e-9);
            let x = -y;
            assert!(solution.displacement(0, [x, 0.0])[1].abs() < size, "{name}: lifted off the roller");
            assert!(solution.stress(0, [x, 0.0])[2].abs() < size, "{name}: shear on the roller");
            match solution {
                Solution::Pressed(_) => {
                    assert!(solution.displacement(1, [1.0, y]).iter().all(|c| c.abs() < size), "{name}: clamp");
                }
                Solution::LiftOff(_) => assert!(solution.displacement(1, [-x, 0.0])[1].abs() < size, "{name}: roller"),
            }
        }
        assert!(closed > 40, "{name}: closed at {closed}");
        assert_eq!(open > 10, matches!(solution, Solution::LiftOff(_)), "{name}: open at {open}");
    }
}

/// Clapeyron: the work of the boundary tractions is twice the strain energy, so 𝓛(u) = −𝒮(τ(u)) (1.15).
#[test]
fn potential_and_complementary_energy_agree() {
    for (name, solution, smooth) in solutions() {
        let mesh = solution.problem(8, Family::Squares).mesh;
        let corners: Vec<_> = (0..mesh.triangles.len()).map(|t| mesh.corners(t)).collect();
        let mut twice_energy = 0.0;
        visit(&corners, 7, |t, _, _, x, w| {
            let body = mesh.body[t];
            twice_energy += w * solution.energy_density(body, solution.stress(body, x));
        });
        let mut work = 0.0;
        for body in 0..2 {
            let [west, east] = [body as f64 - 1.0, body as f64];
            for (s, w) in gauss(60) {
                let x = west + s;
                let sides = [
                    ([x, 0.0], [0.0, -1.0]),
                    ([x, 1.0], [0.0, 1.0]),
                    ([west, s], [-1.0, 0.0]),
                    ([east, s], [1.0, 0.0]),
                ];
                for (p, n) in sides {
                    let (tau, u) = (solution.stress(body, p), solution.displacement(body, p));
                    let t = [tau[0] * n[0] + tau[2] * n[1], tau[2] * n[0] + tau[1] * n[1]];
                    work += w * (t[0] * u[0] + t[1] * u[1]);
                }
            }
        }
        // The square-root solution is not smooth enough for the rules to be exact.
        let tolerance = if smooth { 1e-8 } else { 1e-4 };
        assert!((work - twice_energy).abs() < tolerance * work, "{name}: {work} and {twice_energy}");
    }
}
