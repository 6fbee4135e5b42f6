//! Springs and elastic layers of bodies of revolution against closed solutions.

use std::f64::consts::TAU;

use hypercircle::dual::{Condensed, Options};
use hypercircle::element::{Elements, block};
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;
use hypercircle::study::{answers, certify_divided};

/// Lower and upper bound of the energy.
fn bracket(text: &str, degree: usize) -> [f64; 2] {
    let text = format!("[model]\nkinematics = \"axisymmetric\"\n[geometry]\nsize = 0.5\n{text}");
    let scene = Scene::parse(&text, "springs.toml".as_ref()).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let problem = Problem::load(scene).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let options = Options { elements: Elements::Uniform(block(degree)), ..Options::default() };
    let found = certify_divided(problem, &Condensed::default(), &options).unwrap_or_else(|e| panic!("{e}\n{text}"));
    assert!(found.dual.equilibrium.residual() < 1e-9);
    let upper = found.bracket.free.as_ref().expect("an upper bound");
    let gap = upper.upper() - found.bracket.lower();
    let widenings = upper.widening + found.bracket.lower_widening;
    assert!((gap - widenings - upper.local.total).abs() < 1e-9 * found.bracket.complementary.stored() + widenings);
    [found.bracket.lower(), upper.upper()]
}

fn ring(name: &str, [r0, r1]: [f64; 2], poisson: f64, inside: &str) -> String {
    format!(
        "[[geometry.polygons]]\nbody = \"{name}\"\npoints = [[{r0:?}, 0.0], [{r1:?}, 0.0], [{r1:?}, 1.0], [{r0:?}, 1.0]]\n\
         edges = [\"{name}_foot\", \"{name}_out\", \"{name}_top\", \"{inside}\"]\n[bodies.{name}]\nyoung = 1.0\npoisson = {poisson:?}\n"
    )
}

fn rollers(name: &str) -> String {
    ["foot", "top"].map(|side| format!("[[supports]]\non = \"{name}_{side}\"\ntype = \"roller\"\n")).concat()
}

/// ½ E = −½ ∫ p·u of a tube of radii a, b between rigid plates under a pressure p inside and a bed of stiffness k outside.
fn tube_on_a_bed([a, b]: [f64; 2], nu: f64, p: f64, k: f64) -> f64 {
    // u = A r + B/r, E = 1: σ_r = (A/(1 − 2ν) − B/r²)/(1 + ν); σ_r(a) = −p, σ_r(b) = −k u(b).
    let s = |r: f64| [1.0 / ((1.0 - 2.0 * nu) * (1.0 + nu)), -1.0 / (r * r * (1.0 + nu))];
    let ([m, n], [o, q]) = (s(a), s(b));
    let (o, q) = (o + k * b, q + k / b);
    let determinant = m * q - n * o;
    let (big_a, big_b) = (-p * q / determinant, p * o / determinant);
    -0.5 * p * TAU * a * (big_a * a + big_b / a)
}

#[test]
fn a_solid_cylinder_on_springs_sinks_evenly() {
    let spring = "[[supports]]\non = \"rod_foot\"\ntype = \"spring\"\nstiffness = 4.0\n[[tractions]]\non = \"rod_top\"\npressure = 0.5\n";
    let text = ring("rod", [0.0, 1.5], 0.3, "") + spring;
    // ½ p² (1/k + h/E) over the area.
    let exact = -0.5 * 0.25 * (0.25 + 1.0) * 0.5 * TAU * 2.25;
    for degree in [1, 2, 3] {
        let [lower, upper] = bracket(&text, degree);
        assert!(
            (lower - exact).abs() < 1e-10 * -exact && (upper - exact).abs() < 1e-10 * -exact,
            "{lower} {exact} {upper}"
        );
    }
}

#[test]
fn a_tube_in_an_elastic_bed_is_bracketed_ever_more_closely() {
    for (k, nu) in [(0.7, 0.3), (50.0, 0.3), (0.7, 0.4999)] {
        let load = format!(
            "[[tractions]]\non = \"bore\"\npressure = 0.1\n[[supports]]\non = \"tube_out\"\ntype = \"spring\"\nstiffness = {k:?}\n"
        );
        let text = ring("tube", [1.0, 2.0], nu, "bore") + &rollers("tube") + &load;
        let exact = tube_on_a_bed([1.0, 2.0], nu, 0.1, k);
        for (degree, width) in [(1, 3e-2), (2, 5e-4), (3, 1e-5)] {
            let [lower, upper] = bracket(&text, degree);
            assert!(lower <= exact && exact <= upper, "k = {k}, degree {degree}: {lower} {exact} {upper}");
            assert!(upper - lower < width * -exact, "k = {k}, degree {degree}: {lower} {exact} {upper}");
        }
    }
}

#[test]
fn a_stiff_layer_is_a_bond_and_a_soft_one_gives() {
    let scene = |bond: &str| {
        ring("shaft", [0.0, 1.0], 0.3, "")
            + &ring("hub", [1.0, 2.0], 0.3, "hub_bore")
            + &rollers("shaft")
            + &rollers("hub")
            + "[[tractions]]\non = \"hub_out\"\npressure = 0.1\n[[bonds]]\nbetween = [\"shaft_out\", \"hub_bore\"]\n"
            + bond
    };
    let glued = bracket(&scene(""), 2);
    let stiff = bracket(&scene("stiffness = [1e7, 1e7]\n"), 2);
    let soft = bracket(&scene("stiffness = [0.5, 0.5]\n"), 2);
    assert!((stiff[0] - glued[0]).abs() < 1e-6 * -glued[0] && (stiff[1] - glued[1]).abs() < 1e-6 * -glued[1]);
    // The pressure in the layer from three springs in a row: shaft, layer, hub.
    let nu = 0.3;
    let shaft = (1.0 + nu) * (1.0 - 2.0 * nu);
    // u(a) of the tube for a unit of pressure inside, and for one outside; u(b) for one outside.
    let lame = |pi: f64, po: f64, r: f64| {
        let (a2, b2) = (1.0, 4.0);
        let k = (pi * a2 - po * b2) / (b2 - a2);
        (1.0 + nu) * ((1.0 - 2.0 * nu) * k * r + (pi - po) * a2 * b2 / (b2 - a2) / r)
    };
    let q = -lame(0.0, 0.1, 1.0) / (shaft + 1.0 / 0.5 + lame(1.0, 0.0, 1.0));
    let exact = 0.5 * 0.1 * lame(q, 0.1, 2.0) * TAU * 2.0;
    assert!(soft[0] <= exact && exact <= soft[1] && soft[1] - soft[0] < 1e-3 * -exact, "{soft:?} {exact}");
}

/// The guaranteed ends of every quantity, in degree `degree`.
fn intervals(text: &str, degree: usize) -> Vec<[f64; 2]> {
    let text = format!("[model]\nkinematics = \"axisymmetric\"\n[geometry]\nsize = 0.5\n{text}");
    let scene = Scene::parse(&text, "springs.toml".as_ref()).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let problem = Problem::load(scene).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let options = Options { elements: Elements::Uniform(block(degree)), keep_factor: true, ..Options::default() };
    let found = certify_divided(problem, &Condensed::default(), &options).unwrap_or_else(|e| panic!("{e}\n{text}"));
    answers(&found, &options, |_| true).into_iter().map(|answer| answer.interval.ends).collect()
}

fn quantity(name: &str, of: &str) -> String {
    format!("[[quantities]]\nname = \"{name}\"\n{of}\n")
}

#[test]
fn intervals_hold_the_values_of_a_tube_in_an_elastic_bed() {
    let (k, p, [a, b]) = (0.7, 0.1, [1.0, 2.0]);
    for nu in [0.3, 0.49] {
        let moved = |on: &str| quantity(on, &format!("displacement = \"{on}\"\ndirection = [1.0, 0.0]"));
        let text = ring("tube", [a, b], nu, "bore")
            + &rollers("tube")
            + &format!(
                "[[tractions]]\non = \"bore\"\npressure = {p:?}\n[[supports]]\non = \"tube_out\"\ntype = \"spring\"\n"
            )
            + &format!("stiffness = {k:?}\n")
            + &moved("bore")
            + &moved("tube_out")
            + &quantity("all", "displacement = \"tube\"\ndirection = [1.0, 0.0]")
            + &quantity("hoop", "stress = \"tube\"\ncomponent = \"tt\"")
            + &quantity(
                "radial",
                "stress = \"tube\"\ncomponent = \"rr\"\npolygon = [[1.2, 0.1], [1.7, 0.1], [1.7, 0.9], [1.2, 0.9]]",
            );
        // As `tube_on_a_bed`: u = A r + B/r, σ_r and σ_t = (A/(1 − 2ν) ∓ B/r²)/(1 + ν).
        let s = |r: f64| [1.0 / ((1.0 - 2.0 * nu) * (1.0 + nu)), -1.0 / (r * r * (1.0 + nu))];
        let ([m, n], [o, q]) = (s(a), s(b));
        let (o, q) = (o + k * b, q + k / b);
        let determinant = m * q - n * o;
        let (big_a, big_b) = (-p * q / determinant, p * o / determinant);
        let u = |r: f64| big_a * r + big_b / r;
        // Means weighted with r.
        let all = (big_a * (b.powi(3) - a.powi(3)) / 3.0 + big_b * (b - a)) / (0.5 * (b * b - a * a));
        let of_stress = |sign: f64, [a, b]: [f64; 2]| {
            let even = big_a / (1.0 - 2.0 * nu) * 0.5 * (b * b - a * a);
            (even + sign * big_b * (b / a).ln()) / (1.0 + nu) / (0.5 * (b * b - a * a))
        };
        let exact = [u(a), u(b), all, of_stress(1.0, [a, b]), of_stress(-1.0, [1.2, 1.7])];
        let mut last = [f64::INFINITY; 5];
        for degree in [1, 2, 3] {
            for (i, ([lower, upper], exact)) in intervals(&text, degree).into_iter().zip(exact).enumerate() {
                let rounding = 1e-10 * exact.abs();
                assert!(
                    lower <= exact + rounding && exact <= upper + rounding,
                    "ν = {nu}, degree {degree}, {i}: {lower} {exact} {upper}"
                );
                assert!(upper - lower < last[i], "ν = {nu}, degree {degree}, {i}: {lower} {exact} {upper}");
                last[i] = upper - lower;
            }
        }
        assert!(last.iter().zip(exact).all(|(width, exact)| *width < 0.03 * exact.abs()), "{last:?} of {exact:?}");
    }
}

/// Without Poisson's effect a rod between two beds of springs is a column under its weight: its motion and what both carry are closed.
#[test]
fn forces_of_springs_hold_those_of_a_column() {
    let (below, above, weight) = (4.0, 0.25, 0.5);
    for [r0, r1] in [[0.0, 1.5], [0.75, 1.5]] {
        let spring = |on: &str, k: f64| format!("[[supports]]\non = \"{on}\"\ntype = \"spring\"\nstiffness = {k:?}\n");
        let text = ring("rod", [r0, r1], 0.0, "")
            + &format!("body_force = [0.0, {:?}]\n", -weight)
            + &spring("rod_foot", below)
            + &spring("rod_top", above)
            + &quantity("below", "force = \"rod_foot\"\ndirection = [0.0, 1.0]")
            + &quantity("above", "force = \"rod_top\"\ndirection = [0.0, 1.0]")
            + &quantity("sunk", "displacement = \"rod_top\"\ndirection = [0.0, 1.0]")
            + &quantity("foot", "displacement = \"rod_foot\"\ndirection = [0.0, 1.0]")
            + &quantity("mean", "displacement = \"rod\"\ndirection = [0.0, 1.0]")
            + &quantity("along", "stress = \"rod\"\ncomponent = \"zz\"");
        // E = 1 and of height 1: u'' = w, u'(0) = k u(0), u'(1) = −k' u(1).
        let foot = -weight * (1.0 + 0.5 * above) / (below + above + below * above);
        let top = foot * (1.0 + below) + 0.5 * weight;
        let area = 0.5 * TAU * (r1 * r1 - r0 * r0);
        let mean = foot + 0.5 * below * foot + weight / 6.0;
        let exact = [-below * foot * area, -above * top * area, top, foot, mean, top - foot];
        for (degree, wide) in [(1, 0.1), (2, 5e-4), (3, 5e-4)] {
            for (i, ([lower, upper], exact)) in intervals(&text, degree).into_iter().zip(exact).enumerate() {
                let rounding = 1e-7 * exact.abs();
                assert!(
                    lower <= exact + rounding && exact <= upper + rounding && upper - lower < wide * exact.abs(),
                    "from {r0}, degree {degree}, {i}: {lower} {exact} {upper}"
                );
            }
        }
    }
}
