//! Rigid obstacles with a place of their own.

use crate::arcs::ring_on_pin;
use crate::support::toml::Toml;
use hypercircle::dual::{ActiveSet, Clarabel, Condensed, DualMethod, Options};
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;
use hypercircle::statics::{self, Solvability};
use hypercircle::study::{Certified, certify};

fn problem(text: &str) -> Problem {
    let scene = Scene::parse(text, "scene.toml".as_ref()).unwrap_or_else(|e| panic!("{e}\n{text}"));
    Problem::load(scene).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn bracket(certified: &Certified) -> [f64; 2] {
    [certified.bracket.lower(), certified.bracket.free.as_ref().expect("an upper bound").upper()]
}

fn solved(text: &str) -> Certified {
    certify(problem(text), &Condensed::default(), &Options::default()).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// A block, turned and moved, with rollers at its left and on top.
fn block(place: impl Fn([f64; 2]) -> [f64; 2]) -> Toml {
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 2.0], [0.0, 2.0]].map(place);
    Toml::default()
        .size(0.5)
        .polygon("b", &corners, ["foot", "", "top", "axis"])
        .material("b", 6.0, 0.25)
        .roller("axis")
}

/// A line that has moved into the block squeezes it uniformly, wherever that is.
#[test]
fn a_line_that_overlaps_the_body_squeezes_it() {
    for (angle, shift) in [(0.0_f64, 0.0), (0.7, 0.0), (2.0, 1e6_f64)] {
        let turn = |[x, y]: [f64; 2]| [x * angle.cos() - y * angle.sin(), x * angle.sin() + y * angle.cos()];
        let place = |p: [f64; 2]| turn(p).map(|x| x + shift);
        for moved in [0.0, 0.02] {
            // Along the foot from left to right, the body on the left.
            let line = [[-1.0, 0.03 - moved], [3.0, 0.03 - moved]].map(place);
            let text = block(place)
                .roller("top")
                .table(&format!(
                    "[[contacts]]\non = \"foot\"\nobstacle = {{ line = {line:?} }}\nmove = {:?}",
                    turn([0.0, moved])
                ))
                .text();
            let energy = 0.5 * 6.0 / (1.0 - 0.0625) * 0.015 * 0.015 * 2.0;
            let [lower, upper] = bracket(&solved(&text));
            let close = if shift > 0.0 { 1e-6 } else { 1e-10 } * energy;
            assert!((lower - energy).abs() < close && (upper - energy).abs() < close, "{lower} {upper} {energy}");
        }
    }
}

/// At a distance it is the gap of a boundary.
#[test]
fn a_line_beside_the_body_is_a_gap() {
    let scene = |contact: &str| {
        let load = "[[tractions]]\non = \"top\"\nvalue = [0.0, -0.1]\ngradient = [[0.0, 0.0], [0.15, 0.0]]";
        block(|p| p).table(load).table(&format!("[[contacts]]\non = \"foot\"\n{contact}")).text()
    };
    let own = bracket(&solved(&scene("gap = 0.004")));
    let placed = bracket(&solved(&scene("obstacle = { line = [[5, -0.004], [7, -0.004]] }")));
    for (own, placed) in own.iter().zip(placed) {
        assert!((own - placed).abs() < 1e-12 * own.abs(), "{own} {placed}");
    }
    let problem = problem(&scene("obstacle = { line = [[5, -0.004], [7, -0.004]] }"));
    let again = problem.scene.changed(|_| {}).expect("the same scene");
    assert_eq!(again.contacts, problem.scene.contacts);
}

/// A circle below is the circle of a gap, but for the chords between vertices, and the direction, which turns by the slope of
/// the gap: the finer the mesh, the nearer the two.
#[test]
fn a_circle_below_is_the_circle_of_a_gap() {
    let scene = |contact: &str, size: f64| {
        Toml::default()
            .size(size)
            .polygon("b", &[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], ["foot", "", "top", "axis"])
            .material("b", 1.0, 0.3)
            .roller("axis")
            .pressure("top", 1e-3)
            .table(&format!("[[contacts]]\non = \"foot\"\n{contact}"))
            .text()
    };
    let apart = |size: f64| {
        let gap = solved(&scene("gap = { circle = 20, at = 0 }", size));
        let circle = solved(&scene("obstacle = { circle = { centre = [0, -20], radius = 20 } }", size));
        assert!(circle.problem.notes.iter().any(|note| note.weakens_guarantee && note.text.contains("circle")));
        let [a, b] = [&gap, &circle].map(|c| bracket(c).iter().sum::<f64>() / 2.0);
        (a - b).abs() / gap.bracket.complementary.strain
    };
    let (coarse, fine) = (apart(0.1), apart(0.05));
    assert!(fine < 0.02 && fine < 0.4 * coarse, "{coarse} {fine}");
}

/// A disc in a bore, named all around: edges on the other side are free.
#[test]
fn edges_that_do_not_face_the_obstacle_are_free() {
    let around = |k: usize| {
        let angle = std::f64::consts::TAU * k as f64 / 24.0;
        [angle.cos(), angle.sin()]
    };
    let corners: Vec<[f64; 2]> = (0..24).map(around).collect();
    let scene = |obstacle: &str| {
        Toml::default()
            .outline("b", &corners, &["rim"; 24])
            .material("b", 1.0, 0.3)
            .force("b", [0.0, -1e-4])
            .table(&format!("[[contacts]]\non = \"rim\"\nobstacle = {{ {obstacle} }}"))
            .text()
    };
    let resting = problem(&scene("line = [[-2, -1], [2, -1]]"));
    assert!(resting.interfaces[0].pairs.len() <= 12);
    assert!(resting.notes.iter().any(|note| note.text.contains("do not face")));
    let [lower, upper] = bracket(&solved(&scene("line = [[-2, -1], [2, -1]]")));
    assert!(lower <= upper && upper < 0.0);
    let in_bore = problem(&scene("circle = { centre = [0, 0.1], radius = 1.1, side = \"inside\" }"));
    assert!(in_bore.interfaces[0].pairs.iter().all(|pair| pair.gap.iter().all(|g| *g > -1e-12)));
    let text = scene("line = [[2, -1], [-2, -1]]");
    let refused = Problem::load(Scene::parse(&text, "s.toml".as_ref()).expect("a scene"));
    let turned = refused.expect("the upper half faces it").interfaces[0].pairs.len();
    assert!(turned <= 12, "the other half");
}

#[test]
fn what_does_not_belong_to_an_obstacle_is_refused() {
    let scene = |contact: &str| block(|p| p).roller("top").table(&format!("[[contacts]]\n{contact}")).text();
    let line = "obstacle = { line = [[0, -1], [1, -1]] }";
    for (contact, words) in [
        (format!("on = \"foot\"\n{line}\ngap = 0.1"), "gap"),
        (format!("on = \"foot\"\n{line}\nnormals = \"facets\""), "normals"),
        (format!("on = \"foot\"\n{line}\ndirection = [0, 1]"), "direction"),
        ("on = \"foot\"\nmove = [0, 1]".to_string(), "move"),
        (format!("on = \"foot\"\n{line}\nmove = [0.1, 0.02]\nfriction = {{ bound = 0.1 }}"), "along itself"),
        ("on = \"foot\"\nobstacle = { line = [[0, 0]] }".to_string(), "line"),
        ("on = \"foot\"\nobstacle = { line = [[0, 0], [0, 0]] }".to_string(), "differ"),
        ("on = \"foot\"\nobstacle = { circle = { centre = [0, 0], radius = -1 } }".to_string(), "radius"),
        ("on = \"foot\"\nobstacle = { circle = { centre = [0, 0], radius = 1, side = \"left\" } }".to_string(), "side"),
        ("on = \"foot\"\nobstacle = {}".to_string(), "line"),
        ("on = \"foot\"\nobstacle = { ball = 1 }".to_string(), "ball"),
    ] {
        let error = Scene::parse(&scene(&contact), "s.toml".as_ref()).expect_err(&contact).to_string();
        assert!(error.contains(words), "{contact}: {error}");
    }
    for across in ["move = [0, 0.02]\nfriction = { bound = 0.1 }", "move = [0.1, 0.02]", "friction = { bound = 0.1 }"] {
        let text = scene(&format!("on = \"foot\"\n{line}\n{across}"));
        Scene::parse(&text, "s.toml".as_ref()).unwrap_or_else(|e| panic!("{across}: {e}"));
    }
}

/// A pin beside the centre of the bore moves the ring as a whole, to first order. Its normals meet in its centre, and at vertices nothing
/// hinders the ring to turn about it; between them the jump of that motion does not vanish, and stresses have to balance it.
#[test]
fn a_ring_turns_about_the_centre_of_its_pin() {
    let methods: [&dyn DualMethod; 3] = [&Condensed::default(), &ActiveSet::default(), &Clarabel::default()];
    let central = bracket(&solved(&ring_on_pin([0.0; 2])));
    for (shift, null, apart) in
        [(0.0, 1, 0.0), (1e-11, 1, 1e-8), (1e-5, 0, 1e-5), (1e-3, 0, 1e-3), (0.2, 0, f64::INFINITY)]
    {
        let scene = ring_on_pin([0.6 * shift, -0.8 * shift]);
        let problem = problem(&scene);
        let statics = statics::check(&problem).expect("decided");
        let pins: Vec<bool> = statics.vertex_pins.iter().map(|pin| pin.of_vertices).collect();
        assert_eq!((statics.held.len(), statics.held_along_edges.len(), pins), (1, null, vec![null == 0]), "{shift}");
        for method in methods {
            let found = certify(problem.clone(), method, &Options::default()).expect("solves");
            let residual = found.dual.equilibrium.residual();
            assert!(residual < 1e-9, "{} at {shift}: {residual:e}", method.name());
            let ([a, b], [c, d]) = (bracket(&found), central);
            assert!(a <= d * (1.0 + apart) && c <= b * (1.0 + apart), "{shift}: {a} … {b}, {c} … {d}");
        }
        // A weight through both centres has no moment about either; one across turns the ring.
        for (weight, balanced) in [([0.6, -0.8], true), ([0.8, 0.6], shift < 1e-10)] {
            let text = scene.replace("[bodies.ring]\n", &format!("[bodies.ring]\nbody_force = {weight:?}\n"));
            let possible = statics::check(&self::problem(&text)).expect("decided").equilibrium;
            assert_eq!(matches!(possible, Solvability::Possible { .. }), balanced, "{weight:?} at {shift}");
        }
    }
}
