//! Contact along curves, against the formulas for the curves themselves: what a polygon leaves of them falls like h².

use std::f64::consts::PI;

use super::half_planes::{compliance, fit, hertz};
use super::run::{Report, carries, close, models, sound, with_reference};
use crate::lame::Rings;

#[test]
fn ring() {
    let report = sound("ring");
    let exact = Rings { radii: [1.0, 1.5, 2.0], young: [2.0, 1.0], poisson: 0.3, inside: 0.02, depth: 0.01 };
    for bound in ["lower", "upper"] {
        close(report.number(&format!("/energy/{bound}")), exact.energy(), 1e-3);
    }
    // The pressure on the quarter pushes the inner ring back along both axes.
    for model in models() {
        for c in 0..2 {
            let force = report.number(&format!("/contact/0/resultant/{model}/{c}"));
            close(force, -exact.pressure() * 1.5, 5e-4);
        }
    }
    // One number on each facet, which shows how the triangles lie.
    let points = report.profile(0, "dual");
    assert_eq!(points.len(), 2 * 48);
    for [_, pressure] in points {
        close(pressure, exact.pressure(), 1e-2);
    }
    if with_reference() {
        close(report.number("/primal/1/energy"), exact.energy(), 1e-3);
    }
    assert!(report.notes().contains("48 edges stand for a curve"), "{}", report.notes());
}

/// The error of the polygon against the disc falls like h²: formulas are met within 0.1 %.
#[test]
fn rotor() {
    let report = sound("rotor");
    let (a, b, nu, young, load, thickness) = (0.1_f64, 0.3_f64, 0.3, 210e9, 8000.0 * 500.0_f64.powi(2), 0.02);
    let s = (3.0 + nu) / 8.0 * load;
    let radial = |r: f64| s * (a * a + b * b - (a * b / r).powi(2) - r * r);
    let hoop = |r: f64| s * (a * a + b * b + (a * b / r).powi(2) - (1.0 + 3.0 * nu) / (3.0 + nu) * r * r);
    let u = |r: f64| r * (hoop(r) - nu * radial(r)) / young;
    // 𝓛 = −½ ∫ ϱω² r u over the quarter, by the midpoint rule.
    let n = 10_000;
    let step = (b - a) / f64::from(n);
    let rings: f64 = (0..n).map(|k| a + (f64::from(k) + 0.5) * step).map(|r| r * r * u(r) * step).sum();
    let energy = -0.25 * PI * load * thickness * rings;
    for bound in ["lower", "upper"] {
        close(report.number(&format!("/energy/{bound}")), energy, 1e-3);
    }
    let carried = -load * thickness * (b.powi(3) - a.powi(3)) / 3.0;
    let expected = [carried, u(b) * 2.0 / PI, u(a) * 2.0 / PI];
    for (quantity, expected) in expected.into_iter().enumerate() {
        for end in ["lower", "upper"] {
            close(report.number(&format!("/quantities/{quantity}/{end}")), expected, 1.5e-3);
        }
    }
    assert_eq!(report.0["quantities"][0]["exact_by_statics"], true);
    if with_reference() {
        close(report.number("/primal/1/energy"), energy, 1e-3);
    }
}

/// Half-width and peak pressure within 1 % of Hertz's theory, on half a model.
#[track_caller]
fn is_hertz(report: &Report, half_force: f64, modulus: f64, radius: f64) {
    let (width, peak) = hertz(2.0 * half_force, modulus, radius);
    carries(report, 0, [0.0, half_force]);
    let mut profiles = vec!["dual"];
    if with_reference() {
        profiles.push("FEniCSx P2 reactions");
    }
    for model in profiles {
        let points = report.profile(0, model);
        let (fitted_width, fitted_peak) = fit(&points);
        println!("{model}: half-width {fitted_width} for {width}, peak {fitted_peak} for {peak}");
        close(fitted_width, width, 0.01);
        close(fitted_peak, peak, 0.01);
    }
    let points = report.profile(0, "dual");
    let largest = points.iter().fold(0.0_f64, |m, p| m.max(p[1]));
    let last = points.iter().filter(|p| p[1] > 1e-6 * peak).fold(0.0_f64, |m, p| m.max(p[0]));
    close(largest, peak, 0.01);
    close(last, width, 0.01);
}

#[test]
fn cylinder_on_block() {
    let report = sound("cylinder_on_block");
    is_hertz(&report, 8.63e-5 * 50.0, 1.0 / (2.0 * compliance(1.0, 0.3)), 50.0);
    assert!(report.notes().contains("along its direction, 31 vertices of 'round'"), "{}", report.notes());
}

#[test]
fn two_cylinders() {
    let modulus = 1.0 / (compliance(1.0, 0.3) + compliance(2.0, 0.2));
    is_hertz(&sound("two_cylinders"), 2.7e-4 * 50.0, modulus, 1.0 / (1.0 / 50.0 + 1.0 / 30.0));
}

/// Persson's pressure at the angle φ, in units of force over radius, where equal bodies touch up to 2 arctan b on either
/// side; y = tan φ/2.
fn persson(b: f64, phi: f64) -> f64 {
    let y = (0.5 * phi).tan();
    let (root, side) = ((b * b - y * y).max(0.0).sqrt(), (1.0 + b * b).sqrt());
    let first = 2.0 * root / (PI * side * (1.0 + y * y));
    first + ((side + root) / (side - root)).ln() / (2.0 * PI * b * b * (1.0 + b * b))
}

/// E* ΔR/Q of the same bodies.
fn clearance(b: f64) -> f64 {
    let bb = b * b;
    2.0 * (1.0 - bb) / (PI * bb) - bb.ln_1p() / (PI * bb * (1.0 + bb))
}

/// The formulas hold each other: the pressures carry the force, and they open the gap between disc and plate by ΔR but for
/// a rigid motion. Pressures cos nφ open it by 4n/(n² − 1) cos nφ, constant ones by 2, in units of 1/E*; 1 + d²/dφ² takes
/// the rigid motion out.
#[test]
fn formulas_for_the_pin_hold_each_other() {
    for b in [0.3, (PI / 6.0).tan(), 0.8] {
        let (reach, count) = (2.0 * f64::atan(b), 6_000);
        let nodes: Vec<[f64; 2]> = (0..count)
            .map(|i| PI * ((i as f64 + 0.5) / count as f64 - 0.5))
            .map(|t| [reach * t.sin(), reach * t.cos() * PI / count as f64])
            .collect();
        let pressures: Vec<f64> = nodes.iter().map(|[phi, _]| persson(b, *phi)).collect();
        let moment = |n: usize| -> f64 {
            nodes.iter().zip(&pressures).map(|([phi, w], p)| w * p * (n as f64 * phi).cos()).sum::<f64>() / PI
        };
        close(moment(1) * PI, 1.0, 1e-8);
        // Fejér's means: the coefficients fall like n^(−3/2).
        let terms = 2000;
        let sums = (2..terms).map(|n| (1.0 - n as f64 / terms as f64) * 4.0 * n as f64 * moment(n));
        close(sums.sum::<f64>() - moment(0), clearance(b), 2e-3);
    }
}

#[test]
fn pin() {
    let report = sound("pin");
    let b = (PI / 6.0).tan();
    let force = 0.01 / compliance(1.0, 0.3) / clearance(b);
    for model in models() {
        close(report.number(&format!("/contact/0/resultant/{model}/1")), 0.5 * force, 1e-9);
    }
    let facet = 2.0 * (PI / 240.0).sin();
    let angle = |arc: f64| arc / facet * PI / 120.0;
    let peak = force * persson(b, 0.0);
    let mut profiles = vec!["dual"];
    if with_reference() {
        profiles.push("FEniCSx P1 reactions");
    }
    for model in profiles {
        let points = report.profile(0, model);
        close(points.iter().fold(0.0_f64, |m, p| m.max(p[1])), peak, 0.02);
        let last = points.iter().filter(|p| p[1] > 1e-6 * peak).fold(0.0_f64, |m, p| m.max(angle(p[0])));
        println!("{model}: contact up to {}°", last.to_degrees());
        close(last, PI / 3.0, 0.02);
    }
    // One number on each facet: the mean of Persson's.
    for ends in report.profile(0, "dual").chunks(2) {
        let [from, to] = [ends[0], ends[1]].map(|p| angle(p[0]));
        let inside = (0..50).map(|i| from + (to - from) * (i as f64 + 0.5) / 50.0).filter(|phi| *phi < PI / 3.0);
        let exact = force * inside.map(|phi| persson(b, phi)).sum::<f64>() / 50.0;
        assert!((ends[0][1] - exact).abs() < 0.02 * peak, "{} for {exact} from {from}", ends[0][1]);
    }
}
