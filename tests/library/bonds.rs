//! Bonds: two bodies glued along boundaries whose vertices need not be the same.

use crate::support::random::Random;
use crate::support::toml::Toml;
use hypercircle::dual::{Condensed, Options};
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;
use hypercircle::study::{Certified, certify};

fn scene(text: &str) -> Scene {
    Scene::parse(text, "scene.toml".as_ref()).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn problem(text: &str) -> Problem {
    Problem::load(scene(text)).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn solved(problem: Problem) -> Certified {
    certify(problem, &Condensed::default(), &Options::default()).expect("a solution")
}

fn ends(certified: &Certified) -> [f64; 2] {
    let bracket = &certified.bracket;
    [bracket.lower(), bracket.free.as_ref().expect("an upper bound").upper()]
}

fn bond(toml: Toml, first: &str, second: &str) -> Toml {
    toml.table(&format!("[[bonds]]\nbetween = [\"{first}\", \"{second}\"]"))
}

/// Points of one side between two ends, of which the other side has none.
fn divided(random: &mut Random, from: [f64; 2], to: [f64; 2], n: usize) -> Vec<[f64; 2]> {
    let at = |t: f64| [0, 1].map(|c| from[c] + t * (to[c] - from[c]));
    let within = |i: usize, random: &mut Random| at((i as f64 + random.between(0.2, 0.8)) / n as f64);
    [from].into_iter().chain((0..n).map(|i| within(i, random))).collect()
}

/// Two blocks that meet along a slanted line, each with vertices of its own on it, and a uniform stress all around.
fn patch(seed: u64) -> (Toml, [f64; 3], f64) {
    let mut random = Random::new(seed);
    let (a, b) = ([random.between(0.8, 1.2), 0.0], [random.between(0.8, 1.2), 1.0]);
    let mut left = vec![[0.0, 0.0]];
    left.extend(divided(&mut random, a, b, 2));
    left.extend([b, [0.0, 1.0]]);
    let mut right = vec![[2.0, 0.0], [2.0, 1.0]];
    right.extend(divided(&mut random, b, a, 3));
    right.push(a);
    let stress = [0, 1, 2].map(|_| random.between(-1.0, 1.0));
    let toml = Toml::default()
        .size(0.4)
        .outline("left", &left, &["south", "face", "face", "face", "north", "west"])
        .outline("right", &right, &["east", "top", "skin", "skin", "skin", "skin", "foot"]);
    let mut toml = bond(toml, "face", "skin").clamp("west");
    let [xx, yy, xy] = stress;
    for (on, [nx, ny]) in [("south", [0.0, -1.0]), ("foot", [0.0, -1.0]), ("north", [0.0, 1.0]), ("top", [0.0, 1.0])] {
        toml = toml.traction(on, [xx * nx + xy * ny, xy * nx + yy * ny]);
    }
    (toml.traction("east", [xx, xy]), stress, 2.0)
}

/// Under a uniform stress unlike meshes make no error: the wall moves as that stress has it.
#[test]
fn a_uniform_stress_passes_through_unlike_meshes_exactly() {
    for seed in 0..4 {
        let (toml, [xx, yy, xy], area) = patch(seed);
        let nu: f64 = 0.3;
        let (exx, eyy) = ((1.0 + nu) * ((1.0 - nu) * xx - nu * yy), (1.0 + nu) * ((1.0 - nu) * yy - nu * xx));
        let exy = (1.0 + nu) * xy;
        let wall = "[[supports]]\non = \"west\"\ntype = \"clamped\"";
        let moved =
            format!("{wall}\ndisplacement = {{ value = [0.0, 0.0], gradient = [[{exx}, {exy}], [{exy}, {eyy}]] }}");
        let text = toml.text().replace(wall, &moved);
        let [lower, upper] = ends(&solved(problem(&text)));
        // ½∫σ:ε less the work of the tractions, which is all of ∫σ:ε but what the wall does.
        let density = xx * exx + yy * eyy + 2.0 * xy * exy;
        let on_wall = |y: f64| -(xx * exy * y + xy * eyy * y);
        let energy = 0.5 * density * area - (density * area - on_wall(0.5));
        let close = 1e-12 * (1.0 + density * area);
        assert!(
            lower <= energy + close && energy <= upper + close && upper - lower < 2.0 * close,
            "{seed}: {lower} {energy} {upper}"
        );
    }
}

/// A body cut in two and glued is the body: on one mesh to the last digits, on unlike ones within both brackets.
#[test]
fn a_bond_is_one_body_drawn_as_one() {
    let right: [[f64; 2]; 4] = [[1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.9, 1.0]];
    let own = [[0.933, 0.67], [0.95, 0.5]];
    let scene = |names: [&str; 2], bodies: [&str; 2], own: &[[f64; 2]]| {
        let mut edges = vec!["foot", "east", ""];
        edges.extend(vec![names[1]; own.len() + 1]);
        Toml::default()
            .size(0.24)
            .outline(bodies[0], &[[0.0, 0.0], [1.0, 0.0], [0.9, 1.0], [0.0, 1.0]], &["", names[0], "", "west"])
            .outline(bodies[1], &[&right, own].concat(), &edges)
            .clamp("west")
            .traction("east", [0.4, -0.3])
            .pressure("foot", 0.2)
    };
    let one = ends(&solved(problem(&scene(["", ""], ["a", "a"], &[]).text())));
    let glued = ends(&solved(problem(&bond(scene(["f", "g"], ["a", "b"], &[]), "f", "g").text())));
    for (p, q) in one.iter().zip(&glued) {
        assert!((p - q).abs() < 1e-12 * p.abs(), "{one:?} {glued:?}");
    }
    let unlike = ends(&solved(problem(&bond(scene(["f", "g"], ["a", "b"], &own), "f", "g").text())));
    assert!(unlike[0] <= one[1] && one[0] <= unlike[1], "{one:?} {unlike:?}");
}

/// Energies and local terms say the same gap, and a finer mesh has the narrower bracket within.
#[test]
fn brackets_nest_and_the_local_terms_are_the_gap() {
    for seed in 10..14 {
        let text = patch(seed)
            .0
            .text()
            .replace("\"east\"\nvalue = [", "\"east\"\ngradient = [[0.0, 0.7], [0.2, -0.4]]\nvalue = [");
        let coarse = problem(&text);
        let fine = coarse.refine_uniform(1).expect("a finer mesh");
        let mut outer = [f64::NEG_INFINITY, f64::INFINITY];
        for problem in [coarse, fine] {
            let certified = solved(problem);
            let bracket = &certified.bracket;
            let [lower, upper] = ends(&certified);
            let local = bracket.free.as_ref().expect("an upper bound").local.total;
            assert!((upper - lower - local).abs() < 1e-9 * bracket.complementary.strain, "{seed}");
            assert!(outer[0] <= lower && upper <= outer[1] && lower < upper, "{seed}: {outer:?} {lower} {upper}");
            outer = [lower, upper];
        }
    }
}

#[test]
fn what_cannot_be_bonded_is_refused_with_its_place() {
    let (toml, ..) = patch(1);
    let refused = |from: &str, to: &str| {
        let text = toml.text();
        assert!(text.contains(from), "{text}");
        let text = text.replace(from, to);
        match Scene::parse(&text, "scene.toml".as_ref()) {
            Err(error) => error.to_string(),
            Ok(scene) => Problem::load(scene).expect_err("no problem").to_string(),
        }
    };
    let apart = refused("\"skin\", \"skin\", \"skin\", \"skin\"", "\"skin\", \"skin\", \"skin\", \"\"");
    assert!(apart.contains("bond 'face|skin'"), "{apart}");
    let twice = refused("between = [\"face\", \"skin\"]", "between = [\"face\", \"east\"]");
    assert!(twice.contains("two conditions") || twice.contains("[[bonds]] number 1"), "{twice}");
    let same = refused("between = [\"face\", \"skin\"]", "between = [\"face\", \"face\"]");
    assert!(same.contains("itself"), "{same}");
    let asked =
        refused("[[bonds]]", "[[quantities]]\nname = \"q\"\ndisplacement = \"face\"\ndirection = [1, 0]\n[[bonds]]");
    assert!(asked.contains("bond"), "{asked}");
}

/// A block on another one whose top is a line of its own, `off` below it where a `direction` is given.
fn apart(off: f64, more: &str) -> Toml {
    let sole = [[0.3, 1.0 + off], [0.9, 1.0 + 2.0 * off], [1.7, 1.0 + off], [1.7, 2.0], [0.3, 2.0]];
    let seat = if more.is_empty() {
        vec![[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.7, 1.0], [0.3, 1.0], [0.0, 1.0]]
    } else {
        vec![[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]]
    };
    let names = if more.is_empty() { vec!["foot", "", "", "head", "", ""] } else { vec!["foot", "", "head", ""] };
    Toml::default()
        .size(0.3)
        .outline("a", &seat, &names)
        .outline("b", &sole, &["sole", "sole", "", "top", ""])
        .material("b", 2.0, 0.2)
        .clamp("foot")
        .traction("top", [0.1, -0.2])
        .table(&format!("[[bonds]]\nbetween = [\"head\", \"sole\"]\n{more}"))
}

/// Sides that lie apart by less than a mesh tells are drawn together along their direction; what has nothing opposite is free.
#[test]
fn sides_that_do_not_coincide_are_matched_along_a_direction() {
    for law in ["", "stiffness = [5.0, 2.0]\n"] {
        let exact = apart(0.0, "")
            .text()
            .replace("between = [\"head\", \"sole\"]\n", &format!("between = [\"head\", \"sole\"]\n{law}"));
        let [lower, upper] = ends(&solved(problem(&exact)));
        let mut found = Vec::new();
        for off in [1e-2, 1e-4, 1e-6] {
            let near = problem(&apart(off, &format!("{law}direction = [0.0, 1.0]")).text());
            assert!(near.notes.iter().any(|note| note.text.contains("moved by up to")), "{off}");
            let [below, above] = ends(&solved(near));
            assert!(below < upper && lower < above, "{off}: {below} {above} and {lower} {upper}");
            found.push([below, above]);
        }
        // The geometry moves the bounds by no more than another mesh does.
        let change = |i: usize| (found[i][0] - found[2][0]).abs() / found[2][0].abs();
        assert!(change(0).max(change(1)) < 2e-3, "{} {}", change(0), change(1));
    }
    let far = Problem::load(scene(&apart(0.3, "direction = [0.0, 1.0]").text())).expect_err("no problem").to_string();
    assert!(far.contains("two meshes of one curve"), "{far}");
}
