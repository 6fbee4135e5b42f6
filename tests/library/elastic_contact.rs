//! Elastic contact against closed answers, against what it tends to, and by what every bracket promises.

use crate::support::random::Random;
use crate::support::toml::Toml;
use hypercircle::dual::{Condensed, Options};
use hypercircle::element::{Elements, block};
use hypercircle::mesh::refinement::bisect::RefinementEdges;
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;
use hypercircle::study::{Certified, certify};

fn problem(text: &str) -> Problem {
    let scene = Scene::parse(text, "scene.toml".as_ref()).unwrap_or_else(|e| panic!("{e}\n{text}"));
    Problem::load(scene).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn solved(problem: Problem, degree: usize) -> Certified {
    let options = Options { elements: Elements::Uniform(block(degree)), ..Options::default() };
    certify(problem, &Condensed::default(), &options).expect("a solution")
}

fn ends(certified: &Certified) -> [f64; 2] {
    let bracket = &certified.bracket;
    [bracket.lower(), bracket.free.as_ref().expect("an upper bound").upper()]
}

fn touching(toml: Toml, contact: &str, gap: &str, stiffness: f64) -> Toml {
    toml.table(&format!("[[contacts]]\n{contact}\ngap = {gap}\nstiffness = {stiffness:?}"))
}

fn turned(angle: f64, [x, y]: [f64; 2]) -> [f64; 2] {
    [x * angle.cos() - y * angle.sin(), x * angle.sin() + y * angle.cos()]
}

/// Two columns side by side, each on a contact of its own: one closes its gap, the other does not, at any angle.
#[test]
fn a_column_that_closes_its_gap_and_one_that_does_not_are_exact() {
    for (angle, k) in [(0.0, 2.0), (0.7, 1e-4), (2.0, 1e7)] {
        let place = |corners: [[f64; 2]; 4]| corners.map(|p| turned(angle, p));
        let (pressure, gap) = (0.3, 0.05);
        let toml = Toml::default()
            .size(0.6)
            .polygon("a", &place([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]), ["foot", "ea", "top", "wa"])
            .polygon("c", &place([[2.0, 0.0], [3.0, 0.0], [3.0, 1.0], [2.0, 1.0]]), ["sole", "ec", "held", "wc"])
            .material("a", 2.0, 0.0)
            .roller("ea")
            .roller("wa")
            .clamp("held")
            .traction("top", turned(angle, [0.0, -pressure]));
        let toml = touching(touching(toml, "on = \"foot\"", "0.05", k), "on = \"sole\"", "0.1", k);
        let energy = -(pressure * pressure / 4.0 + pressure * pressure / (2.0 * k) + pressure * gap);
        for degree in [1, 2] {
            let certified = solved(problem(&toml.text()), degree);
            let ([lower, upper], close) = (ends(&certified), 1e-9 * energy.abs());
            assert!(lower <= energy + close && energy <= upper + close, "{lower} {energy} {upper}");
            assert!(upper - lower < close, "{angle} {k}: {lower} {upper}");
            assert!(certified.dual.contact_traction[1].values().iter().all(|t| t.abs() < 1e-12));
        }
    }
}

/// A block squeezed evenly by an obstacle that overlaps it and yields, at whose ends clamps move as the block does: the supports press
/// there, soft or stiff, and at any angle. On the body of ν = 0 the strain e along the push is k (g − e L)/E.
#[test]
fn an_elastic_contact_between_clamps_is_pressed_there_and_exact() {
    let (young, overlap, length) = (2.0, 0.02, 1.5);
    for (angle, k) in [(0.0, 5.0), (0.0, 0.01), (0.7, 5.0), (2.0, 1e5)] {
        let strain = k * overlap / (young + k * length);
        // u = −e x along the push, turned.
        let [c, s] = [f64::cos(angle), f64::sin(angle)];
        let gradient = [[c * c, c * s], [s * c, s * s]].map(|row| row.map(|x| -strain * x));
        let clamp = |on: &str| {
            format!("[[supports]]\non = \"{on}\"\ntype = \"clamped\"\ndisplacement = {{ gradient = {gradient:?} }}")
        };
        let toml = Toml::default()
            .size(0.6)
            .polygon(
                "a",
                &[[0.0, 0.0], [length, 0.0], [length, 1.0], [0.0, 1.0]].map(|p| turned(angle, p)),
                ["foot", "east", "top", "west"],
            )
            .material("a", young, 0.0)
            .table(&clamp("foot"))
            .table(&clamp("top"))
            .table(&clamp("west"));
        let line = [[length - overlap, 0.0], [length - overlap, 1.0]].map(|p| turned(angle, p));
        let toml =
            toml.table(&format!("[[contacts]]\non = \"east\"\nobstacle = {{ line = {line:?} }}\nstiffness = {k:?}"));
        // What the contact stores, and the block; nothing loads it.
        let yielded = overlap - strain * length;
        let energy = 0.5 * young * strain * strain * length + 0.5 * k * yielded * yielded;
        for degree in [1, 2] {
            let [lower, upper] = ends(&solved(problem(&toml.text()), degree));
            assert!(lower <= energy + 1e-12 && energy <= upper + 1e-12, "{angle} {k}: {lower} {energy} {upper}");
            assert!(upper - lower < 1e-8 * energy, "{angle} {k}: {lower} {energy} {upper}");
        }
    }
}

/// A block on another one, with a gap that opens along them and a force that may lift an end.
fn blocks(random: &mut Random, law: &str) -> Toml {
    let kinematics = random.pick(&["plane-strain", "plane-stress"]);
    let (skew, left) = (random.between(-0.1, 0.1), random.between(-0.6, -0.2));
    let slope = random.between(0.0, 0.2);
    let toml = Toml::default()
        .model(kinematics, random.between(0.5, 2.0))
        .size(random.between(0.35, 0.6))
        .outline("a", &[[0.0, 0.0], [2.0, skew], [2.0, 1.0], [0.0, 1.0]], &["foot", "", "top", "west"])
        .outline(
            "b",
            &[[-0.5, -1.0], [2.5, -1.0], [2.5, skew], [2.0, skew], [0.0, 0.0], [-0.5, 0.0]],
            &["ground", "", "", "seat", "", ""],
        )
        .material("a", random.magnitude(-0.5, 0.5), random.between(0.0, 0.45))
        .material("b", random.magnitude(-0.5, 0.5), random.between(0.0, 0.49))
        .clamp("ground")
        .roller("west")
        .force("a", [0.0, -0.05])
        .traction("top", [random.between(-0.05, 0.05), left]);
    toml.table(&format!("[[contacts]]\nbetween = [\"foot\", \"seat\"]\ngap = [[0.0, 0.0], [2.0, {slope:?}]]\n{law}"))
}

/// Energies and local terms say the same gap, and finer meshes narrow the bracket, soft or stiff.
#[test]
fn brackets_nest_and_the_gap_is_said_twice() {
    for seed in 0..8 {
        let mut random = Random::new(seed);
        let k = random.magnitude(-3.0, 6.0);
        let coarse = problem(&blocks(&mut random, &format!("stiffness = {k:?}")).text());
        let fine = coarse.refine_uniform(1).expect("a finer mesh");
        let mut outer = [f64::NEG_INFINITY, f64::INFINITY];
        let mut width = f64::INFINITY;
        for problem in [coarse, fine] {
            let certified = solved(problem, 1 + (seed % 3) as usize);
            let (bracket, [lower, upper]) = (&certified.bracket, ends(&certified));
            let local = &bracket.free.as_ref().expect("an upper bound").local;
            let stored = bracket.complementary.stored();
            assert!((upper - lower - local.total).abs() < 1e-9 * stored, "{seed}: {} {}", upper - lower, local.total);
            assert!(local.pairs.iter().flatten().all(|term| *term >= 0.0), "{seed}: {:?}", local.pairs);
            let room = 1e-10 * stored;
            assert!(
                outer[0] <= lower + room && lower <= upper && upper <= outer[1] + room,
                "{seed}: {outer:?} {lower} {upper}"
            );
            assert!(
                upper - lower < 0.8 * width || upper - lower < 1e-6 * stored,
                "{seed}, {k}: {width} {}",
                upper - lower
            );
            (outer, width) = ([lower, upper], upper - lower);
        }
    }
}

/// The energy grows with the stiffness, from that of bodies that do not touch to that of rigid contact.
#[test]
fn stiff_contact_is_rigid_and_energy_grows_with_stiffness() {
    for seed in 0..4 {
        let of = |law: &str| ends(&solved(problem(&blocks(&mut Random::new(seed), law).text()), 1));
        let mut below = f64::NEG_INFINITY;
        for k in [1e-2, 1.0, 1e2, 1e4, 1e8, 1e12] {
            let [lower, upper] = of(&format!("stiffness = {k:?}"));
            assert!(lower < upper && upper > below, "{seed}, {k}: {below} {lower} {upper}");
            below = lower;
        }
        let ([lower, upper], [stiff, above]) = (of(""), of("stiffness = 1e12"));
        assert!((lower - stiff).abs() < 1e-8 * lower.abs(), "{seed}: {lower} {stiff}");
        assert!(above - stiff < 1.5 * (upper - lower), "{seed}: {stiff} {above} and {lower} {upper}");
    }
}

/// Refinement of a few triangles divides both sides, and brackets nest.
#[test]
fn adaptive_meshes_nest() {
    let mut coarse = problem(&blocks(&mut Random::new(5), "stiffness = 3.0").text());
    let mut edges = RefinementEdges::longest(&coarse.mesh);
    let mut before = ends(&solved(coarse.clone(), 1));
    for _ in 0..3 {
        let beside = coarse.pairs().next().and_then(|pair| pair.edges[1]).expect("a contact");
        let marked = coarse.mesh.edges[beside].triangles[0].expect("a triangle");
        let (finer, next, _) = coarse.bisect(&edges, &[marked]).expect("sides that match");
        (coarse, edges) = (finer, next);
        let now = ends(&solved(coarse.clone(), 1));
        let room = 1e-10 * now[0].abs();
        assert!(before[0] - room <= now[0] && now[0] <= now[1] && now[1] <= before[1] + room, "{before:?} {now:?}");
        before = now;
    }
}

#[test]
fn what_elastic_contact_cannot_be_is_refused() {
    let base = || {
        Toml::default()
            .polygon("b", &[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], ["foot", "", "top", "west"])
            .roller("west")
    };
    let said = |toml: Toml| {
        let parsed = Scene::parse(&toml.text(), "scene.toml".as_ref());
        match parsed {
            Err(error) => error.to_string(),
            Ok(scene) => Problem::load(scene).expect_err("no problem").to_string(),
        }
    };
    for (k, word) in [("0.0", "positive"), ("-1.0", "positive"), ("[2.0, 1.0]", "lower end"), ("[1.0]", "1 or 2")] {
        let found = said(base().table(&format!("[[contacts]]\non = \"foot\"\nstiffness = {k}")));
        assert!(found.contains(word), "{k}: {found}");
    }
    let sides = "between = [\"foot\", \"top\"]\ndirection = [0.0, 1.0]";
    let found = said(touching(base(), sides, "0.0", 1.0));
    assert!(found.contains("direction"), "{found}");
    let arc =
        base().text().replace("edges = [\"foot\"", "arcs = [{ edge = 0, through = [0.5, -0.2] }]\nedges = [\"foot\"");
    let scene = Scene::parse(&format!("{arc}[[contacts]]\non = \"foot\"\nstiffness = 1.0\n"), "scene.toml".as_ref());
    let found = Problem::load(scene.expect("a scene")).expect_err("no problem").to_string();
    assert!(found.contains("facets"), "{found}");
}
