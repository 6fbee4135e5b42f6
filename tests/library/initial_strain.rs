//! Thermal expansion and initial stress: exact solutions, and both bounds.

use crate::support::random::Random;
use crate::support::toml::Toml;
use hypercircle::dual::{Clarabel, Condensed, DualMethod, Options, Uzawa};
use hypercircle::element::{Elements, block};
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;
use hypercircle::study::{Certified, certify};

fn problem(text: &str) -> Problem {
    let scene = Scene::parse(text, "scene.toml".as_ref()).unwrap_or_else(|e| panic!("{e}\n{text}"));
    Problem::load(scene).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn solved_by(method: &dyn DualMethod, text: &str, degree: usize) -> Certified {
    let options = Options { elements: Elements::Uniform(block(degree)), ..Options::default() };
    certify(problem(text), method, &options).expect("a solution")
}

fn solved(text: &str, degree: usize) -> Certified {
    solved_by(&Condensed::default(), text, degree)
}

fn ends(certified: &Certified) -> [f64; 2] {
    let bracket = &certified.bracket;
    [bracket.lower(), bracket.free.as_ref().expect("an upper bound").upper()]
}

const PLY: &str = "orthotropic = { young = [10.0, 1.0, 2.0], poisson = [0.3, 0.2, 0.25], shear = 0.6, angle = 30.0 }";

/// A bar between 0 and `length` along x, of height one.
fn bar(length: f64, kinematics: &str) -> Toml {
    let corners = [[0.0, 0.0], [length, 0.0], [length, 1.0], [0.0, 1.0]];
    Toml::default().model(kinematics, 1.0).size(0.4).polygon("a", &corners, ["south", "east", "north", "west"])
}

/// A body that may expand is without stress, whatever its material and wherever it is warm: affine strains fit together.
#[test]
fn free_expansion_is_without_stress() {
    for kinematics in ["plane-strain", "plane-stress"] {
        for keys in ["young = 3.0\npoisson = 0.49999", PLY] {
            for warm in ["40.0", "{ value = -5.0, gradient = [20.0, -13.0] }"] {
                let keys = format!("{keys}\nexpansion = 1e-3\ntemperature = {warm}");
                let text = bar(2.0, kinematics).matter("a", &keys).text();
                for degree in [1, 3] {
                    let found = solved(&text, degree);
                    let [lower, upper] = ends(&found);
                    let largest = found.dual.stress.values().as_flattened().iter().fold(0.0_f64, |m, s| m.max(s.abs()));
                    assert!(lower <= 1e-13 && (-1e-13..1e-6).contains(&upper), "{keys}: {lower} {upper}");
                    assert!(largest < 1e-7, "{keys}: {largest}");
                }
            }
        }
    }
}

/// A bar that cannot grow has σ_xx = −Eα ΔT (plane stress) or −Eα ΔT/(1 − ν) (plane strain).
#[test]
fn a_bar_held_between_walls_is_exact() {
    let (young, nu, alpha, warm) = (7.0, 0.3, 1e-3, 50.0);
    for (kinematics, factor) in [("plane-stress", 1.0), ("plane-strain", 1.0 / (1.0 - nu))] {
        let keys = format!("young = {young:?}\npoisson = {nu:?}\nexpansion = {alpha:?}\ntemperature = {warm:?}");
        let text = bar(2.0, kinematics).matter("a", &keys).roller("west").roller("east").text();
        for degree in [1, 2] {
            let found = solved(&text, degree);
            let stress = -young * alpha * warm * factor;
            for [xx, yy, xy] in found.dual.stress.values() {
                assert!((xx - stress).abs() < 1e-12 && yy.abs() < 1e-12 && xy.abs() < 1e-12, "{xx} {stress}");
            }
            // −Π = −½∫aσ:σ − ∫σ:ε0.
            let (plane, own) = if factor == 1.0 {
                (young, alpha * warm)
            } else {
                (young / (1.0 - nu * nu), (1.0 + nu) * alpha * warm)
            };
            let energy = 2.0 * (-0.5 * stress * stress / plane - stress * own);
            let [lower, upper] = ends(&found);
            assert!((lower - energy).abs() < 1e-12 && (upper - energy).abs() < 1e-10, "{lower} {upper} {energy}");
        }
    }
}

/// A body that is clamped all around keeps its initial stress.
#[test]
fn a_clamped_body_keeps_its_initial_stress() {
    for kinematics in ["plane-strain", "plane-stress"] {
        let keys = format!("{PLY}\ninitial_stress = [0.3, -0.7, 0.2]");
        let mut toml = bar(1.5, kinematics).matter("a", &keys);
        for on in ["south", "east", "north", "west"] {
            toml = toml.clamp(on);
        }
        let found = solved(&toml.text(), 2);
        for stress in found.dual.stress.values() {
            (0..3).for_each(|c| assert!((stress[c] - [0.3, -0.7, 0.2][c]).abs() < 1e-12, "{stress:?}"));
        }
    }
}

/// Two blocks in contact with materials, temperatures, stresses and loads of a seed.
fn mixed(seed: u64) -> String {
    let mut random = Random::new(seed);
    let mut keys = |stiff: f64| {
        let law = match random.below(3) {
            0 => format!("young = {stiff:?}\npoisson = {:?}", random.between(0.0, 0.49)),
            _ => {
                let young = [stiff, stiff * random.magnitude(-1.5, 0.5), stiff * random.magnitude(-1.0, 0.3)];
                let most = |i: usize, j: usize| 0.4 * (young[i] / young[j]).sqrt();
                let poisson = [most(0, 1), most(0, 2), most(1, 2)];
                let (shear, angle) = (0.3 * stiff, random.between(-90.0, 90.0));
                format!(
                    "orthotropic = {{ young = {young:?}, poisson = {poisson:?}, shear = {shear:?}, angle = {angle:?} }}"
                )
            }
        };
        let expansion = [0, 1, 2].map(|_| random.between(0.0, 0.02));
        let gradient = [0, 1].map(|_| if random.chance(0.5) { random.between(-5.0, 5.0) } else { 0.0 });
        let stress = [0, 1, 2].map(|_| 0.1 * stiff * random.between(-1.0, 1.0));
        let warm = random.between(-5.0, 10.0);
        format!(
            "{law}\nexpansion = {expansion:?}\ntemperature = {{ value = {warm:?}, gradient = {gradient:?} }}\ninitial_stress = {stress:?}"
        )
    };
    let [a, b] = [keys(1.0), keys(3.0)];
    let kinematics = random.pick(&["plane-strain", "plane-stress"]);
    Toml::default()
        .model(kinematics, 0.7)
        .size(0.35)
        .polygon("a", &[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], ["foot", "face", "", "load"])
        .polygon("b", &[[1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0]], ["", "wall", "", "seat"])
        .matter("a", &a)
        .matter("b", &b)
        .force("a", [0.1, random.between(-0.3, 0.1)])
        .clamp("wall")
        .roller("foot")
        .traction("load", [0.6, random.between(-0.2, 0.2)])
        .contact("face", "seat")
        .text()
}

#[test]
fn brackets_nest_and_their_gaps_are_local() {
    for seed in 0..10 {
        let text = mixed(seed);
        let mut before: Option<[f64; 2]> = None;
        for degree in [1, 2, 3] {
            let found = solved(&text, degree);
            let free = found.bracket.free.as_ref().expect("an upper bound");
            let by_energies = free.potential.total() - found.bracket.complementary.lower();
            let own = ends(&found);
            let size = found.bracket.complementary.strain + found.bracket.complementary.initial.abs();
            assert!((by_energies - free.local.total).abs() < 1e-9 * size, "{seed}: {by_energies} {}", free.local.total);
            if let Some([lower, upper]) = before {
                assert!(own[0] >= lower - 1e-12 * size && own[0] <= upper && own[1] >= lower, "seed {seed}");
            }
            before = Some(own);
        }
    }
}

#[test]
fn methods_agree() {
    for seed in [3, 4] {
        let text = mixed(seed);
        let exact = ends(&solved(&text, 1))[0];
        let others: [&dyn DualMethod; 2] = [&Clarabel::default(), &Uzawa::default()];
        for method in others {
            let found = ends(&solved_by(method, &text, 1))[0];
            assert!((found - exact).abs() < 1e-6 * exact.abs(), "{}: {found} {exact}", method.name());
        }
    }
}

/// Invalid temperatures and initial stresses are refused.
#[test]
fn wrong_keys_are_named() {
    let refused = |keys: &str, fragment: &str| {
        let text = bar(1.0, "plane-strain").matter("a", &format!("young = 1.0\npoisson = 0.3\n{keys}")).text();
        let error = Scene::parse(&text, "scene.toml".as_ref()).expect_err(fragment).to_string();
        assert!(error.contains(fragment), "{error}");
    };
    refused("temperature = 3.0", "no `expansion`");
    refused("expansion = [1e-5, 2e-5]\ntemperature = 3.0", "2 numbers, not 3");
    refused("expansion = 1e-5\ntemperature = nan", "finite");
    refused("expansion = 1e-5\ntemperature = { value = 1.0, gradient = [1.0] }", "1 component");
    refused("initial_stress = [1.0, 2.0]", "3 or 4");
}

/// A scene made by a program keeps its temperatures, and one that lies far away is the same scene.
#[test]
fn drafts_and_distance_change_nothing() {
    let scene = Scene::parse(&mixed(1), "scene.toml".as_ref()).expect("a scene");
    assert_eq!(scene.bodies, scene.changed(|_| ()).expect("the same scene").bodies);
    let at = |x: f64| {
        let keys =
            format!("{PLY}\nexpansion = 1e-3\ntemperature = {{ value = {:?}, gradient = [8.0, 0.0] }}", -8.0 * x);
        let corners = [[x, 0.0], [x + 2.0, 0.0], [x + 2.0, 1.0], [x, 1.0]];
        let toml = Toml::default().size(0.4).polygon("a", &corners, ["south", "east", "north", "west"]);
        ends(&solved(&toml.matter("a", &keys).clamp("west").roller("east").text(), 1))
    };
    let [near, far] = [at(0.0), at(4096.0)];
    (0..2).for_each(|i| assert!((near[i] - far[i]).abs() < 1e-9 * near[i].abs(), "{near:?} {far:?}"));
}
