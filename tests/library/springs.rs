//! Springs to the ground and elastic layers, against closed answers and against what they tend to.

use crate::support::random::Random;
use crate::support::toml::Toml;
use hypercircle::dual::{Condensed, Options};
use hypercircle::mesh::refinement::bisect::RefinementEdges;
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

fn springs(toml: Toml, on: &str, stiffness: &str) -> Toml {
    toml.table(&format!("[[supports]]\non = \"{on}\"\ntype = \"spring\"\nstiffness = {stiffness}"))
}

fn layer(toml: Toml, [first, second]: [&str; 2], stiffness: [f64; 2]) -> Toml {
    toml.table(&format!("[[bonds]]\nbetween = [\"{first}\", \"{second}\"]\nstiffness = {stiffness:?}"))
}

fn turned(angle: f64, [x, y]: [f64; 2]) -> [f64; 2] {
    [x * angle.cos() - y * angle.sin(), x * angle.sin() + y * angle.cos()]
}

/// A block pressed and sheared uniformly, its foot not widening, moves as a whole by what springs give.
#[test]
fn a_uniform_traction_on_springs_has_the_energy_of_both() {
    for (angle, [kn, kt]) in [(0.0, [3.0, 0.5]), (0.7, [1e-3, 20.0]), (2.0, [1e6, 1e-2])] {
        let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]].map(|p| turned(angle, p));
        let (pressure, shear) = (0.3, 0.2);
        let side = -pressure / 3.0;
        let names = ["foot", "east", "top", "west"];
        let toml = Toml::default().size(0.6).polygon("b", &corners, names).material("b", 2.0, 0.25);
        let toml = springs(toml, "foot", &format!("[{kn:?}, {kt:?}]"))
            .traction("top", turned(angle, [shear, -pressure]))
            .traction("east", turned(angle, [side, shear]))
            .traction("west", turned(angle, [-side, -shear]));
        let [lower, upper] = ends(&solved(problem(&toml.text())));
        let strain = pressure * pressure / 2.4 + 2.0 * 0.625 * shear * shear;
        let stored = pressure * pressure / kn + shear * shear / kt;
        let energy = -(strain + stored);
        let close = 1e-10 * energy.abs();
        assert!(
            lower <= energy + close && energy <= upper + close && upper - lower < close,
            "{lower} {energy} {upper}"
        );
    }
}

/// Two blocks with a layer between them, one of them clamped.
fn two(stiffness: Option<[f64; 2]>) -> Toml {
    let toml = Toml::default()
        .size(0.35)
        .outline("a", &[[0.0, 0.0], [1.0, 0.1], [1.1, 1.0], [0.0, 1.0]], &["", "f", "", "west"])
        .outline("b", &[[1.0, 0.1], [2.0, 0.0], [2.0, 1.0], [1.1, 1.0], [1.06, 0.64]], &["", "east", "", "g", "g"])
        .clamp("west")
        .traction("east", [0.4, -0.3]);
    match stiffness {
        Some(stiffness) => layer(toml, ["f", "g"], stiffness),
        None => toml.table("[[bonds]]\nbetween = [\"f\", \"g\"]"),
    }
}

#[test]
fn stiff_springs_are_supports_and_stiff_layers_bonds() {
    let block = || {
        Toml::default()
            .size(0.4)
            .polygon("b", &[[0.0, 0.0], [2.0, 0.2], [2.0, 1.0], [0.0, 1.0]], ["foot", "", "top", "west"])
            .traction("top", [0.2, -0.5])
    };
    let cases = [
        (springs(block(), "foot", "[1e12, 1e12]"), block().clamp("foot")),
        (springs(block(), "foot", "1e12").clamp("west"), block().roller("foot").clamp("west")),
        (two(Some([1e12, 1e12])), two(None)),
    ];
    for (stiff, rigid) in cases {
        let [[a, b], [c, d]] = [stiff, rigid].map(|toml| ends(&solved(problem(&toml.text()))));
        assert!((a - c).abs() < 1e-9 * c.abs() && b <= d + 0.3 * (d - c) && b >= c, "{a} {b} {c} {d}");
    }
}

/// On soft springs a body moves as a whole, F²/2K, and its strains are those of a free body in balance, but for what its widening
/// foot stores in them.
#[test]
fn soft_springs_add_what_a_rigid_body_stores_in_them() {
    let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]];
    for k in [1e-3_f64, 1e-6, 1e-9] {
        let toml = Toml::default().size(0.5).polygon("b", &corners, ["foot", "", "top", ""]);
        let toml = springs(toml, "foot", &format!("[{k:?}, {k:?}]")).traction("top", [0.0, -0.5]);
        let [lower, upper] = ends(&solved(problem(&toml.text())));
        let energy: f64 = -0.5 * (0.5 * 0.5 / k * 2.0) - 0.5 * 2.0 * 0.91 * 0.25;
        let rounding = 1e-13 * energy.abs();
        assert!(energy - rounding <= upper && lower <= energy + 0.013 * k + rounding, "{lower} {energy} {upper}");
        assert!(upper - lower < 1e-5 * k + 1e-11 * energy.abs(), "{lower} {energy} {upper}");
    }
}

/// Of two mirrored halves with a layer between them each is on springs of twice the stiffness.
#[test]
fn half_of_a_symmetric_body_stands_on_springs_twice_as_stiff() {
    let half = [[0.0, 0.0], [1.0, 0.0], [0.8, 1.0], [0.0, 1.0]];
    let mirrored = half.map(|[x, y]| [-x, y]);
    let names = ["", "pull", "", "f"];
    let one = Toml::default().size(0.3).polygon("a", &half, names).roller("low");
    let one = one.text().replace("edges = [\"\", \"pull\"", "edges = [\"low\", \"pull\"");
    let one = format!(
        "{one}[[supports]]\non = \"f\"\ntype = \"spring\"\nstiffness = 4.0\n[[tractions]]\non = \"pull\"\nvalue = [0.3, 0.0]\n"
    );
    let both = Toml::default()
        .size(0.3)
        .polygon("a", &half, ["low", "pull", "", "f"])
        .polygon("b", &mirrored, ["deep", "push", "", "g"])
        .roller("low")
        .roller("deep")
        .traction("pull", [0.3, 0.0])
        .traction("push", [-0.3, 0.0]);
    let both = layer(both, ["f", "g"], [2.0, 7.0]);
    let ([a, b], [c, d]) = (ends(&solved(problem(&one))), ends(&solved(problem(&both.text()))));
    assert!((2.0 * a - c).abs() < 1e-10 * c.abs() && 2.0 * a <= d && c <= 2.0 * b, "{a} {b} {c} {d}");
}

/// A stack of bodies on springs with layers and contact between them, and quantities of all kinds.
fn random_scene(seed: u64) -> String {
    let mut random = Random::new(seed);
    let mut k = || format!("[{:?}, {:?}]", random.magnitude(-0.5, 2.5), random.magnitude(-0.5, 2.5));
    let (ground, glue, wall, held) = (k(), k(), k(), k());
    let mut random = Random::new(seed + 1000);
    let (low, high) = (random.between(0.4, 0.7), random.between(1.2, 1.6));
    let kinematics = random.pick(&["plane-strain", "plane-stress"]);
    let mut toml = Toml::default()
        .model(kinematics, random.between(0.5, 2.0))
        .size(random.between(0.3, 0.5))
        .outline("a", &[[0.0, 0.0], [1.0, 0.0], [1.0, low], [0.0, low]], &["foot", "", "over", "west"])
        .outline(
            "b",
            &[[0.0, low], [0.45, low], [1.0, low], [1.0, high], [0.0, high]],
            &["under", "under", "", "cover", "side"],
        )
        .outline("c", &[[0.0, high], [1.0, high], [1.0, 2.0], [0.0, 2.0]], &["sole", "", "top", ""])
        .material("a", random.magnitude(-1.0, 1.0), random.between(0.0, 0.45))
        .material("b", random.magnitude(-1.0, 1.0), random.between(0.0, 0.45))
        .force("b", [0.1, -0.2])
        .traction("top", [random.between(-0.1, 0.1), random.between(-0.6, -0.3)]);
    toml = springs(toml, "foot", &ground);
    toml = springs(toml, "side", &wall);
    toml = layer(toml, ["over", "under"], [1.0, 1.0]);
    toml = springs(toml, "held", &held).contact("cover", "sole");
    let text = toml.text().replace("stiffness = [1.0, 1.0]", &format!("stiffness = {glue}"));
    let text = text.replace("\"sole\", \"\", \"top\", \"\"]", "\"sole\", \"held\", \"top\", \"\"]");
    let asked = [
        "force = \"foot\"\ndirection = [0.6, 0.8]",
        "moment = \"side\"\nabout = [0.2, 0.1]",
        "force = \"cover|sole\"",
        "force = \"held\"\ndirection = [1, 0]",
        "displacement = \"foot\"\ndirection = [0, 1]",
        "displacement = \"b\"\ndirection = [1, 1]",
        "displacement = \"under\"\ndirection = [1, 0]",
        "stress = \"a\"\ncomponent = \"xy\"",
    ];
    let asked: Vec<String> =
        asked.iter().enumerate().map(|(i, what)| format!("[[quantities]]\nname = \"q{i}\"\n{what}\n")).collect();
    format!("{text}{}", asked.concat())
}

/// Energies and local terms say the same gap, finer meshes narrow the bracket, and intervals hold what far finer stresses say.
#[test]
fn brackets_and_intervals_hold_with_springs_layers_and_contact() {
    for seed in 0..3 {
        let coarse = problem(&random_scene(seed));
        let fine = coarse.refine_uniform(1).expect("a finer mesh");
        let mut outer = [f64::NEG_INFINITY, f64::INFINITY];
        let mut found = Vec::new();
        for problem in [coarse, fine] {
            let certified = solved(problem);
            let bracket = &certified.bracket;
            let [lower, upper] = ends(&certified);
            let local = bracket.free.as_ref().expect("an upper bound").local.total;
            let stored = bracket.complementary.stored();
            assert!((upper - lower - local).abs() < 1e-9 * stored, "{seed}: {} {local}", upper - lower);
            assert!(outer[0] <= lower && upper <= outer[1] && lower < upper, "{seed}: {outer:?} {lower} {upper}");
            outer = [lower, upper];
            found.push(answers(&certified, &Options::default(), |_| true));
        }
        for (wide, narrow) in found[0].iter().zip(&found[1]) {
            let ([a, b], [c, d]) = (wide.interval.ends, narrow.interval.ends);
            assert!(a < b && c < d && a <= d && c <= b, "{seed} {}: {a} {b} {c} {d}", wide.name);
            let value = narrow.interval.value;
            assert!(wide.interval.outside(value) == 0.0, "{seed} {}: {value} is not in {a} … {b}", wide.name);
            assert!(
                d - c < 0.9 * (b - a) || d - c < 1e-7 * value.abs().max(1e-3),
                "{seed} {}: {a} {b} {c} {d}",
                wide.name
            );
        }
    }
}

/// Refinement of a few triangles on one side of a layer divides the edges of the other with them, and brackets nest.
#[test]
fn both_sides_of_a_layer_are_divided_together() {
    let mut coarse = problem(&two(Some([7.0, 2.0])).text());
    let mut edges = RefinementEdges::longest(&coarse.mesh);
    let mut before = ends(&solved(coarse.clone()));
    for _ in 0..3 {
        let beside = coarse.bed_pairs().next().map(|(pair, _)| pair.edge).expect("a layer");
        let marked = coarse.mesh.edges[beside].triangles[0].expect("a triangle");
        let (finer, next, _) = coarse.bisect(&edges, &[marked]).expect("sides that match");
        (coarse, edges) = (finer, next);
        let now = ends(&solved(coarse.clone()));
        let room = 1e-10 * now[0].abs();
        assert!(
            before[0] - room <= now[0] && now[0] <= now[1] + room && now[1] <= before[1] + room,
            "{before:?} {now:?}"
        );
        before = now;
    }
}

#[test]
fn what_springs_cannot_be_is_refused() {
    let scene = |stiffness: &str, more: &str| {
        let toml = Toml::default().polygon("b", &[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], ["foot", "", ""]);
        let text = toml.table(&format!("[[supports]]\non = \"foot\"\ntype = \"spring\"\n{stiffness}\n{more}")).text();
        Scene::parse(&text, "scene.toml".as_ref()).expect_err("no scene").to_string()
    };
    for (stiffness, more, word) in [
        ("", "", "no `stiffness`"),
        ("stiffness = 0", "", "hold nothing"),
        ("stiffness = [0.0, 0.0]", "", "hold nothing"),
        ("stiffness = [1.0, -1.0]", "", "negative"),
        ("stiffness = [1.0]", "", "component"),
        ("stiffness = 1.0", "displacement = 0.1", "displacement"),
        ("stiffness = 1.0", "direction = [0.0, 1.0]", "direction"),
    ] {
        let found = scene(stiffness, more);
        assert!(found.contains(word), "{found}");
    }
}
