//! Coulomb friction against statics, against friction with the bound that it ends with, and against the two ends of its energy.

use crate::support::random::Random;
use crate::support::toml::Toml;
use hypercircle::dual::{Condensed, DualMethod, Options};
use hypercircle::element::{Elements, block};
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;
use hypercircle::statics::{friction_can_balance, wedged};
use hypercircle::study::{
    Certified, Coulomb, End, Goal, StudyError, adapt, answers, certify_divided, solve_coulomb, solve_coulomb_to,
};

fn problem(text: &str) -> Problem {
    let scene = Scene::parse(text, "scene.toml".as_ref()).unwrap_or_else(|e| panic!("{e}\n{text}"));
    Problem::load(scene).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn tried(problem: &Problem, degree: usize) -> Result<(Certified, Coulomb), StudyError> {
    let options = Options { elements: Elements::Uniform(block(degree)), ..Options::default() };
    let method = Condensed::default();
    solve_coulomb(problem, &method, &options, |held| certify_divided(held, &method, &options), |_| ())
}

fn solved(text: &str, degree: usize) -> (Certified, Coulomb) {
    tried(&problem(text), degree).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// ∫ p ds of each contact, and ∫ τ̄ ds of the bound that was used; of a body of revolution over the full turn.
fn forces(certified: &Certified) -> Vec<[f64; 2]> {
    let all = certified.problem.interfaces.iter().zip(&certified.dual.contact_traction);
    all.map(|(interface, tractions)| {
        let of = |(k, pair): (usize, &hypercircle::problem::ContactPair)| {
            let t = tractions.of(k);
            let bound = pair.friction.map_or_else(|| vec![0.0], |friction| friction.weighted());
            let size = certified.problem.scene.thickness * pair.length;
            [-size * t.iter().sum::<f64>() / t.len() as f64, size * bound.iter().sum::<f64>() / bound.len() as f64]
        };
        interface.pairs.iter().enumerate().map(of).fold([0.0; 2], |sum, own| [sum[0] + own[0], sum[1] + own[1]])
    })
    .collect()
}

/// A wedge with faces at `angle` degrees to the vertical in a rigid groove, with a force across its top.
fn wedge(angle: f64, mu: f64, down: f64) -> (String, f64) {
    let half = 0.3 + angle.to_radians().tan();
    let text = Toml::default()
        .size(0.25)
        .outline("wedge", &[[-0.3, 0.0], [0.3, 0.0], [half, 1.0], [-half, 1.0]], &["", "right", "load", "left"])
        .traction("load", [0.0, -down])
        .table(&format!("[[contacts]]\non = \"left\"\nfriction = {{ coefficient = {mu:?} }}"))
        .table(&format!("[[contacts]]\non = \"right\"\nfriction = {{ coefficient = {mu:?} }}"))
        .text();
    (text, 2.0 * half * down)
}

/// Pressed from above it slides along both faces: 2 N (sin α + μ cos α) = P, below the angle of friction and above.
#[test]
fn a_wedge_in_a_groove_presses_as_statics_says() {
    for mu in [0.2, 0.5] {
        let (text, load) = wedge(20.0, mu, 0.01);
        let (certified, coulomb) = solved(&text, 1);
        let (sin, cos) = 20.0_f64.to_radians().sin_cos();
        let normal = load / (2.0 * (sin + mu * cos));
        for [pressure, bound] in forces(&certified) {
            assert!((pressure - normal).abs() < 1e-7 * normal, "{pressure} {normal}");
            assert!((bound - mu * normal).abs() < 1e-7 * normal, "{bound} {}", mu * normal);
        }
        assert_eq!(coulomb.wedged.len(), usize::from(mu > 20.0_f64.to_radians().tan()));
        assert!(coulomb.distances.iter().flatten().all(|distance| distance.relative < 1e-6));
    }
}

/// A wedge turned about an axis, in a groove: along the axis its faces carry (N' + N'') (sin α + μ cos α) = P. A cone, which has one face, has
/// its axis inside.
#[test]
fn wedges_and_cones_of_revolution_press_as_statics_says() {
    let (sin, cos) = 20.0_f64.to_radians().sin_cos();
    let (mu, down, half) = (0.2, 0.01, 0.3 + sin / cos);
    for (middle, degree) in [(1.0, 1), (1.0, 2), (40.0, 2), (0.0, 1), (0.0, 3)] {
        let cone = middle == 0.0;
        let [foot, top] = if cone { [0.0; 2] } else { [middle - 0.3, middle - half] };
        let friction = |on: &str| format!("[[contacts]]\non = \"{on}\"\nfriction = {{ coefficient = {mu:?} }}");
        let outline = [[foot, 0.0], [middle + 0.3, 0.0], [middle + half, 1.0], [top, 1.0]];
        let left = if cone { "" } else { "left" };
        let mut toml = Toml::default().turned().size(0.3).outline("wedge", &outline, &["", "right", "load", left]);
        toml = toml.traction("load", [0.0, -down]).table(&friction("right"));
        let text = if cone { toml.text() } else { toml.table(&friction("left")).text() };
        let (certified, coulomb) = solved(&text, degree);
        let load = down * 0.5 * std::f64::consts::TAU * ((middle + half).powi(2) - top * top);
        let faces = forces(&certified);
        let pressure: f64 = faces.iter().map(|face| face[0]).sum();
        let normal = load / (sin + mu * cos);
        assert!((pressure - normal).abs() < 2e-2 * normal, "{middle} {degree}: {pressure} {normal}");
        for [pressure, bound] in faces {
            assert!((bound - mu * pressure).abs() < 1e-6 * normal, "{middle} {degree}: {bound} {}", mu * pressure);
        }
        assert!(
            coulomb.wedged.is_empty() && coulomb.distances.iter().flatten().all(|d| d.relative < 0.2),
            "{coulomb:?}"
        );
        let wedges = |mu: f64| wedged(&problem(&text.replace("coefficient = 0.2", &format!("coefficient = {mu:?}"))));
        assert_eq!([0.363, 0.365].map(|mu| wedges(mu).len()), [0, 1], "{middle}");
    }
}

/// A hub shrunk onto a shaft holds a push with no more than the forces of its friction. Nothing wedges it: its hoop stress says how much it
/// presses.
#[test]
fn a_hub_holds_what_its_pressure_carries() {
    let ring = |[a, b]: [f64; 2]| [[a, 0.0], [b, 0.0], [b, 1.0], [a, 1.0]];
    let pushed = |load: f64| {
        Toml::default()
            .turned()
            .size(0.25)
            .outline("shaft", &ring([0.0, 1.0]), &["foot", "seat", "", ""])
            .outline("hub", &ring([1.0, 2.0]), &["push", "", "", "bore"])
            .clamp("foot")
            .traction("push", [0.0, load])
            .table("[[contacts]]\nbetween = [\"seat\", \"bore\"]\ngap = -0.01\nfriction = { coefficient = 0.2 }")
            .text()
    };
    let (certified, coulomb) = solved(&pushed(5e-5), 2);
    let [[pressure, bound]] = forces(&certified)[..] else { panic!("one contact") };
    let push = |load: f64| load * 1.5 * std::f64::consts::TAU;
    assert!(bound > push(5e-5) && coulomb.wedged.is_empty() && coulomb.lowest.is_none(), "{pressure} {bound}");
    // Lamé: δ/b · 3/8 of E, but for the ends.
    assert!((pressure / (0.00375 * std::f64::consts::TAU) - 1.0).abs() < 0.15, "{pressure}");
    let most = bound / (1.5 * std::f64::consts::TAU);
    solved(&pushed(0.8 * most), 2);
    let slides = tried(&problem(&pushed(1.3 * most)), 2).expect_err("no equilibrium").to_string();
    assert!(slides.contains("slides along its contact"), "{slides}");
}

/// Quantities have intervals for the bound that was found: the forces of a block that slides are those of statics.
#[test]
fn quantities_are_for_the_bound_that_was_found() {
    let asked = |name: &str, of: &str| format!("[[quantities]]\nname = \"{name}\"\n{of}\n");
    let text = pushed(0.3, 0.03, 0.5)
        + &asked("normal", "force = \"foot\"\nwindow = [0.1, 0.5, 1.5, 1.9]")
        + &asked("rubs", "force = \"foot\"\ncomponent = \"tangential\"\nwindow = [0.1, 0.5, 1.5, 1.9]")
        + &asked("moved", "displacement = \"high\"\ndirection = [1.0, 0.0]");
    hypercircle::study::refuse_quantities(&problem(&text)).expect("quantities that have an interval");
    let (certified, _) = solved(&text, 2);
    let fine = solved(&text.replace("size = 0.5", "size = 0.2"), 3).0;
    let of = |certified: &Certified| answers(certified, &Options::default(), |_| true);
    for (coarse, fine) in of(&certified).iter().zip(&of(&fine)) {
        let ([a, b], [c, d]) = (coarse.interval.ends, fine.interval.ends);
        assert!(b.is_finite() && a.is_finite() && d - c < b - a, "{}: {a} {b} {c} {d}", coarse.name);
        // The bounds differ by what a linear function misses of the pressure.
        assert!(a <= d && c <= b, "{}: {a} {b} {c} {d}", coarse.name);
    }
}

/// A limit on time that has passed keeps the bound of the coarse mesh, and says how far it is from that of the fine one.
#[test]
fn a_bound_is_kept_where_no_time_is_left_for_another() {
    let (options, method) = (Options::default(), Condensed::default());
    let to = |seconds: Option<f64>| {
        let certify = |held, method: &dyn DualMethod, options: &Options| certify_divided(held, method, options);
        let goal = Goal { max_triangles: Some(400), ..Goal::new(0.02) };
        let adapt = |held, options: &Options, _: Option<f64>| adapt(held, &method, options, &goal, |_| ());
        let given = problem(&wedge(20.0, 0.2, 0.01).0.replace("size = 0.25", "size = 0.5"));
        solve_coulomb_to((Some(0.02), seconds), given, (&method, &options), certify, adapt, |_| ()).expect("solves")
    };
    let (kept, coulomb) = to(Some(0.0));
    let far = coulomb.distances.iter().flatten().fold(0.0_f64, |m, distance| m.max(distance.relative));
    let (sought, coulomb) = to(None);
    let near = coulomb.distances.iter().flatten().fold(0.0_f64, |m, distance| m.max(distance.relative));
    assert!(far > 1e-3 && near < 0.1 * far, "{far} {near}");
    assert!(kept.certified.problem.mesh.triangles.len() <= sought.certified.problem.mesh.triangles.len());
}

/// A given bound, however large, moves no load to the borderline of equilibrium: nothing but a lift is allowed, and the loads work against it.
#[test]
fn a_wedge_that_sticks_is_not_on_the_borderline() {
    for bound in ["1e-9", "1e-3", "1.0", "1e6", "1e12"] {
        let text = wedge(20.0, 0.2, 0.01).0.replace("coefficient = 0.2", &format!("bound = {bound}"));
        let given = problem(&text);
        let triangles = given.mesh.triangles.len();
        let found = certify_divided(given, &Condensed::default(), &Options::default()).expect("a solution");
        assert_eq!(found.statics.notes, Vec::<String>::new(), "{bound}");
        assert_eq!(found.problem.mesh.triangles.len(), triangles, "{bound}");
    }
}

#[test]
fn faces_wedge_from_the_angle_of_friction_on() {
    for angle in [5.0, 20.0, 40.0] {
        let limit = f64::to_radians(angle).tan();
        let wedges = |mu: f64| wedged(&problem(&wedge(angle, mu, 0.01).0));
        assert!(wedges(limit * (1.0 - 1e-5)).is_empty());
        let found = wedges(limit * (1.0 + 1e-5));
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].contacts.len(), 2, "{found:?}");
    }
}

/// Pulled out of its groove nothing holds the wedge below the angle of friction; above, forces of friction could.
#[test]
fn a_wedge_that_is_pulled_out_comes_loose_or_is_left_open() {
    let pulled = |mu: f64| {
        let problem = problem(&wedge(20.0, mu, -0.01).0);
        assert_eq!(friction_can_balance(&problem), mu > 0.4);
        tried(&problem, 1).expect_err("no solution").to_string()
    };
    let loose = pulled(0.2);
    assert!(loose.contains("lifts off") && loose.contains("no solution exists"), "{loose}");
    let left_open = pulled(0.5);
    assert!(left_open.contains("wedge") && left_open.contains("not known"), "{left_open}");
}

/// A block on another one, pressed by 0.1 per length and pushed from the side.
fn pushed(mu: f64, push: f64, size: f64) -> String {
    let square = |y: f64| [[0.0, y], [2.0, y], [2.0, y + 1.0], [0.0, y + 1.0]];
    Toml::default()
        .size(size)
        .outline("low", &square(0.0), &["floor", "", "top", ""])
        .outline("high", &square(1.0), &["foot", "", "load", "push"])
        .clamp("floor")
        .traction("load", [0.0, -0.1])
        .traction("push", [push, 0.0])
        .table(&format!("[[contacts]]\nbetween = [\"foot\", \"top\"]\nfriction = {{ coefficient = {mu:?} }}"))
        .text()
}

#[test]
fn a_block_slides_away_from_the_force_of_statics_on() {
    // Friction carries 0.3 · 0.2.
    let (certified, coulomb) = solved(&pushed(0.3, 0.059, 0.5), 2);
    let [[pressure, bound]] = forces(&certified)[..] else { panic!("one contact") };
    assert!((pressure - 0.2).abs() < 1e-9 && (bound - 0.06).abs() < 1e-9, "{pressure} {bound}");
    assert!(coulomb.lowest.is_none() && coulomb.highest.is_some() && coulomb.wedged.is_empty());
    let away = tried(&problem(&pushed(0.3, 0.061, 0.5)), 2).expect_err("no equilibrium");
    assert!(matches!(away, StudyError::NoEquilibrium { .. }));
    let told = away.to_string();
    assert!(told.contains("friction resists with 0.06, and the load in this direction is 0.061"), "{told}");
}

/// A slanted strut that is pushed over its foot: without friction the foot lifts off, and once it sticks it is jammed.
#[test]
fn a_strut_that_jams_or_lifts_off_has_two_solutions() {
    let t = 20.0_f64.to_radians().tan();
    let points = [[0.0, 0.0], [0.2, 0.0], [0.2 - 0.2 * t, 0.2], [0.2 - 2.0 * t, 2.0], [-2.0 * t, 2.0], [-0.2 * t, 0.2]];
    let text = |mu: f64| {
        Toml::default()
            .size(0.2)
            .outline("strut", &points, &["foot", "push", "", "top", "", "pull"])
            .clamp("top")
            .traction("push", [7e-4, -1e-3])
            .traction("pull", [7e-4, -1e-3])
            .table(&format!("[[contacts]]\non = \"foot\"\nfriction = {{ coefficient = {mu:?} }}"))
            .text()
    };
    let (jammed, coulomb) = solved(&text(1.5), 1);
    assert!(coulomb.has_several() && coulomb.starts.len() == 2, "{:?}", coulomb.starts);
    assert!(forces(&jammed)[0][0] > 1e-4);
    let (_, coulomb) = solved(&text(0.1), 1);
    assert!(!coulomb.has_several() && coulomb.starts.iter().all(|start| matches!(start.end, End::Arrived(_))));
}

/// A scene drawn at random: a block on another one or on rigid ground, turned, held by a spring so that it is held without friction.
fn random_scene(seed: u64) -> (String, usize) {
    let mut random = Random::new(seed);
    let (angle, mu) = (random.between(-3.0, 3.0), random.magnitude(-1.5, 0.0));
    let turned = |[x, y]: [f64; 2]| [x * f64::cos(angle) - y * angle.sin(), x * angle.sin() + y * angle.cos()];
    let at = |points: &[[f64; 2]]| points.iter().map(|p| turned(*p)).collect::<Vec<_>>();
    let (push, press) = (random.between(-0.2, 0.2), -random.between(0.05, 0.3));
    let spring = format!(
        "[[supports]]\non = \"side\"\ntype = \"spring\"\nstiffness = [{:?}, {:?}]",
        random.magnitude(-1.0, 1.0),
        random.magnitude(-1.0, 0.5)
    );
    let toml = Toml::default().size(random.between(0.5, 0.8)).table(&spring);
    let friction = format!("friction = {{ coefficient = {mu:?} }}");
    let toml = if random.chance(0.5) {
        let high = at(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]]);
        toml.outline("high", &high, &["foot", "side", "load", "push"])
            .table(&format!("[[contacts]]\non = \"foot\"\n{friction}"))
    } else {
        let middle = random.pick(&[1.0, 1.15]);
        toml.outline(
            "low",
            &at(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, middle], [0.0, 1.0]]),
            &["floor", "", "top", "top", ""],
        )
        .outline(
            "high",
            &at(&[[0.0, 1.0], [1.0, middle], [2.0, 1.0], [2.0, 2.0], [0.0, 2.0]]),
            &["foot", "foot", "side", "load", "push"],
        )
        .material("low", random.magnitude(-1.0, 1.0), random.between(0.0, 0.45))
        .clamp("floor")
        .table(&format!("[[contacts]]\nbetween = [\"foot\", \"top\"]\n{friction}"))
    };
    (
        toml.traction("load", turned([0.2 * push, press])).traction("push", turned([push, 0.0])).text(),
        1 + random.below(2),
    )
}

#[test]
fn random_scenes_lie_between_their_two_ends() {
    let (mut arrived, mut both) = (0, 0);
    for seed in 0..10 {
        let (text, degree) = random_scene(seed);
        let (certified, coulomb) = match tried(&problem(&text), degree) {
            Ok(found) => found,
            Err(StudyError::Coulomb(_) | StudyError::NoEquilibrium { .. }) => continue,
            Err(other) => panic!("seed {seed}: {other}\n{text}"),
        };
        arrived += 1;
        let upper = certified.bracket.free.as_ref().expect("an upper bound").upper();
        let lowest = coulomb.lowest.expect("springs hold the bodies");
        assert!(lowest <= upper, "seed {seed}: {lowest} {upper}");
        // There is no upper end where the field of sides that stick slides by more than rounding.
        if let Some(highest) = coulomb.highest {
            both += 1;
            assert!(certified.bracket.lower() <= highest, "seed {seed}: {lowest} {upper} {highest}");
        }
        for distance in coulomb.distances.iter().flatten() {
            assert!(distance.relative < if degree == 1 { 1e-6 } else { 0.2 }, "seed {seed}: {distance:?}");
        }
    }
    assert!(arrived >= 7 && both >= 5, "{arrived} {both}");
}
