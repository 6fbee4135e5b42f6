//! Gaps that are circles and parabolas: brackets of coarse meshes hold what fine ones find.

use crate::support::random::{Random, scenes_or};
use crate::support::toml::Toml;
use hypercircle::bounds::Bracket;
use hypercircle::dual::{self, Condensed, Options};
use hypercircle::element::{Elements, block};
use hypercircle::problem::Problem;
use hypercircle::scene::{Gap, Scene, Touching};
use hypercircle::study::{Adapt, Goal, adapt};

/// A block over an obstacle or over another block, pressed down by its top or by a load on it.
struct Pressed {
    rigid: bool,
    moved: bool,
    /// Where sides are matched along the upright direction.
    along: bool,
    size: f64,
    force: f64,
}

impl Pressed {
    fn random(random: &mut Random) -> Self {
        Pressed {
            rigid: random.chance(0.5),
            moved: random.chance(0.5),
            along: random.chance(0.5),
            size: random.between(0.9, 2.2),
            force: random.between(0.02, 0.08),
        }
    }

    fn problem(&self, gap: &str) -> Problem {
        let mut text = Toml::default()
            .size(self.size)
            .polygon("upper", &[[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [0.0, 2.0]], ["foot", "", "top", "axis"])
            .roller("axis");
        if !self.rigid {
            text = text
                .polygon("lower", &[[0.0, -2.0], [4.0, -2.0], [4.0, 0.0], [0.0, 0.0]], ["ground", "", "seat", "side"])
                .clamp("ground")
                .roller("side");
        }
        text = match self.moved {
            true => text.table(&format!(
                "[[supports]]\non = \"top\"\ntype = \"clamped\"\ndisplacement = [0.0, {:?}]",
                -self.force
            )),
            false => text.pressure("top", self.force),
        };
        let sides = match (self.rigid, self.along) {
            (true, _) => "on = \"foot\"",
            (false, true) => "between = [\"foot\", \"seat\"]\ndirection = [0.0, -1.0]",
            (false, false) => "between = [\"foot\", \"seat\"]",
        };
        let text = text.table(&format!("[[contacts]]\n{sides}\ngap = {gap}")).text();
        let scene = Scene::parse(&text, "scene.toml".as_ref()).unwrap_or_else(|e| panic!("{e}\n{text}"));
        Problem::load(scene).expect("a problem")
    }
}

/// The lower and the upper bound.
fn bracket(problem: &Problem, degree: usize) -> [f64; 2] {
    let options = Options { elements: Elements::Uniform(block(degree)), ..Options::default() };
    let dual = dual::solve(&Condensed::default(), problem, &[], &options).expect("solves");
    ends(&Bracket::new(problem, &dual))
}

fn ends(bracket: &Bracket) -> [f64; 2] {
    [bracket.lower(), bracket.free.as_ref().expect("an upper bound").upper()]
}

/// The bracket of a run towards `tolerance`.
fn adapted(problem: &Problem, tolerance: f64, with: Adapt) -> [f64; 2] {
    let goal = Goal { adapt: with, ..Goal::new(tolerance) };
    let adapted = adapt(problem.clone(), &Condensed::default(), &Options::default(), &goal, |_| ()).expect("solves");
    assert_eq!(adapted.stopped, None);
    assert!(adapted.certified.problem.notes.iter().all(|note| !note.weakens_guarantee));
    ends(&adapted.certified.bracket)
}

fn holds([lower, upper]: [f64; 2], [from, to]: [f64; 2]) -> bool {
    let middle = 0.5 * (from + to);
    lower <= middle && middle <= upper && lower <= to && from <= upper
}

#[test]
fn coarse_brackets_hold_the_middle_of_fine_ones() {
    for seed in 0..scenes_or(2) as u64 {
        let mut random = Random::new(seed);
        let pressed = Pressed::random(&mut random);
        let (radius, at) = (random.between(3.0, 12.0), random.between(0.0, 2.5));
        for curve in ["circle", "parabola"] {
            let coarse = pressed.problem(&format!("{{ {curve} = {radius:?}, at = {at:?} }}"));
            let fine = adapted(&coarse, 1e-3, Adapt::Hp);
            for degree in 1..=4 {
                let found = bracket(&coarse, degree);
                println!("seed {seed}, {curve}, degree {degree}: {found:?} and {fine:?}");
                assert!(holds(found, fine), "seed {seed}, {curve}, degree {degree}: {found:?} and {fine:?}");
            }
            for tolerance in [0.1, 0.02] {
                for with in [Adapt::H, Adapt::Hp] {
                    let found = adapted(&coarse, tolerance, with);
                    assert!(holds(found, fine), "seed {seed}, {curve}, {tolerance}: {found:?} and {fine:?}");
                }
            }
        }
    }
}

/// Energies grow where gaps shrink: a table of chords lies above a curve, one of a parabola's tangents below it and below the
/// circle of that radius. The stresses of neither know of curves.
#[test]
fn tables_of_chords_and_of_tangents_enclose_a_curve() {
    let step = 0.125;
    for seed in 20..23 {
        let mut random = Random::new(seed);
        let pressed = Pressed { size: 1.3, ..Pressed::random(&mut random) };
        let touching = Touching { radius: random.between(6.0, 12.0), at: step * random.below(20) as f64 };
        let nodes = || (0..=32).map(|k| f64::from(k) * step);
        let tangents: Vec<[f64; 2]> = nodes()
            .take(32)
            .map(|s| [s + 0.5 * step, (s - touching.at) * (s + step - touching.at) / (2.0 * touching.radius)])
            .collect();
        let [_, above] = bracket(&pressed.problem(&format!("{tangents:?}")), 3);
        for (name, gap) in [("circle", Gap::Circle(touching)), ("parabola", Gap::Parabola(touching))] {
            let chords: Vec<[f64; 2]> = nodes().map(|s| [s, gap.at(s)]).collect();
            let [below, _] = bracket(&pressed.problem(&format!("{chords:?}")), 3);
            let curve = format!("{{ {name} = {:?}, at = {:?} }}", touching.radius, touching.at);
            for [lower, upper] in [1, 3].map(|degree| bracket(&pressed.problem(&curve), degree)) {
                println!("seed {seed}, {name}: [{below}, {above}] and [{lower}, {upper}]");
                assert!(
                    below <= upper && lower <= above,
                    "seed {seed}, {name}: [{below}, {above}], [{lower}, {upper}]"
                );
            }
        }
    }
}

/// Hertz by h and by hp, towards 1 %, 0.3 % and 0.1 %.
#[test]
fn brackets_of_hertz_hold_each_other_s_middles() {
    let pressed = Pressed { rigid: true, moved: false, along: false, size: 2.0, force: 0.02 };
    for curve in ["circle", "parabola"] {
        let problem = pressed.problem(&format!("{{ {curve} = 10.0, at = 0.0 }}"));
        let tolerances = [0.01, 0.003, 0.001];
        let found: Vec<[f64; 2]> = [Adapt::H, Adapt::Hp]
            .into_iter()
            .flat_map(|with| tolerances.map(|tolerance| adapted(&problem, tolerance, with)))
            .collect();
        let width = |of: &[f64; 2]| of[1] - of[0];
        for wide in &found {
            for narrow in found.iter().filter(|narrow| width(narrow) < 0.25 * width(wide)) {
                assert!(holds(*wide, *narrow), "{curve}: {wide:?} and {narrow:?}");
            }
            for other in &found {
                assert!(wide[0] <= other[1] && other[0] <= wide[1], "{curve}: {wide:?} and {other:?}");
            }
        }
    }
}
