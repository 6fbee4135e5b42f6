//! Bodies of revolution: Lamé's tube and sphere, a warm tube, a press fit, a valve in its seat, a turning spindle and disc, Hertz's sphere,
//! Boussinesq's punch, Sneddon's cone.

use std::f64::consts::PI;

use super::half_planes::{compliance, fit};
use super::run::{Report, carries, close, models, sound};
use crate::command::with_reference;

/// The energy lies within the bracket, and that within `relative` of it.
#[track_caller]
fn holds(report: &Report, energy: f64, relative: f64) {
    let [lower, upper] = ["lower", "upper"].map(|bound| report.number(&format!("/energy/{bound}")));
    assert!(lower <= energy && energy <= upper, "{lower} {energy} {upper}");
    close(lower, energy, relative);
    close(upper, energy, relative);
    if with_reference() {
        let model = report.number("/primal/1/energy");
        assert!(energy <= model + 1e-12 * energy.abs());
        close(model, energy, relative);
    }
}

/// Quantity `k` of the report lies in its interval, which is within `relative` of it.
#[track_caller]
fn answers(report: &Report, k: usize, value: f64, relative: f64) {
    let [lower, upper] = ["lower", "upper"].map(|end| report.number(&format!("/quantities/{k}/{end}")));
    assert!(lower <= value && value <= upper, "{lower} {value} {upper}");
    close(lower, value, relative);
    close(upper, value, relative);
}

#[test]
fn tube() {
    let (a, b, nu, pressure): (f64, f64, _, _) = (1.0, 2.0, 0.3, 0.01);
    let k = pressure * a * a / (b * b - a * a);
    let u = |r: f64| (1.0 + nu) * k * ((1.0 - 2.0 * nu) * r + b * b / r);
    let report = sound("tube");
    holds(&report, -PI * pressure * a * u(a), 1e-3);
    answers(&report, 0, u(a), 1e-3);
    answers(&report, 1, u(b), 1e-3);
}

#[test]
fn warm_tube() {
    let (a, b, nu, alpha): (f64, f64, _, _) = (1.0, 2.0, 0.3, 0.01);
    let warm = |r: f64| 1.0 + 2.0 * r;
    let i = |r: f64| 0.5 * (r * r - a * a) + 2.0 / 3.0 * (r.powi(3) - a.powi(3));
    let c = (1.0 + nu) / (1.0 - nu) * alpha * i(b) / (b * b - a * a);
    let u = |r: f64| (1.0 + nu) / (1.0 - nu) * alpha * i(r) / r + c * ((1.0 - 2.0 * nu) * r + a * a / r);
    // σ_r + σ_θ is the same everywhere but for the temperature, and σ_z = ν (σ_r + σ_θ) − αT.
    let both = |r: f64| 2.0 * c / (1.0 + nu) - alpha * warm(r) / (1.0 - nu);
    let density = |r: f64| alpha * warm(r) * ((1.0 + nu) * both(r) - alpha * warm(r)) * r;
    let mut sum = 0.0;
    let steps = 1000;
    for k in 0..steps {
        let [p, q] = [k, k + 1].map(|k| a + (b - a) * f64::from(k) / f64::from(steps));
        sum += (q - p) / 6.0 * (density(p) + 4.0 * density(0.5 * (p + q)) + density(q));
    }
    let report = sound("warm_tube");
    holds(&report, -PI * sum, 1e-3);
    answers(&report, 0, u(a), 1e-3);
    answers(&report, 1, u(b), 1e-3);
}

/// The polygon is smaller than the sphere, by 0.4 % of the energy.
#[test]
fn hollow_sphere() {
    let (a, b, nu, pressure): (f64, f64, _, _) = (1.0, 2.0, 0.3, 0.01);
    let k = pressure * a.powi(3) / (b.powi(3) - a.powi(3));
    let inside = k * ((1.0 - 2.0 * nu) * a + (1.0 + nu) * b.powi(3) / (2.0 * a * a));
    let report = sound("hollow_sphere");
    for bound in ["lower", "upper"] {
        close(report.number(&format!("/energy/{bound}")), -PI * pressure * a * a * inside, 1e-2);
    }
}

#[test]
fn press_fit() {
    let (b, c, length, depth) = (10.0, 20.0, 10.0, 0.01);
    let hub = b * ((c * c + b * b) / (c * c - b * b) + 0.33) / 70e3;
    let shaft = b * (1.0 - 0.3) / 210e3;
    let pressure = depth / (hub + shaft);
    let report = sound("press_fit");
    holds(&report, 0.5 * pressure * depth * 2.0 * PI * b * length, 2e-3);
    for [_, found] in report.profile(0, "dual") {
        close(found, pressure, 0.02);
    }
    answers(&report, 0, pressure * 2.0 * PI * b * length, 2e-3);
    // Around the axis a radial force has no resultant.
    for model in models() {
        for c in 0..2 {
            let force = report.number(&format!("/contact/0/resultant/{model}/{c}"));
            assert!(force.abs() < 1e-9 * pressure * b * length, "{model}: {force}");
        }
    }
}

#[test]
fn spindle() {
    let (b, length, nu, young, load): (f64, _, _, _, _) = (0.1, 0.05, 0.3, 210e9, 8000.0 * 1000.0_f64.powi(2));
    let k = (1.0 + nu) * (1.0 - 2.0 * nu) / (1.0 - nu) * load / (8.0 * young);
    // 𝓛 = −½ ∫ ϱω² r u with u = k ((3 − 2ν) b² r − r³).
    let work = 2.0 * PI * length * load * k * b.powi(6) * ((3.0 - 2.0 * nu) / 4.0 - 1.0 / 6.0);
    let report = sound("spindle");
    holds(&report, -0.5 * work, 2e-2);
    answers(&report, 0, k * (2.0 - 2.0 * nu) * b.powi(3), 1e-3);
}

/// Radius of contact and peak pressure within half a per cent of Hertz's theory.
#[test]
fn hertz_sphere() {
    let report = sound("hertz_sphere");
    let (radius, modulus) = (1.0_f64, 1.0 / compliance(1.0, 0.3));
    let force = 4.0 / 3.0 * modulus * radius.powi(3) / 50.0;
    carries(&report, 0, [0.0, force]);
    let peak = 1.5 * force / (PI * radius * radius);
    let mut profiles = vec!["dual"];
    if with_reference() {
        profiles.push("FEniCSx P2 reactions");
    }
    for model in profiles {
        let (fitted_radius, fitted_peak) = fit(&report.profile(0, model));
        println!("{model}: radius {fitted_radius} for {radius}, peak {fitted_peak} for {peak}");
        close(fitted_radius, radius, 0.005);
        close(fitted_peak, peak, 0.005);
    }
}

/// Means over the thickness are those of plane stress.
#[test]
fn flywheel() {
    let ([a, b], half, nu, young, load): ([f64; 2], _, _, _, _) =
        ([0.05, 0.2], 0.005, 0.3, 210e9, 8000.0 * 500.0_f64.powi(2));
    let q = (3.0 + nu) / 8.0 * load;
    let [inner, outer] = [a * a, b * b];
    let u = |r: f64| {
        let [even, odd] = [inner + outer, inner * outer / (r * r)];
        let hoop = even + odd - (1.0 + 3.0 * nu) / (3.0 + nu) * r * r;
        q * r / young * (hoop - nu * (even - odd - r * r))
    };
    let steps = 2000;
    let at = |i: i32| a + (b - a) * (f64::from(i) + 0.5) / f64::from(steps);
    let work: f64 =
        (0..steps).map(at).map(|r| 2.0 * PI * half * load * r * r * u(r)).sum::<f64>() * (b - a) / f64::from(steps);
    let report = sound("flywheel");
    holds(&report, -0.5 * work, 5e-3);
    answers(&report, 0, u(a), 3e-3);
    answers(&report, 1, u(b), 1e-3);
}

/// The force of a pressure, linear between points, within the radius `end`.
fn force_within(points: &[[f64; 2]], end: f64) -> f64 {
    let part = |w: &[[f64; 2]]| {
        let ([a, p], [b, q]) = (w[0], w[1]);
        let c = b.min(end);
        if c <= a {
            return 0.0;
        }
        let at = |r: f64| r * (p + (q - p) * (r - a) / (b - a));
        // Simpson's rule is exact.
        2.0 * PI * (c - a) / 6.0 * (at(a) + 4.0 * at(0.5 * (a + c)) + at(c))
    };
    points.windows(2).map(part).sum()
}

/// The pressures of both models.
fn pressures(report: &Report) -> Vec<Vec<[f64; 2]>> {
    let of_models = with_reference().then_some("FEniCSx P2 reactions");
    std::iter::once("dual").chain(of_models).map(|model| report.profile(0, model)).collect()
}

/// Within the radius r of a flat punch of radius one acts F (1 − √(1 − r²)).
#[test]
fn boussinesq() {
    let report = sound("boussinesq");
    let force = 0.05 * PI * 400.0;
    carries(&report, 0, [0.0, -force]);
    for points in pressures(&report) {
        for r in [0.25, 0.5, 0.75, 0.9_f64] {
            close(force_within(&points, r), force * (1.0 - (1.0 - r * r).sqrt()), 5e-3);
        }
        // Infinite at the rim: the finite value there only shows that the mesh is fine.
        assert!(points.last().expect("points")[1] > 20.0 * points[0][1]);
    }
}

/// p = ½ E* tan β arcosh(1/r): within the radius r acts ½ π E* tan β (r² arcosh(1/r) + 1 − √(1 − r²)).
#[test]
fn cone() {
    let report = sound("cone");
    let force = 0.5 * PI * 0.02 / compliance(1.0, 0.3);
    carries(&report, 0, [0.0, force]);
    for points in pressures(&report) {
        for r in [0.25, 0.5, 0.75, 0.95_f64] {
            close(force_within(&points, r), force * (r * r * (1.0 / r).acosh() + 1.0 - (1.0 - r * r).sqrt()), 1e-2);
        }
        let last = points.iter().filter(|p| p[1] > 1e-3 * force).fold(0.0_f64, |m, p| m.max(p[0]));
        assert!((last - 1.0).abs() <= 0.05, "pressure up to {last}");
    }
}

/// The seat carries N = P/(sin α + μ cos α) across its face and μ N along it, by stresses, by displacements with the same bound of friction,
/// and by displacements with limits of their own.
#[test]
fn valve() {
    let report = sound("valve");
    let (sin, cos) = 20.0_f64.to_radians().sin_cos();
    let load = 0.01 * PI * 0.6639702342662023_f64.powi(2);
    let normal = load / (sin + 0.2 * cos);
    carries(&report, 0, [0.0, load]);
    // The bound misses of μ times the pressure what a linear function times r does.
    close(report.number("/contact/0/friction/force"), 0.2 * normal, 5e-3);
    answers(&report, 0, normal, 2e-2);
    assert_eq!(report.number("/contact/0/friction/slip_fraction"), 1.0);
    assert_eq!(report.0["coulomb"]["wedging"].as_array().map_or(0, Vec::len), 0);
    if with_reference() {
        for degree in [1, 2] {
            let name = format!("coulomb/FEniCSx P{degree}/friction-force");
            let own = report.0["remarks"].as_array().into_iter().flatten().find(|check| check["name"] == name.as_str());
            let force = own.and_then(|check| check["reference"].as_f64()).unwrap_or(f64::NAN);
            close(force, 0.2 * normal, 1e-8);
        }
    }
}
