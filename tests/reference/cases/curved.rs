//! Contact along curves, against the formulas for the curves themselves: what a polygon leaves of them falls like h².

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
