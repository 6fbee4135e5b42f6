//! The published benchmarks: each number is what its formula gives, and each scene asks for the quantities that the index names.

use std::f64::consts::PI;

use hypercircle::problem::Problem;
use hypercircle::published::cases;
use hypercircle::scene::Scene;
use hypercircle::study::refuse_quantities;

/// The integral over [0, 1] of the pressure `p` in x = sin t, with the weight that falls from 1 at 0.4 to 0 at 0.6.
fn weighted(p: impl Fn(f64) -> f64) -> f64 {
    let weight = |x: f64| ((0.6 - x) / 0.2).clamp(0.0, 1.0);
    let n = 200_000;
    let at = |k: usize| (k as f64 + 0.5) * 0.5 * PI / n as f64;
    (0..n).map(|k| weight(at(k).sin()) * p(at(k).sin()) * at(k).cos()).sum::<f64>() * 0.5 * PI / n as f64
}

/// The value of the formula of a published number; `None` for a number without a formula.
fn evaluated(case: &str, quantity: &str, which: usize) -> Option<f64> {
    let root = |a: f64| (PI * a).sqrt();
    let (alpha, angle) = (0.5_f64, 0.25 * PI);
    let tangent = (angle.tan() / angle).sqrt();
    let kirsch = |r: f64| 1.0 + 0.5 / r.powi(2) + 1.5 / r.powi(4);
    let arc = PI / 12.0;
    let polynomial = |c: [f64; 5]| c.iter().rev().fold(0.0, |sum, c| sum * alpha + c);
    // Inertia of a depth of 2, load 1, length 10, E = 1000, ν = 0.3; radii 1 and 2, E = 1, ν = 0.3 of the tube.
    let inertia = 2.0 / 3.0;
    let force = PI * 1000.0 / (4.0 * 100.0 * 0.91);
    Some(match (case, quantity, which) {
        ("kirsch", "at 1.25", _) => kirsch(1.25),
        ("kirsch", "at 1.5", _) => kirsch(1.5),
        ("kirsch", "at 2", _) => kirsch(2.0),
        ("hondros", "across", _) => 2.0 / PI * ((2.0 * arc).sin() - arc),
        ("hondros", "along", _) => -2.0 / PI * ((2.0 * arc).sin() + arc),
        ("lame", "hoop", _) => (1.0 + 4.0 / 2.25) / 3.0,
        ("lame", "radial", _) => (1.0 - 4.0 / 2.25) / 3.0,
        ("lame", "opening", _) => 1.3 / 3.0 * (0.4 * 1.5 + 4.0 / 1.5),
        ("turning_disc", "hoop", _) => 0.4125 * (5.0 + 4.0 / 2.25 - 1.9 / 3.3 * 2.25),
        ("turning_disc", "radial", _) => 0.4125 * (5.0 - 4.0 / 2.25 - 2.25),
        ("turning_disc", ..) => 1.5 * 0.4125 * (5.0 + 4.0 / 2.25 - 1.9 / 3.3 * 2.25 - 0.3 * (5.0 - 4.0 / 2.25 - 2.25)),
        ("cantilever", "bending", _) => -5.0 * 0.5 / inertia,
        ("cantilever", "shear", _) => 0.75 / (2.0 * inertia),
        ("cantilever", "deflection", _) => 1000.0 / (3000.0 * inertia) + 10.0 * 2.6 / (2.0 * 1000.0 * inertia),
        ("bimetal", "above", _) => 0.5 - 0.75 * 0.4,
        ("bimetal", "below", _) => -0.5 + 0.75 * 0.4,
        ("centre_crack", ..) => root(alpha) * (1.0 - 0.025 * alpha.powi(2) + 0.06 * alpha.powi(4)) / angle.cos().sqrt(),
        ("edge_crack", _, 0) => {
            root(alpha) * tangent * (0.752 + 2.02 * alpha + 0.37 * (1.0 - angle.sin()).powi(3)) / angle.cos()
        }
        ("edge_crack", ..) => root(alpha) * polynomial([1.122, -0.231, 10.550, -21.710, 30.382]),
        ("double_edge_crack", ..) => root(alpha) * tangent * (1.0 + 0.122 * angle.cos().powi(4)),
        ("edge_crack_bending", _, 0) => root(alpha) * polynomial([1.122, -1.40, 7.33, -13.08, 14.0]),
        ("edge_crack_bending", ..) => {
            root(alpha) * tangent * (0.923 + 0.199 * (1.0 - angle.sin()).powi(4)) / angle.cos()
        }
        ("flat_punch", ..) => weighted(|x| 2.0 / (PI * (1.0 - x * x).sqrt())),
        ("hertz", ..) => weighted(|x| 2.0 * force / PI * (1.0 - x * x).sqrt()),
        _ => return None,
    })
}

#[test]
fn published_numbers_are_those_of_their_formulas() {
    for case in cases() {
        for (which, value) in case.values.iter().enumerate() {
            let expected = evaluated(&case.name, &value.quantity, which);
            assert_eq!(expected.is_some(), value.formula.is_some(), "{}: {}", case.name, value.quantity);
            let decimals = value.printed.split_once('.').map_or(0, |(_, decimals)| decimals.len());
            if let Some(expected) = expected {
                let off = (expected - value.number()).abs();
                assert!(off < 0.51 * 0.1_f64.powi(decimals as i32), "{}: {} and {expected}", case.name, value.printed);
            }
        }
    }
}

#[test]
fn scenes_ask_for_what_the_index_judges() {
    for case in cases() {
        let scene = Scene::parse(case.scene(), "case.toml".as_ref()).unwrap_or_else(|e| panic!("{}: {e}", case.name));
        let asked = |name: &str| scene.quantities.iter().any(|quantity| quantity.name == name);
        for value in &case.values {
            assert!(asked(&value.quantity), "{}: {}", case.name, value.quantity);
            assert!(value.elsewhere.is_some() || case.refine.contains_key(&value.quantity), "{}", case.name);
        }
        assert!(case.refine.keys().all(|name| asked(name)), "{}", case.name);
        let problem = Problem::load(scene).unwrap_or_else(|e| panic!("{}: {e}", case.name));
        refuse_quantities(&problem).unwrap_or_else(|e| panic!("{}: {e}", case.name));
    }
}
