//! Bodies of revolution: Lamé's tube and sphere, a warm tube, a press fit, a turning spindle, Hertz's sphere.

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
