//! The border of equilibrium: each scene on either side of it, however turned, scaled and numbered.

use super::build::{renumbered, transformed};
use super::scenes::{Case, Gives, cases};
use crate::problem::Problem;
use crate::statics::{MotionKind, Moving, Solvability, check};

/// The motion a scene is found to give way in, and the sentence; `None` where it stands.
fn gives(problem: &Problem) -> Option<(Vec<Moving>, f64, String)> {
    match check(problem).unwrap().equilibrium {
        Solvability::Possible { .. } => None,
        Solvability::Impossible { work, bodies, sentence, .. } => Some((bodies, work, sentence)),
    }
}

/// Checks that `found` is the motion of `case`, both brought to the position x ↦ length · R(angle) x + shift.
fn assert_same(case: &Case, found: &[Moving], angle: f64, length: f64, shift: [f64; 2]) {
    let (sin, cos) = angle.sin_cos();
    let turn = |[x, y]: [f64; 2]| [cos * x - sin * y, sin * x + cos * y];
    let lead = &found[0];
    assert_eq!(lead.bodies, [case.body], "{}", case.name);
    assert!(case.gives.is(lead.kind), "{}: {:?}", case.name, lead.kind);
    let (expected, got) = match (&case.gives, lead.kind) {
        (Gives::Lifts(direction), _) => {
            let norm = lead.displacement[0].hypot(lead.displacement[1]);
            (turn(*direction), lead.displacement.map(|x| x / norm))
        }
        (Gives::Tips(at) | Gives::Turns(at), MotionKind::Tips { centre } | MotionKind::Turns { centre }) => {
            (turn(*at), [0, 1].map(|i| (centre[i] - shift[i]) / length))
        }
        _ => unreachable!("kinds were compared"),
    };
    for i in 0..2 {
        assert!((expected[i] - got[i]).abs() < 1e-6, "{}: {expected:?} against {got:?}", case.name);
    }
}

#[test]
fn loads_far_and_near_the_border_fall_on_the_right_side() {
    assert_eq!(cases().len(), 20);
    for case in cases() {
        for inside in [-0.3, -1e-3, -1e-6, -1e-8, 0.0] {
            assert!(gives(&(case.scene)(inside)).is_none(), "{} at {inside}", case.name);
        }
        for outside in [1e-8, 1e-6, 1e-3] {
            let found = gives(&(case.scene)(outside));
            let (bodies, work, sentence) = found.unwrap_or_else(|| panic!("{} at {outside}", case.name));
            assert!(work > 0.0 && sentence.contains(&format!("`{}`", case.body)), "{}: {sentence}", case.name);
            assert_same(&case, &bodies, 0.0, 1.0, [0.0; 2]);
        }
    }
}

#[test]
fn turning_scaling_shifting_and_renumbering_change_nothing() {
    for case in cases() {
        for (angle, length, force, shift) in [
            (0.7, 1.0, 1.0, [0.0; 2]),
            (2.0, 1e9, 1e-9, [1e9, -3e9]),
            (-1.1, 1e-9, 1e9, [2e-9, 1e-8]),
            (0.1, 1e-6, 1e-9, [1e-4, 0.0]),
        ] {
            let moved = |excess: f64| renumbered(transformed((case.scene)(excess), angle, length, force, shift));
            assert!(gives(&moved(-1e-6)).is_none(), "{} turned by {angle}", case.name);
            let (bodies, ..) = gives(&moved(1e-6)).unwrap_or_else(|| panic!("{} turned by {angle}", case.name));
            assert_same(&case, &bodies, angle, length, shift);
        }
    }
}

/// The work of the loads on the motion is what a finite difference of the picture gives: traction times displacement.
#[test]
fn motion_is_allowed_and_its_work_is_positive() {
    for case in cases() {
        let problem = (case.scene)(1e-3);
        let statics = check(&problem).unwrap();
        let Solvability::Impossible { motion, work, .. } = &statics.equilibrium else { panic!("{}", case.name) };
        let u = motion.at_vertices(&problem, &statics.components);
        for pair in problem.pairs() {
            for end in 0..2 {
                let v = u[pair.first[end]];
                let w = pair.second.map_or([0.0; 2], |second| u[second[end]]);
                let jump = (v[0] - w[0]) * pair.normal[0] + (v[1] - w[1]) * pair.normal[1];
                assert!(jump < 1e-10, "{}: penetrates by {jump}", case.name);
            }
        }
        assert!((work - super::freedom::work_of_vertices(&problem, &u)).abs() < 1e-12, "{}", case.name);
    }
}

#[test]
fn sentences_read_well() {
    let sentence = |name: &str| {
        let case = cases().into_iter().find(|case| case.name == name).unwrap();
        gives(&(case.scene)(0.5)).unwrap().2
    };
    assert_eq!(
        sentence("block lifted off its base"),
        "Body `top` lifts off its contact `top|base` in direction (0, 1): nothing holds it against the load 0.5."
    );
    assert_eq!(
        sentence("leaning tower"),
        "Body `tower` tips clockwise about (1, 1) off its contact `tower|base`: nothing holds it against the moment \
         0.25 of its load about that point."
    );
    assert_eq!(
        sentence("wedge raises a block"),
        "Body `wedge` lifts off its contact `wedge|rigid` in direction (-1, 0): body `block` moves with it, nothing \
         resists, and the loads do work 1 on this motion (largest displacement 1)."
    );
}
