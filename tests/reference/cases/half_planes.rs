//! Contacts small against the bodies, held against the formulas for half-planes. Half of each is modelled, its axis of
//! symmetry on a roller.

use super::run::{Report, carries, case, close, sound, with_reference};

/// Radius in the gap x²/(2R) of both Hertz scenes.
const RADIUS: f64 = 50.0;
/// Distance of vertices on the contact.
const EDGE: f64 = 0.05;

/// Plane-strain compliance (1 − ν²)/E.
pub fn compliance(young: f64, nu: f64) -> f64 {
    (1.0 - nu * nu) / young
}

/// Half-width and peak pressure of Hertz's theory under a force `force` per thickness, for curves of radius `radius`.
pub fn hertz(force: f64, modulus: f64, radius: f64) -> (f64, f64) {
    let width = (4.0 * force * radius / (std::f64::consts::PI * modulus)).sqrt();
    let peak = (force * modulus / (std::f64::consts::PI * radius)).sqrt();
    (width, peak)
}

/// p² of Hertz's pressure is linear in x²: the line through the points with at least a third of the largest pressure
/// gives peak and half-width without looking at single values, at the end of contact least of all.
pub fn fit(points: &[[f64; 2]]) -> (f64, f64) {
    let largest = points.iter().fold(0.0_f64, |m, p| m.max(p[1]));
    let used: Vec<[f64; 2]> =
        points.iter().filter(|p| p[1] > largest / 3.0).map(|p| [p[0] * p[0], p[1] * p[1]]).collect();
    let count = used.len() as f64;
    let mean = [0, 1].map(|c| used.iter().map(|p| p[c]).sum::<f64>() / count);
    let moment = |c: usize| used.iter().map(|p| (p[0] - mean[0]) * (p[c] - mean[c])).sum::<f64>();
    let slope = moment(1) / moment(0);
    let at_axis = mean[1] - slope * mean[0];
    (((-at_axis / slope).sqrt()), at_axis.sqrt())
}

#[track_caller]
fn is_hertz(report: &Report, half_force: f64, modulus: f64) {
    let (width, peak) = hertz(2.0 * half_force, modulus, RADIUS);
    let mut profiles = vec!["dual"];
    if with_reference() {
        profiles.push("FEniCSx P2 reactions");
    }
    for model in profiles {
        let points = report.profile(0, model);
        let mut inside: Vec<f64> = points.iter().map(|p| p[0]).filter(|x| *x < width).collect();
        inside.dedup();
        assert!(inside.len() > 10, "{} points across the half-width", inside.len());
        let (fitted_width, fitted_peak) = fit(&points);
        println!("{model}: half-width {fitted_width} for {width}, peak {fitted_peak} for {peak}");
        close(fitted_width, width, 0.02);
        close(fitted_peak, peak, 0.02);
        let largest = points.iter().fold(0.0_f64, |m, p| m.max(p[1]));
        close(largest, peak, 0.02);
        let last = points.iter().filter(|p| p[1] > 1e-6 * peak).fold(0.0_f64, |m, p| m.max(p[0]));
        assert!((last - width).abs() <= EDGE, "{model}: pressure up to {last}, half-width {width}");
    }
}

#[test]
fn hertz_rigid() {
    let report = sound("hertz_rigid");
    carries(&report, 0, [0.0, 3e-4 * 30.0]);
    is_hertz(&report, 3e-4 * 30.0, 1.0 / compliance(1.0, 0.3));
}

#[test]
fn hertz_elastic() {
    let report = sound("hertz_elastic");
    carries(&report, 0, [0.0, 2.3e-4 * 30.0]);
    is_hertz(&report, 2.3e-4 * 30.0, 1.0 / (compliance(1.0, 0.3) + compliance(3.0, 0.45)));
}

/// e of 1/E* = ½ Σ e_i for a half-plane of an orthotropic body in plane strain, axis 1 along the surface or across it.
fn orthotropic([e1, e2, e3]: [f64; 3], [nu12, nu13, nu23]: [f64; 3], shear: f64, across: bool) -> f64 {
    let along = [1.0 / e1 - nu13 * nu13 * e3 / (e1 * e1), 1.0 / e2 - nu23 * nu23 * e3 / (e2 * e2)];
    let mixed = -nu12 / e1 - nu13 / e1 * nu23 / e2 * e3;
    let [first, second] = if across { [along[1], along[0]] } else { along };
    (first * second).sqrt() * ((2.0 * mixed + 1.0 / shear) / first + 2.0 * (second / first).sqrt()).sqrt()
}

#[test]
fn hertz_orthotropic() {
    let report = sound("hertz_orthotropic");
    let half_force = 2.27e-4 * 30.0;
    carries(&report, 0, [0.0, half_force]);
    let isotropic = orthotropic([2.0; 3], [0.3; 3], 1.0 / 1.3, false);
    close(isotropic, 2.0 * compliance(2.0, 0.3), 1e-14);
    let upper = orthotropic([2.0, 0.8, 1.0], [0.3, 0.25, 0.2], 0.5, false);
    let lower = orthotropic([6.0, 2.0, 3.0], [0.3, 0.2, 0.25], 1.2, true);
    is_hertz(&report, half_force, 2.0 / (upper + lower));
}

/// A parabola given by its values at the vertices, so that the bounds hold for exactly this gap.
#[test]
fn gap_tables_are_parabolas_on_the_vertices() {
    for name in ["hertz_rigid", "hertz_elastic", "hertz_orthotropic"] {
        let text = std::fs::read_to_string(case(name)).expect("readable");
        let scene: toml::Table = text.parse().expect("TOML");
        let rows = scene["contacts"][0]["gap"].as_array().expect("a table");
        for (k, row) in rows.iter().take(41).enumerate() {
            let [s, g] = [0, 1].map(|c| row[c].as_float().expect("a number"));
            assert!((s - EDGE * k as f64).abs() < 1e-12 && (g - s * s / (2.0 * RADIUS)).abs() < 1e-15, "{row}");
        }
    }
}

/// p = F / (π √(a² − x²)) with a = 1: the force within x is 2F/π · asin x.
#[test]
fn punch() {
    let report = sound("punch");
    let half_force = 0.05 * 20.0;
    carries(&report, 0, [0.0, -half_force]);
    let mut profiles = vec!["dual"];
    if with_reference() {
        profiles.push("FEniCSx P2 reactions");
    }
    for model in profiles {
        let points = report.profile(0, model);
        for x in [0.25, 0.5, 0.75, 0.9] {
            close(within(&points, x), half_force * 2.0 / std::f64::consts::PI * x.asin(), 0.02);
        }
        close(points[0][1], 2.0 * half_force / std::f64::consts::PI, 0.02);
        // Infinite at the corner: the finite value there only shows that the mesh is fine.
        assert!(points.last().expect("points")[1] > 20.0 * points[0][1]);
    }
}

/// ∫ p from 0 to x of a piecewise linear p.
fn within(points: &[[f64; 2]], x: f64) -> f64 {
    let part = |w: &[[f64; 2]]| {
        let ([a, p], [b, q]) = (w[0], w[1]);
        let end = b.min(x);
        if end <= a {
            return 0.0;
        }
        let at_end = p + (q - p) * (end - a) / (b - a);
        0.5 * (end - a) * (p + at_end)
    };
    points.windows(2).map(part).sum()
}
