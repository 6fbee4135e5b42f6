//! A block on a rigid cylinder, given by the distance of a circle from its straight foot: Hertz's peak pressure.
//!
//! `tests/meshes/foot.msh` was written by gmsh 4.15 from `foot.geo`. The block is 120 times as large as the contact, so that
//! the formula for the half-plane holds to about 0.005 %.

use hypercircle::dual::{self, Condensed, DualSolution, Options};
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;
use hypercircle::study::{Goal, adapt};

/// Force on half the block, radius of the cylinder.
const FORCE: f64 = 0.009;
const RADIUS: f64 = 50.0;

/// Half of the block over that gap.
pub fn foot(gap: &str) -> Problem {
    let text = format!(
        "[model]\nkinematics = \"plane-strain\"\n[mesh]\nfile = \"foot.msh\"\n\
         [bodies.block]\nyoung = 1.0\npoisson = 0.3\n[[supports]]\non = \"axis\"\ntype = \"roller\"\n\
         [[tractions]]\non = \"top\"\npressure = {:?}\n[[contacts]]\non = \"foot\"\ngap = {gap}\n",
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
