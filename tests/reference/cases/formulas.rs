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

/// A strip that friction holds: the bar in which the force falls by the bound per length.
#[test]
fn pulled_strip() {
    let report = sound("pulled_strip");
    let (force, bound, height, young) = (0.3 * 0.02, 0.02, 0.02, 1.0);
    let moved = force * force / (2.0 * bound * young * height) + bound * height / (3.0 * 0.5 * young);
    close(report.number("/quantities/0/value"), moved, 0.01);
    let [low, high] = ["lower", "upper"].map(|end| report.number(&format!("/quantities/0/{end}")));
    assert!(low <= moved && moved <= high, "{low} {moved} {high}");
    for end in ["lower", "upper"] {
        close(report.number(&format!("/energy/{end}")), -force.powi(3) / (6.0 * bound * young * height), 0.015);
    }
    close(report.number("/contact/0/friction/force"), -force, 1e-9);
    // Over the height of the strip slip passes into stick, somewhere on an edge.
    let slip = 0.5 * report.number("/contact/0/friction/slip_fraction");
    assert!((slip - force / bound).abs() < height + 0.01, "{slip}");
}

/// Friction with a given bound between sheared half-planes: the traction in the middle, and where it slides.
#[test]
fn sheared_contact() {
    let report = Run::new("solve", &case("sheared_contact"), &["--tolerance", "0.02"]).report();
    close(report.number("/contact/0/friction/force"), -0.016, 1e-9);
    let (bound, stuck) = (0.01, 0.6_f64);
    let traction = report.0["contact"][0]["friction"]["traction"].as_array().expect("points");
    let at = |point: &serde_json::Value| [0, 1].map(|i| point[i].as_f64().expect("a number"));
    let steps: Vec<[[f64; 2]; 2]> = traction.windows(2).map(|w| [at(&w[0]), at(&w[1])]).collect();
    // The mean between two distances x from the middle of the contact, whose length is 2.
    let mean = |[from, to]: [f64; 2]| {
        let (mut sum, mut length) = (0.0, 0.0);
        let inside = |s: f64| (from - 1e-9..=to + 1e-9).contains(&(s - 1.0).abs());
        for [[s, q], [r, p]] in steps.iter().filter(|[a, b]| inside(a[0]) && inside(b[0])) {
            sum -= 0.5 * (q + p) * (r - s);
            length += r - s;
        }
        assert!(length > 0.2, "{length} from {from} to {to}");
        sum / length
    };
    let q = |x: f64| bound * (1.0 - 2.0 / PI * ((stuck * stuck - x * x) / (1.0 - stuck * stuck)).sqrt().atan());
    let n = 100;
    let exact = (0..n).map(|k| q(0.3 * (f64::from(k) + 0.5) / f64::from(n))).sum::<f64>() / f64::from(n);
    close(mean([0.0, 0.3]), exact, 0.02);
    close(mean([0.75, 1.0]), bound, 0.01);
}
