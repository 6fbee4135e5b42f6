//! Contacts with a given friction bound, against closed answers, against contact that sticks or slides freely, and against themselves.

use crate::support::random::Random;
use crate::support::toml::Toml;
use hypercircle::dual::{ActiveSet, Condensed, DualMethod, Options};
use hypercircle::element::{Elements, block};
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;
use hypercircle::study::{Certified, StudyError, certify};

fn problem(text: &str) -> Problem {
    let scene = Scene::parse(text, "scene.toml".as_ref()).unwrap_or_else(|e| panic!("{e}\n{text}"));
    Problem::load(scene).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn tried(text: &str, method: &dyn DualMethod, degree: usize) -> Result<Certified, StudyError> {
    let problem = problem(text);
    certify(problem, method, &Options { elements: Elements::Uniform(block(degree)), ..Options::default() })
}

fn solved(text: &str, degree: usize) -> Certified {
    tried(text, &Condensed::default(), degree).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn ends(certified: &Certified) -> [f64; 2] {
    let bracket = &certified.bracket;
    [bracket.lower(), bracket.free.as_ref().expect("an upper bound").upper()]
}

/// By how much the gap from energies and from local terms differ, relative to the energies.
fn two_ways(certified: &Certified) -> f64 {
    let (bracket, free) = (&certified.bracket, certified.bracket.free.as_ref().expect("an upper bound"));
    let gap = free.potential.total() - bracket.complementary.lower();
    (gap - free.local.total).abs() / (free.potential.magnitude + bracket.complementary.magnitude)
}

fn turned(angle: f64, [x, y]: [f64; 2]) -> [f64; 2] {
    [x * angle.cos() - y * angle.sin(), x * angle.sin() + y * angle.cos()]
}

fn contact(toml: Toml, keys: &str) -> Toml {
    toml.table(&format!("[[contacts]]\n{keys}"))
}

/// A strip that is held by friction on both faces along a length L and pulled at one end: with ν = 0 and a stiff strip it slides along
/// P/2τ from that end, where the stress falls linearly, and energies are those of a bar on a rigid foundation,
/// 𝓛 = −½ ∫ σ²/E − 0 with σ = P − 2τx/h: −P³/(12 τ E) for a strip of height h = 1 over half its faces (the rest is symmetry).
#[test]
fn a_bar_bonded_by_friction_slides_as_far_as_its_load_asks() {
    // A slender strip on a rigid ground below and rollers above it: σ_x is uniform across, and shear costs little.
    let (load, bound, height, young) = (0.3, 0.02, 0.02, 1.0);
    let strip = [[0.0, 0.0], [1.0, 0.0], [1.0, height], [0.0, height]];
    let toml = Toml::default()
        .size(0.01)
        .model("plane-stress", 1.0)
        .polygon("bar", &strip, ["foot", "pull", "top", "end"])
        .material("bar", young, 0.0)
        .roller("top")
        .traction("pull", [load, 0.0]);
    let toml = contact(toml, &format!("on = \"foot\"\nfriction = {{ bound = {bound:?} }}"));
    let certified = solved(&toml.text(), 2);
    let [lower, upper] = ends(&certified);
    // F = load · height falls by `bound` per length: it slides along F / bound, and stores ∫ F(x)²/2Eh there.
    let force = load * height;
    let stored = force.powi(3) / (6.0 * bound * young * height);
    // Shear across the strip, τ²h/3G per length at most, is what the bar leaves out.
    let shear = bound * bound * height / 3.0 * 2.0 / young * (force / bound);
    assert!(lower <= -stored + 1e-12 && upper >= -stored - shear, "{lower} {upper} {stored} {shear}");
    assert!(upper - lower < 0.02 * stored, "{lower} {upper}");
    assert!(two_ways(&certified) < 1e-9);
}

/// Support of the upper block where friction does not hold it.
const SPRING: &str = "[[supports]]\non = \"side\"\ntype = \"spring\"\nstiffness = [0.5, 0.1]";

/// One block on another one, pressed and pushed, turned by an angle; the two meet along a line or along a kinked one.
fn blocks(angle: f64, kinked: bool, friction: Option<f64>, gap: f64, push: f64) -> Toml {
    let at = |points: &[[f64; 2]]| points.iter().map(|p| turned(angle, *p)).collect::<Vec<_>>();
    let middle = if kinked { 1.2 } else { 1.0 };
    let low = at(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, middle], [0.0, 1.0]]);
    let high = at(&[[0.0, 1.0], [1.0, middle], [2.0, 1.0], [1.8, 2.0], [0.2, 2.0]]);
    let toml = Toml::default()
        .size(0.45)
        .outline("low", &low, &["floor", "", "top", "top", ""])
        .outline("high", &high, &["foot", "foot", if kinked { "side" } else { "" }, "load", "push"])
        .material("low", 3.0, 0.2)
        .clamp("floor")
        .table(if kinked { SPRING } else { "" })
        .traction("load", turned(angle, [0.0, -0.3]))
        .traction("push", turned(angle, [push, 0.0]));
    let friction = friction.map_or_else(String::new, |bound| format!("friction = {{ bound = {bound:?} }}"));
    contact(toml, &format!("between = [\"top\", \"foot\"]\ngap = {gap:?}\n{friction}"))
}

#[test]
fn no_bound_is_no_friction_and_a_large_one_sticks() {
    for (angle, normals) in [(0.0, "smooth"), (0.7, "facets")] {
        let text = |f: Option<f64>| {
            blocks(angle, true, f, 0.0, 0.05).text().replace("gap = 0.0", &format!("normals = \"{normals}\""))
        };
        let [free, none] = [None, Some(0.0)].map(|f| ends(&solved(&text(f), 1)));
        assert_eq!(free, none);
        let all: Vec<[f64; 2]> = [1e-12, 1e-9, 1e9, 1e12].map(|f| ends(&solved(&text(Some(f)), 1))).into();
        let close = |a: [f64; 2], b: [f64; 2], part: f64| {
            assert!((a[0] - b[0]).abs() <= part * b[0].abs(), "{a:?} {b:?}");
            assert!((a[1] - b[1]).abs() <= 0.2 * (b[1] - b[0]), "{a:?} {b:?}");
        };
        close(all[0], free, 1e-10);
        close(all[1], free, 1e-7);
        close(all[2], all[3], 1e-12);
        // Nothing opens under the load: what sticks is bonded. Where the direction turns, contact has fewer tractions than a bond.
        let bonded = text(None).replace("[[contacts]]", "[[bonds]]").replace("normals = \"facets\"\n", "");
        if normals == "facets" {
            close(all[3], ends(&solved(&bonded, 1)), 1e-9);
        }
    }
}

#[test]
fn energies_grow_with_the_bound() {
    for (angle, degree) in [(0.0, 1), (0.3, 2)] {
        let mut last: Option<[f64; 2]> = None;
        for bound in [0.0, 1e-3, 0.01, 0.02, 0.04, 0.08, 0.2, 1.0] {
            let now = ends(&solved(&blocks(angle, true, Some(bound), 0.0, 0.2).text(), degree));
            if let Some(last) = last {
                assert!(now[0] >= last[0] - 1e-12 && now[1] >= last[0], "{last:?} {now:?} at {bound}");
            }
            last = Some(now);
        }
    }
}

/// A scene with friction drawn at random: blocks on each other or on rigid ground, sides that match or do not, gaps, obstacles, cracks.
fn random_scene(seed: u64) -> (String, usize) {
    let mut random = Random::new(seed);
    let degree = 1 + random.below(3);
    let angle = if random.chance(0.5) { 0.0 } else { random.between(-3.0, 3.0) };
    let bound = match random.below(3) {
        0 => format!("{:?}", random.magnitude(-3.0, 0.5)),
        1 => format!("[[0.3, {:?}], [1.1, {:?}]]", random.magnitude(-2.0, 0.0), random.between(0.0, 0.2)),
        _ => format!("[[0.2, 0.0], [0.9, {:?}], [1.6, 0.0]]", random.magnitude(-2.0, 0.0)),
    };
    let (push, press) = (random.between(-0.2, 0.2), -random.between(0.0, 0.4));
    let gap = if random.chance(0.3) { random.between(0.0, 0.05) } else { 0.0 };
    let friction = format!("friction = {{ bound = {bound} }}");
    let at = |points: &[[f64; 2]]| points.iter().map(|p| turned(angle, *p)).collect::<Vec<_>>();
    let toml = Toml::default().size(random.between(0.4, 0.7));
    let toml = match random.below(4) {
        0 => {
            // Held at its side, on rigid ground.
            let toml = toml
                .outline("b", &at(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]]), &["foot", "push", "load", "wall"])
                .table(&format!(
                    "[[supports]]\non = \"wall\"\ntype = \"spring\"\nstiffness = [{:?}, 0.1]",
                    random.magnitude(-1.0, 1.0)
                ));
            contact(toml, &format!("on = \"foot\"\ngap = {gap:?}\n{friction}"))
        }
        1 => {
            let high = at(&[[0.3, 1.0 + gap], [1.5, 1.0 + gap], [1.5, 2.0], [0.3, 2.0]]);
            let toml = toml
                .outline("low", &at(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]]), &["floor", "", "top", ""])
                .outline("high", &high, &["foot", "", "load", "push"])
                .table("[[supports]]\non = \"floor\"\ntype = \"clamped\"\n[[supports]]\non = \"load\"\ntype = \"spring\"\nstiffness = [0.1, 0.1]")
                .traction("push", turned(angle, [push, press]));
            let direction = turned(angle, [0.0, -1.0]);
            return (
                contact(toml, &format!("between = [\"foot\", \"top\"]\ndirection = {direction:?}\n{friction}")).text(),
                degree,
            );
        }
        2 => {
            // A crack from the edge to the middle.
            let toml = toml
                .outline(
                    "b",
                    &at(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [0.0, 1.0]]),
                    &["wall", "", "", "upper", ""],
                )
                .outline(
                    "b",
                    &at(&[[0.0, 1.0], [1.0, 1.0], [2.0, 1.0], [2.0, 2.0], [0.0, 2.0]]),
                    &["lower", "", "", "load", "push"],
                )
                .clamp("wall");
            contact(toml, &format!("between = [\"upper\", \"lower\"]\n{friction}"))
        }
        _ => {
            let toml = toml
                .outline("low", &at(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]]), &["floor", "", "top", ""])
                .outline(
                    "high",
                    &at(&[[0.0, 1.0], [2.0, 1.0], [2.0, 2.0], [0.0, 2.0]]),
                    &["foot", "side", "load", "push"],
                )
                .material("high", random.magnitude(-1.0, 1.0), random.between(0.0, 0.49))
                .clamp("floor")
                .table(&format!(
                    "[[supports]]\non = \"side\"\ntype = \"spring\"\nstiffness = [{:?}, 0.0]",
                    random.magnitude(-1.0, 1.0)
                ));
            contact(toml, &format!("between = [\"top\", \"foot\"]\ngap = {gap:?}\n{friction}"))
        }
    };
    let toml = toml.traction("load", turned(angle, [0.3 * push, press])).traction("push", turned(angle, [push, 0.0]));
    (toml.text(), degree)
}

#[test]
fn random_scenes_have_their_gap_both_ways() {
    let mut decided = 0;
    for seed in 0..60 {
        let (text, degree) = random_scene(seed);
        let certified = match tried(&text, &Condensed::default(), degree) {
            Ok(certified) => certified,
            Err(StudyError::NoEquilibrium { .. }) => continue,
            Err(other) => panic!("seed {seed}: {other}\n{text}"),
        };
        decided += 1;
        let [lower, upper] = ends(&certified);
        assert!(lower <= upper && two_ways(&certified) < 1e-9, "seed {seed}: {lower} {upper} {}", two_ways(&certified));
        let local = &certified.bracket.free.as_ref().expect("an upper bound").local;
        assert!(local.pairs.iter().flatten().all(|term| *term >= -1e-12 * upper.abs()), "seed {seed}");
        if seed % 4 == 0 {
            let other = tried(&text, &ActiveSet::default(), degree).unwrap_or_else(|e| panic!("seed {seed}: {e}"));
            let [again, _] = ends(&other);
            assert!((again - lower).abs() <= 1e-9 * lower.abs(), "seed {seed}: {again} {lower}");
        }
    }
    assert!(decided > 40, "{decided}");
}

#[test]
fn a_block_that_is_pushed_too_hard_slides_away() {
    let toml = blocks(0.3, false, Some(0.05), 0.0, 0.2);
    let error = tried(&toml.text(), &Condensed::default(), 1).expect_err("no equilibrium").to_string();
    assert!(error.contains("slides") && error.contains("friction resists with 0.1"), "{error}");
    // Just enough.
    let [lower, upper] = ends(&solved(&blocks(0.3, false, Some(0.105), 0.0, 0.2).text(), 2));
    assert!(lower <= upper);
}
