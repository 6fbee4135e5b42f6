//! Intervals that come from energies: quantities with friction, with elastic contact, and with polynomial tractions.

use hypercircle::dual::{Condensed, Options};
use hypercircle::element::{Elements, block};
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;
use hypercircle::study::{Answer, Wanted, answers, certify, refuse_quantities, refuse_wanted};

use crate::support::random::Random;
use crate::support::toml::Toml;

fn solved(text: &str, refine: usize, degree: usize) -> Vec<Answer> {
    let scene = Scene::parse(text, "scene.toml".as_ref()).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let problem = Problem::load(scene).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let problem = problem.refine_uniform(refine).expect("a finer mesh");
    let options = Options { elements: Elements::Uniform(block(degree)), ..Options::default() };
    let certified = certify(problem, &Condensed::default(), &options).expect("a solution");
    answers(&certified, &options, |_| true)
}

fn asked(toml: Toml) -> Toml {
    toml.table("[[quantities]]\nname = \"top\"\ndisplacement = \"top\"\ndirection = [0.6, -0.8]")
        .table("[[quantities]]\nname = \"all\"\ndisplacement = \"a\"\ndirection = [0, -1]")
}

fn blocks(random: &mut Random, contact: &str) -> Toml {
    let load = [random.between(-0.02, 0.02), random.between(-0.1, -0.05)];
    Toml::default()
        .size(0.4)
        .model("plane-strain", 0.7)
        .polygon("a", &[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]], ["foot", "", "top", "side"])
        .polygon("b", &[[0.0, -1.0], [2.0, -1.0], [2.0, 0.0], [0.0, 0.0]], ["ground", "", "seat", ""])
        .material("a", random.between(1.0, 3.0), 0.3)
        .material("b", random.between(1.0, 3.0), 0.2)
        .clamp("ground")
        .roller("side")
        .traction("top", load)
        .table(&format!("[[contacts]]\nbetween = [\"foot\", \"seat\"]\n{contact}"))
}

/// Far finer meshes have their value inside the intervals of coarse ones.
#[test]
fn elastic_contact_has_intervals() {
    for seed in 0..2 {
        let mut random = Random::new(seed);
        let stiffness = random.magnitude(-1.0, 3.0);
        let toml = blocks(&mut random, &format!("gap = [[0.0, 0.0], [2.0, 0.03]]\nstiffness = {stiffness:?}"));
        let text = asked(toml).table("[[quantities]]\nname = \"seat\"\nforce = \"foot|seat\"").text();
        let (coarse, fine) = (solved(&text, 0, 1), solved(&text, 0, 3));
        for (coarse, fine) in coarse.iter().zip(&fine) {
            let [low, high] = coarse.interval.ends;
            let value = fine.interval.value;
            assert!(low <= value && value <= high, "{seed} {}: {low} {value} {high}", coarse.name);
            assert!(fine.interval.half_width() < 0.6 * coarse.interval.half_width(), "{}", coarse.name);
            assert!(high - low < 0.5 * value.abs(), "{seed} {}: {low} {value} {high}", coarse.name);
        }
        // The force is what the load presses with.
        let seat = coarse.iter().find(|answer| answer.name == "seat").expect("the force");
        assert!(seat.interval.value > 0.0);
    }
}

/// Rigid contact is elastic contact that is very stiff, and its intervals are of another make.
#[test]
fn stiff_contact_has_the_values_of_rigid_contact() {
    let ask = |contact: &str| {
        let toml = asked(blocks(&mut Random::new(7), contact));
        solved(&toml.table("[[quantities]]\nname = \"seat\"\nforce = \"foot|seat\"").text(), 0, 2)
    };
    for (stiff, rigid) in ask("stiffness = 1e9").iter().zip(&ask("")) {
        let [low, high] = stiff.interval.ends;
        let [least, most] = rigid.interval.ends;
        assert!(low <= most && least <= high, "{}: {low} {high}, {least} {most}", stiff.name);
        let near = (stiff.interval.value - rigid.interval.value).abs();
        assert!(near < 1e-2 * rigid.interval.value.abs(), "{}: {near}", stiff.name);
    }
}

/// A polynomial that is affine along its edges has the intervals' values of the affine load.
#[test]
fn polynomial_tractions_have_intervals() {
    let block = |load: &str| {
        let toml = Toml::default()
            .size(0.4)
            .polygon("a", &[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]], ["foot", "", "top", ""])
            .material("a", 2.0, 0.3)
            .clamp("foot")
            .table(&format!("[[tractions]]\non = \"top\"\n{load}"));
        asked(toml).text()
    };
    let given = solved(&block("value = [0.0, -1.0]\nterms = [{ powers = [1, 1], value = [0.5, 0.25] }]"), 0, 2);
    let plain = solved(&block("value = [0.0, -1.0]\ngradient = [[0.5, 0.0], [0.25, 0.0]]"), 0, 2);
    for (given, plain) in given.iter().zip(&plain) {
        let [low, high] = given.interval.ends;
        assert!(low <= plain.interval.value && plain.interval.value <= high, "{}", given.name);
    }
    let bent = block("value = [0.0, -1.0]\nterms = [{ powers = [3, 0], value = [0.2, 0.3] }]");
    for (coarse, fine) in solved(&bent, 0, 1).iter().zip(solved(&bent, 1, 2)) {
        let ([low, high], value) = (coarse.interval.ends, fine.interval.value);
        assert!(low <= value && value <= high, "{}: {low} {value} {high}", coarse.name);
    }
}

/// A block on a block with friction, asked for all that has an interval.
fn rubbing(contact: &str) -> String {
    let toml = Toml::default()
        .size(0.6)
        .polygon("low", &[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]], ["floor", "", "seat", ""])
        .polygon("high", &[[0.0, 1.0], [2.0, 1.0], [2.0, 2.0], [0.0, 2.0]], ["foot", "", "load", "push"])
        .material("low", 2.0, 0.2)
        .material("high", 1.0, 0.3)
        .clamp("floor")
        .traction("load", [0.0, -0.3])
        .traction("push", [0.1, 0.0])
        .table(contact);
    let asked = |name: &str, of: &str| format!("[[quantities]]\nname = \"{name}\"\n{of}");
    toml.table(&asked("top", "displacement = \"load\"\ndirection = [0.6, -0.8]"))
        .table(&asked("body", "displacement = \"high\"\ndirection = [1, 0]"))
        .table(&asked("floor", "force = \"floor\"\ndirection = [1, 0]"))
        .table(&asked("stress", "stress = \"high\"\ncomponent = \"xy\""))
        .table(&asked("part", "stress = \"high\"\ncomponent = \"xx\"\nbox = [[0.3, 1.2], [1.1, 1.7]]"))
        .text()
}

const FORCES: &str = r#"
[[quantities]]
name = "normal"
force = "foot|seat"
[[quantities]]
name = "along"
force = "foot|seat"
component = "tangential"
[[quantities]]
name = "turning"
moment = "foot|seat"
about = [1.0, 1.0]
"#;

fn ends_of(answers: &[Answer], name: &str) -> [f64; 2] {
    let answer = answers.iter().find(|answer| answer.name == name).unwrap_or_else(|| panic!("{name}"));
    assert!(answer.interval.reasons.iter().all(Option::is_none), "{name}: {:?}", answer.interval.reasons);
    answer.interval.ends
}

/// Forces on a block that friction alone holds agree with statics, whether it slides in part or not.
#[test]
fn forces_of_friction_are_those_of_statics() {
    for bound in [0.055, 5.0] {
        let contact = format!("[[contacts]]\nbetween = [\"foot\", \"seat\"]\nfriction = {{ bound = {bound:?} }}");
        let found = solved(&(rubbing(&contact) + FORCES), 0, 1);
        // Pressed with 2 · 0.3 and pushed with 0.1 at half its height; what the floor exerts holds the push.
        for (name, exact) in [("normal", 0.6), ("along", -0.1), ("turning", 0.05), ("floor", -0.1)] {
            let [low, high] = ends_of(&found, name);
            assert!(low <= exact && exact <= high, "{bound}, {name}: {low} {exact} {high}");
            assert!(high - low < 0.2 * exact.abs(), "{bound}, {name}: {low} {high}");
        }
    }
}

/// Friction that is never overcome is a bond, whose intervals are of another make.
#[test]
fn friction_that_sticks_has_the_values_of_a_bond() {
    let between = "between = [\"foot\", \"seat\"]";
    let stuck = solved(&rubbing(&format!("[[contacts]]\n{between}\nfriction = {{ bound = 1e6 }}")), 0, 1);
    let bonded = solved(&rubbing(&format!("[[bonds]]\n{between}")), 0, 2);
    for answer in &bonded {
        let ([low, high], [least, most]) = (ends_of(&stuck, &answer.name), answer.interval.ends);
        assert!(low <= most && least <= high, "{}: {low} {high}, {least} {most}", answer.name);
        assert!(high - low > most - least, "{}", answer.name);
    }
}

/// The end of the strip of `cases/pulled_strip.toml` moves by F²/2τEh, and by no more than the shear across it adds.
#[test]
fn a_strip_that_slides_moves_as_its_bar() {
    let toml = Toml::default()
        .size(0.02)
        .model("plane-stress", 1.0)
        .polygon("strip", &[[0.0, 0.0], [0.5, 0.0], [0.5, 0.02], [0.0, 0.02]], ["foot", "pull", "top", ""])
        .material("strip", 1.0, 0.0)
        .roller("top")
        .traction("pull", [0.3, 0.0])
        .table("[[contacts]]\non = \"foot\"\nfriction = { bound = 0.02 }")
        .table("[[quantities]]\nname = \"pull\"\ndisplacement = \"pull\"\ndirection = [1, 0]");
    let [low, high] = ends_of(&solved(&toml.text(), 0, 2), "pull");
    let (bar, shear) = (0.006 * 0.006 / (2.0 * 0.02 * 0.02), 0.02 * 0.02 / (3.0 * 0.5));
    assert!(low <= bar + shear && bar <= high, "{low} {high}");
    assert!(high - low < 0.1 * bar, "{low} {high}");
}

/// Quantities without an interval are told with those that have one, and nothing is refined towards them.
#[test]
fn what_friction_leaves_without_an_interval_is_told_with_what_has_one() {
    let contact = "[[contacts]]\nbetween = [\"foot\", \"seat\"]\nfriction = { bound = 1.0 }";
    for of in [
        "displacement = \"foot\"\ndirection = [1, 0]",
        "displacement = \"high\"\npoint = [1.0, 1.5]\ndirection = [1, 0]",
    ] {
        let text = format!("{}\n[[quantities]]\nname = \"this one\"\n{of}\n", rubbing(contact));
        let problem = Problem::load(Scene::parse(&text, "scene.toml".as_ref()).expect("a scene")).expect("a problem");
        refuse_quantities(&problem).expect("no interval is no mistake");
        let wanted = Wanted { name: "this one".to_string(), tolerance: 0.1 };
        let error = refuse_wanted(&problem, &[wanted]).expect_err("refused");
        assert!(error.contains("'this one'") && error.contains("mean stresses"), "{error}");
        let options = Options::default();
        let certified = certify(problem, &Condensed::default(), &options).expect("an answer");
        let interval = &answers(&certified, &options, |name| name == "this one")[0].interval;
        assert!(!interval.has_an_end(), "{:?}", interval.ends);
        assert!(
            interval.reasons.iter().flatten().all(|reason| reason.contains("mean stresses")),
            "{:?}",
            interval.reasons
        );
    }
    let text = rubbing("[[contacts]]\nbetween = [\"foot\", \"seat\"]") + FORCES;
    let error = Scene::parse(&text, "scene.toml".as_ref()).expect_err("no friction").to_string();
    assert!(error.contains("component") && error.contains("without friction"), "{error}");
}

/// A bound that is all but none leaves the values of frictionless contact in bodies of revolution too, and their intervals are of another make.
#[test]
fn displacements_of_bodies_of_revolution_have_intervals_beside_friction() {
    let ask = |friction: &str| {
        let ring = |[a, b]: [f64; 2]| [[a, 0.0], [b, 0.0], [b, 1.0], [a, 1.0]];
        let moved = |name: &str, of: &str, along: [f64; 2]| {
            format!("[[quantities]]\nname = \"{name}\"\ndisplacement = \"{of}\"\ndirection = {along:?}")
        };
        let toml = Toml::default()
            .turned()
            .size(0.5)
            .outline("shaft", &ring([0.0, 1.0]), &["foot", "seat", "", ""])
            .outline("hub", &ring([1.0, 2.0]), &["ground", "out", "top", "bore"])
            .clamp("foot")
            .roller("ground")
            .traction("top", [0.0, -0.01])
            .table(&format!("[[contacts]]\nbetween = [\"seat\", \"bore\"]\ngap = -0.01\n{friction}"))
            .table(&moved("top", "top", [0.0, 1.0]))
            .table(&moved("out", "out", [1.0, 0.0]))
            .table(&moved("sunk", "hub", [0.0, 1.0]))
            .table(&moved("grown", "hub", [1.0, 0.0]));
        solved(&toml.text(), 0, 3)
    };
    for (rubbed, free) in ask("friction = { bound = 1e-12 }").iter().zip(&ask("")) {
        let ([low, high], [least, most]) = (rubbed.interval.ends, free.interval.ends);
        assert!(low <= least && most <= high, "{}: {low} {high}, {least} {most}", rubbed.name);
        assert!(high - low < 0.3 * high.abs().max(low.abs()), "{}: {low} {high}", rubbed.name);
    }
}
