//! Cases whose stress the equilibrium elements hold exactly: both bounds are the energy itself.

use super::run::{Report, carries, close, sound, turns, with_reference};

/// The bracket has closed on `energy` but for what it was widened by, and P2 has found it too.
#[track_caller]
fn closed_on(report: &Report, energy: f64) {
    let [lower, upper, free, widening] =
        ["lower", "upper", "free_upper", "widening"].map(|key| report.number(&format!("/energy/{key}")));
    assert!(lower <= energy && energy <= upper, "{lower} {energy} {upper}");
    assert!(widening < 1e-11 * energy.abs(), "{widening}");
    close(lower + widening, energy, 1e-12 + widening / energy.abs());
    close(free, energy, 1e-12 + 2.0 * widening / energy.abs());
    if with_reference() {
        close(report.number("/primal/1/energy"), energy, 1e-11);
        assert!(report.number("/stress/relative_energy_norm_difference") < 1e-6);
    }
}

/// The dual pressure of contact `index` is `pressure(arc length)` at both ends of every edge.
#[track_caller]
fn pressed(report: &Report, index: usize, pressure: impl Fn(f64) -> f64) {
    let points = report.profile(index, "dual");
    assert!(points.len() >= 4);
    for [arc, found] in points {
        close(found, pressure(arc), 1e-9);
    }
}

#[test]
fn patch() {
    let report = sound("patch");
    // σ_xx = −2 in both plates, thickness ½, moduli 4 and 1, each a unit square.
    closed_on(&report, -0.5 * 2.0_f64.powi(2) * (1.0 / 4.0 + 1.0) * 0.5);
    if with_reference() {
        // A linear displacement is in P1.
        close(report.number("/primal/0/energy"), -1.25, 1e-11);
    }
    carries(&report, 0, [-1.0, 0.0]);
    turns(&report, 0, 0.5);
    pressed(&report, 0, |_| 2.0);
}

/// ε_xx = e₀ + κy in two layers without force and moment: e₀, κ, and −½∫σ²/E − ∫σ αΔT per length.
fn heated([first, second]: [f64; 2], [cold, warm]: [f64; 2]) -> [f64; 3] {
    // Moments of y over the layers: ½, ∓⅛, 1/24.
    let [force, mixed, bending] = [0.5 * (first + second), 0.125 * (second - first), (first + second) / 24.0];
    let thermal = [0.5 * (first * cold + second * warm), 0.125 * (second * warm - first * cold)];
    let determinant = force * bending - mixed * mixed;
    let strain = (thermal[0] * bending - thermal[1] * mixed) / determinant;
    let bend = (force * thermal[1] - mixed * thermal[0]) / determinant;
    let layer = |young: f64, free: f64, sign: f64| {
        // σ = p + q y on 0 … ±½.
        let [p, q] = [young * (strain - free), young * bend];
        let square = 0.5 * p * p + sign * 0.25 * p * q + q * q / 24.0;
        -0.5 * square / young - free * (0.5 * p + sign * 0.125 * q)
    };
    [strain, bend, layer(first, cold, -1.0) + layer(second, warm, 1.0)]
}

#[test]
fn bimetal() {
    let report = sound("bimetal");
    let [strain, bend, energy] = heated([1.0, 2.0], [0.06, 0.18]);
    // Forces and moment vanish: −Π is what is left of the work of ε0.
    closed_on(&report, 3.0 * energy);
    close(report.number("/quantities/0/value"), 3.0 * (strain + 0.25 * bend), 1e-7);
}

#[test]
fn laminate() {
    let report = sound("laminate");
    let along = 1.0 / 140.0 - 0.3_f64.powi(2) * 10.0 / 140.0_f64.powi(2);
    let across = 1.0 / 10.0 - 0.45_f64.powi(2) * 10.0 / 10.0_f64.powi(2);
    let layer = |compliance: f64, sign: f64| {
        let [e, k] = [0.002_f64, 0.01];
        (0.5 * e * e + sign * 0.25 * e * k + k * k / 24.0) / compliance
    };
    closed_on(&report, -0.5 * 3.0 * (layer(along, -1.0) + layer(across, 1.0)));
}

#[test]
fn bending() {
    let report = sound("bending");
    // ½ (1 − ν²)/E · length · ∫ (1 + 3/2 y)² dy over |y| < ½.
    closed_on(&report, -0.5 * 0.91 * 4.0 * (1.0 + 2.25 / 12.0));
    if with_reference() {
        assert!(report.number("/primal/0/energy") > -2.15, "P1 cannot bend without an error");
    }
    carries(&report, 0, [-1.0, 0.0]);
    // ∫ y (1 + 3/2 y) dy.
    turns(&report, 0, 0.125);
    pressed(&report, 0, |arc| 1.0 + 1.5 * (arc - 0.5));
    assert!(report.notes().contains("slides"), "{}", report.notes());
}

#[test]
fn silo() {
    let report = sound("silo");
    // Oedometer: ½ ∫ σ_yy² / M with M = E (1 − ν) / ((1 + ν)(1 − 2ν)); thickness 2, width 1.
    let modulus = |young: f64, nu: f64| young * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
    let upper = (3.0_f64.powi(3) / 3.0 / 3.0) / modulus(30.0, 0.4);
    let lower = ((7.0_f64.powi(3) - 3.0_f64.powi(3)) / 3.0 / 2.0) / modulus(100.0, 0.25);
    closed_on(&report, -0.5 * 2.0 * (upper + lower));
    carries(&report, 0, [0.0, 6.0]);
    carries(&report, 1, [0.0, 14.0]);
    pressed(&report, 0, |_| 3.0);
    pressed(&report, 1, |_| 7.0);
}

#[test]
fn compacted() {
    let report = sound("compacted");
    // The load above is a + b d + c d² at the depth d below the top of each layer: ½ ∫ σ_yy² / M.
    let modulus = |young: f64, nu: f64| young * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
    let square = |[a, b, c]: [f64; 3], d: f64| {
        let parts = [a * a, a * b, (b * b + 2.0 * a * c) / 3.0, b * c / 2.0, c * c / 5.0];
        parts.iter().rev().fold(0.0, |sum, part| d * (sum + part))
    };
    let upper = square([0.0, 2.0, 0.25], 1.0) / modulus(30.0, 0.4);
    let lower = square([2.25, 2.5, 0.125], 2.0) / modulus(100.0, 0.25);
    let energy = -0.5 * 2.0 * (upper + lower);
    let widening = report.number("/energy/widening");
    assert!(report.number("/energy/lower") <= energy && energy <= report.number("/energy/upper"));
    close(report.number("/energy/lower") + widening, energy, 1e-12);
    close(report.number("/energy/free_upper"), energy, 1e-11);
    assert_eq!(report.number("/dual/degree_min"), 2.0);
    if with_reference() {
        // The displacement is cubic: P2 comes from above.
        let found = report.number("/primal/1/energy");
        assert!(found > energy);
        close(found, energy, 1e-5);
    }
    carries(&report, 0, [0.0, 4.5]);
    carries(&report, 1, [0.0, 15.5]);
    pressed(&report, 0, |_| 2.25);
    pressed(&report, 1, |_| 7.75);
    assert!(report.notes().contains("is not the same everywhere"), "{}", report.notes());
}

#[test]
fn springs() {
    let report = sound("springs");
    // ½ ∫ σ²/E' in the block and ½ ∫ σ²/k on the springs, ∫ (3 + 1.5 x)² dx = 19.5.
    closed_on(&report, -0.5 * 19.5 * (0.9375 / 100.0 + 1.0 / 40.0));
    for (quantity, exact) in [(0, 6.0), (1, 1.0), (2, 3.0 / 40.0)] {
        for end in ["lower", "upper"] {
            let found = report.number(&format!("/quantities/{quantity}/{end}"));
            assert!((found - exact).abs() < 1e-7, "{found} is not {exact}");
        }
    }
}

/// Not exact: that of a rigid block, which this one is to five digits.
#[test]
fn elastic_contact() {
    let report = sound("elastic_contact");
    // Pressure from 0 to 2 N/c over the closed length c: the springs store ∫ p²/2k = (2 N/c)² c/6k, and the block as good as nothing.
    let (force, closed, k) = (6.0, 1.5, 40.0);
    let largest = 2.0 * force / closed;
    let energy = -largest * largest * closed / (6.0 * k);
    close(report.number("/energy/lower"), energy, 1e-4);
    close(report.number("/energy/upper"), energy, 1e-4);
    close(report.number("/contact/0/pressure_max/dual"), largest, 1e-3);
    close(report.number("/contact/0/open_fraction"), 0.25, 1e-9);
    close(report.number("/contact/0/resultant/dual/1"), force, 1e-9);
    close(report.number("/contact/0/moment/dual"), 0.5 * force, 1e-9);
    if with_reference() {
        close(report.number("/contact/0/resultant/primal/1"), force, 1e-3);
        close(report.number("/contact/0/pressure_max/primal"), largest, 1e-3);
        close(report.number("/primal/1/energy"), energy, 1e-4);
    }
}

#[test]
fn bonded() {
    let report = sound("bonded");
    closed_on(&report, -0.5 * 4.0 / 50.0 * 2.0 * 0.5);
}

#[test]
fn crack() {
    let report = sound("crack");
    closed_on(&report, -0.5 * 0.36 * 0.91 / 10.0 * 6.0);
    carries(&report, 0, [0.0, -0.6]);
    pressed(&report, 0, |_| 0.6);
}

#[test]
fn gap() {
    let report = sound("gap");
    // Two springs in series, E/L = 2 and 1/0.91 per unit of height, share what is left of the motion.
    let force = 0.02 / (1.0 / 2.0 + 0.91);
    closed_on(&report, 0.5 * force * 0.02);
    carries(&report, 0, [-force, 0.0]);
    pressed(&report, 0, |_| force);
}
