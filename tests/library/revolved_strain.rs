//! Temperatures and initial stresses of bodies of revolution against closed solutions.

use std::f64::consts::TAU;

use hypercircle::dual::{Condensed, Options};
use hypercircle::element::polynomial::quadrature::segment_rule;
use hypercircle::element::{Elements, block};
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;
use hypercircle::study::certify_divided;

/// Lower and upper bound of the energy of a rectangle in r and z.
fn bracket(degree: usize, [r0, r1]: [f64; 2], [z0, z1]: [f64; 2], size: f64, rest: &str) -> [f64; 2] {
    let text = format!(
        "[model]\nkinematics = \"axisymmetric\"\n[geometry]\nsize = {size:?}\n[[geometry.polygons]]\nbody = \"tube\"\n\
         points = [[{r0:?}, {z0:?}], [{r1:?}, {z0:?}], [{r1:?}, {z1:?}], [{r0:?}, {z1:?}]]\n\
         edges = [\"foot\", \"out\", \"top\", \"in\"]\n{rest}"
    );
    let scene = Scene::parse(&text, "strained.toml".as_ref()).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let problem = Problem::load(scene).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let options = Options { elements: Elements::Uniform(block(degree)), ..Options::default() };
    let certified = certify_divided(problem, &Condensed::default(), &options).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let upper = certified.bracket.free.as_ref().expect("an upper bound");
    assert!(certified.dual.equilibrium.residual() < 1e-9);
    [certified.bracket.lower(), upper.upper()]
}

const ROLLERS: &str = "[[supports]]\non = \"foot\"\ntype = \"roller\"\n[[supports]]\non = \"top\"\ntype = \"roller\"\n";

/// Energy of a tube between rigid plates whose temperature is t0 + t1 r (Timoshenko & Goodier, Theory of Elasticity, 151): with
/// I = ∫_a^r T r dr, σ_r and σ_θ in its plane, and −½∫ σ:αT of all.
fn tube_energy([a, b]: [f64; 2], length: f64, nu: f64, alpha: f64, [t0, t1]: [f64; 2]) -> f64 {
    let warm = |r: f64| t0 + t1 * r;
    let i = |r: f64| 0.5 * t0 * (r * r - a * a) + t1 * (r.powi(3) - a.powi(3)) / 3.0;
    // E = 1; C1/(1 − 2ν) and C2 of u = (1 + ν)/(1 − ν) α I/r + C1 r + C2/r.
    let c1 = (1.0 + nu) / (1.0 - nu) * alpha * i(b) / (b * b - a * a);
    let c2 = c1 * a * a;
    let work = |r: f64| {
        let inner = alpha / (1.0 - nu) * i(r) / (r * r);
        let radial = -inner + (c1 - c2 / (r * r)) / (1.0 + nu);
        let hoop = inner + (c1 + c2 / (r * r)) / (1.0 + nu) - alpha * warm(r) / (1.0 - nu);
        let axial = nu * (radial + hoop) - alpha * warm(r);
        alpha * warm(r) * (radial + hoop + axial) * r
    };
    let integral: f64 = segment_rule(40).iter().map(|(s, w)| w * (b - a) * work(a + s * (b - a))).sum();
    -0.5 * TAU * length * integral
}

#[test]
fn a_tube_with_a_linear_temperature_is_bracketed_ever_more_closely() {
    for (nu, factors) in [(0.3, [2e-3, 2e-6, 2e-9]), (0.4999, [2e-3, 2e-6, 1e-8])] {
        let exact = tube_energy([1.0, 2.0], 1.0, nu, 0.01, [1.0, 2.0]);
        for (degree, width) in [1, 2, 3].into_iter().zip(factors) {
            let rest = format!(
                "[bodies.tube]\nyoung = 1.0\npoisson = {nu:?}\nexpansion = 0.01\ntemperature = {{ value = 1.0, gradient = [2.0, 0.0] }}\n{ROLLERS}"
            );
            let [lower, upper] = bracket(degree, [1.0, 2.0], [0.0, 1.0], 0.25, &rest);
            assert!(lower <= exact && exact <= upper, "ν = {nu}, degree {degree}: {lower} {exact} {upper}");
            assert!(upper - lower < width * exact, "ν = {nu}, degree {degree}: {lower} {exact} {upper}");
        }
    }
}

#[test]
fn what_expands_freely_has_no_energy() {
    // u = α g (r z, (z² − r²)/2) has the strain α g z in every direction, and a constant temperature that of r and z.
    for temperature in ["3.0", "{ value = 1.0, gradient = [0.0, 2.0] }"] {
        for radii in [[0.0, 1.0], [0.5, 1.5]] {
            for degree in [1, 2] {
                let body = format!(
                    "[bodies.tube]\nyoung = 2.0\npoisson = 0.3\nexpansion = 0.01\ntemperature = {temperature}\n"
                );
                let [lower, upper] = bracket(degree, radii, [0.0, 1.0], 0.5, &body);
                // ½ ∫ cε0:ε0 is of this size.
                let size = 1e-3;
                assert!(
                    (-1e-12 * size..=0.0).contains(&lower) && upper < 1e-9 * size,
                    "{temperature} {degree}: {lower} {upper}"
                );
            }
        }
    }
}

#[test]
fn axes_that_expand_differently_leave_the_known_stress() {
    // A solid cylinder held along z, with α along its axis alone: σ_z = −E α T, the rest free.
    let text = format!(
        "[bodies.tube]\northotropic = {{ young = [3.0, 2.0, 3.0], poisson = [0.0, 0.0, 0.0], shear = 1.0 }}\nexpansion = [0.0, 0.01, 0.0]\ntemperature = 1.0\n{ROLLERS}"
    );
    let exact = 0.5 * 2.0 * 1e-4 * 0.5 * TAU * 2.0;
    let [lower, upper] = bracket(1, [0.0, 1.0], [-1.0, 1.0], 0.7, &text);
    assert!((lower - exact).abs() < 1e-12 * exact && (upper - exact).abs() < 1e-12 * exact, "{lower} {exact} {upper}");
}

#[test]
fn a_body_that_is_held_keeps_its_initial_stress() {
    let clamps: String =
        ["foot", "top", "in", "out"].map(|on| format!("[[supports]]\non = \"{on}\"\ntype = \"clamped\"\n")).concat();
    // Uniform rr = tt and zz are in balance: nothing moves, and the energy is ½∫ σ0:aσ0.
    let stress = [0.3, -0.2, 0.0, 0.3];
    let text = format!("[bodies.tube]\nyoung = 2.0\npoisson = 0.25\ninitial_stress = {stress:?}\n{clamps}");
    let [rr, zz, _, tt] = stress;
    let (squares, sum) = (rr * rr + zz * zz + tt * tt, rr + zz + tt);
    let exact = 0.5 * (1.25 * squares - 0.25 * sum * sum) / 2.0 * TAU * 0.5 * (4.0 - 1.0);
    let [lower, upper] = bracket(1, [1.0, 2.0], [0.0, 1.0], 0.5, &text);
    assert!((lower - exact).abs() < 1e-11 * exact && (upper - exact).abs() < 1e-11 * exact, "{lower} {exact} {upper}");
}

#[test]
fn a_thin_ring_far_out_is_one_in_plane_strain() {
    let body = |kinematics: &str, r: f64| {
        let temperature = |z: f64| format!("{{ value = {:?}, gradient = [1.0, {z:?}] }}", 0.5 - r);
        let text = format!(
            "[model]\nkinematics = \"{kinematics}\"\n[geometry]\nsize = 0.5\n[[geometry.polygons]]\nbody = \"tube\"\n\
             points = [[{r:?}, 0.0], [{:?}, 0.0], [{:?}, 1.0], [{r:?}, 1.0]]\nedges = [\"foot\", \"out\", \"top\", \"in\"]\n\
             [bodies.tube]\nyoung = 1.0\npoisson = 0.3\nexpansion = [0.01, 0.02, 0.0]\ntemperature = {}\n\
             [[supports]]\non = \"foot\"\ntype = \"clamped\"\n[[supports]]\non = \"in\"\ntype = \"roller\"\n",
            r + 1.0,
            r + 1.0,
            temperature(-0.5)
        );
        let scene = Scene::parse(&text, "far.toml".as_ref()).unwrap_or_else(|e| panic!("{e}\n{text}"));
        let problem = Problem::load(scene).unwrap_or_else(|e| panic!("{e}\n{text}"));
        let options = Options { elements: Elements::Uniform(block(2)), ..Options::default() };
        let found = certify_divided(problem, &Condensed::default(), &options).unwrap_or_else(|e| panic!("{e}"));
        [found.bracket.lower(), found.bracket.free.as_ref().expect("an upper bound").upper()]
    };
    let far = 1048576.0;
    let (plane, turned) = (body("plane-strain", 0.0), body("axisymmetric", far).map(|e| e / (TAU * (far + 0.5))));
    // Without expansion around the axis: what is held of it has an energy of its own, which is not one of the plane.
    let rounding = 4e-6 * plane[1];
    assert!(plane[0] <= turned[1] + rounding && turned[0] <= plane[1] + rounding, "{turned:?} {plane:?}");
    assert!((turned[1] - plane[1]).abs() < 3e-2 * plane[1], "{turned:?} {plane:?}");
}
