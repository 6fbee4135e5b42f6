//! Bodies of revolution: closed solutions, the axis, and brackets of different degrees that hold one energy.

use std::f64::consts::TAU;

use crate::support::random::Random;
use hypercircle::dual::{Condensed, Options};
use hypercircle::element::{Elements, block};
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;
use hypercircle::study::{Certified, Goal, StudyError, adapt, answers, certify_divided, refuse_quantities};

/// A rectangle in r and z with conditions on its sides.
fn rectangle(name: &str, [r0, r1]: [f64; 2], [z0, z1]: [f64; 2], poisson: f64) -> String {
    format!(
        "[[geometry.polygons]]\nbody = \"{name}\"\npoints = [[{r0:?}, {z0:?}], [{r1:?}, {z0:?}], [{r1:?}, {z1:?}], [{r0:?}, {z1:?}]]\n\
         edges = [\"{name}_foot\", \"{name}_out\", \"{name}_top\", \"{name}_in\"]\n\
         [bodies.{name}]\nyoung = 1.0\npoisson = {poisson:?}\n"
    )
}

fn head(kinematics: &str, size: f64) -> String {
    format!("[model]\nkinematics = \"{kinematics}\"\n[geometry]\nsize = {size:?}\n")
}

fn rollers(on: &str) -> String {
    format!("[[supports]]\non = \"{on}\"\ntype = \"roller\"\n")
}

fn pressure(on: &str, value: f64) -> String {
    format!("[[tractions]]\non = \"{on}\"\npressure = {value:?}\n")
}

fn parsed(text: &str) -> Scene {
    Scene::parse(text, "revolved.toml".as_ref()).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn problem(text: &str) -> Problem {
    Problem::load(parsed(text)).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn solved(text: &str, degree: usize) -> Certified {
    let options = Options { elements: Elements::Uniform(block(degree)), ..Options::default() };
    certify_divided(problem(text), &Condensed::default(), &options).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// Lower and upper bound of the energy.
fn bracket(certified: &Certified) -> [f64; 2] {
    let upper = certified.bracket.free.as_ref().expect("an upper bound");
    assert!(certified.dual.equilibrium.residual() < 1e-9);
    // The gap, by another way.
    let gap = upper.upper() - certified.bracket.lower();
    let widenings = upper.widening + certified.bracket.lower_widening;
    assert!((gap - widenings - upper.local.total).abs() < 1e-9 * certified.bracket.complementary.strain + widenings);
    [certified.bracket.lower(), upper.upper()]
}

fn tube(poisson: f64, size: f64) -> String {
    let body = rectangle("tube", [1.0, 2.0], [0.0, 1.0], poisson);
    head("axisymmetric", size) + &body + &rollers("tube_foot") + &rollers("tube_top") + &pressure("tube_in", 1.0)
}

/// Energy of the tube under a pressure of one inside, held along the axis: half of −p u 2π a.
fn tube_energy(poisson: f64) -> f64 {
    -0.5 * TAU * (1.0 + poisson) * ((1.0 - 2.0 * poisson) / 3.0 + 4.0 / 3.0)
}

#[test]
fn the_tube_of_lame_is_bracketed_ever_more_closely() {
    // Errors of the lower bound on squares of half the wall, from an independent program.
    for (degree, known) in [(1, 5.7e-3), (2, 8.4e-5), (3, 1.1e-6)] {
        let exact = tube_energy(0.3);
        let [lower, upper] = bracket(&solved(&tube(0.3, 0.5), degree));
        assert!(lower <= exact && exact <= upper, "degree {degree}: {lower} {exact} {upper}");
        let off = (exact - lower) / -exact;
        assert!(off < 1.05 * known && off > 0.5 * known, "degree {degree}: {off} where {known} is known");
        assert!(upper - exact < exact - lower, "degree {degree}");
    }
}

#[test]
fn uniform_states_are_exact_on_the_axis_and_beside_a_small_hole() {
    // The cosine of a right angle is 6e-17.
    for inside in [0.0, 6.1e-17, -6.1e-17, 1e-6] {
        for degree in [1, 2] {
            let body = rectangle("rod", [inside, 1.0], [0.0, 1.0], 0.3);
            let text = head("axisymmetric", 0.5) + &body + &rollers("rod_foot") + &rollers("rod_top");
            let [lower, upper] = bracket(&solved(&(text + &pressure("rod_out", 1.0)), degree));
            let exact = -0.5 * TAU * 1.3 * 0.4;
            let allowed = if inside < 1e-12 { 1e-12 } else { 1e-9 };
            assert!(lower <= exact * (1.0 - 1e-10) && exact <= upper + 1e-10, "{inside} {degree}: {lower} {upper}");
            assert!(upper - lower < allowed * -exact, "{inside} {degree}: {lower} {upper}");
        }
    }
}

/// Shaft of radius b in a hub of outer radius c, of one material: p = E δ (c² − b²) / (2 b c²), and the energy is p δ π b per length.
#[test]
fn a_press_fit_has_the_pressure_of_lame() {
    let bodies = rectangle("shaft", [0.0, 1.0], [0.0, 0.5], 0.3) + &rectangle("hub", [1.0, 2.0], [0.0, 0.5], 0.3);
    let supports = rollers("shaft_foot") + &rollers("hub_foot");
    let fit = "[[contacts]]\nbetween = [\"shaft_out\", \"hub_in\"]\ngap = -0.01\n";
    let solution = solved(&(head("axisymmetric", 0.25) + &bodies + &supports + fit), 2);
    let [lower, upper] = bracket(&solution);
    let pressed = 0.01 * 3.0 / 8.0;
    let exact = 0.5 * pressed * 0.01 * TAU * 0.5;
    assert!(lower <= exact && exact <= upper && upper - lower < 1e-4 * exact, "{lower} {exact} {upper}");
    for t in solution.dual.contact_traction[0].values() {
        assert!((-t / pressed - 1.0).abs() < 0.02, "{t}");
    }
}

#[test]
fn nearly_incompressible_tubes_have_a_bracket_too() {
    let exact = tube_energy(0.4999);
    let [lower, upper] = bracket(&solved(&tube(0.4999, 0.5), 2));
    assert!(lower <= exact && exact <= upper && upper - lower < 1e-3 * -exact, "{lower} {exact} {upper}");
}

#[test]
fn far_from_the_axis_the_answer_is_that_of_plane_strain() {
    const FAR: f64 = 1e6;
    let scene = |kinematics: &str, inside: f64| {
        let body = rectangle("block", [inside, inside + 1.0], [0.0, 1.0], 0.3);
        let support = "[[supports]]\non = \"block_foot\"\ntype = \"clamped\"\n";
        head(kinematics, 0.5) + &body + support + &pressure("block_out", 1.0)
    };
    for degree in [2, 4] {
        let plane = bracket(&solved(&scene("plane-strain", 0.0), degree));
        let ring = bracket(&solved(&scene("axisymmetric", FAR), degree)).map(|e| e / (TAU * FAR));
        assert!(plane[0] < ring[1] && ring[0] < plane[1], "{plane:?} {ring:?}");
        assert!(
            (plane[0] - ring[0]).abs() < 1e-2 / degree as f64 && (plane[1] - ring[1]).abs() < 2e-2,
            "{plane:?} {ring:?}"
        );
    }
}

/// Two bodies, one on the other or one in the other, with loads of all kinds.
fn random_scene(random: &mut Random) -> String {
    let inside = if random.chance(0.5) { 0.0 } else { random.magnitude(-2.0, 1.0) };
    let radius = inside + random.between(0.5, 1.5);
    let (foot, top) = (random.between(0.3, 1.0), random.between(1.2, 2.0));
    let nu = random.between(0.0, 0.45);
    let bodies =
        rectangle("low", [inside, radius], [0.0, foot], nu) + &rectangle("up", [inside, radius], [foot, top], 0.2);
    let weight = format!("body_force = [{:?}, {:?}]\n", random.between(-0.2, 0.2), random.between(-0.5, 0.0));
    let gap = if random.chance(0.5) { 0.0 } else { random.between(-0.02, 0.02) };
    let base = if random.chance(0.5) { "clamped" } else { "roller" };
    head("axisymmetric", 0.6)
        + &bodies
        + &weight
        + &format!("[[supports]]\non = \"low_foot\"\ntype = \"{base}\"\n")
        + &format!(
            "[[tractions]]\non = \"up_top\"\nvalue = [{:?}, {:?}]\ngradient = [[0.3, 0.0], [{:?}, 0.0]]\n",
            random.between(-0.1, 0.1),
            random.between(-1.0, -0.5),
            random.between(-0.1, 0.1)
        )
        + &format!("[[contacts]]\nbetween = [\"low_top\", \"up_foot\"]\ngap = {gap:?}\n")
}

#[test]
fn brackets_of_all_degrees_and_meshes_hold_one_energy() {
    let mut random = Random::new(47);
    for _ in 0..3 {
        let text = random_scene(&mut random);
        let mut all: Vec<[f64; 2]> = [1, 2, 3].map(|degree| bracket(&solved(&text, degree))).to_vec();
        let goal = Goal { max_triangles: Some(80), ..Goal::new(0.02) };
        let adapted = adapt(problem(&text), &Condensed::default(), &Options::default(), &goal, |_| ());
        all.push(bracket(&adapted.unwrap_or_else(|e| panic!("{e}\n{text}")).certified));
        let highest = all.iter().fold(f64::NEG_INFINITY, |m, b| m.max(b[0]));
        let lowest = all.iter().fold(f64::INFINITY, |m, b| m.min(b[1]));
        assert!(highest <= lowest, "{all:?}\n{text}");
        assert!(all[2][0] > all[0][0], "higher degrees say more: {all:?}\n{text}");
    }
}

/// The guaranteed ends of every quantity, in degree `degree`.
fn intervals(text: &str, degree: usize) -> Vec<[f64; 2]> {
    let options = Options { elements: Elements::Uniform(block(degree)), keep_factor: true, ..Options::default() };
    let certified = certify_divided(problem(text), &Condensed::default(), &options);
    let certified = certified.unwrap_or_else(|e| panic!("{e}\n{text}"));
    answers(&certified, &options, |_| true).into_iter().map(|answer| answer.interval.ends).collect()
}

fn quantity(name: &str, of: &str) -> String {
    format!("[[quantities]]\nname = \"{name}\"\n{of}\n")
}

#[test]
fn intervals_of_the_full_turn_hold_the_values_of_lame() {
    let moved = |on: &str| quantity(on, &format!("displacement = \"{on}\"\ndirection = [1.0, 0.0]"));
    let text = tube(0.3, 0.5) + &moved("tube_in") + &moved("tube_out");
    // u = (1 + ν) ((1 − 2ν) r + b²/r)/3.
    let of_tube = [1.0, 2.0].map(|r: f64| 1.3 * (0.4 * r + 4.0 / r) / 3.0);
    let bodies = rectangle("shaft", [0.0, 1.0], [0.0, 0.5], 0.3) + &rectangle("hub", [1.0, 2.0], [0.0, 0.5], 0.3);
    let fit = "[[contacts]]\nbetween = [\"shaft_out\", \"hub_in\"]\ngap = -0.01\n";
    let fit = head("axisymmetric", 0.25) + &bodies + &rollers("shaft_foot") + &rollers("hub_foot") + fit;
    let fit = fit + &quantity("press", "force = \"shaft_out\"");
    // Pressure times the area of the seat.
    let of_fit = [0.01 * 3.0 / 8.0 * TAU * 0.5];
    for (degree, wide) in [(1, 3e-2), (2, 5e-4)] {
        for (text, exact) in [(&text, &of_tube[..]), (&fit, &of_fit)] {
            for ([lower, upper], exact) in intervals(text, degree).into_iter().zip(exact) {
                assert!(lower <= *exact && *exact <= upper, "degree {degree}: {lower} {exact} {upper}");
                assert!(upper - lower < wide * exact, "degree {degree}: {lower} {exact} {upper}");
            }
        }
    }
}

#[test]
fn means_of_bodies_and_regions_hold_the_values_of_lame() {
    let region = "polygon = [[1.1, 0.1], [1.83, 0.2], [1.6, 0.9], [1.2, 0.7]]";
    let stress = |name: &str, of: &str| quantity(name, &format!("stress = \"tube\"\n{of}"));
    let text = tube(0.3, 0.5)
        + &stress("radial", "component = \"rr\"")
        + &stress("hoop", "component = \"tt\"")
        + &stress("axial", "component = \"zz\"")
        + &stress("part", &format!("component = \"tt\"\n{region}"))
        + &stress("shear", &format!("component = \"rz\"\n{region}"))
        + &quantity("grown", "displacement = \"tube\"\ndirection = [1.0, 0.0]")
        + &quantity("held", "force = \"tube_foot\"\ndirection = [0.0, 1.0]");
    // σ = (1 ∓ 4/r²)/3, and 2ν/3 along the axis; ∫ over r from 1 to 2 of r and of 1/r are 3/2 and ln 2.
    let two = std::f64::consts::LN_2;
    let mean = |sign: f64| (1.5 + sign * 4.0 * two) / 3.0 / 1.5;
    let grown = 1.3 / 3.0 * (0.4 * 7.0 / 3.0 + 4.0) / 1.5;
    // The hoop stress over the region: ∫ (r + 4/r)/3 over ∫ r, by strips between its sides.
    let corners = [[1.1, 0.1], [1.83, 0.2], [1.6, 0.9], [1.2, 0.7]];
    let height = |r: f64| {
        let cuts = (0..4).filter_map(|i| {
            let ([a, y], [b, z]): ([f64; 2], [f64; 2]) = (corners[i], corners[(i + 1) % 4]);
            ((a - r) * (b - r) < 0.0).then(|| y + (r - a) / (b - a) * (z - y))
        });
        let ends: Vec<f64> = cuts.collect();
        if let [p, q] = ends[..] { (p - q).abs() } else { 0.0 }
    };
    let steps = 400_000;
    let over = |of: &dyn Fn(f64) -> f64| {
        (0..steps).map(|i| 1.1 + 0.73 * (i as f64 + 0.5) / steps as f64).map(|r| of(r) * height(r)).sum::<f64>()
    };
    let part = over(&|r| (r + 4.0 / r) / 3.0) / over(&|r| r);
    // The foot pushes against σ_zz = 2ν/3: its force on the body is −σ_zz times the area.
    let exact = [mean(-1.0), mean(1.0), 0.2, part, 0.0, grown, -0.2 * TAU * 1.5];
    for (degree, wide) in [(2, 0.3), (3, 0.05)] {
        for (k, ([lower, upper], exact)) in intervals(&text, degree).into_iter().zip(exact).enumerate() {
            let rounding = 1e-8;
            assert!(
                lower <= exact + rounding && exact <= upper + rounding,
                "{k}, degree {degree}: {lower} {exact} {upper}"
            );
            assert!(upper - lower < wide, "{k}, degree {degree}: {lower} {exact} {upper}");
        }
    }
}

#[test]
fn intervals_of_all_degrees_hold_one_value() {
    let mut random = Random::new(48);
    for _ in 0..2 {
        let (a, b) = (random.between(0.1, 0.3), random.between(0.1, 0.3));
        let asked = quantity("all", "force = \"low_top\"")
            + &quantity("part", &format!("force = \"low_top\"\nwindow = [0.0, {a:?}, {a:?}, {:?}]", a + b))
            + &quantity("top", "displacement = \"up_top\"\ndirection = [0.0, 1.0]")
            + &quantity("side", "displacement = \"low_out\"\ndirection = [1.0, 0.0]")
            + &quantity("sunk", "displacement = \"up\"\ndirection = [0.0, 1.0]")
            + &quantity("hoop", "stress = \"low\"\ncomponent = \"tt\"")
            + &quantity("along", "stress = \"up\"\ncomponent = \"zz\"")
            + &quantity("held", "force = \"low_foot\"\ndirection = [0.0, 1.0]");
        let text = random_scene(&mut random) + &asked;
        let all = [1, 2, 3].map(|degree| intervals(&text, degree));
        for k in 0..8 {
            let ends = all.each_ref().map(|of| of[k]);
            let lower = ends.iter().fold(f64::NEG_INFINITY, |m, e| m.max(e[0]));
            let upper = ends.iter().fold(f64::INFINITY, |m, e| m.min(e[1]));
            let size = 1e-9 * lower.abs().max(upper.abs());
            assert!(lower <= upper + size && upper.is_finite() && lower.is_finite(), "{k}: {ends:?}\n{text}");
            assert!(ends[2][1] - ends[2][0] <= ends[0][1] - ends[0][0] + size, "{k}: {ends:?}\n{text}");
        }
    }
}

/// A hub pressed onto a shaft is pushed onto its foot: the force there is that of statics, and the mean of σ_zz below the load too.
#[test]
fn what_statics_says_along_the_axis_is_exact() {
    let bodies = rectangle("shaft", [0.0, 1.0], [0.0, 0.5], 0.3) + &rectangle("hub", [1.0, 2.0], [0.0, 0.5], 0.2);
    let text = head("axisymmetric", 0.25)
        + &bodies
        + &rollers("shaft_foot")
        + &rollers("hub_foot")
        + &pressure("hub_top", 0.02)
        + "[[contacts]]\nbetween = [\"shaft_out\", \"hub_in\"]\ngap = -0.01\n"
        + &quantity("foot", "force = \"hub_foot\"\ndirection = [0.0, 1.0]")
        + &quantity("along", "stress = \"hub\"\ncomponent = \"zz\"");
    let exact = [0.02 * 0.5 * TAU * 3.0, -0.02];
    for degree in [1, 2, 3] {
        for ([lower, upper], exact) in intervals(&text, degree).into_iter().zip(exact) {
            assert!((lower - exact).abs() < 1e-7 && (upper - exact).abs() < 1e-7, "{degree}: {lower} {exact} {upper}");
        }
    }
}

#[test]
fn what_moves_along_the_axis_is_no_equilibrium() {
    let body = rectangle("ring", [1.0, 2.0], [0.0, 1.0], 0.3);
    let text = head("axisymmetric", 0.5) + &body + "[[contacts]]\non = \"ring_foot\"\n";
    let pulled = problem(&(text.clone() + &pressure("ring_top", -1.0)));
    let found = certify_divided(pulled, &Condensed::default(), &Options::default());
    let Err(StudyError::NoEquilibrium { work, .. }) = found else { panic!("a ring that is pulled off its seat") };
    assert!((work / (0.5 * TAU * 3.0) - 1.0).abs() < 1e-9, "{work}");
    // Pressed on it, or by a pressure inside alone, it stays.
    bracket(&solved(&(text.clone() + &pressure("ring_top", 1.0)), 1));
    bracket(&solved(&(text + &pressure("ring_in", 1.0)), 1));
}

#[test]
fn what_cannot_be_beside_an_axis_is_refused() {
    let refused = |text: String| match Scene::parse(&text, "revolved.toml".as_ref()) {
        Err(error) => error.to_string(),
        Ok(scene) => Problem::load(scene).expect_err(&text).to_string(),
    };
    let body = |inside: f64| rectangle("rod", [inside, 1.0], [0.0, 1.0], 0.3);
    let text = head("axisymmetric", 0.5).replace("[geometry]", "thickness = 2.0\n[geometry]") + &body(0.0);
    assert!(refused(text).contains("thickness"));
    let beyond = refused(head("axisymmetric", 0.5) + &body(-0.5));
    assert!(beyond.contains("axis of revolution") && beyond.contains("-0.5"), "{beyond}");
    let held = "[[supports]]\non = \"rod_in\"\ntype = \"clamped\"\n";
    let held = refused(head("axisymmetric", 0.5) + &body(0.0) + held);
    assert!(held.contains("rod_in") && held.contains("leave it out"), "{held}");
    let with = |key: &str| {
        refused(
            head("axisymmetric", 0.5) + &body(0.5).replace("young", &format!("{key}\nyoung")) + &rollers("rod_foot"),
        )
    };
    for (key, said) in [
        ("body_force = { value = [0.0, 0.0], gradient = [[0.0, 1.0], [0.0, 0.0]] }", "varies along z"),
        ("rotation = { density = 1.0, omega = 1.0, about = [1.0, 0.0] }", "turns about its axis"),
    ] {
        assert!(with(key).contains(said), "{}", with(key));
    }
    for asked in [
        "stress = \"rod\"\npoint = [0.7, 0.5]\ncomponent = \"von-mises\"",
        "displacement = \"rod\"\npoint = [0.7, 0.5]\ndirection = [0.0, 1.0]",
        "force = \"rod_foot\"\ndirection = [1.0, 0.0]",
    ] {
        let text = head("axisymmetric", 0.5) + &body(0.5) + &rollers("rod_foot") + &quantity("a", asked);
        let error = refuse_quantities(&problem(&text)).expect_err(asked);
        assert!(error.contains("a body of revolution has no interval"), "{error}");
    }
    // Rollers there say what is so anyway.
    problem(&(head("axisymmetric", 0.5) + &body(0.0) + &rollers("rod_in")));
}

/// Triangles as long as the ring is wide, between frictionless walls: no strain across the axis, so that the energy is that of a column.
#[test]
fn brackets_of_flat_rings_hold_their_energy() {
    for (height, degree) in [(1e-3, 1), (1e-3, 4), (1e-4, 6), (1e-5, 4), (1e-6, 2)] {
        let nu: f64 = 0.3;
        let text = head("axisymmetric", 0.5)
            + &rectangle("rod", [0.5, 1.0], [0.0, height], nu)
            + &rollers("rod_foot")
            + &rollers("rod_in")
            + &rollers("rod_out")
            + &pressure("rod_top", 0.5);
        let options = Options { elements: Elements::Uniform(block(degree)), ..Options::default() };
        let found = certify_divided(problem(&text), &Condensed::default(), &options).expect("a solution");
        let young = (1.0 + nu) * (1.0 - 2.0 * nu) / (1.0 - nu);
        let exact = -0.125 * TAU * 0.5 * (1.0 - 0.25) * height * young;
        let upper = found.bracket.free.as_ref().map_or(0.0, |free| free.upper());
        assert!(
            found.bracket.lower() <= exact && exact <= upper,
            "{height} {degree}: {:e} {exact:e} {upper:e}",
            found.bracket.lower()
        );
        assert!(
            exact - found.bracket.lower() < 1e-3 * -exact,
            "{height} {degree}: {:e}",
            found.bracket.lower() / exact
        );
    }
}
