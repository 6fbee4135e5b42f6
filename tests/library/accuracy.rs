//! Equilibrium to round-off where naive formulas lose it, and what each step of the method wins.

use crate::setup::blocks::{blocks, cornered, scaled, sliding, solved, tilting};
use crate::setup::{Role, Setup, lift_off};
use hypercircle::dual::{self, Condensed, DualError, Equilibrium, Options};
use hypercircle::problem::{Condition, Problem};

const ALLOWED: f64 = 1e-11;

fn residual(e: &Equilibrium) -> f64 {
    e.jump.max(e.applied).max(e.resultant).max(e.tension)
}

/// Equilibrium of the solution, allowed to be off by round-off only.
fn equilibrated(what: &str, problem: &Problem) {
    let found = solved(problem, Condensed::default());
    let plain = solved(problem, Condensed { most_refinements: 0, ..Condensed::default() });
    println!(
        "{what}: {:.1e} (resultant {:.1e}), without refinement {:.1e}",
        residual(&found.equilibrium),
        found.equilibrium.resultant,
        residual(&plain.equilibrium)
    );
    assert!(residual(&found.equilibrium) <= ALLOWED, "{what}: {:?}", found.equilibrium);
}

#[test]
fn every_poisson_ratio() {
    for nu in [0.0, 0.3, 0.49, 0.4999, 0.499999] {
        equilibrated(&format!("ν = {nu}"), &blocks([(1.0, nu); 2], [12, 12], tilting).build());
    }
}

#[test]
fn every_stiffness_ratio() {
    for (left, right) in [(1e4, 1.0), (1e8, 1.0), (1.0, 1e8), (1.0, 1e4)] {
        let problem = blocks([(left, 0.3), (right, 0.3)], [12, 12], tilting).build();
        equilibrated(&format!("E = {left:e} on {right:e}"), &problem);
    }
}

#[test]
fn every_system_of_units() {
    for size in [1e-3, 1e3] {
        let problem = scaled(&lift_off(12), size, 1e6, 2.1e11);
        equilibrated(&format!("E = 2.1e11, length {size:e}"), &problem);
    }
}

#[test]
fn stretched_triangles() {
    for stretch in [1e2, 1e4] {
        let flat = |p: [f64; 2]| [p[0], p[1] / stretch];
        let strip = blocks([(1.0, 0.3); 2], [12, 12], |_| [1.0, 0.0]).on("right.bottom", Role::Roller);
        equilibrated(&format!("flat by {stretch:e} on a roller"), &strip.map(flat).build());
        let layer = |p: [f64; 2]| [if p[0] > 1.0 { 1.0 + (p[0] - 1.0) / stretch } else { p[0] }, p[1]];
        equilibrated(
            &format!("layer thin by {stretch:e}"),
            &blocks([(1.0, 0.3); 2], [12, 12], tilting).map(layer).build(),
        );
        let both = blocks([(1.0, 0.499999), (1e4, 0.3)], [12, 12], tilting).map(layer).build();
        equilibrated(&format!("thin by {stretch:e}, nearly incompressible on stiff"), &both);
    }
}

/// A cantilever whose free end is in contact. Here the body is badly conditioned and not its triangles: the round-off of
/// a traction acts on the long sides, the load on the short ones.
#[test]
fn slender_cantilever() {
    for slenderness in [1e2, 3e2, 1e3, 3e3, 1e4] {
        let rod = blocks([(1.0, 0.3); 2], [12, 12], |_| [1.0, 0.0]).map(|p| [p[0], p[1] / slenderness]).build();
        equilibrated(&format!("slender by {slenderness:e}"), &rod);
    }
}

#[test]
fn bodies_that_contact_alone_holds() {
    equilibrated("in a corner", &cornered(1.0));
    equilibrated("in a corner, stiff", &cornered(2.1e11));
    equilibrated("free to slide", &sliding());
}

/// A stiff punch on a soft foundation: it moves as a rigid body, and its strains are what is left of that motion.
#[test]
fn refinement_on_the_stresses_wins_what_a_rigid_motion_hides() {
    let punch = |young: f64| {
        Setup::default()
            .material("soft", [0.0, 0.0], [1.0, 1.0], [12, 12], 1.0, 0.3, [0.0; 2])
            .material("stiff", [0.0, 1.0], [1.0, 2.0], [12, 12], young, 0.3, [0.0; 2])
            .on("soft.bottom", Role::Clamped([0.0; 2]))
            .on("stiff.top", Role::Load(|[x, _]| [0.2, -1.0 - x]))
            .on("stiff.left", Role::Load(|[_, y]| [0.1 * y, 0.0]))
            .on("stiff.right", Role::Roller)
            .contact("soft.top", Some("stiff.bottom"), |_| 0.0)
            .build()
    };
    for young in [1e4, 1e8] {
        let problem = punch(young);
        let residuals: Vec<f64> = (0..4)
            .map(|most_refinements| {
                residual(&solved(&problem, Condensed { most_refinements, ..Condensed::default() }).equilibrium)
            })
            .collect();
        println!("E = {young:e}: {residuals:?}");
        assert!(residuals[3] <= ALLOWED);
        assert!(residuals[0] > 1e-17 * young && residuals[0] > 30.0 * residuals[3], "{residuals:?}");
    }
}

#[test]
fn nothing_to_solve_for_is_no_failure() {
    // Two triangles, all four sides clamped, and one of them alone: no unknown at all.
    let clamped = || {
        let sides = ["bottom", "right", "top", "left"];
        let square = Setup::default().material("body", [0.0; 2], [1.0; 2], [1, 1], 1.0, 0.3, [1.0, 2.0]);
        sides.into_iter().fold(square, |s, side| s.on(&format!("body.{side}"), Role::Clamped([0.0; 2])))
    };
    let two = solved(&clamped().build(), Condensed::default());
    assert_eq!((two.unknowns, two.closed.len()), (4, 0));
    assert!(residual(&two.equilibrium) <= ALLOWED);
    let mut one = clamped().without(|[x, y]| y > x).build();
    for condition in &mut one.conditions {
        *condition = Condition::Clamped([[0.0; 2]; 2]);
    }
    let one = solved(&one, Condensed::default());
    assert_eq!(one.unknowns, 0);
    assert!(residual(&one.equilibrium) <= ALLOWED);
}

#[test]
fn a_body_without_hold_is_refused_or_balanced() {
    // The free motions are kept from the solver on purpose.
    let afloat = |load: fn([f64; 2]) -> [f64; 2]| {
        Setup::default()
            .rectangle("body", [0.0; 2], [1.0; 2], 4)
            .on("body.left", Role::Load(load))
            .on("body.right", Role::Load(|_| [1.0, 0.0]))
            .build()
    };
    let solve = |p: &Problem| dual::solve(&Condensed::default(), p, &[], &Options::default());
    match solve(&afloat(|_| [1.0, 0.0])) {
        Err(DualError::Factorisation { reason }) => println!("{reason}"),
        Err(other) => panic!("{other}"),
        Ok(found) => assert!(residual(&found.equilibrium) > 1e-3, "an unbalanced load cannot be balanced"),
    }
}
