//! Twenty scenes at the border of equilibrium, from scene file to verdict: a millionth of the load outside, no
//! equilibrium exists and the sentence names body and motion; a millionth inside, the scene is solved.

use crate::support::toml::Toml;
use hypercircle::dual::{Condensed, DualError, Options};
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;
use hypercircle::statics::{Solvability, check};
use hypercircle::study::{Goal, StudyError, adapt, certify};

struct Case {
    name: &'static str,
    /// The scene in which the driving load is 1 + the argument times the load that can be held.
    scene: fn(f64) -> Toml,
    body: &'static str,
    motion: &'static str,
}

fn square(x: f64, y: f64, width: f64, height: f64) -> Vec<[f64; 2]> {
    vec![[x, y], [x + width, y], [x + width, y + height], [x, y + height]]
}

fn cases() -> Vec<Case> {
    let case = |name, scene, body, motion| Case { name, scene, body, motion };
    vec![
        case("lifted by its top", lifted, "top", "lifts off its contact `top_foot|base_top` in direction (0, 1)"),
        case("pulled off on rollers", pulled, "right", "lifts off its contact `face|right_face` in direction (1, 0)"),
        case("overhang to the right", |x| overhang(x, 1.0, 1.0), "beam", "tips clockwise about (3, 1)"),
        case("overhang to the left", |x| overhang(x, -1.0, 1.0), "beam", "tips counter-clockwise about (-3, 1)"),
        case("overhang in millimetres", |x| overhang(x, 1.0, 1e3), "beam", "tips clockwise about (3000, 1000)"),
        case("beam on two posts", on_two_posts, "beam", "tips clockwise about (3, 1)"),
        case("leaning tower", tower, "tower", "tips clockwise about (1, 1)"),
        case("held up against a ceiling", ceiling, "block", "lifts off its contact `top|rigid` in direction (0, -1)"),
        case("guided upwards", guided, "block", "lifts off its contact `foot|rigid` in direction (0, 1)"),
        case("last of a row", |x| row(x, 2), "c", "lifts off its contact `b_right|c_left` in direction (1, 0)"),
        case("middle of a row", |x| row(x, 1), "b", "lifts off its contact `a_right|b_left` in direction (1, 0)"),
        case("wedge", wedge, "wedge", "lifts off its contact"),
        case("pulled up an incline", incline, "block", "in direction (0.8, 0.6)"),
        case("couple", couple, "block", "tips counter-clockwise about (1, 0.5)"),
        case("seesaw", seesaw, "bar", "tips clockwise about (1, 0)"),
        case("pressure under a lid", lid, "lid", "in direction (0, 1)"),
        case("bracket", bracket, "bracket", "tips clockwise about (1, 0)"),
        case("between two and a stop", between, "middle", "in direction (-1, 0)"),
        case("pushed over against a stop", pushed_over, "block", "tips clockwise about (1, 0.5)"),
        case("lifted at one side", lifted_at_one_side, "top", "tips counter-clockwise about (0, 1)"),
    ]
}

fn lifted(x: f64) -> Toml {
    Toml::default()
        .polygon("base", &square(0.0, 0.0, 1.0, 1.0), ["floor", "", "base_top", ""])
        .polygon("top", &square(0.0, 1.0, 1.0, 1.0), ["top_foot", "", "pull", ""])
        .force("top", [0.0, -1.0])
        .clamp("floor")
        .traction("pull", [0.0, 1.0 + x])
        .contact("top_foot", "base_top")
}

fn pulled(x: f64) -> Toml {
    Toml::default()
        .polygon("left", &square(0.0, 0.0, 1.0, 1.0), ["", "face", "", "wall"])
        .polygon("right", &square(1.0, 0.0, 1.0, 1.0), ["rollers", "push", "", "right_face"])
        .force("right", [1.0 + x, 0.0])
        .clamp("wall")
        .roller("rollers")
        .traction("push", [-1.0, 0.0])
        .contact("face", "right_face")
}

/// A beam of length 4 on a base of length 3, loaded beyond its end; mirrored for `side` = −1, in units of 1/`unit`.
fn overhang(x: f64, side: f64, unit: f64) -> Toml {
    let at = |points: &[[f64; 2]]| points.iter().map(|p| [side * unit * p[0], unit * p[1]]).collect::<Vec<_>>();
    let beam = at(&[[0.0, 1.0], [3.0, 1.0], [4.0, 1.0], [4.0, 2.0], [3.0, 2.0], [0.0, 2.0]]);
    Toml::default()
        .polygon("base", &at(&square(0.0, 0.0, 3.0, 1.0)), ["floor", "", "seat", ""])
        .polygon("beam", &beam, ["foot", "", "", "load", "", ""])
        .force("beam", [0.0, -0.125 / unit])
        .clamp("floor")
        .traction("load", [0.0, -1.0 - x])
        .contact("seat", "foot")
}

fn on_two_posts(x: f64) -> Toml {
    let beam = [[0.0, 1.0], [1.0, 1.0], [2.0, 1.0], [3.0, 1.0], [4.0, 1.0], [4.0, 2.0], [3.0, 2.0], [0.0, 2.0]];
    Toml::default()
        .polygon("first", &square(0.0, 0.0, 1.0, 1.0), ["floor_1", "", "seat_1", ""])
        .polygon("second", &square(2.0, 0.0, 1.0, 1.0), ["floor_2", "", "seat_2", ""])
        .polygon("beam", &beam, ["foot_1", "", "foot_2", "", "", "load", "", ""])
        .force("beam", [0.0, -0.125])
        .clamp("floor_1")
        .clamp("floor_2")
        .traction("load", [0.0, -1.0 - x])
        .contact("seat_1", "foot_1")
        .contact("seat_2", "foot_2")
}

fn tower(x: f64) -> Toml {
    let lean = 1.0 + x;
    Toml::default()
        .polygon("base", &square(0.0, 0.0, 1.0, 1.0), ["floor", "", "seat", ""])
        .polygon("tower", &[[0.0, 1.0], [1.0, 1.0], [1.0 + lean, 2.0], [lean, 2.0]], ["foot", "", "", ""])
        .force("tower", [0.0, -1.0])
        .clamp("floor")
        .contact("seat", "foot")
}

fn ceiling(x: f64) -> Toml {
    Toml::default()
        .polygon("block", &square(0.0, 0.0, 3.0, 1.0), ["push", "", "top", ""])
        .force("block", [0.0, -1.0 - x])
        .traction("push", [0.0, 1.0])
        .rigid("top")
}

fn guided(x: f64) -> Toml {
    Toml::default()
        .polygon("block", &square(0.0, 0.0, 1.0, 5.0), ["foot", "pull", "", "rail"])
        .force("block", [0.0, -1.0])
        .roller("rail")
        .traction("pull", [0.0, 1.0 + x])
        .rigid("foot")
}

/// Three blocks on rollers, drawn against a wall, one of them pulled away.
fn row(x: f64, pulled: usize) -> Toml {
    let mut toml = Toml::default();
    for (i, name) in ["a", "b", "c"].into_iter().enumerate() {
        let edges = ["rollers", "right", "top", "left"].map(|side| format!("{name}_{side}"));
        let edges = [0, 1, 2, 3].map(|k| edges[k].as_str());
        toml = toml.polygon(name, &square(i as f64, 0.0, 1.0, 1.0), edges).force(name, [-1.0, 0.0]).roller(edges[0]);
        if i == pulled {
            toml = toml.traction(edges[2], [(3 - i) as f64 * (1.0 + x), 0.0]);
        }
    }
    toml.rigid("a_left").contact("a_right", "b_left").contact("b_right", "c_left")
}

fn wedge(x: f64) -> Toml {
    Toml::default()
        .polygon("wedge", &[[0.0, 0.0], [2.0, 0.0], [2.0, 1.5], [0.0, 0.5]], ["foot", "stop", "slope", ""])
        .polygon("block", &[[0.0, 0.5], [2.0, 1.5], [2.0, 3.0], [0.0, 3.0]], ["sole", "", "", "rail"])
        .force("wedge", [-1.0 - x, 0.0])
        .force("block", [0.0, -1.0])
        .roller("rail")
        .rigid("foot")
        .rigid("stop")
        .contact("slope", "sole")
}

fn incline(x: f64) -> Toml {
    let at = |s: f64, t: f64| [0.8 * s - 0.6 * t, 0.6 * s + 0.8 * t];
    let block = [at(1.0, 0.0), at(2.0, 0.0), at(2.0, 1.0), at(1.0, 1.0)];
    Toml::default()
        .polygon(
            "ramp",
            &[[0.0, 0.0], [2.4, -1.0], at(3.0, 0.0), at(2.0, 0.0), at(1.0, 0.0)],
            ["floor", "", "", "slope", ""],
        )
        .polygon("block", &block, ["sole", "pull", "", "stop"])
        .force("block", [0.0, -1.0 / 0.6])
        .clamp("floor")
        .traction("pull", [0.8 * (1.0 + x), 0.6 * (1.0 + x)])
        .rigid("stop")
        .contact("sole", "slope")
}

fn couple(x: f64) -> Toml {
    let corners = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [0.0, 1.0]];
    Toml::default()
        .polygon("block", &corners, ["up", "foot", "right", "down", "head", "left"])
        .traction("up", [0.0, 1.0])
        .traction("down", [0.0, -1.0])
        .traction("left", [0.0, -0.5 * (1.0 + x)])
        .traction("right", [0.0, 0.5 * (1.0 + x)])
        .rigid("foot")
        .rigid("head")
}

fn seesaw(x: f64) -> Toml {
    let bar = [[-2.0, 0.0], [-1.0, 0.0], [0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [-1.0, 1.0], [-2.0, 1.0]];
    Toml::default()
        .polygon("post", &square(0.0, -1.0, 1.0, 1.0), ["floor", "", "pivot", ""])
        .polygon("bar", &bar, ["rest", "", "seat", "", "", "", "pull", ""])
        .force("bar", [0.0, -0.25])
        .clamp("floor")
        .traction("pull", [0.0, 0.4 * (1.0 + x)])
        .rigid("rest")
        .contact("seat", "pivot")
}

fn lid(x: f64) -> Toml {
    let lid = [[0.0, 1.0], [1.0, 1.0], [2.0, 1.0], [3.0, 1.0], [3.0, 2.0], [0.0, 2.0]];
    Toml::default()
        .polygon("left", &square(0.0, 0.0, 1.0, 1.0), ["floor_1", "", "rim_1", ""])
        .polygon("right", &square(2.0, 0.0, 1.0, 1.0), ["floor_2", "", "rim_2", ""])
        .polygon("lid", &lid, ["seat_1", "below", "seat_2", "", "", ""])
        .force("lid", [0.0, -1.0])
        .clamp("floor_1")
        .clamp("floor_2")
        .pressure("below", 3.0 * (1.0 + x))
        .contact("seat_1", "rim_1")
        .contact("seat_2", "rim_2")
}

fn bracket(x: f64) -> Toml {
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 2.0], [3.0, 2.0], [3.0, 3.0], [1.0, 3.0], [0.0, 3.0]];
    Toml::default()
        .polygon("bracket", &corners, ["foot", "", "", "", "", "weight", ""])
        .force("bracket", [0.0, -1.0 - x])
        .traction("weight", [0.0, -1.0])
        .rigid("foot")
}

fn between(x: f64) -> Toml {
    Toml::default()
        .polygon("bottom", &square(0.0, 0.0, 2.0, 1.0), ["floor", "", "bottom_top", ""])
        .polygon("middle", &square(0.0, 1.0, 2.0, 1.0), ["middle_foot", "stop", "middle_top", "push"])
        .polygon("top", &square(0.0, 2.0, 2.0, 1.0), ["top_foot", "", "", ""])
        .force("middle", [-0.5 * (1.0 + x), -1.0])
        .force("top", [0.0, -1.0])
        .clamp("floor")
        .traction("push", [1.0, 0.0])
        .rigid("stop")
        .contact("bottom_top", "middle_foot")
        .contact("middle_top", "top_foot")
}

fn pushed_over(x: f64) -> Toml {
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.5], [1.0, 2.0], [0.0, 2.0], [0.0, 1.0]];
    Toml::default()
        .polygon("block", &corners, ["foot", "stop", "", "", "push", ""])
        .force("block", [0.0, -1.0])
        .traction("push", [1.0 + x, 0.0])
        .rigid("foot")
        .rigid("stop")
}

fn lifted_at_one_side(x: f64) -> Toml {
    let top = [[0.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.5, 2.0], [0.0, 2.0]];
    Toml::default()
        .polygon("base", &square(0.0, 0.0, 1.0, 1.0), ["floor", "", "seat", ""])
        .polygon("top", &top, ["foot", "", "pull", "", ""])
        .force("top", [0.0, -1.0])
        .clamp("floor")
        .traction("pull", [0.0, 4.0 / 3.0 * (1.0 + x)])
        .contact("foot", "seat")
}

fn problem(toml: &Toml) -> Problem {
    let text = toml.text();
    let scene = Scene::parse(&text, "scene.toml".as_ref()).unwrap_or_else(|e| panic!("{e}\n{text}"));
    Problem::load(scene).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

#[test]
fn outside_the_border_body_and_motion_are_named() {
    assert_eq!(cases().len(), 20);
    for case in cases() {
        for excess in [1e-6, 0.1] {
            match certify(problem(&(case.scene)(excess)), &Condensed::default(), &Options::default()) {
                Err(StudyError::NoEquilibrium { sentence, work, motion, .. }) => {
                    assert!(work > 0.0, "{}", case.name);
                    assert!(motion.iter().flatten().any(|u| u.abs() > 0.5), "{}: a picture shows nothing", case.name);
                    let named = sentence.to_lowercase().contains(&format!("body `{}` ", case.body));
                    assert!(named && sentence.contains(case.motion), "{} by {excess}: {sentence}", case.name);
                }
                other => panic!("{} by {excess}: {:?}", case.name, other.map(|c| c.statics.equilibrium)),
            }
        }
    }
}

#[test]
fn inside_the_border_an_equilibrium_is_found() {
    for case in cases() {
        for excess in [-1e-6, -1e-3, -0.1] {
            let verdict = check(&problem(&(case.scene)(excess))).expect("decided").equilibrium;
            assert!(matches!(verdict, Solvability::Possible { .. }), "{} by {excess}: {verdict:?}", case.name);
        }
    }
}

/// Inside by ever less, bodies stand on ever less of their base, down to the last millionth: the mesh is refined there until
/// it can express that. What comes out is in equilibrium and bracketed; where digits run out, that is said.
#[test]
fn inside_the_border_every_scene_is_solved() {
    let mut refused = 0;
    for case in cases() {
        for excess in [-1e-6, -1e-4, -0.1] {
            let goal = Goal { max_triangles: Some(1000), ..Goal::new(1e6) };
            let adapted =
                adapt(problem(&(case.scene)(excess)), &Condensed::default(), &Options::default(), &goal, |_| ());
            let certified = match adapted {
                Ok(adapted) => adapted.certified,
                Err(StudyError::Dual(DualError::NotConverged { residual, wanted, .. })) if excess >= -1e-5 => {
                    assert!(residual > wanted, "{} by {excess}", case.name);
                    refused += 1;
                    continue;
                }
                Err(e) => panic!("{} by {excess}: {e}", case.name),
            };
            let residual = certified.dual.equilibrium.residual();
            let allowed = if excess <= -1e-4 { 1e-10 } else { 1e-9 };
            assert!(residual < allowed, "{} by {excess}: {residual:.1e}", case.name);
            let upper = certified.bracket.free.as_ref().expect("an upper bound").upper();
            assert!(certified.bracket.lower() <= upper, "{} by {excess}", case.name);
        }
    }
    assert!(refused <= 4, "{refused} scenes were refused");
}

/// A block pressed on a frictionless plane may slide: the stress is unique and the scene is solved.
#[test]
fn a_block_that_may_slide_is_solved_and_said_to_slide() {
    let slab = Toml::default()
        .polygon("block", &square(0.0, 0.0, 2.0, 1.0), ["foot", "", "load", ""])
        .traction("load", [0.0, -1.0])
        .rigid("foot");
    let certified = certify(problem(&slab), &Condensed::default(), &Options::default()).expect("solves");
    // Uniaxial stress −1 in plane strain: ½ (1 − ν²)/E times the area.
    let exact = -0.5 * (1.0 - 0.09) * 2.0;
    assert!((certified.bracket.complementary.lower() - exact).abs() < 1e-12);
    assert!((certified.bracket.free.as_ref().expect("an upper bound").potential.total() - exact).abs() < 1e-12);
    let notes = certified.statics.notes.join(" ");
    assert!(notes.contains("`block`") && notes.contains("slide"), "{notes}");
    // Pushed sideways by the least force it does not stand.
    let pushed = slab.force("block", [1e-6, 0.0]);
    let error = certify(problem(&pushed), &Condensed::default(), &Options::default()).expect_err("slides away");
    assert!(error.to_string().contains("slides"), "{error}");
}
