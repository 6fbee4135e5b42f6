//! Intervals that come from energies: quantities with elastic contact, and with polynomial tractions.

use hypercircle::dual::{Condensed, Options};
use hypercircle::element::{Elements, block};
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;
use hypercircle::study::{Answer, answers, certify};

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
