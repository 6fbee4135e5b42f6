//! The element of `examples/own_element.rs`, from [`EquilibriumElement`] to a solution.

#[path = "../../examples/own_element.rs"]
mod example;

use crate::setup::blocks::{blocks, tilting};
use example::{PLAIN, solution};
use hypercircle::bounds::{Bracket, complementary};
use hypercircle::element::block;
use hypercircle::problem::Problem;
use hypercircle::scene::Draft;

/// Lift-off between blocks of two materials, on triangles of every shape, with and without weight.
fn problems() -> Vec<Problem> {
    let bent = |[x, y]: [f64; 2]| [x, y + 0.1 * (3.0 * x).sin() * y * (1.0 - y)];
    let heavy = || {
        let mut problem = blocks([(1.0, 0.3), (3.0, 0.1)], [3, 4], tilting).map(bent).build();
        let weight = |draft: &mut Draft| draft.bodies[0].body_force = [0.2, -0.4].into();
        problem.scene = problem.scene.changed(weight).expect("a valid scene");
        problem
    };
    vec![heavy(), blocks([(1.0, 0.4999), (0.5, 0.4)], [4, 3], tilting).map(bent).build()]
}

#[test]
fn an_element_of_one_file_gives_the_bound_of_the_shipped_one() {
    for problem in problems() {
        let [own, shipped] = [solution(&problem, &PLAIN), solution(&problem, block(2))].map(|s| s.expect("solves"));
        let [mine, theirs] = [&own, &shipped].map(|s| complementary(&problem, &s.stress));
        let scale = theirs.strain;
        assert!((mine.lower() - theirs.lower()).abs() < 1e-10 * scale, "{} and {}", mine.lower(), theirs.lower());
        assert!(own.equilibrium.residual() < 1e-9, "{:?}", own.equilibrium);
        // The space of least energy is unique, and so is the field.
        let mut largest = 0.0_f64;
        let mut off = 0.0_f64;
        for t in 0..own.stress.len() {
            for (a, b) in own.stress.block(t).as_flattened().iter().zip(shipped.stress.block(t).as_flattened()) {
                (largest, off) = (largest.max(b.abs()), off.max((a - b).abs()));
            }
        }
        assert!(off < 1e-8 * largest, "{off:e} of {largest:e}");
        let bracket = Bracket::new(&problem, &own);
        let upper = bracket.free.as_ref().expect("an upper bound").upper();
        assert!(bracket.lower() < upper && upper - bracket.lower() < 0.05 * scale);
    }
}
