//! Where refinement ends: at its tolerance, though rounding of the data could explain what is left of the gap, or with the reason
//! that ended it and advice that follows from that.

use crate::support::toml::Toml;
use hypercircle::dual::{Condensed, Options};
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;
use hypercircle::study::{Adapt, Adapted, Goal, adapt};

/// A stiff block turned and pressed on a soft one, from which it is apart by a wedge.
fn wedge(ratio: f64) -> Problem {
    let text = Toml::default()
        .polygon("lower", &[[0.0, -2.0], [2.0, -2.0], [2.0, 0.0], [0.0, 0.0]], ["ground", "", "low", "axis_low"])
        .polygon("upper", &[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]], ["up", "", "top", "axis_up"])
        .material("lower", 1.0, 0.3)
        .material("upper", ratio, 0.3)
        .clamp("ground")
        .roller("axis_low")
        .roller("axis_up")
        .table("[[tractions]]\non = \"top\"\nvalue = [0.0, -1.5e-4]\ngradient = [[0.0, 0.0], [0.0, 3.7e-5]]")
        .table("[[contacts]]\nbetween = [\"low\", \"up\"]\ngap = [[0.0, 0.0], [2.0, 0.0315]]")
        .text();
    Problem::load(Scene::parse(&text, "scene.toml".as_ref()).expect("a scene")).expect("a problem")
}

fn run(problem: Problem, goal: &Goal) -> Adapted {
    adapt(problem, &Condensed::default(), &Options::default(), goal, |_| ()).expect("an answer")
}

/// A gap is round-off of the stiffest body where it is crossed by it, 64 ε E g², which here is more than all energy: the run
/// ended at 8 %, and advised larger limits.
#[test]
fn a_stiff_body_on_a_soft_one_is_refined_to_the_tolerance() {
    for ratio in [1.0, 1e7] {
        let goal = Goal { adapt: Adapt::Hp, ..Goal::new(0.003) };
        let adapted = run(wedge(ratio), &goal);
        let last = adapted.history.last().expect("one mesh");
        assert_eq!(adapted.stopped, None, "{ratio:e}");
        assert!(last.relative_error_bound <= 0.003, "{ratio:e}: {last:?}");
    }
}

#[test]
fn advice_follows_from_what_ended_the_run() {
    let limits: [(&str, Goal); 2] = [
        ("--max-triangles", Goal { max_triangles: Some(60), ..Goal::new(1e-4) }),
        ("--max-seconds", Goal { max_seconds: Some(1e-9), ..Goal::new(1e-4) }),
    ];
    for (option, goal) in limits {
        let adapted = run(wedge(1.0), &goal);
        let advice = adapted.advice.expect("a limit was met");
        assert!(advice.contains(option) && adapted.stopped.is_some(), "{advice}");
    }
    // A patch is solved exactly; below rounding there is nothing, and no limit has a part in that.
    let patch = Toml::default()
        .polygon("a", &[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], ["foot", "", "top", "side"])
        .roller("foot")
        .roller("side")
        .pressure("top", 1.0)
        .text();
    let problem = Problem::load(Scene::parse(&patch, "scene.toml".as_ref()).expect("a scene")).expect("a problem");
    let adapted = run(problem, &Goal { max_triangles: Some(1000), ..Goal::new(1e-12) });
    let (stopped, advice) = (adapted.stopped.expect("out of reach"), adapted.advice.expect("advice"));
    assert!(stopped.contains("is no more than rounding can leave"), "{stopped}");
    assert!(advice.starts_with("No limit of this run was met") && !advice.contains("--max"), "{advice}");
    assert!(adapted.history.len() <= 2);
}
