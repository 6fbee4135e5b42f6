//! Elements of bodies of revolution: right ones have their properties, and mistakes of a formula written here are named.

use std::f64::consts::TAU;

use hypercircle::scene::Kinematics;
use hypercircle::workbench::formulas::{Family, Variant, ring};
use hypercircle::workbench::{DisplacementElement, Material, Options, Order, Report};
use nalgebra::{DMatrix, Matrix4};

use crate::support::random::Random;

fn material() -> Material {
    Material::new(Kinematics::Axisymmetric, 2.5, 0.27, 1.0).expect("a material")
}

/// Radii of a bilinear ring: of the hoop strain (`None`: there is none) and of the weight, by the radius of the point, that of the middle,
/// and the node.
struct Radii {
    hoop: fn(f64, f64, f64) -> Option<f64>,
    weight: fn(f64, f64) -> f64,
    turn: f64,
    places: &'static [f64],
}

const GAUSS: &[f64] = &[-0.577_350_269_189_625_8, 0.577_350_269_189_625_8];
const RIGHT: Radii = Radii { hoop: |r, _, _| Some(r), weight: |r, _| r, turn: TAU, places: GAUSS };

/// The bilinear ring of textbooks on [−1, 1]², with points of weight one, or one of weight four.
fn bilinear(nodes: [[f64; 2]; 4], young: f64, nu: f64, radii: &Radii) -> DMatrix<f64> {
    let (signs, c) = ([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]], young / ((1.0 + nu) * (1.0 - 2.0 * nu)));
    let d = Matrix4::from_fn(|i, j| match (i, j) {
        (3, 3) => c * (0.5 - nu),
        (3, _) | (_, 3) => 0.0,
        (i, j) => c * if i == j { 1.0 - nu } else { nu },
    });
    let weight = if radii.places.len() == 1 { 4.0 } else { 1.0 };
    let middle = nodes.iter().map(|x| x[0]).sum::<f64>() / 4.0;
    let mut k = DMatrix::zeros(8, 8);
    for (&x, &y) in radii.places.iter().flat_map(|x| radii.places.iter().map(move |y| (x, y))) {
        let n = signs.map(|[a, b]: [f64; 2]| 0.25 * (1.0 + a * x) * (1.0 + b * y));
        let slopes = signs.map(|[a, b]: [f64; 2]| [0.25 * a * (1.0 + b * y), 0.25 * b * (1.0 + a * x)]);
        let j = [0, 1].map(|c| [0, 1].map(|l| (0..4).map(|i| nodes[i][c] * slopes[i][l]).sum::<f64>()));
        let det = j[0][0] * j[1][1] - j[0][1] * j[1][0];
        let r = (0..4).map(|i| n[i] * nodes[i][0]).sum::<f64>();
        let mut b = DMatrix::zeros(4, 8);
        for i in 0..4 {
            let [s, t] = slopes[i];
            let [dr, dz] = [(j[1][1] * s - j[1][0] * t) / det, (j[0][0] * t - j[0][1] * s) / det];
            (b[(0, 2 * i)], b[(1, 2 * i + 1)], b[(3, 2 * i)], b[(3, 2 * i + 1)]) = (dr, dz, dz, dr);
            b[(2, 2 * i)] = (radii.hoop)(r, middle, nodes[i][0]).map_or(0.0, |radius| n[i] / radius);
        }
        k += b.transpose() * d * b * (radii.turn * (radii.weight)(r, middle) * det * weight);
    }
    k
}

const NODES: [[f64; 2]; 4] = [[1.0, 0.0], [2.1, 0.1], [1.9, 1.0], [0.8, 1.2]];

fn of_matrix(k: &DMatrix<f64>) -> Report {
    let element = DisplacementElement::of_matrix("mine", k, NODES.to_vec(), Order::Interleaved, Some(material()));
    let claimed = Options { claimed: vec!["reference".into()], ..Options::default() };
    Report::of_displacement(&element.expect("an element"), &claimed)
}

fn missing(report: &Report) -> Vec<&str> {
    report.findings.iter().filter(|f| f.is_missing()).map(|f| f.name.as_str()).collect()
}

#[test]
fn the_families_are_right_on_all_shapes_and_places() {
    for family in Family::ALL {
        let element = family.element("own", material(), Variant::Right).expect("a ring");
        let report = Report::of_displacement(&element, &Options::default());
        let words: Vec<String> = report.findings.iter().filter(|f| f.is_missing()).map(|f| f.in_words()).collect();
        assert!(report.passed && report.diagnosis.is_none(), "{family:?}: {words:?} {:?}", report.diagnosis);
        assert!(report.findings.iter().all(|f| f.passed == Some(true)), "{family:?}: {}", report.verdict);
    }
}

/// ½ ∫ D_tt (1/r)² 2πr dr dz of a radial shift is known in closed form.
#[test]
fn a_radial_shift_stores_what_the_hoop_says() {
    let [a, b, height] = [0.7, 1.9, 0.8];
    let nodes = [[a, 0.0], [b, 0.0], [b, height], [a, height]];
    let k = ring::stiffness(Family::Q4, &nodes, &material().hooke_of_rings(), Variant::Right).expect("a ring");
    let own = bilinear(nodes, 2.5, 0.27, &RIGHT);
    assert!((&k - &own).amax() < 1e-14 * k.amax());
    assert!(Family::Q4.element("own", material(), Variant::Hybrid).is_err(), "variants of the plane have no ring");
    let shift = DMatrix::from_fn(8, 1, |i, _| if i % 2 == 0 { 1.0 } else { 0.0 });
    let stored = (shift.transpose() * k * &shift)[(0, 0)];
    let c = 2.5 * 0.73 / (1.27 * 0.46);
    // Two points of Gauss for ∫ dr/r.
    let exact = TAU * c * height * (b / a).ln();
    assert!((stored / exact - 1.0).abs() < 0.01, "{stored} for {exact}");
}

#[test]
fn mistakes_in_radii_are_named() {
    let middle: &'static [f64] = &[0.0];
    let ways: [(&str, Radii); 9] = [
        ("", RIGHT),
        ("per-radian", Radii { turn: 1.0, ..RIGHT }),
        ("hoop-left-out", Radii { hoop: |_, _, _| None, ..RIGHT }),
        ("hoop-radius", Radii { hoop: |_, middle, _| Some(middle), ..RIGHT }),
        ("hoop-radius", Radii { hoop: |_, _, node| Some(node), ..RIGHT }),
        ("weight-radius", Radii { weight: |_, middle| middle, ..RIGHT }),
        ("radius-left-out", Radii { weight: |_, _| 1.0, ..RIGHT }),
        ("radius-left-out", Radii { weight: |_, _| 1.0, turn: 1.0, ..RIGHT }),
        ("one-point", Radii { places: middle, ..RIGHT }),
    ];
    for (cause, radii) in ways {
        let report = of_matrix(&bilinear(NODES, 2.5, 0.27, &radii));
        let found = report.diagnosis.as_ref().map_or("", |diagnosis| diagnosis.cause.as_str());
        assert_eq!(found, cause, "{:?}", report.diagnosis);
        assert_eq!(report.passed, cause.is_empty(), "{cause}: {}", report.verdict);
    }
    let rank = of_matrix(&bilinear(NODES, 2.5, 0.27, &Radii { places: middle, ..RIGHT }));
    assert_eq!(rank.finding("rank").and_then(|f| f.value), Some(3.0));
    let other = of_matrix(&bilinear(NODES, 1.3 * 2.5, 0.27, &RIGHT));
    assert_eq!(other.diagnosis.expect("a factor").cause, "factor");
}

#[test]
fn noise_is_explained_by_nothing() {
    let right = bilinear(NODES, 2.5, 0.27, &RIGHT);
    let mut random = Random::new(5);
    for size in [1.0, 1e-2, 1e-5] {
        let noise = DMatrix::from_fn(8, 8, |_, _| random.between(-1.0, 1.0));
        let report = of_matrix(&(&right + (&noise + noise.transpose()) * (size * right.amax())));
        assert_eq!(report.diagnosis.expect("something is wrong").cause, "unexplained");
        assert!(!report.passed);
    }
}

#[test]
fn what_is_no_ring_is_refused() {
    let k = bilinear(NODES, 2.5, 0.27, &RIGHT);
    let beyond = NODES.map(|[r, z]| [r - 1.0, z]).to_vec();
    let refused = DisplacementElement::of_matrix("mine", &k, beyond, Order::Interleaved, Some(material()));
    assert!(refused.is_err_and(|e| e.contains("r ≥ 0")));
    assert!(Material::new(Kinematics::Axisymmetric, 1.0, 0.3, 2.0).is_err_and(|e| e.contains("full turn")));
}

/// A formula that forgets the weight scales otherwise, and is no slice far from the axis.
#[test]
fn a_formula_without_the_weight_is_caught_by_its_scaling() {
    let formula = |nodes: &[[f64; 2]], m: &Material| {
        let nodes: [[f64; 2]; 4] = nodes.try_into().map_err(|_| "four nodes".to_string())?;
        Ok(bilinear(nodes, m.young, m.poisson, &Radii { weight: |_, _| 1.0, ..RIGHT }))
    };
    let element = DisplacementElement::of_formula("mine", NODES.to_vec(), material(), formula).expect("an element");
    let report = Report::of_displacement(&element, &Options::default());
    let found = missing(&report);
    for name in ["scaling", "plane-limit", "patch-distorted", "patch-energy"] {
        assert!(found.contains(&name), "{name}: {found:?}");
    }
    assert!(!found.contains(&"rigid-motions") && !found.contains(&"reflection"));
}
