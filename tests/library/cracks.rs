//! Cracks: two boundaries of one body that touch, open, or hold together, with tips that both share.

use crate::support::toml::Toml;
use hypercircle::dual::{Condensed, Options};
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;
use hypercircle::study::{Certified, answers, certify};

fn problem(text: &str) -> Problem {
    let scene = Scene::parse(text, "scene.toml".as_ref()).unwrap_or_else(|e| panic!("{e}\n{text}"));
    Problem::load(scene).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn solved(problem: Problem) -> Certified {
    certify(problem, &Condensed::default(), &Options::default()).expect("a solution")
}

fn ends(certified: &Certified) -> [f64; 2] {
    let bracket = &certified.bracket;
    [bracket.lower(), bracket.free.as_ref().expect("an upper bound").upper()]
}

/// A block of two polygons, cut between x = 1 and 2 where `names` are given, loaded on top.
fn block(names: [&str; 2], traction: [f64; 2]) -> Toml {
    let lower = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [2.0, 1.0], [1.0, 1.0], [0.0, 1.0]];
    let upper = [[0.0, 1.0], [1.0, 1.0], [2.0, 1.0], [3.0, 1.0], [3.0, 2.0], [0.0, 2.0]];
    Toml::default()
        .size(0.4)
        .outline("a", &lower, &["foot", "", "", names[0], "", ""])
        .outline("a", &upper, &["", names[1], "", "", "top", ""])
        .clamp("foot")
        .traction("top", traction)
}

/// Pressed uniformly by a wall that lets it widen, a crack is not there.
#[test]
fn a_closed_crack_carries_a_uniform_pressure() {
    let text = block(["low", "high"], [0.0, -0.6]).contact("low", "high").text();
    let text = text.replace("type = \"clamped\"", "type = \"roller\"");
    let certified = solved(problem(&text));
    let [lower, upper] = ends(&certified);
    let energy = -0.5 * 0.91 * 0.36 * 6.0;
    assert!((lower - energy).abs() < 1e-12 && (upper - energy).abs() < 1e-12, "{lower} {energy} {upper}");
    let pressed = certified.dual.contact_traction.iter().flat_map(|of| of.values());
    assert!(pressed.into_iter().all(|t| (t + 0.6).abs() < 1e-11));
}

/// Pulled apart, faces that may touch are free faces; held together, they are none.
#[test]
fn an_opened_crack_is_free_and_a_bonded_one_is_none() {
    let pull = [0.05, 0.6];
    let free = ends(&solved(problem(&block(["low", "high"], pull).text())));
    let open = ends(&solved(problem(&block(["low", "high"], pull).contact("low", "high").text())));
    for (a, b) in free.iter().zip(&open) {
        assert!((a - b).abs() < 1e-3 * a.abs(), "{free:?} {open:?}");
    }
    assert!((free[0] - open[0]).abs() < 1e-11, "{free:?} {open:?}");
    let whole = ends(&solved(problem(&block(["", ""], pull).text())));
    let bonded = block(["low", "high"], pull).table("[[bonds]]\nbetween = [\"low\", \"high\"]");
    let bonded = ends(&solved(problem(&bonded.text())));
    assert!((whole[0] - bonded[0]).abs() < 1e-12 && free[1] < whole[0], "{whole:?} {bonded:?} {free:?}");
}

/// A crack that closes in part: brackets nest, local terms are the gap, intervals hold the values of a finer mesh.
#[test]
fn a_crack_that_closes_in_part_is_bracketed() {
    let text = block(["low", "high"], [0.6, 0.0]).contact("low", "high").text();
    let asked = "[[quantities]]\nname = \"lip\"\ndisplacement = \"high\"\ndirection = [0, 1]\n\
        [[quantities]]\nname = \"inner\"\nforce = \"low|high\"\nwindow = [0.1, 0.4, 0.7, 0.9]\n\
        [[quantities]]\nname = \"all\"\nforce = \"low|high\"\n";
    let coarse = problem(&format!("{text}{asked}"));
    let fine = coarse.refine_uniform(1).expect("a finer mesh");
    let mut outer = [f64::NEG_INFINITY, f64::INFINITY];
    let mut found = Vec::new();
    for problem in [coarse, fine] {
        let certified = solved(problem);
        let [lower, upper] = ends(&certified);
        let local = certified.bracket.free.as_ref().expect("an upper bound").local.total;
        assert!((upper - lower - local).abs() < 1e-9 * certified.bracket.complementary.strain);
        assert!(outer[0] <= lower && upper <= outer[1] && lower < upper, "{outer:?} {lower} {upper}");
        outer = [lower, upper];
        found.push(answers(&certified, &Options::default(), |_| true));
    }
    for (wide, narrow) in found[0].iter().zip(&found[1]).take(2) {
        assert_eq!(wide.interval.outside(narrow.interval.value), 0.0, "{}", wide.name);
        assert!(wide.interval.ends.iter().all(|end| end.is_finite()), "{}", wide.name);
    }
    // What is carried up to the tips is no bounded functional.
    let reason = found[0][2].interval.reasons[1].as_ref().expect("an infinite end");
    assert!(reason.contains("ends inside a body"), "{reason}");
}

/// A crack that is one edge long without a size opens as it does on finer meshes: its faces get a vertex between them.
#[test]
fn a_crack_of_one_edge_is_one() {
    let pull = [0.05, 0.6];
    let coarse = block(["low", "high"], pull).contact("low", "high").text().replace("size = 0.4\n", "");
    let short = problem(&coarse);
    assert!(short.pairs().count() == 2, "{} pairs", short.pairs().count());
    let [lower, upper] = ends(&solved(short.refine_uniform(1).expect("a finer mesh")));
    let [below, above] = ends(&solved(problem(&block(["low", "high"], pull).contact("low", "high").text())));
    let [_, whole] = ends(&solved(problem(&block(["", ""], pull).text())));
    assert!(lower < above && below < upper, "{lower} {upper} and {below} {above}");
    assert!(above < whole - 0.5 * (above - below), "{above} {whole}");
}
