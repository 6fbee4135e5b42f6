//! Cases that handbooks have formulas for, of beams and of strips that are infinite: met within 0.1 %.

use std::f64::consts::PI;

use super::run::{Run, case, close, sound, with_reference};

/// A beam on Winkler's foundation: Hetényi's formula for a force on a free end.
#[test]
fn winkler_beam() {
    let report = sound("winkler_beam");
    let (beta, lambda): (f64, f64) = (1.0 / 32.0, 2.5);
    let (sinh, cosh) = (lambda.sinh(), lambda.cosh());
    let (sin, cos) = lambda.sin_cos();
    let settled = 2.0 * beta * (sinh * cosh - sin * cos) / (sinh * sinh - sin * sin);
    for end in ["lower", "value", "upper"] {
        close(report.number(&format!("/quantities/0/{end}")), settled, 1e-3);
    }
    // 𝓛 = −½ Fw.
    for bound in ["lower", "upper"] {
        close(report.number(&format!("/energy/{bound}")), -0.5 * settled, 1e-3);
    }
    close(report.number("/quantities/1/value"), 1.0, 1e-9);
    if with_reference() {
        close(report.number("/primal/1/energy"), -0.5 * settled, 1e-3);
    }
}

/// A crack that opens: the energy that Tada's formula for K_I sets free while it grows.
#[test]
fn open_crack() {
    let report = sound("open_crack");
    let (plane, half) = (1.0 - 0.3 * 0.3, 0.5);
    let released = |a: f64| PI * a * (1.0 - 0.025 * a * a + 0.06 * a.powi(4)).powi(2) / (PI * a / 2.0).cos();
    let n = 10_000;
    let step = half / f64::from(n);
    let crack: f64 = (0..n).map(|k| released((f64::from(k) + 0.5) * step) * step).sum();
    let energy = -plane * (0.5 * 6.0 + crack);
    assert!(report.number("/energy/lower") < energy && energy < report.number("/energy/upper"), "{energy}");
    assert_eq!(report.0["contact"][0]["open_fraction"], 1.0);
    let finer = Run::new("solve", &case("open_crack"), &["--tolerance", "0.02"]).report();
    for bound in ["lower", "upper"] {
        close(finer.number(&format!("/energy/{bound}")), energy, 1e-3);
    }
}
