//! The mean of the contact pressure around its largest value, and how far it may be from the exact one.

use crate::support::toml::Toml;
use hypercircle::compare::contact::pressure::{dual_pressure, profile};
use hypercircle::compare::{Allowances, ContactSummary, MeanPressure, compare};
use hypercircle::dual::{Condensed, Options};
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;
use hypercircle::study::{Adapt, Certified, Goal, adapt, certify};

fn problem(toml: &Toml) -> Problem {
    let text = toml.text();
    Problem::load(Scene::parse(&text, "scene.toml".as_ref()).unwrap_or_else(|e| panic!("{e}\n{text}")))
        .expect("a problem")
}

fn refined(toml: &Toml, adapt_by: Adapt, tolerance: f64) -> Certified {
    let goal = Goal { adapt: adapt_by, ..Goal::new(tolerance) };
    adapt(problem(toml), &Condensed::default(), &Options::default(), &goal, |_| ()).expect("an answer").certified
}

fn contact(certified: &Certified) -> ContactSummary {
    let Certified { problem, dual, bracket, .. } = certified;
    compare(problem, dual, bracket, Vec::new(), &Allowances::default()).contacts.swap_remove(0)
}

fn mean(certified: &Certified) -> MeanPressure {
    contact(certified).pressure_mean.expect("something presses")
}

/// An eccentric load lifts a block off another.
fn blocks(size: f64) -> Toml {
    Toml::default()
        .size(size)
        .polygon("left", &[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], ["rollers", "face", "", "load"])
        .polygon("right", &[[1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0]], ["", "wall", "", "right_face"])
        .clamp("wall")
        .roller("rollers")
        .table("[[tractions]]\non = \"load\"\nvalue = [4.0, 0.0]\ngradient = [[0.0, -7.0], [0.0, 0.0]]")
        .contact("face", "right_face")
}

/// ∫ p φ / ∫ φ of the pressure on `fine` with the weight around `mean` that the mesh of `coarse` has.
fn of(fine: &Certified, coarse: &Certified, mean: &MeanPressure) -> f64 {
    let along = |p: [f64; 2]| p[1];
    let vertices: Vec<f64> = {
        let pairs = &coarse.problem.interfaces[0].pairs;
        let mut all: Vec<f64> =
            pairs.iter().flat_map(|pair| pair.first.map(|v| along(coarse.problem.mesh.points[v]))).collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    };
    let cone = |y: f64| (1.0 - (y - along(mean.at)).abs() / mean.radius).max(0.0);
    let weight = |y: f64| {
        let k = vertices.partition_point(|v| *v < y).clamp(1, vertices.len() - 1);
        let [a, b] = [vertices[k - 1], vertices[k]];
        ((b - y) * cone(a) + (y - a) * cone(b)) / (b - a)
    };
    let interface = &fine.problem.interfaces[0];
    let points = profile(interface, &dual_pressure(&fine.dual, 0));
    let (mut force, mut whole) = (0.0, 0.0);
    for pair in points.windows(2) {
        let [[s, p], [t, q]] = [pair[0], pair[1]];
        // Steps so fine that the kinks of φ do not matter.
        for k in 0..20 {
            let part = (f64::from(k) + 0.5) / 20.0;
            let phi = weight(s + part * (t - s));
            force += phi * (p + part * (q - p)) * (t - s) / 20.0;
            whole += phi * (t - s) / 20.0;
        }
    }
    force / whole
}

#[test]
fn the_exact_mean_is_no_farther_away_than_is_said() {
    let fine = refined(&blocks(1.0), Adapt::Hp, 0.002);
    let mut last = f64::INFINITY;
    for size in [0.5, 0.25, 0.125] {
        let coarse = certify(problem(&blocks(size)), &Condensed::default(), &Options::default()).expect("solves");
        let found = mean(&coarse);
        let (exact, half) = (of(&fine, &coarse, &found), found.half_width.expect("a bound"));
        println!("{size}: {found:?}, {exact}");
        assert!((found.value - exact).abs() <= half, "{size}: {found:?}, {exact}");
        assert!(half < last);
        last = half;
    }
}

/// Where the pressure is the same everywhere, so is the mean, and nothing is left open.
#[test]
fn a_uniform_pressure_is_its_mean() {
    let toml = Toml::default()
        .size(0.5)
        .polygon("upper", &[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], ["foot", "", "top", "axis"])
        .roller("axis")
        .pressure("top", 3.0)
        .rigid("foot");
    let certified = certify(problem(&toml), &Condensed::default(), &Options::default()).expect("solves");
    let found = mean(&certified);
    assert!((found.value - 3.0).abs() < 1e-12 && found.half_width.expect("a bound") < 1e-5, "{found:?}");
}

/// An elastic block on a rigid cylinder: on triangles of high degree the largest pressure is a tenth too high and more, the mean
/// is not.
#[test]
fn the_mean_of_hertz_is_met_by_mesh_and_degree() {
    let (radius, half_force): (f64, f64) = (50.0, 3e-4 * 30.0);
    let modulus = 1.0 / (1.0 - 0.3 * 0.3);
    let width = (8.0 * half_force * radius / (std::f64::consts::PI * modulus)).sqrt();
    let peak = 4.0 * half_force / (std::f64::consts::PI * width);
    let hertz = Toml::default()
        .polygon("block", &[[0.0, 0.0], [30.0, 0.0], [30.0, 30.0], [0.0, 30.0]], ["foot", "", "top", "axis"])
        .roller("axis")
        .pressure("top", 3e-4)
        .table(&format!("[[contacts]]\non = \"foot\"\ngap = {{ parabola = {radius:?}, at = 0.0 }}"));
    for (way, tolerance) in [(Adapt::Hp, 0.01), (Adapt::Hp, 0.003), (Adapt::H, 0.01)] {
        let certified = refined(&hertz, way, tolerance);
        let summary = contact(&certified);
        let found = summary.pressure_mean.expect("something presses");
        let steps = 2000;
        let (mut force, mut whole) = (0.0, 0.0);
        for k in 0..steps {
            let x = found.at[0] + found.radius * (2.0 * (f64::from(k) + 0.5) / f64::from(steps) - 1.0);
            let phi = if x > 0.0 { 1.0 - (x - found.at[0]).abs() / found.radius } else { 0.0 };
            force += phi * peak * (1.0 - (x / width).powi(2)).max(0.0).sqrt();
            whole += phi;
        }
        let (exact, half) = (force / whole, found.half_width.expect("a bound"));
        println!("{way:?} {tolerance}: peak {peak:.5}, {:.5}; mean {exact:.5}, {found:?}", summary.pressure_max.dual);
        // The block is no half-plane, and its gap is linear between vertices.
        assert!((found.value - exact).abs() <= half + 0.03 * peak, "{way:?} {tolerance}: {exact}, {found:?}");
    }
}
