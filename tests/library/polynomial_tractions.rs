//! Tractions of a higher degree than one, against stresses that balance them exactly.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use hypercircle::dual::{Condensed, Options};
use hypercircle::element::{Elements, block};
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;
use hypercircle::study::{Certified, certify};

use crate::support::random::Random;
use crate::support::toml::Toml;

/// A polynomial by its powers of x and y.
#[derive(Clone, Default)]
struct Polynomial(BTreeMap<[u8; 2], f64>);

impl Polynomial {
    fn add(&mut self, powers: [u8; 2], value: f64) {
        *self.0.entry(powers).or_default() += value;
    }

    fn plus(mut self, other: &Polynomial, factor: f64) -> Self {
        other.0.iter().for_each(|(powers, value)| self.add(*powers, factor * value));
        self
    }

    fn slope(&self, c: usize) -> Self {
        let mut out = Polynomial::default();
        for (powers, value) in self.0.iter().filter(|(powers, _)| powers[c] > 0) {
            let mut lower = *powers;
            lower[c] -= 1;
            out.add(lower, f64::from(powers[c]) * value);
        }
        out
    }

    fn product(&self, other: &Polynomial) -> Self {
        let mut out = Polynomial::default();
        for ([i, j], a) in &self.0 {
            other.0.iter().for_each(|([k, l], b)| out.add([i + k, j + l], a * b));
        }
        out
    }

    fn integral(&self, [x, y]: [[f64; 2]; 2]) -> f64 {
        let along = |n: u8, [a, b]: [f64; 2]| (b.powi(i32::from(n) + 1) - a.powi(i32::from(n) + 1)) / f64::from(n + 1);
        self.0.iter().map(|([i, j], value)| value * along(*i, x) * along(*j, y)).sum()
    }

    fn degree(&self) -> u8 {
        self.0.keys().map(|[i, j]| i + j).max().unwrap_or(0)
    }

    fn value(&self, powers: [u8; 2]) -> f64 {
        self.0.get(&powers).copied().unwrap_or(0.0)
    }
}

/// Real and imaginary part of (x + iy)ⁿ.
fn harmonic(n: u8) -> [Polynomial; 2] {
    let [x, y] = [[1, 0], [0, 1]].map(|powers| Polynomial([(powers, 1.0)].into()));
    let mut parts = [Polynomial([([0, 0], 1.0)].into()), Polynomial::default()];
    for _ in 0..n {
        let [re, im] = &parts;
        parts = [re.product(&x).plus(&im.product(&y), -1.0), re.product(&y).plus(&im.product(&x), 1.0)];
    }
    parts
}

/// A biharmonic Airy function of degrees up to `n`.
fn airy(random: &mut Random, n: u8) -> Polynomial {
    let square = Polynomial([([2, 0], 1.0), ([0, 2], 1.0)].into());
    let mut out = Polynomial::default();
    for degree in 2..=n {
        for part in harmonic(degree).into_iter().chain(harmonic(degree - 2).map(|part| part.product(&square))) {
            out = out.plus(&part, random.between(-1.0, 1.0));
        }
    }
    out
}

fn traction(on: &str, along: [&Polynomial; 2], sign: f64) -> String {
    let pair = |powers: [u8; 2]| {
        let [x, y] = along.map(|p| sign * p.value(powers));
        format!("[{x:?}, {y:?}]")
    };
    let [[xx, xy], [yx, yy]] = along.map(|p| [[1, 0], [0, 1]].map(|powers| sign * p.value(powers)));
    let degree = along.iter().map(|p| p.degree()).max().unwrap_or(0);
    let powers = (2..=degree).flat_map(|d| (0..=d).map(move |j| [d - j, j]));
    let terms: Vec<String> =
        powers.map(|[i, j]| format!("{{ powers = [{i}, {j}], value = {} }}", pair([i, j]))).collect();
    format!(
        "[[tractions]]\non = \"{on}\"\nvalue = {}\ngradient = [[{xx:?}, {xy:?}], [{yx:?}, {yy:?}]]\nterms = [{}]",
        pair([0, 0]),
        terms.join(", ")
    )
}

/// A rectangle under the tractions of a polynomial stress, and its energy.
fn scene(random: &mut Random, degree: u8) -> (String, f64) {
    let phi = airy(random, degree + 2);
    let [xx, yy, xy] =
        [phi.slope(1).slope(1), phi.slope(0).slope(0), Polynomial::default().plus(&phi.slope(0).slope(1), -1.0)];
    let corner = [random.between(-1.0, 1.0), random.between(-1.0, 1.0)];
    let sides = [random.between(0.7, 1.4), random.between(0.7, 1.4)];
    let [x, y] = [0, 1].map(|c| [corner[c], corner[c] + sides[c]]);
    let (young, nu, thickness) = (random.magnitude(-1.0, 1.0), random.between(0.0, 0.4), 0.5);
    let text = Toml::default()
        .model("plane-stress", thickness)
        .size(0.5)
        .polygon("body", &[[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]], ["south", "east", "north", "west"])
        .material("body", young, nu)
        .table(&traction("south", [&xy, &yy], -1.0))
        .table(&traction("east", [&xx, &xy], 1.0))
        .table(&traction("north", [&xy, &yy], 1.0))
        .table(&traction("west", [&xx, &xy], -1.0))
        .text();
    let square = |f: &Polynomial, g: &Polynomial| f.product(g).integral([x, y]);
    let twice = square(&xx, &xx) + square(&yy, &yy) - 2.0 * nu * square(&xx, &yy) + 2.0 * (1.0 + nu) * square(&xy, &xy);
    (text, -0.5 * thickness * twice / young)
}

/// r^n P_n(cos θ) for n = 0 … `most`, by the recursion of Legendre polynomials.
fn zonal(most: usize) -> Vec<Polynomial> {
    let z = Polynomial([([0, 1], 1.0)].into());
    let square = Polynomial([([2, 0], 1.0), ([0, 2], 1.0)].into());
    let mut all = vec![Polynomial([([0, 0], 1.0)].into()), z.clone()];
    for n in 1..most {
        let k = n as f64;
        let next = Polynomial::default().plus(&all[n].product(&z), (2.0 * k + 1.0) / (k + 1.0));
        all.push(next.plus(&all[n - 1].product(&square), -k / (k + 1.0)));
    }
    all
}

/// A cylinder with or without a hole under the tractions of the displacement ∇H of a harmonic H that is even in z, and its energy.
fn revolved(random: &mut Random, degree: usize, inside: f64) -> (String, f64) {
    let all = zonal(degree + 2);
    let even = all.iter().skip(2).step_by(2);
    let h = even.fold(Polynomial::default(), |sum, part| sum.plus(part, random.between(-1.0, 1.0)));
    let hoop = Polynomial(h.slope(0).0.iter().map(|([i, j], value)| ([i - 1, *j], *value)).collect());
    let [rr, zz, rz] = [h.slope(0).slope(0), h.slope(1).slope(1), h.slope(0).slope(1)];
    let (outside, height) = (random.between(0.8, 1.2), random.between(0.7, 1.1));
    let (young, nu) = (random.magnitude(-1.0, 1.0), random.between(0.0, 0.45));
    let double = young / (1.0 + nu);
    let edges = if inside > 0.0 { ["foot", "out", "top", "in"] } else { ["foot", "out", "top", ""] };
    let mut text = Toml::default()
        .turned()
        .size(0.5)
        .polygon("body", &[[inside, 0.0], [outside, 0.0], [outside, height], [inside, height]], edges)
        .material("body", young, nu)
        .table("[[supports]]\non = \"foot\"\ntype = \"roller\"")
        .table(&traction("out", [&rr, &rz], double))
        .table(&traction("top", [&rz, &zz], double));
    if inside > 0.0 {
        text = text.table(&traction("in", [&rr, &rz], -double));
    }
    let radius = Polynomial([([1, 0], 1.0)].into());
    let square = |f: &Polynomial| f.product(f).product(&radius).integral([[inside, outside], [0.0, height]]);
    let sum = square(&rr) + square(&zz) + square(&hoop) + 2.0 * square(&rz);
    (text.text(), -0.5 * TAU * double * sum)
}

fn load(text: &str) -> Problem {
    let scene = Scene::parse(text, "scene.toml".as_ref()).unwrap_or_else(|e| panic!("{e}\n{text}"));
    Problem::load(scene).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn solved(problem: Problem, degree: usize) -> Certified {
    let options = Options { elements: Elements::Uniform(block(degree)), ..Options::default() };
    certify(problem, &Condensed::default(), &options).expect("a solution")
}

#[test]
fn the_bracket_holds_the_energy_of_the_polynomial() {
    let (mut left_out, mut narrower) = (0, 0);
    for seed in 0..8 {
        let mut random = Random::new(seed);
        let degree = 2 + random.below(3) as u8;
        let (text, energy) = scene(&mut random, degree);
        let mut widths = Vec::new();
        for (refined, degree) in [(0, 1), (0, usize::from(degree)), (1, usize::from(degree))] {
            let problem = load(&text).refine_uniform(refined).expect("a finer mesh");
            let bracket = solved(problem, degree).bracket;
            let upper = bracket.free.as_ref().expect("an upper bound");
            let (lower, above) = (bracket.lower(), upper.upper());
            assert!(lower <= energy && energy <= above, "{seed}: {lower} {energy} {above}");
            // Without what the rests of the tractions add, it does not.
            let bare = [bracket.complementary.lower(), upper.potential.total()];
            left_out += usize::from(energy < bare[0] || bare[1] < energy);
            widths.push(above - lower);
        }
        narrower += usize::from(widths[2] < 0.3 * widths[1]);
    }
    assert!(left_out >= 4, "the rests never mattered: {left_out}");
    assert!(narrower >= 6, "the bracket does not close: {narrower}");
}

/// On the axis, beside a hole, and beside one so small that it is none.
#[test]
fn the_bracket_of_a_body_of_revolution_holds_the_energy_of_the_polynomial() {
    let (mut left_out, mut narrower) = (0, 0);
    for (seed, (degree, inside)) in
        [(2, 0.0), (2, 0.3), (4, 0.0), (4, 0.4), (4, 1e-6), (2, 0.1)].into_iter().enumerate()
    {
        let (text, energy) = revolved(&mut Random::new(seed as u64), degree, inside);
        let mut widths = Vec::new();
        for (refined, of_stress) in [(0, 1), (0, 3), (1, 3)] {
            let problem = load(&text).refine_uniform(refined).expect("a finer mesh");
            let bracket = solved(problem, of_stress).bracket;
            let upper = bracket.free.as_ref().expect("an upper bound");
            let (lower, above) = (bracket.lower(), upper.upper());
            assert!(lower <= energy && energy <= above, "{seed}: {lower} {energy} {above}");
            let bare = [bracket.complementary.lower(), upper.potential.total()];
            left_out += usize::from(energy < bare[0] || bare[1] < energy);
            widths.push((above - lower) / -energy);
        }
        narrower += usize::from(widths[2] < 0.3 * widths[1]);
        println!("{seed} {degree} {inside}: {widths:?}");
    }
    assert!(left_out >= 4, "the rests never mattered: {left_out}");
    assert!(narrower >= 5, "the bracket does not close: {narrower}");
}

/// Terms that are affine along the edges are no more than other words for affine loads.
#[test]
fn what_edges_hold_costs_nothing() {
    let block = |load: &str| {
        Toml::default()
            .size(0.4)
            .polygon("body", &[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]], ["foot", "", "top", ""])
            .material("body", 2.0, 0.3)
            .clamp("foot")
            .table(&format!("[[tractions]]\non = \"top\"\n{load}"))
            .text()
    };
    // y = 1 on top.
    let given = block("value = [0.0, -1.0]\nterms = [{ powers = [1, 2], value = [0.5, 0.25] }]");
    let plain = block("value = [0.0, -1.0]\ngradient = [[0.5, 0.0], [0.25, 0.0]]");
    let [given, plain] = [given, plain].map(|text| solved(load(&text), 1).bracket);
    let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-10 * b.abs(), "{a} {b}");
    close(given.lower(), plain.lower());
    close(given.free.expect("a bound").upper(), plain.free.expect("a bound").upper());
}

#[test]
fn powers_that_are_none_are_refused() {
    let with = |powers: &str| {
        let text = Toml::default()
            .polygon("body", &[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]], ["foot", "top", ""])
            .material("body", 2.0, 0.3)
            .clamp("foot")
            .table(&format!(
                "[[tractions]]\non = \"top\"\nvalue = [0, 0]\nterms = [{{ powers = {powers}, value = [1, 0] }}]"
            ));
        Scene::parse(&text.text(), "scene.toml".as_ref()).map(|_| ()).map_err(|e| e.to_string())
    };
    assert!(with("[2, 0]").is_ok());
    for powers in ["[1, 0]", "[4, 3]", "[-1, 3]", "[1.5, 1.5]"] {
        let message = with(powers).expect_err("no powers");
        assert!(message.contains("powers are whole numbers that add up to 2 … 6"), "{message}");
    }
}
