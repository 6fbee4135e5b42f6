//! Elastic contact and friction of bodies of revolution against closed solutions, and against themselves.

use std::f64::consts::TAU;

use crate::support::random::Random;
use hypercircle::dual::{Condensed, Options};
use hypercircle::element::{Elements, block};
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;
use hypercircle::study::{Certified, Goal, StudyError, adapt, answers, certify_divided};

fn tried(text: &str, degree: usize) -> Result<Certified, StudyError> {
    let text = format!("[model]\nkinematics = \"axisymmetric\"\n[geometry]\nsize = 0.5\n{text}");
    let scene = Scene::parse(&text, "contact.toml".as_ref()).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let problem = Problem::load(scene).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let options = Options { elements: Elements::Uniform(block(degree)), ..Options::default() };
    certify_divided(problem, &Condensed::default(), &options)
}

/// Lower and upper bound of the energy.
fn ends(found: &Certified) -> [f64; 2] {
    assert!(found.dual.equilibrium.residual() < 1e-9, "{}", found.dual.equilibrium.residual());
    let upper = found.bracket.free.as_ref().expect("an upper bound");
    // The gap, by another way.
    let gap = upper.upper() - found.bracket.lower();
    let widenings = upper.widening + found.bracket.lower_widening;
    let size = upper.potential.magnitude + found.bracket.complementary.magnitude;
    assert!((gap - widenings - upper.local.total).abs() < 1e-9 * size + widenings, "{gap} {}", upper.local.total);
    assert!(upper.local.pairs.iter().flatten().all(|term| *term >= -1e-12 * size));
    [found.bracket.lower(), upper.upper()]
}

fn bracket(text: &str, degree: usize) -> [f64; 2] {
    ends(&tried(text, degree).unwrap_or_else(|e| panic!("{e}\n{text}")))
}

fn ring(name: &str, [r0, r1]: [f64; 2], [z0, z1]: [f64; 2], poisson: f64) -> String {
    format!(
        "[[geometry.polygons]]\nbody = \"{name}\"\npoints = [[{r0:?}, {z0:?}], [{r1:?}, {z0:?}], [{r1:?}, {z1:?}], [{r0:?}, {z1:?}]]\n\
         edges = [\"{name}_foot\", \"{name}_out\", \"{name}_top\", \"{name}_bore\"]\n[bodies.{name}]\nyoung = 1.0\npoisson = {poisson:?}\n"
    )
}

fn rollers(name: &str) -> String {
    ["foot", "top"].map(|side| format!("[[supports]]\non = \"{name}_{side}\"\ntype = \"roller\"\n")).concat()
}

const NU: f64 = 0.3;

/// u(r) of a tube of radii 1 and 2 under pressures inside and outside, rigid plates at its ends.
fn lame([inside, outside]: [f64; 2], r: f64) -> f64 {
    let k = (inside - 4.0 * outside) / 3.0;
    (1.0 + NU) * ((1.0 - 2.0 * NU) * k * r + (inside - outside) * 4.0 / 3.0 / r)
}

/// Pressure of a fit of a shaft in a tube over a layer that yields by 1/k, with this gap and pressure outside, and the energy per height.
fn fit(k: f64, gap: f64, outside: f64) -> [f64; 2] {
    let shaft = (1.0 + NU) * (1.0 - 2.0 * NU);
    // By how much the sides come closer without contact, and how far a pressure of one keeps them apart.
    let closes = -lame([0.0, outside], 1.0);
    let apart = shaft + lame([1.0, 0.0], 1.0) + 1.0 / k;
    let q = ((closes - gap) / apart).max(0.0);
    let moved = -lame([q, outside], 2.0);
    [q, -0.5 * TAU * (2.0 * outside * moved + q * gap)]
}

#[test]
fn a_fit_over_an_elastic_layer_has_the_pressure_of_lame() {
    for (k, gap, outside) in
        [(0.5, -0.01, 0.0), (40.0, -0.01, 0.05), (3.0, 0.02, 0.1), (1e7, 0.02, 0.1), (3.0, 0.2, 0.1)]
    {
        let load = if outside == 0.0 {
            String::new()
        } else {
            format!("[[tractions]]\non = \"hub_out\"\npressure = {outside:?}\n")
        };
        let text = ring("shaft", [0.0, 1.0], [0.0, 0.5], NU).replace("shaft_bore", "")
            + &ring("hub", [1.0, 2.0], [0.0, 0.5], NU)
            + &rollers("shaft")
            + &rollers("hub")
            + &load
            + &format!("[[contacts]]\nbetween = [\"shaft_out\", \"hub_bore\"]\ngap = {gap:?}\nstiffness = {k:?}\n");
        let [pressure, energy] = fit(k, gap, outside);
        let exact = 0.5 * energy;
        for (degree, width) in [(1, 6e-2), (2, 1e-3), (3, 2e-5)] {
            let found = tried(&text, degree).unwrap_or_else(|e| panic!("{e}\n{text}"));
            let [lower, upper] = ends(&found);
            let rounding = 1e-11 * exact.abs();
            assert!(
                lower <= exact + rounding && exact <= upper + rounding && upper - lower < width * exact.abs(),
                "k = {k}, gap {gap}, degree {degree}: {lower} {exact} {upper}"
            );
            let near = found.dual.contact_traction[0].iter().flatten().all(|t| (-t - pressure).abs() <= 0.1 * pressure);
            assert!(near && (degree > 1 || pressure > 0.0 || gap == 0.2), "{pressure}");
        }
        if gap < 0.0 {
            let asked = text + "[[quantities]]\nname = \"seat\"\nforce = \"shaft_out\"\n";
            let found = tried(&asked, 2).unwrap_or_else(|e| panic!("{e}\n{asked}"));
            let [low, high] = answers(&found, &Options::default(), |_| true)[0].interval.ends;
            let force = pressure * TAU * 0.5;
            assert!(low <= force && force <= high && high - low < 0.1 * force, "{low} {force} {high}");
        }
    }
}

#[test]
fn a_rod_on_elastic_ground_sinks_evenly() {
    let load = "[[contacts]]\non = \"rod_foot\"\nstiffness = 4.0\ngap = 0.01\n[[tractions]]\non = \"rod_top\"\npressure = 0.5\n";
    let text = ring("rod", [0.0, 1.5], [0.0, 1.0], NU).replace("rod_bore", "") + load;
    // −½ p² (1/k + h/E) − p g over the area.
    let exact = -(0.5 * 0.25 * (0.25 + 1.0) + 0.5 * 0.01) * 0.5 * TAU * 2.25;
    for degree in [1, 2, 3] {
        for end in bracket(&text, degree) {
            assert!((end - exact).abs() < 1e-9 * -exact, "degree {degree}: {end} {exact}");
        }
    }
}

/// A tube of radii 1 and 2 on a mandrel with friction, pulled along it by its weight, in a bed outside.
fn hung(bound: &str) -> String {
    let across =
        |side: &str| format!("[[supports]]\non = \"tube_{side}\"\ntype = \"roller\"\ndirection = [1.0, 0.0]\n");
    ring("tube", [1.0, 2.0], [0.0, 1.0], NU)
        + "body_force = [0.0, 0.2]\n"
        + &across("foot")
        + &across("top")
        + "[[supports]]\non = \"tube_out\"\ntype = \"spring\"\nstiffness = [1.0, 0.5]\n"
        + &format!("[[contacts]]\non = \"tube_bore\"\nfriction = {{ bound = {bound} }}\n")
}

/// Its energy: G r u' = c − f r²/2 with −G u'(1) the friction where it slides, u(1) = 0 where it sticks, and G u'(2) = −k u(2).
fn hung_energy(bound: f64) -> f64 {
    let (f, k, g, ln) = (0.2, 0.5, 0.5 / (1.0 + NU), std::f64::consts::LN_2);
    let outside = |c: f64| -(c - 2.0 * f) / (2.0 * k);
    let inside = |c: f64| outside(c) - (c * ln - 0.75 * f) / g;
    let sticks = (f / k + 0.75 * f / g) / (0.5 / k + ln / g);
    let slides = bound + 0.5 * f;
    let c = slides.min(sticks);
    // ∫ r u from 1 to 2, by parts: (b² u_b − a² u_a)/2 − ½ ∫ r² u'.
    let work = f * (2.0 * outside(c) - 0.5 * inside(c) - 0.5 * (1.5 * c - 15.0 / 8.0 * f) / g);
    -0.5 * TAU * (work - if slides < sticks { bound * inside(c) } else { 0.0 })
}

#[test]
fn a_tube_slides_along_its_mandrel_until_friction_holds_it() {
    let mut energies = Vec::new();
    for bound in [0.0, 0.02, 0.1, 0.18, 0.5] {
        let exact = hung_energy(bound);
        for (degree, width) in [(1, 2e-2), (2, 1e-3), (3, 1e-4)] {
            let [lower, upper] = bracket(&hung(&format!("{bound:?}")), degree);
            assert!(lower <= exact && exact <= upper, "{bound}, degree {degree}: {lower} {exact} {upper}");
            assert!(upper - lower < width * -exact, "{bound}, degree {degree}: {lower} {exact} {upper}");
        }
        energies.push(exact);
    }
    // It sticks under the last two alone.
    assert!(
        energies.windows(2).take(3).all(|w| w[1] > w[0] + 1e-3) && energies[3] < energies[4] + 1e-12,
        "{energies:?}"
    );
}

/// A rod in a rigid bore, pulled at one end: it slides along F/(2πRτ) of its length, and stores what a bar does.
#[test]
fn a_rod_is_pulled_out_of_its_bore_as_far_as_its_load_asks() {
    let (radius, bound, load) = (0.1, 0.02, 0.3);
    let text = ring("rod", [0.0, radius], [0.0, 1.0], 0.0).replace("rod_bore", "")
        + &format!("[[tractions]]\non = \"rod_top\"\nvalue = [0.0, {load:?}]\n")
        + &format!("[[contacts]]\non = \"rod_out\"\nfriction = {{ bound = {bound:?} }}\n");
    let area = 0.5 * TAU * radius * radius;
    let (force, along) = (load * area, TAU * radius * bound);
    let stored = force.powi(3) / (6.0 * along * area);
    // Shear is ½ ∫ (τ r/R)²/G at most.
    let shear = area * bound * bound / 4.0 * 2.0 * (force / along);
    let [lower, upper] = bracket(&text, 2);
    assert!(lower <= -stored && upper >= -stored - shear, "{lower} {upper} {stored} {shear}");
    assert!(upper - lower < 0.02 * stored, "{lower} {upper} {stored}");
}

#[test]
fn a_fit_is_pushed_out_by_the_force_that_statics_asks_for() {
    let pushed = |load: f64| {
        ring("shaft", [0.0, 1.0], [0.0, 0.5], NU).replace("shaft_bore", "")
            + &ring("hub", [1.0, 2.0], [0.0, 0.5], NU)
            + "[[supports]]\non = \"hub_foot\"\ntype = \"clamped\"\n"
            + &format!("[[tractions]]\non = \"shaft_top\"\npressure = {load:?}\n")
            + "[[contacts]]\nbetween = [\"shaft_out\", \"hub_bore\"]\ngap = -0.01\nfriction = { bound = 0.04 }\n"
    };
    // 2π r l τ̄ over the face of the shaft.
    let most = TAU * 0.5 * 0.04 / (0.5 * TAU);
    let Err(StudyError::NoEquilibrium { .. }) = tried(&pushed(1.001 * most), 1) else { panic!("a shaft that is held") };
    let message = tried(&pushed(1.001 * most), 1).expect_err("none").to_string();
    assert!(message.contains("slides") && message.contains("friction resists with 0.125"), "{message}");
    let found = tried(&pushed(0.999 * most), 2).unwrap_or_else(|e| panic!("{e}"));
    let [lower, upper] = ends(&found);
    assert!(lower < upper);
}

/// A disc on another one with friction that varies along the seat, which reaches the axis or a bore: brackets of all degrees hold one energy.
#[test]
fn brackets_of_all_degrees_hold_one_energy() {
    let mut random = Random::new(4747);
    for seed in 0..4 {
        let inside = if random.chance(0.5) { 0.0 } else { random.magnitude(-2.0, 0.5) };
        let radius = inside + random.between(0.8, 1.5);
        let (foot, top) = (random.between(0.3, 0.8), random.between(1.2, 1.6));
        let bodies = ring("low", [inside, radius], [0.0, foot], 0.2) + &ring("up", [inside, radius], [foot, top], 0.4);
        let bodies = if inside == 0.0 { bodies.replace("low_bore", "").replace("up_bore", "") } else { bodies };
        let (a, b) = (random.between(0.0, 0.1), random.between(0.0, 0.1));
        let bound =
            [format!("{a:?}"), format!("[[0.0, {a:?}], [0.3, {b:?}], [0.6, 0.0]]"), "[[0.0, 0.0], [2.0, 0.3]]".into()];
        let law = if seed == 3 {
            format!("stiffness = {:?}", random.magnitude(-1.0, 3.0))
        } else {
            format!("friction = {{ bound = {} }}", bound[seed])
        };
        let text = bodies
            + "[[supports]]\non = \"low_foot\"\ntype = \"clamped\"\n"
            + &format!("[[tractions]]\non = \"up_top\"\npressure = {:?}\n", random.between(0.1, 0.4))
            + &format!("[[tractions]]\non = \"up_out\"\nvalue = [{:?}, 0.0]\n", random.between(-0.3, 0.3))
            + &format!("[[contacts]]\nbetween = [\"low_top\", \"up_foot\"]\ngap = [[0.0, 0.0], [2.0, 0.05]]\n{law}\n");
        let all = [1, 2, 3].map(|degree| bracket(&text, degree));
        let highest = all.iter().fold(f64::NEG_INFINITY, |m, b| m.max(b[0]));
        let lowest = all.iter().fold(f64::INFINITY, |m, b| m.min(b[1]));
        assert!(highest <= lowest && all[2][0] > all[0][0], "{all:?}\n{text}");
        assert!(all[2][1] - all[2][0] < 0.1 * all[2][1].abs(), "{all:?}\n{text}");
    }
}

/// On one triangle beside the axis linear stresses have no pressure along a direction that turns: refinement begins with more.
#[test]
fn contact_that_turns_on_the_axis_is_refined_from_one_edge() {
    let text = "[model]\nkinematics = \"axisymmetric\"\n".to_string()
        + &ring("block", [0.0, 2.0], [0.0, 2.0], NU).replace("block_bore", "")
        + "[[tractions]]\non = \"block_top\"\npressure = 0.01\n"
        + "[[contacts]]\non = \"block_foot\"\nobstacle = { circle = { centre = [0, -50], radius = 50 } }\n";
    let scene = Scene::parse(&text, "contact.toml".as_ref()).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let problem = Problem::load(scene).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let options = Options { elements: Elements::Uniform(block(1)), ..Options::default() };
    let adapted = adapt(problem, &Condensed::default(), &options, &Goal::new(0.03), |_| ());
    let adapted = adapted.unwrap_or_else(|e| panic!("{e}\n{text}"));
    assert!(adapted.history.first().is_some_and(|row| row.triangles < 10) && adapted.stopped.is_none());
    let bracket = &adapted.certified.bracket;
    let [lower, upper] = [bracket.lower(), bracket.free.as_ref().expect("an upper bound").upper()];
    assert!(lower < upper && upper - lower < 1e-3 * -upper, "{lower} {upper}");
}
