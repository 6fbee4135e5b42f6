//! A block on a rigid cylinder, given by the distance of a circle from its straight foot: Hertz's pressure.
//!
//! `tests/meshes/foot.msh` was written by gmsh 4.15 from `foot.geo`. The block is 120 times as large as the contact, so that
//! the formula for the half-plane holds to about 0.005 %.

use hypercircle::dual::{self, Condensed, DualSolution, Options};
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;
use hypercircle::study::{Goal, Wanted, adapt, answers};

/// Force on half the block, radius of the cylinder.
const FORCE: f64 = 0.009;
const RADIUS: f64 = 50.0;

/// Half of the block over that gap.
pub fn foot(gap: &str) -> Problem {
    foot_asked(gap, "")
}

/// As [`foot`], with tables of `quantities`.
fn foot_asked(gap: &str, quantities: &str) -> Problem {
    let text = format!(
        "[model]\nkinematics = \"plane-strain\"\n[mesh]\nfile = \"foot.msh\"\n\
         [bodies.block]\nyoung = 1.0\npoisson = 0.3\n[[supports]]\non = \"axis\"\ntype = \"roller\"\n\
         [[tractions]]\non = \"top\"\npressure = {:?}\n[[contacts]]\non = \"foot\"\ngap = {gap}\n{quantities}",
        FORCE / 120.0
    );
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/meshes/foot.toml");
    Problem::load(Scene::parse(&text, &file).expect("a scene")).expect("a problem")
}

/// The largest pressure relative to p₀ = √(F E* / (π R)), less one.
fn peak_off(dual: &DualSolution) -> f64 {
    let pressures = dual.contact_traction[0].values();
    let modulus = 1.0 / (1.0 - 0.09);
    let exact = (2.0 * FORCE * modulus / (std::f64::consts::PI * RADIUS)).sqrt();
    pressures.iter().fold(0.0_f64, |m, t| m.max(-t)) / exact - 1.0
}

#[test]
fn the_peak_pressure_gets_better_from_mesh_to_mesh() {
    for gap in ["{ circle = 50, at = 0 }", "{ parabola = 50, at = 0 }"] {
        let mut last = 3e-3_f64;
        for n in 0..3 {
            let problem = foot(gap).refine_uniform(n).expect("refines");
            let dual = dual::solve(&Condensed::default(), &problem, &[], &Options::default()).expect("solves");
            let off = peak_off(&dual);
            println!("{gap}, refined {n} times: {:+.4} %", 100.0 * off);
            assert!(off.abs() < 0.5 * last, "{off} after {last}");
            last = off.abs();
        }
    }
}

#[test]
fn adaptive_refinement_does_not_show_the_edges_in_the_peak() {
    let goal = Goal::new(5e-4);
    let adapted = adapt(foot("{ circle = 50, at = 0 }"), &Condensed::default(), &Options::default(), &goal, |_| ());
    let adapted = adapted.expect("solves");
    let off = peak_off(&adapted.certified.dual);
    println!("{:+.4} %", 100.0 * off);
    assert!(off.abs() < 5e-4, "{off}");
}

/// The mean of p₀ √(1 − x²/a²) over the middle half of the contact, |x| < a/2, where a weight that falls from 1 to 0 between
/// 0.45 a and 0.55 a takes the place of the edge.
#[test]
fn the_mean_pressure_over_the_middle_half_of_the_contact_is_that_of_hertz() {
    let modulus = 1.0 / (1.0 - 0.09);
    let half_width = (8.0 * FORCE * RADIUS / (std::f64::consts::PI * modulus)).sqrt();
    let peak = 4.0 * FORCE / (std::f64::consts::PI * half_width);
    let [full, none] = [0.45, 0.55].map(|part| part * half_width);
    let weight = |x: f64| ((none - x) / (none - full)).clamp(0.0, 1.0);
    let steps = 20_000;
    let middle = |i: i32| (f64::from(i) + 0.5) * none / f64::from(steps);
    let integral = |f: &dyn Fn(f64) -> f64| (0..steps).map(|i| f(middle(i))).sum::<f64>() * none / f64::from(steps);
    let mean = |force: f64| force / integral(&weight);
    let exact = mean(integral(&|x| weight(x) * peak * (1.0 - (x / half_width).powi(2)).sqrt()));

    let table =
        format!("[[quantities]]\nname = \"middle\"\nforce = \"foot|rigid\"\nwindow = [0.0, 0.0, {full:?}, {none:?}]\n");
    let wanted = vec![Wanted { name: "middle".to_string(), tolerance: 1e-3 }];
    let goal = Goal { wanted, max_triangles: Some(20_000), ..Goal::new(f64::INFINITY) };
    let options = Options { keep_factor: true, ..Options::default() };
    let problem = foot_asked("{ circle = 50, at = 0 }", &table);
    let adapted = adapt(problem, &Condensed::default(), &options, &goal, |_| ()).expect("an answer");
    assert_eq!(adapted.stopped, None);
    let interval = answers(&adapted.certified, &options, |_| true).pop().expect("one answer").interval;
    let [low, high] = interval.ends.map(mean);
    println!("{exact} in [{low}, {high}], {} triangles", adapted.certified.problem.mesh.triangles.len());
    // The block is no half-plane: by 5e-5.
    assert!(low <= exact * (1.0 + 1e-4) && exact * (1.0 - 1e-4) <= high, "{exact} in [{low}, {high}]");
    assert!(high - low <= 2.1e-3 * exact && (mean(interval.value) / exact - 1.0).abs() < 5e-4);
}
