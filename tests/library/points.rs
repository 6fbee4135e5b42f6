//! Values at points: exact for fields that both models represent, never outside, of second order, and refused where they are none.

use crate::support::asked::{ask, of_degree, quantity};
use hypercircle::dual::Condensed;
use hypercircle::problem::Problem;
use hypercircle::quantity::Form;
use hypercircle::scene::{Component, Invariant, PointValue, Scene, Target};
use hypercircle::study::{Answer, Goal, Wanted, adapt, answers, certify_divided, refuse_quantities};

const XX: PointValue = PointValue::Stress(Component::XX);
const YY: PointValue = PointValue::Stress(Component::YY);
const XY: PointValue = PointValue::Stress(Component::XY);
const UX: PointValue = PointValue::Displacement([1.0, 0.0]);
const UY: PointValue = PointValue::Displacement([0.0, 1.0]);

/// A plate [0, 2] × [0, 1] with conditions on its sides.
fn plate(kinematics: &str, size: f64, rest: &str) -> Problem {
    let text = format!(
        "[model]\nkinematics = \"{kinematics}\"\n[geometry]\nsize = {size}\n[[geometry.polygons]]\nbody = \"plate\"\n\
         points = [[0, 0], [2, 0], [2, 1], [0, 1]]\nedges = [\"bottom\", \"right\", \"top\", \"left\"]\n\
         [bodies.plate]\nyoung = 2.0\npoisson = 0.3\n{rest}"
    );
    Problem::load(Scene::parse(&text, "plate.toml".as_ref()).expect("a scene")).expect("a problem")
}

fn at(at: [f64; 2], value: PointValue) -> Target {
    Target::Point { body: 0, at, value, smoothness: value.smoothness() }
}

fn found(mut problem: Problem, degree: usize, targets: &[Target]) -> Vec<Answer> {
    let names = targets.iter().enumerate().map(|(i, target)| quantity(&i.to_string(), target.clone()));
    let quantities = names.collect();
    ask(&mut problem, quantities);
    let options = of_degree(degree);
    let certified = certify_divided(problem, &Condensed::default(), &options).expect("an answer");
    answers(&certified, &options, |_| true)
}

const POINTS: [[f64; 2]; 4] = [[0.93, 0.52], [0.21, 0.17], [1.71, 0.9], [1.0, 0.5]];

#[test]
fn fields_that_both_models_represent_have_their_value_at_every_point() {
    // A plate that is bent, σ_xx = 1 − 2y; one under its own weight between rollers, σ_yy = y − 1 and u_y = −(1 − ν²)/E (y − y²/2).
    let bent = "[[supports]]\non = \"left\"\ntype = \"roller\"\n\
                [[tractions]]\non = \"right\"\nvalue = [1, 0]\ngradient = [[0, -2], [0, 0]]";
    let weight = "body_force = [0, -1]\n[[supports]]\non = \"left\"\ntype = \"roller\"\n[[supports]]\non = \"right\"\n\
                  type = \"roller\"\n[[supports]]\non = \"bottom\"\ntype = \"roller\"";
    let warm = "expansion = 0.1\ntemperature = { value = 0.5, gradient = [0, 1] }\n\
                [[supports]]\non = \"left\"\ntype = \"roller\"";
    for (degree, size, points) in [(1, 0.3, &POINTS[..]), (2, 0.5, &POINTS[1..3]), (3, 0.7, &POINTS[..1])] {
        for &p in points {
            let [x, y] = p;
            let invariant = |i| PointValue::Invariant(i);
            let asked = [XX, YY, XY, UX, invariant(Invariant::VonMises), invariant(Invariant::SmallestPrincipal)];
            let targets: Vec<Target> = asked.into_iter().map(|value| at(p, value)).collect();
            let sigma = 1.0 - 2.0 * y;
            let exact = [sigma, 0.0, 0.0, 0.5 * x * sigma, sigma.abs(), sigma.min(0.0)];
            let bent = found(plate("plane-stress", size, bent), degree, &targets);
            let targets = [at(p, YY), at(p, XX), at(p, UY), at(p, UX)];
            let of_weight = [y - 1.0, 0.3 * (y - 1.0), -0.5 * 0.91 * (y - 0.5 * y * y), 0.0];
            let heavy = found(plate("plane-stress", size, weight), degree, &targets);
            // Warmer above: no stress, and e(u) = ε0.
            let targets = [at(p, XX), at(p, UX), at(p, invariant(Invariant::VonMises))];
            let warm = found(plate("plane-stress", size, warm), degree, &targets);
            let of_warmth = [0.0, 0.1 * x * (0.5 + y), 0.0];
            let all = bent.iter().zip(exact).chain(heavy.iter().zip(of_weight)).chain(warm.iter().zip(of_warmth));
            for (answer, exact) in all {
                let [low, high] = answer.interval.ends;
                assert!(low <= exact && exact <= high, "{p:?} {}: {exact} in [{low:e}, {high:e}]", answer.name);
                // The radius of the ball is the root of a gap that is known to rounding.
                assert!(high - low < 3e-5, "{p:?} {}: [{low}, {high}]", answer.name);
                assert!((answer.interval.value - exact).abs() < 1e-9, "{p:?} {}", answer.name);
            }
        }
    }
}

const SHEARED: &str =
    "[[supports]]\non = \"left\"\ntype = \"clamped\"\n[[tractions]]\non = \"right\"\nvalue = [0, 0.1]";

#[test]
fn half_widths_fall_at_second_order_and_meshes_agree() {
    let targets: Vec<Target> = [XX, XY, UX, UY].into_iter().map(|value| at([1.1, 0.4], value)).collect();
    let finest = found(plate("plane-strain", 0.12, SHEARED), 2, &targets);
    let mut widths: Vec<Vec<f64>> = Vec::new();
    for size in [0.25, 0.125] {
        let coarse = found(plate("plane-strain", size, SHEARED), 1, &targets);
        for (coarse, fine) in coarse.iter().zip(&finest) {
            let ([a, b], [c, d]) = (coarse.interval.ends, fine.interval.ends);
            assert!(a <= c && d <= b, "{size}: [{a}, {b}] and [{c}, {d}]");
        }
        widths.push(coarse.iter().map(|answer| answer.interval.half_width()).collect());
    }
    // Two corners are singular with r^0.71: the energy error falls like h^1.42.
    for k in 0..targets.len() {
        let rate = (widths[0][k] / widths[1][k]).log2();
        assert!(rate > 1.3, "{k}: {rate} {widths:?}");
    }
}

#[test]
fn a_kernel_of_any_smoothness_encloses_the_same_value() {
    let targets: Vec<Target> = (0..=PointValue::SMOOTHEST)
        .flat_map(|smoothness| {
            let of = move |value| Target::Point { body: 0, at: [0.83, 0.61], value, smoothness };
            [of(YY), of(UX)]
        })
        .collect();
    for degree in [1, 2] {
        let found = found(plate("plane-strain", 0.2, SHEARED), degree, &targets);
        for k in 0..2 {
            let ends = || found.iter().skip(k).step_by(2).map(|answer| answer.interval.ends);
            let low = ends().fold(f64::NEG_INFINITY, |m, [low, _]| m.max(low));
            let high = ends().fold(f64::INFINITY, |m, [_, high]| m.min(high));
            assert!(low <= high, "degree {degree}: {low} {high}");
        }
    }
}

#[test]
fn refinement_towards_a_point_reaches_a_tolerance() {
    let mut problem = plate("plane-strain", 0.25, SHEARED);
    ask(&mut problem, vec![quantity("point", at([0.4, 0.3], XX))]);
    let wanted = vec![Wanted { name: "point".to_string(), tolerance: 2e-3 }];
    let goal = Goal { wanted, max_triangles: Some(4000), ..Goal::new(f64::INFINITY) };
    let options = of_degree(1);
    let adapted = adapt(problem, &Condensed::default(), &options, &goal, |_| ()).expect("an answer");
    assert_eq!(adapted.stopped, None);
    let found = answers(&adapted.certified, &options, |_| true);
    let interval = &found[0].interval;
    assert!(interval.half_width() <= 2e-3 * interval.value.abs());
}

#[test]
fn points_on_the_outline_and_outside_are_refused_with_what_is_bounded() {
    let refused = |p: [f64; 2], value: PointValue| {
        let mut problem = plate("plane-strain", 0.25, SHEARED);
        ask(&mut problem, vec![quantity("q", at(p, value))]);
        refuse_quantities(&problem).expect_err("no value")
    };
    for (p, value, words) in [
        ([2.0, 0.4], UX, ["lies on the outline", "displacement = \"right\""]),
        ([0.7, 1.0], YY, ["no bounded functional", "polygon = [["]),
        ([0.7, 1.2], YY, ["does not lie in body 'plate'", "inside"]),
    ] {
        let text = refused(p, value);
        assert!(words.iter().all(|word| text.contains(word)), "{text}");
    }
    let ply = "orthotropic = { young = [2.0, 1.0, 1.0], poisson = [0.3, 0.3, 0.3], shear = 0.5, angle = 30.0 }";
    let anisotropic = |size| {
        let mut problem = plate("plane-strain", size, SHEARED);
        let text = problem.scene.to_toml().replace("young = 2.0, poisson = 0.3", ply);
        assert!(text.contains("orthotropic"), "{text}");
        let scene = Scene::parse(&text, "ply.toml".as_ref()).unwrap_or_else(|error| panic!("{error}\n{text}"));
        problem = Problem::load(scene).expect("a problem");
        ask(&mut problem, vec![quantity("q", at([0.7, 0.5], YY))]);
        refuse_quantities(&problem).expect_err("no value")
    };
    let text = anisotropic(0.25);
    assert!(text.contains("is not isotropic") && text.contains("polygon = [...]"), "{text}");
    // The line that is offered is one that holds.
    let text = refused([0.7, 1.0], YY);
    let point = text.split("`point = [").nth(1).and_then(|rest| rest.split(']').next()).expect("a point");
    let point: Vec<f64> = point.split(", ").map(|x| x.parse().expect("a number")).collect();
    let mut problem = plate("plane-strain", 0.25, SHEARED);
    ask(&mut problem, vec![quantity("q", at([point[0], point[1]], YY))]);
    refuse_quantities(&problem).expect("a point inside");
    assert!(Form::new(&problem, &problem.scene.quantities[0]).is_ok());
}

/// A bar of height 1, E = 100 and ν = 0 between rollers, pressed by 1: on springs of 10 its points sink by 1/10 + y/100, and below a layer,
/// clamped at its foot, by y/100. Discs reach what is soft, whose traction follows the displacement.
#[test]
fn discs_may_reach_springs_and_layers() {
    let bar = |name: &str, [low, high]: [f64; 2]| {
        let sides = ["foot", "right", "top", "left"].map(|side| format!("\"{name}_{side}\"")).join(", ");
        let rollers =
            ["left", "right"].map(|side| format!("[[supports]]\non = \"{name}_{side}\"\ntype = \"roller\"\n"));
        let polygon = format!("[[0, {low}], [1, {low}], [1, {high}], [0, {high}]]");
        let body = format!("[bodies.{name}]\nyoung = 100.0\npoisson = 0.0\n{}", rollers.concat());
        (format!("[[geometry.polygons]]\nbody = \"{name}\"\npoints = {polygon}\nedges = [{sides}]\n"), body)
    };
    let pressed = |on: &str| format!("[[tractions]]\non = \"{on}_top\"\npressure = 1.0\n");
    let ((low, of_low), (high, of_high)) = (bar("low", [0.0, 1.0]), bar("high", [1.0, 2.0]));
    let springs = "[[supports]]\non = \"low_foot\"\ntype = \"spring\"\nstiffness = [10.0, 10.0]\n";
    let layer = "[[supports]]\non = \"low_foot\"\ntype = \"clamped\"\n\
                 [[bonds]]\nbetween = [\"low_top\", \"high_foot\"]\nstiffness = [10.0, 10.0]\n";
    let scenes = [
        (0.1, format!("{low}{of_low}{springs}{}", pressed("low"))),
        (0.0, format!("{low}{high}{of_low}{of_high}{layer}{}", pressed("high"))),
    ];
    for (size, degree) in [(0.5, 1), (0.3, 2), (0.5, 3)] {
        for (sinks, scene) in &scenes {
            let text = format!("[model]\nkinematics = \"plane-stress\"\n[geometry]\nsize = {size}\n{scene}");
            for p in [[0.5, 0.5], [0.4, 0.3], [0.3, 0.7]] {
                let problem =
                    Problem::load(Scene::parse(&text, "bar.toml".as_ref()).expect("a scene")).expect("a problem");
                let answers = found(problem, degree, &[at(p, UY), at(p, UX)]);
                for (answer, exact) in answers.iter().zip([-sinks - 0.01 * p[1], 0.0]) {
                    let [low, high] = answer.interval.ends;
                    assert!(low <= exact && exact <= high, "{p:?}: {exact} in [{low:e}, {high:e}], degree {degree}");
                    assert!(high - low < 1e-4, "{p:?}: {low:e} to {high:e}");
                }
            }
        }
    }
}

/// Beside friction and elastic contact intervals come from energies: of a uniform stress they are its value, and of others they hold the
/// value of a far finer mesh.
#[test]
fn stresses_at_points_beside_friction_and_elastic_contact() {
    let sheared = "[[contacts]]\non = \"bottom\"\nfriction = { bound = 0.7 }\n[[tractions]]\non = \"top\"\nvalue = [0.5, -1]\n\
                   [[tractions]]\non = \"right\"\nvalue = [-0.3, 0.5]\n[[tractions]]\non = \"left\"\nvalue = [0.3, -0.5]";
    let pressed = "[[contacts]]\non = \"bottom\"\nstiffness = 4.0\n[[supports]]\non = \"left\"\ntype = \"roller\"\n\
                   [[tractions]]\non = \"top\"\nvalue = [0, -1]";
    let mises = (0.09_f64 + 1.0 - 0.3 + 0.75).sqrt();
    for (rest, exact) in [(sheared, [-0.3, -1.0, 0.5, mises]), (pressed, [0.0, -1.0, 0.0, 1.0])] {
        let values = [XX, YY, XY, PointValue::Invariant(Invariant::VonMises)];
        let targets = values.map(|value| at([0.93, 0.52], value));
        for (answer, exact) in found(plate("plane-stress", 0.3, rest), 1, &targets).iter().zip(exact) {
            let [low, high] = answer.interval.ends;
            assert!(low <= exact + 1e-12 && exact - 1e-12 <= high && high - low < 1e-4, "{low} {exact} {high}");
        }
    }
    // The foot slides in part, and lifts in part.
    let pushed = "[[contacts]]\non = \"bottom\"\nfriction = { bound = 0.15 }\n[[tractions]]\non = \"top\"\npressure = 0.5\n\
                  [[tractions]]\non = \"left\"\nvalue = [0.2, 0]";
    let tilted = "[[contacts]]\non = \"bottom\"\nstiffness = 4.0\n[[supports]]\non = \"left\"\ntype = \"roller\"\n\
                  [[tractions]]\non = \"top\"\nvalue = [0, -1]\ngradient = [[0, 0], [-3, 0]]";
    for rest in [pushed, tilted] {
        let targets = [at([0.4, 0.6], YY), at([1.3, 0.4], XY)];
        let of = |size: f64, degree| found(plate("plane-strain", size, rest), degree, &targets);
        for (coarse, fine) in of(0.3, 2).iter().zip(of(0.08, 2)) {
            let ([low, high], [a, b]) = (coarse.interval.ends, fine.interval.ends);
            assert!(low <= fine.interval.value && fine.interval.value <= high, "{low} {} {high}", fine.interval.value);
            assert!(a <= high && low <= b && b - a < 0.7 * (high - low), "[{low}, {high}] and [{a}, {b}]");
        }
    }
}
